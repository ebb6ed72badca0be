"""The README: length, commands, table of misprints, picture and links."""

import re

from derivation.engine.files import ROOT
from derivation.plate.derived import misprints
from derivation.plate.reporting import README, README_FIGURE

TEXT = (ROOT / README).read_text()


def test_readme_has_at_most_150_lines() -> None:
    assert len(TEXT.splitlines()) <= 150


def test_readme_has_one_command_to_build_and_one_to_test() -> None:
    commands = [
        line
        for line in TEXT.splitlines()
        if line.startswith("python3 -m venv ") and not line.endswith("-e .")
    ]
    assert len(commands) == 2
    assert commands[0].endswith("platecontact build")
    assert commands[1].endswith("pytest")


def test_table_contains_every_misprint() -> None:
    table = TEXT.partition("## What the paper gets wrong")[2].partition("\n## ")[0]
    wrong = {finding.printed.equation for finding in misprints() if finding.is_misprint}
    assert wrong <= set(re.findall(r"\((\d+)\)", table))


def test_picture_exists() -> None:
    assert f"]({README_FIGURE})" in TEXT
    assert (ROOT / README_FIGURE).read_bytes().startswith(b"<?xml")


def test_local_links_have_targets() -> None:
    for link in re.findall(r"\]\(([^)\s]+)\)", TEXT):
        assert (ROOT / link.partition("#")[0]).exists(), link
