"""A report as a LaTeX document, made of its parts."""

from dataclasses import dataclass

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
