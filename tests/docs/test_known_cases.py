"""The page of known cases: its last table lists every case."""

import re

from derivation.engine.files import ROOT

TEXT = (ROOT / "docs" / "guides" / "known_cases.md").read_text()


def test_last_table_lists_every_case() -> None:
    cases, _, table = TEXT.partition("## All cases")
    numbers = re.findall(r"^## (\d+)\. ", cases, re.M)
    assert numbers == [str(number + 1) for number in range(len(numbers))]
    assert set(re.findall(r"^(\d+)\. ", table, re.M)) == set(numbers)
