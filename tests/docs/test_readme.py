"""The README: short, with every misprint, a picture, and the two commands that CI runs."""

import re

from derivation.engine.files import ROOT
from derivation.plate.derived import misprints
from derivation.plate.reporting import PICTURE, README

TEXT = (ROOT / README).read_text()


def test_it_is_short() -> None:
    assert len(TEXT.splitlines()) <= 150


def test_ci_finds_two_commands() -> None:
    commands = [line for line in TEXT.splitlines() if line.startswith("python3 -m venv ")]
    assert len(commands) == 2
    assert commands[0].endswith("platecontact build")
    assert commands[1].endswith("pytest")


def test_every_misprint_is_in_the_table() -> None:
    table = TEXT.partition("## What the paper gets wrong")[2].partition("\n## ")[0]
    wrong = {finding.printed.equation for finding in misprints() if finding.is_misprint}
    assert wrong <= set(re.findall(r"\((\d+)\)", table))


def test_the_picture_is_there() -> None:
    assert f"]({PICTURE})" in TEXT
    assert (ROOT / PICTURE).read_bytes().startswith(b"<?xml")


def test_local_links_lead_somewhere() -> None:
    for link in re.findall(r"\]\(([^)\s]+)\)", TEXT):
        assert (ROOT / link.partition("#")[0]).exists(), link
