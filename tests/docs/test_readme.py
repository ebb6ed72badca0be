"""The README: its recipes are run and print what it says; its tables name what there is."""

import os
import re
import subprocess
import sys
from doctest import ELLIPSIS, OutputChecker
from pathlib import Path

import pytest
from typer.main import get_command

from derivation.cli import app
from derivation.engine.files import ROOT
from derivation.plate.derived import misprints
from derivation.plate.reporting import PICTURE, README
from derivation.scene.effects import EFFECTS

TEXT = (ROOT / README).read_text()
RECIPES = re.findall(r"^\*\*(\d)\. (.*?)\*\*.*?```console\n(.*?)```", TEXT, re.M | re.S)


def commands(block: str) -> list[tuple[str, str]]:
    """Commands of a block, each with what it is said to print."""
    pieces = re.split(r"^\$ ", block, flags=re.M)[1:]
    return [(line, said) for line, _, said in (piece.partition("\n") for piece in pieces)]


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A folder in which the checkout's example scenes are found, and nothing of it is written."""
    (tmp_path / "derivation").symlink_to(ROOT / "derivation")
    return tmp_path


def run(command: str, where: Path) -> str:
    """What a command prints, of its notes only those that stay; it may fail only by a verdict."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        command, shell=True, cwd=where, capture_output=True, text=True, check=False,
        env=os.environ | {"PATH": path, "COLUMNS": "80"},
    )  # fmt: skip
    assert done.returncode == ("diagnose" in command), done.stderr
    return done.stdout


def test_there_are_five_recipes() -> None:
    assert [number for number, _, _ in RECIPES] == ["1", "2", "3", "4", "5"]


@pytest.mark.parametrize(("name", "block"), [recipe[1:] for recipe in RECIPES])
def test_a_recipe_prints_what_it_is_said_to(name: str, block: str, checkout: Path) -> None:
    for command, said in commands(block):
        lines = run(command, checkout).splitlines()
        printed = "".join(f"{line.rstrip()}\n" for line in lines)
        assert OutputChecker().check_output(said, printed, ELLIPSIS), f"{name}: {printed}"


def test_every_effect_and_command_is_in_its_table() -> None:
    for effect in EFFECTS:
        assert f"| `{effect.name}` | " in TEXT
    commands = get_command(app).commands  # type: ignore[attr-defined]
    names = [name for name, command in commands.items() if not command.hidden]
    for name in (*names, *(f"check {name}" for name in commands["check"].commands)):
        assert f"| `{name}` | " in TEXT


def test_every_misprint_is_in_the_table() -> None:
    table = TEXT.partition("## What the paper gets wrong")[2].partition("\n## ")[0]
    wrong = {finding.printed.equation for finding in misprints() if finding.is_misprint}
    assert wrong <= set(re.findall(r"\((\d+)\)", table))


def test_the_picture_is_there() -> None:
    assert f"]({PICTURE})" in TEXT
    assert (ROOT / PICTURE).read_bytes().startswith(b"<?xml")
