"""The page of known cases: its blocks print what it says, and its last table has every case."""

import doctest
import re

from derivation.engine.files import ROOT

PAGE = ROOT / "docs" / "known_cases.md"
TEXT = PAGE.read_text()


def test_the_page_prints_what_it_says() -> None:
    found = doctest.testfile(str(PAGE), module_relative=False)
    assert found.attempted > 50
    assert not found.failed


def test_every_case_is_in_the_last_table() -> None:
    cases, _, table = TEXT.partition("## All cases")
    numbers = re.findall(r"^## (\d+)\. ", cases, re.M)
    assert numbers == [str(number + 1) for number in range(len(numbers))]
    assert set(re.findall(r"^(\d+)\. ", table, re.M)) == set(numbers)


def test_the_readme_links_the_page() -> None:
    assert "](docs/known_cases.md)" in (ROOT / "README.md").read_text()
