"""The sources of a paper: a table in a TOML file, as references of the report and .bib file."""

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from derivation.engine.report.latex import escape

Entry = Mapping[str, str]


@dataclass(frozen=True)
class References:
    """The sources of a paper, read from a TOML file; without a file there are none."""

    table: Path | None = None

    @cached_property
    def _rows(self) -> dict[str, dict[str, str]]:
        rows = {} if self.table is None else tomllib.loads(self.table.read_text(encoding="utf-8"))
        return dict(sorted(rows.items()))

    @property
    def entries(self) -> dict[str, Entry]:
        """Sources by key, in alphabetical order, without the entry `steps` (see `cited`)."""
        return {
            key: {name: text for name, text in entry.items() if name != "steps"}
            for key, entry in self._rows.items()
        }

    def cited(self, step: str) -> list[str]:
        """Return the keys of the sources that a step of the derivation uses."""
        return [key for key, entry in self._rows.items() if step in entry.get("steps", ())]

    def bib(self) -> str:
        """Return the sources as the text of a BibTeX file."""
        return "\n".join(bib_entry(key, entry) for key, entry in self.entries.items())

    def items(self) -> list[dict[str, str]]:
        """Return key and LaTeX of every source, as the report lists them."""
        return [{"key": key, "text": item(entry)} for key, entry in self.entries.items()]


def bib_entry(key: str, entry: Entry) -> str:
    """Return a BibTeX entry; braces keep the capitals of the title."""
    fields = [
        f"  {name} = {{{{{text}}}}}," if name == "title" else f"  {name} = {{{text}}},"
        for name, text in entry.items()
        if name != "type"
    ]
    return "\n".join([f"@{entry['type']}{{{key},", *fields, "}", ""])


def item(entry: Entry) -> str:
    """Return a source as LaTeX in one line."""
    return ", ".join(_parts(entry)) + "."


def _parts(entry: Entry) -> Iterator[str]:
    if "author" in entry:
        yield names(entry["author"])
    yield rf"\emph{{{escape(entry['title'])}}}"
    if "journal" in entry:
        yield rf"{escape(entry['journal'])} \textbf{{{entry['volume']}}}, {entry['pages']}"
    if "edition" in entry:
        yield {"2": "2nd", "3": "3rd"}.get(entry["edition"], f"{entry['edition']}th") + " edition"
    for name in ("publisher", "howpublished", "note"):
        if name in entry:
            yield escape(
                entry[name][0].lower() + entry[name][1:] if name == "note" else entry[name]
            )
    if "year" in entry:
        yield entry["year"]
    if "doi" in entry:
        yield rf"\href{{https://doi.org/{entry['doi']}}}{{doi:{escape(entry['doi'])}}}"


def names(authors: str) -> str:
    """Return `Last, First and ...` as `F. Last, ...`; a name in braces is not changed."""
    people = authors.split(" and ")
    surnames = [_name(person) for person in people if person != "others"]
    return ", ".join(surnames) + (" and others" if "others" in people else "")


def _name(person: str) -> str:
    if person.startswith("{"):
        return escape(person.strip("{}"))
    last, _, first = person.partition(", ")
    return "~".join([*(f"{part[0]}." for part in first.split()), escape(last)])
