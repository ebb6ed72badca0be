"""A report as a LaTeX document, made of its parts."""

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches

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
            near = get_close_matches(name, known, n=1)
            hint = f"did you mean {near[0]}? " if near else ""
            raise ValueError(f"no section {name!r}: {hint}expected one of {', '.join(known)}")
    return tuple(name for name in known if not names or name in names)
