"""The tutorials: their commands print what they say, and their Python blocks too."""

import doctest
import os
import re
import subprocess
import sys
from doctest import ELLIPSIS, OutputChecker
from pathlib import Path

import pytest

from derivation.engine.files import ROOT

PAGES = sorted(page for page in (ROOT / "docs" / "tutorials").glob("*.md") if page.stem != "index")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
KINDS = {"console", "python", "toml"}
DIFFERENT = 'diagnose Omega_3 --formula "-sinh(phi*h)/(2*mu*phi'
"""The command that ends with status 1, as it says."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder in which the example scenes are found."""
    (tmp_path / "derivation").symlink_to(ROOT / "derivation")
    return tmp_path


def run(command: str, folder: Path) -> str:
    """What a command prints on standard output."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        command, shell=True, cwd=folder, capture_output=True, text=True, check=False,
        env=os.environ | {"PATH": path, "COLUMNS": "80"},
    )  # fmt: skip
    assert done.returncode == (DIFFERENT in command), done.stderr
    return "".join(f"{line.rstrip()}\n" for line in done.stdout.splitlines())


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_print_what_the_page_says(page: Path, folder: Path) -> None:
    for kind, text in BLOCK.findall(page.read_text()):
        assert kind in KINDS, "every block is executed"
        if kind == "toml":
            name = text.partition("\n")[0].removeprefix("# ")
            (folder / name).write_text(text)
        if kind == "console":
            for piece in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
                command, _, said = piece.partition("\n")
                printed = run(command, folder)
                assert OutputChecker().check_output(said, printed, ELLIPSIS), printed


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_python_blocks_print_what_the_page_says(page: Path) -> None:
    found = doctest.testfile(str(page), module_relative=False, optionflags=ELLIPSIS)
    assert not found.failed
    assert found.attempted == page.read_text().count("\n>>> ")
