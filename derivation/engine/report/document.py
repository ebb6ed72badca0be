"""The LaTeX documents of a report, made of its parts: the report and its appendices."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from derivation.engine.nearest import did_you_mean
from derivation.engine.report.latex import environment
from derivation.engine.report.references import References

REPORT, APPENDICES = "report", "appendices"
"""Names of the two documents, and of their files."""
_REFERENCE = re.compile(r"\\ref\{sec:([\w-]+)\}")
_PART = re.compile(r"\\otherpart\{[\w-]+\}\{([^}]*)\}")


@dataclass(frozen=True)
class Parts:
    """The parts of the documents.

    Attributes
    ----------
    title, front
        Title, and LaTeX in front of the sections.
    sections
        LaTeX by name of section; each begins with its heading and the label `sec:NAME`.
    references
        The sources; a document lists those that it cites.
    """

    title: str
    front: str
    sections: Mapping[str, str]
    references: References


@dataclass(frozen=True)
class Text:
    """The LaTeX of a document in parts: title, title page, sections, references."""

    title: str
    front: str
    sections: tuple[str, ...]
    references: str

    @property
    def figures(self) -> set[str]:
        """Names of the figures in the sections."""
        return set(re.findall(r"\{figures/([\w-]+)\.pdf\}", "".join(self.sections)))

    def document(self, version: str) -> str:
        """Return the whole file; it states the version of the program."""
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


@dataclass(frozen=True)
class Plan:
    """Names of the sections of the report and of its appendices, each in order."""

    sections: tuple[str, ...]
    appendices: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all sections and appendices, in order."""
        return self.sections + self.appendices

    def number(self, name: str) -> str:
        """Return the number of a section, or the letter of an appendix."""
        if name in self.sections:
            return str(self.sections.index(name) + 1)
        return chr(ord("A") + self.appendices.index(name))

    def documents(self, parts: Parts, shown: Sequence[str] = ()) -> dict[str, Text]:
        """Return the documents by name: report and appendices, or one with the given sections."""
        if shown:
            name = "-".join([REPORT, *shown])
            return {name: self._document(parts, parts.title, parts.front, shown, linked=False)}
        texts = {REPORT: self._document(parts, parts.title, parts.front, self.sections)}
        if self.appendices:
            title = f"{parts.title}: appendices"
            front = environment().get_template("appendices.tex.j2").render(title=parts.title)
            texts[APPENDICES] = self._document(parts, title, front, self.appendices)
        return texts

    def _document(
        self, parts: Parts, title: str, front: str, names: Sequence[str], linked: bool = True
    ) -> Text:
        first = next((name for name in names if name in self.appendices), "")
        texts = [front]
        texts += [("\\appendix\n" * (name == first)) + parts.sections[name] for name in names]
        front, *sections = (self._resolved(text, names, linked) for text in texts)
        return Text(title, front, tuple(sections), _listed(parts.references, [front, *sections]))

    def _resolved(self, text: str, names: Sequence[str], linked: bool) -> str:
        """Replace references to sections of another document by their number, and a link."""

        def number(match: re.Match[str]) -> str:
            name = match[1]
            if name in names:
                return match[0]
            other = APPENDICES if name in self.appendices else REPORT
            count = self.number(name)
            return rf"\elsewhere{{{other}}}{{sec:{name}}}{{{count}}}" if linked else count

        text = _REFERENCE.sub(number, text)
        return text if linked else _PART.sub(r"\1", text)


def cited_keys(texts: Sequence[str]) -> Iterator[str]:
    """Yield the keys that texts cite."""
    for text in texts:
        for keys in re.findall(r"\\cite\{([^}]*)\}", text):
            yield from keys.split(",")


def _listed(references: References, texts: Sequence[str]) -> str:
    """Return LaTeX of the list of the sources that texts cite; empty if there are none."""
    keys = set(cited_keys(texts))
    items = [item for item in references.items() if item["key"] in keys]
    return environment().get_template("references.tex.j2").render(items=items) if items else ""


def chosen_sections(names: Sequence[str], known: Sequence[str]) -> tuple[str, ...]:
    """Return the named sections in the report's order.

    Raises
    ------
    ValueError
        If there is no section of a name.
    """
    for name in names:
        if name not in known:
            suggestion = did_you_mean(name, known)
            raise ValueError(
                f"--section: no section {name!r}: {suggestion}expected one of {', '.join(known)}"
            )
    return tuple(name for name in known if name in names)
