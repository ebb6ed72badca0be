"""The bibliography: complete entries, and an entry for every source that is cited."""

import re
from collections.abc import Iterator
from pathlib import Path

from derivation.engine.files import ROOT
from derivation.plate.report.prose import REFERENCES

NEEDED = {
    "article": {"author", "title", "journal", "volume", "pages", "year", "doi"},
    "book": {"author", "title", "publisher", "year"},
    "incollection": {"author", "title", "booktitle", "publisher", "year"},
    "misc": {"title", "howpublished", "year"},
}
"""Required fields of an entry, by its type."""
CITED = re.compile(
    r"((?:[A-Z][A-Za-zéöüíä]+(?:, | and | & ))*[A-Z][A-Za-zéöüíä]+)(?: et al\.)?"
    r"(?:,? (?:[A-Z]\. )*(?:and [A-Z][a-z]+, [A-Z]\. [A-Z]\. )?)?,? \(?((?:18|19|20)\d\d)\b(?!-)"
)
UMLAUTS = str.maketrans({"ö": "oe", "ü": "ue", "ä": "ae", "é": "e", "í": "i"})
NO_AUTHORS = {"January", "Version", "Python", "Copyright"}


def test_entries_of_the_bibliography_are_complete() -> None:
    """The paper itself is excluded, because its copy states no author."""
    for key, entry in REFERENCES.entries.items():
        missing = NEEDED[entry["type"]] - set(entry)
        assert not missing or key == "paper", (key, missing)
        assert re.fullmatch(r"10\.\d{4,}/\S+", entry.get("doi", "10.1000/1")), key
        assert re.fullmatch(r"(18|19|20)\d\d", entry.get("year", "2000")), key
    dois = [entry["doi"] for entry in REFERENCES.entries.values() if "doi" in entry]
    assert len(set(dois)) == len(dois)
    assert REFERENCES.bib().count("\n@") + 1 == len(REFERENCES.entries)


def citations() -> Iterator[tuple[Path, str]]:
    """Yield first author and year of each source that code, documentation and report cite."""
    for folder, kinds in {"derivation": "py toml j2", "docs": "md py", "generated": "py"}.items():
        for path in sorted(p for kind in kinds.split() for p in (ROOT / folder).rglob(f"*.{kind}")):
            if path.name not in ("references.toml", "materials.toml"):
                for authors, year in CITED.findall(path.read_text()):
                    first = re.split(r",? and |, | & ", authors)[0]
                    if first not in NO_AUTHORS:
                        yield path, first.translate(UMLAUTS).lower() + year


def test_cited_sources_are_in_the_bibliography() -> None:
    actual = {key: path for path, key in citations()}
    assert {"thornton1997", "kuwabara1987", "chung2011", "sneddon1965"} <= set(actual)
    assert {key: path for key, path in actual.items() if key not in REFERENCES.entries} == {}


def test_sources_of_materials_are_in_the_bibliography() -> None:
    """Standards are found by their number, books and articles by their author."""
    text = (ROOT / "derivation" / "scene" / "input" / "materials.toml").read_text()
    keys = {f"en{number}" for number in re.findall(r"\bEN (\d+(?:-\d)*)", text)}
    assert keys <= set(REFERENCES.entries)
    assert {"en1993-1-1", "en572-1"} <= keys
    for author in ("Wyllie", "Goodman", "Kaye and Laby", "Gammon"):
        assert author in text
        assert any(key.startswith(author.lower().split()[0]) for key in REFERENCES.entries)
