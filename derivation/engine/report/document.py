"""A report as a LaTeX document, made of its parts."""

from collections.abc import Sequence
from dataclasses import dataclass

from derivation.engine.nearest import did_you_mean
from derivation.engine.report.latex import environment


@dataclass(frozen=True)
class Text:
    """A report's LaTeX in parts: title, title page, sections, references."""

    title: str
    front: str
    sections: tuple[str, ...]
    references: str

    def shows(self, figure: str) -> bool:
        """Whether a figure stands in a section."""
        return any(f"figures/{figure}.pdf" in section for section in self.sections)

    def document(self, version: str) -> str:
        """The whole file."""
        return (
            environment()
            .get_template("report.tex.j2")
            .render(
                title=self.title,
                version=version,
                front=self.front,
                sections=[*self.sections, self.references],
            )
        )


def chosen(names: Sequence[str], known: Sequence[str]) -> tuple[str, ...]:
    """Return the named sections in the report's order; all of them if none is named.

    Raises
    ------
    ValueError
        If there is no section of a name.
    """
    for name in names:
        if name not in known:
            near = did_you_mean(name, known)
            raise ValueError(
                f"--section: no section {name!r}: {near}expected one of {', '.join(known)}"
            )
    return tuple(name for name in known if not names or name in names)
