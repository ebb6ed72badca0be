"""Every block of README, CONTRIBUTING and the documentation site is executed.

Commands and Python code must print the output on the page, in which `...` matches any text.
`test_contributing.py` executes the examples of `docs/development`.
"""

import doctest
import os
import re
import shlex
import subprocess
import sys
import tomllib
from doctest import ELLIPSIS, OutputChecker
from pathlib import Path

import guide
import pytest

from derivation.cli import main
from derivation.engine.files import ROOT

PAGES = [
    ROOT / "README.md",
    ROOT / "CONTRIBUTING.md",
    *sorted(page for page in (ROOT / "docs").rglob("*.md") if page.parent != ROOT / "docs"),
]
BLOCK = re.compile(r"^```(.*)\n((?:.*\n)*?)^```", re.MULTILINE)
NAMED = re.compile(r"# (\S+\.toml)\n")
CI = (ROOT / ".ci" / "run").read_text()
COMMANDS = [page for page in PAGES if "```console" in page.read_text()]
PYTHON = [page for page in PAGES if "\n>>> " in page.read_text()]


def name(page: Path) -> str:
    return f"{page.parent.name}/{page.stem}"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with the example scenes and the environment at their usual paths."""
    (tmp_path / "derivation").symlink_to(ROOT / "derivation")
    (tmp_path / ".venv").mkdir()
    (tmp_path / ".venv" / "bin").symlink_to(Path(sys.executable).parent)
    return tmp_path


def run(command: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """Return the exit status of a command, and its standard output.

    Commands of the program run in this process, which has imported everything, unless they need a
    shell or import another paper. The README's command starts the installed program.
    """
    words = shlex.split(command.replace("\\\n", " "))
    if words[0] == "platecontact" and not {"|", ">", "--paper"} & {*words}:
        capsys.readouterr()
        status, text = main(words[1:]), capsys.readouterr().out
    else:
        status, text = shell(command, folder)
    return status, "".join(f"{line.rstrip()}\n" for line in text.splitlines())


def shell(command: str, folder: Path) -> tuple[int, str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        command, shell=True, cwd=folder, stdout=subprocess.PIPE, text=True, check=False,
        env=os.environ | {"PATH": path},
    )  # fmt: skip
    return done.returncode, done.stdout


@pytest.mark.parametrize("page", COMMANDS, ids=name)
def test_commands_print_the_output_on_the_page(
    page: Path, folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(folder)
    monkeypatch.setenv("COLUMNS", "80")
    for kind, text in BLOCK.findall(page.read_text()):
        if kind == "toml" and NAMED.match(text):
            (folder / text.partition("\n")[0].removeprefix("# ")).write_text(text)
        if kind == "console":
            for piece in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
                command, expected = _split(piece)
                status, printed = run(command, folder, capsys)
                matches = OutputChecker().check_output(expected, printed, ELLIPSIS)
                assert matches or expected == "...\n", printed
                assert status == ("Omega_3: different" in expected), command


def _split(piece: str) -> tuple[str, str]:
    """Return a command, including lines continued by a backslash, and its expected output."""
    lines = piece.splitlines(keepends=True)
    last = next(i for i, line in enumerate(lines) if not line.endswith("\\\n"))
    return "".join(lines[: last + 1]), "".join(lines[last + 1 :])


@pytest.mark.parametrize("page", PYTHON, ids=name)
def test_python_prints_the_output_on_the_page(page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PYTHONPATH", str(ROOT))  # for worker processes
    outcome = doctest.testfile(str(page), module_relative=False, optionflags=ELLIPSIS)
    assert not outcome.failed
    assert outcome.attempted == page.read_text().count("\n>>> ")


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_every_block_is_tested_or_of_an_accepted_kind(page: Path) -> None:
    """Console and Python blocks are executed above; other rules apply to the rest."""
    for kind, text in BLOCK.findall(page.read_text()):
        if page.stem in guide.PAGES and page.parent.name == "development":
            assert guide.BLOCK.match(f"```{kind}\n{text}```"), text
        elif kind == "python":
            assert text.startswith(">>> "), text
        elif kind == "toml":
            assert tomllib.loads(text), text
            assert NAMED.match(text) or page.name == "README.md", "a scene without a file name"
        elif kind == "sh":
            assert page.parent == ROOT
            for line in text.splitlines():
                assert line in CI or line.split()[0] in ("apt-get", "python3"), line
        elif kind == "text":
            assert "$ " not in text, "a command must be in a console block"
        else:
            assert kind in ("console", "python", "toml", "{toctree}"), kind


def test_scene_in_the_readme_equals_the_example() -> None:
    scene = (ROOT / "derivation" / "scene" / "examples" / "glass_pane.toml").read_text()
    [block] = [text for kind, text in BLOCK.findall(PAGES[0].read_text()) if kind == "toml"]
    assert tomllib.loads(block) == tomllib.loads(scene)
