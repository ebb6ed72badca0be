"""The page of known cases: its last table has every case."""

import re

from derivation.engine.files import ROOT

TEXT = (ROOT / "docs" / "guides" / "known_cases.md").read_text()


def test_every_case_is_in_the_last_table() -> None:
    cases, _, table = TEXT.partition("## All cases")
    numbers = re.findall(r"^## (\d+)\. ", cases, re.M)
    assert numbers == [str(number + 1) for number in range(len(numbers))]
    assert set(re.findall(r"^(\d+)\. ", table, re.M)) == set(numbers)
