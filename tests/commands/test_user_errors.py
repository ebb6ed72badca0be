"""Help, mistyped commands, missing write permission, a full disk, and Ctrl-C."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

from derivation import pipeline
from derivation.checks import bounds as bounds_check
from derivation.checks import dynamic_benchmark
from derivation.checks import effects as effects_check
from derivation.checks import inertia as inertia_check
from derivation.cli import app, main
from derivation.engine import outputs, report_files
from derivation.engine.files import ROOT
from derivation.engine.paper import Paper
from derivation.plate import paper as plate_paper
from derivation.plate import reporting


def commands(group: Any, prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield all commands and subcommands with their names, except hidden former names."""
    for name, command in group.commands.items():
        if not command.hidden:
            yield prefix + name, command
            yield from commands(command, f"{prefix}{name} ") if hasattr(command, "commands") else ()


COMMANDS = dict(commands(get_command(app)))
PAPER = str(ROOT / "derivation" / "scene" / "examples" / "paper.toml")
NOBODY = 65534
LOADED = dynamic_benchmark, reporting, report_files
"""Modules of the commands below, imported before the process gives up its permissions."""
Captured = pytest.CaptureFixture[str]


# --- help and completion


@pytest.mark.parametrize("command", COMMANDS)
def test_help_is_complete_with_an_example(command: str, capsys: Captured) -> None:
    assert main([*command.split(), "--help"]) == 0
    shown = capsys.readouterr().out
    assert f"Example: platecontact {command}" in shown
    example = re.search(rf"Example: platecontact {command}(.*)", shown)
    assert example is not None
    for option in re.findall(r"--[a-z-]+", example[1]):
        assert option in shown.replace(example[0], ""), "an option of the example is not explained"
    assert all(len(line) <= 80 for line in shown.splitlines())
    for parameter in COMMANDS[command].params:
        if parameter.name not in {"more", "help"}:
            assert parameter.help, f"{parameter.name} is not explained"


def test_an_error_in_a_search_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "search", "--time", "soon"]) == 2
    assert capsys.readouterr().err.startswith("platecontact: --time")


def test_completion_script_is_printed_and_completes() -> None:
    module = [sys.executable, "-m", "derivation.cli"]
    known = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1",
    }

    def printed(*arguments: str, **variables: str) -> str:
        return subprocess.run(
            [*module, *arguments], env=known | variables, capture_output=True, text=True, check=True
        ).stdout

    script = printed("--show-completion", "bash")
    assert "complete -o default -F _platecontact_completion platecontact" in script
    if shell := shutil.which("bash"):
        subprocess.run([shell, "-n"], input=script, text=True, check=True)
    variables = {"_PLATECONTACT_COMPLETE": "complete_bash"}
    assert printed(**variables, COMP_WORDS="platecontact sim", COMP_CWORD="1").split() == [
        "simulate"
    ]
    options = printed(**variables, COMP_WORDS="platecontact simulate --p", COMP_CWORD="2")
    assert options.split() == ["--plot"]


# --- mistyped


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["simulat", PAPER], "simulate'?"),
        (["simulate", PAPER, "--plt", "x.svg"], "--plot"),
        (["check", "hardcases"], "hard-cases'?"),
        (["check", "--digits", "30", "timing"], "timing"),
        (["check", "search", "--sed", "3"], "see `platecontact check search --help`"),
        (["check", "search", "--time"], "see `platecontact check search --help`"),
        (["indent", PAPER, "--force"], "see `platecontact indent --help`"),
        (["report", "--check", "--fragment", "K_j"], "--check"),
        (["report", "--section", "law", "--fragment", "K_j"], "--section"),
        (["report", "--fragment", "K_j", "--force"], "--force"),
        (["rewrite", "x", "--update"], "FORMULA"),
        (["rewrite", "x", "--variable", "1"], "--variable: "),
        (["rewrite", "x", "--where", "y < 1"], "--where: "),
        (["rewrite", "--where", "x < 1"], "FORMULA"),
        (["benchmark", "--quick", "--update"], "--quick"),
        (["generate", "--out", PAPER], "paper.toml"),
        (["report", "--out", PAPER], "paper.toml"),
        (["simulate", PAPER, "--csv", "/dev/null"], "/dev/null"),
        (["derive", "--json", str(ROOT)], str(ROOT)),
    ],
)
def test_mistyped_command_gives_one_line_and_status_2(
    arguments: list[str], expected: str, capsys: Captured
) -> None:
    assert main(arguments) == 2
    shown = capsys.readouterr()
    [line] = shown.err.strip().splitlines()
    assert line.startswith("platecontact: ")
    assert expected in line
    assert shown.out == ""


# --- no permission to write


@pytest.fixture
def read_only() -> Iterator[Path]:
    """Yield a folder without write permission; a superuser becomes another user for the test."""
    folder = Path(tempfile.mkdtemp())
    folder.chmod(0o555)
    root = os.geteuid() == 0
    if root:
        os.setresuid(NOBODY, NOBODY, 0)
    yield folder
    if root:
        os.setresuid(0, 0, 0)
    left = sorted(path.name for path in folder.iterdir())
    folder.chmod(0o755)
    shutil.rmtree(folder)
    assert left == []


@pytest.mark.parametrize(
    "arguments",
    [
        ["generate", "--out", "."],
        ["generate", "--out", "new/folder"],
        ["generate", "--scene", PAPER, "--out", "x.py"],
        ["report", "--out", "."],
        ["report", "--section", "law", "--out", "."],
        ["report", "--fragment", "K_j", "--out", "."],
        ["build", "--out", "."],
        ["check", "--json", "x.json"],
        ["check", "contact-law", "--json", "x.json"],
        ["check", "search", "--out", "x.toml"],
        ["accuracy", "--out", "x.json"],
        ["benchmark", "--dynamic", "--out", "x.json"],
        ["rewrite", "--json", "x.json"],
        ["reference", PAPER, "--digits", "1000", "--json", "x.json"],
        ["simulate", PAPER, "--plot", "x.svg"],
        ["simulate", PAPER, "--csv", "x.csv"],
        ["simulate", PAPER, "--animate", "x.gif"],
        ["simulate", PAPER, "--sweep", "plate.thickness=1e-2:2e-1:99999", "--json", "x.json"],
        ["map", PAPER],
        ["schema", "--out", "x.json"],
        ["indent", PAPER, "--force", "10", "--json", "x.json"],
        ["explain", PAPER, "--json", "x.json"],
        ["derive", "--json", "x.json"],
        ["misprints", "--json", "x.json"],
        ["diagnose", "G", "--formula", "T", "--json", "x.json"],
    ],
    ids=lambda arguments: " ".join(a for a in arguments if a != PAPER),
)
def test_missing_permission_is_reported_before_the_computation(
    arguments: list[str], read_only: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    """Some of these commands would otherwise run for minutes."""
    monkeypatch.chdir(read_only)
    assert main(arguments) == 2
    _expect_permission_error(capsys)


@pytest.mark.parametrize(
    ("options", "module", "name"),
    [
        (["contact-law"], pipeline, "MEASURED_CONTACT"),
        (["timing"], pipeline, "MEASURED_SPEED"),
        (["hard-cases"], Paper, "hard"),
        (["error-bounds", "-n", "3000"], bounds_check, "MEASURED"),
        (["effects", "-n", "3000"], effects_check, "MEASURED"),
        (["inertia", "-n", "500"], inertia_check, "MEASURED"),
    ],
)
def test_missing_permission_for_a_record_is_reported_before_the_check(
    options: list[str], module: object, name: str, read_only: Path,
    monkeypatch: pytest.MonkeyPatch, capsys: Captured,
) -> None:  # fmt: skip
    monkeypatch.setattr(module, name, read_only / "x.json")
    assert main(["check", *options, "--update"]) == 2
    _expect_permission_error(capsys)


@pytest.mark.parametrize("command", ["check", "rewrite"])
def test_missing_permission_for_records_of_a_paper_is_reported_at_once(
    command: str, read_only: Path, monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr(plate_paper, "PAPER", replace(plate_paper.PAPER, records=read_only))
    assert main([command, "--update"]) == 2
    _expect_permission_error(capsys)


def _expect_permission_error(capsys: Captured) -> None:
    lines = [line for line in capsys.readouterr().err.splitlines() if line.strip()]
    assert len(lines) == 1, lines
    assert lines[0].startswith("platecontact: cannot write ")
    assert "Permission denied; obtain permission to write there, or name another folder" in lines[0]


def test_records_are_written_only_in_a_checkout(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    monkeypatch.setattr(outputs, "in_checkout", lambda: False)
    assert main(["check", "contact-law", "--update"]) == 2
    assert "--json FILE" in capsys.readouterr().err


def test_read_only_file_is_not_replaced(read_only: Path, capsys: Captured) -> None:
    """This holds even if its folder is writable."""
    with (
        tempfile.TemporaryDirectory() as folder
    ):  # the other user owns it if the test runs as superuser
        path = Path(folder) / "x.json"
        path.write_text("mine")
        path.chmod(0o444)
        Path(folder).chmod(0o777)
        assert main(["schema", "--out", str(path)]) == 2
        assert path.read_text() == "mine"
        assert list(read_only.parent.joinpath(folder).iterdir()) == [path]
    _expect_permission_error(capsys)


def test_symbolic_link_is_followed(tmp_path: Path) -> None:
    (tmp_path / "link.json").symlink_to(tmp_path / "real.json")
    assert main(["schema", "--out", str(tmp_path / "link.json")]) == 0
    assert (tmp_path / "link.json").is_symlink()
    assert (tmp_path / "real.json").read_text().startswith("{")


# --- a full disk


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """Mount a file system of 64 kB with 44 kB of free space."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = ["mount", "-t", "tmpfs", "-o", "size=64k", "none", str(disk)]
    try:
        subprocess.run(mounted, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("only a superuser can mount a file system")
    (disk / "filled").write_bytes(bytes(20 * 1024))
    yield disk
    subprocess.run(["umount", str(disk)], check=True)


@pytest.mark.parametrize(
    ("arguments", "last"),
    [
        (["simulate", PAPER, "--csv", "a/b/x.csv", "--plot", "x.svg"], "x.svg"),
        (["report", "--section", "law", "--no-pdf", "--out", "new"], "report-law.html"),
        (["schema", "--out", "x.json"], "x.json"),
    ],
    ids=["simulate", "report", "schema"],
)
def test_full_disk_is_left_unchanged(
    arguments: list[str],
    last: str,
    small_disk: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Captured,
) -> None:
    """No file is written, not even those for which there is enough space."""
    monkeypatch.chdir(small_disk)
    if last == "x.json":  # no free space at all
        Path("more").write_bytes(bytes(shutil.disk_usage(small_disk).free))
    before = sorted(Path().iterdir())
    assert main(arguments) == 2
    lines = capsys.readouterr().err.strip().splitlines()
    assert lines[-1].startswith("platecontact: cannot write ")
    assert f"{last}: No space left on device; free some space, or name" in lines[-1]
    assert sorted(Path().iterdir()) == before


def test_full_device_as_standard_output_is_an_error() -> None:
    with Path("/dev/full").open("w") as full:
        run = subprocess.run(
            [sys.executable, "-m", "derivation.cli", "schema"],
            stdout=full, stderr=subprocess.PIPE, text=True, check=False, cwd=ROOT,
        )  # fmt: skip
    assert run.returncode == 2
    assert run.stderr == "platecontact: standard output: No space left on device\n"


def test_value_that_is_no_number_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reference", "any.toml", "--digits", "many"]) == 2
    assert "--digits': Input should be a valid integer, got many (see" in capsys.readouterr().err


# --- Ctrl-C

READY = """
import sys
from derivation.cli import main
print("ready", flush=True)
sys.exit(main(sys.argv[1:]))
"""


@pytest.mark.parametrize(
    "arguments",
    [
        ["simulate", PAPER, "--sweep", "plate.thickness=1e-2:2e-1:99999", "--csv", "x.csv"],
        [
            "check",
            "search",
            "--time",
            "1h",
            "--function",
            "G",
            "--json",
            "x.json",
            "--out",
            "x.toml",
        ],
    ],
    ids=["sweep", "search"],
)
def test_ctrl_c_ends_all_processes_and_leaves_no_incomplete_file(
    arguments: list[str], tmp_path: Path
) -> None:
    """The signal is sent to all processes of the command, as a terminal does."""
    run = subprocess.Popen(
        [sys.executable, "-c", READY, *arguments], cwd=tmp_path, text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)}, start_new_session=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert run.stdout is not None
    assert run.stdout.readline() == "ready\n"
    time.sleep(3.5)  # the command imports, starts processes or computes at that time
    assert run.poll() is None
    os.killpg(run.pid, signal.SIGINT)
    output, message = run.communicate(timeout=60)  # returns when all processes have ended
    assert run.returncode == 2
    assert "interrupted" in message
    assert "Traceback" not in output + message
    for path in tmp_path.iterdir():  # cases that the search has found until then
        assert (json.loads if path.suffix == ".json" else tomllib.loads)(path.read_text())
    assert "--sweep" not in arguments or not list(tmp_path.iterdir())
