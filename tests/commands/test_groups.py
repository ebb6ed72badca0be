"""The help of the command line: groups of commands, width of lines, version, and `-h`."""

import tomllib

import pytest
from typer.main import get_command

from derivation.cli import app, main
from derivation.commands.groups import GROUPS
from derivation.engine.files import ROOT


def test_every_command_is_in_one_group() -> None:
    commands = get_command(app).commands  # type: ignore[attr-defined]
    visible = [name for name, command in commands.items() if not command.hidden]
    assert sorted(name for names in GROUPS.values() for name in names) == sorted(visible)


@pytest.mark.parametrize("command", ["", "check"])
def test_help_is_complete_in_80_columns(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*command.split(), "--help"]) == 0
    shown = capsys.readouterr().out
    assert "..." not in shown.partition("Options:")[2]
    assert all(len(line) <= 80 for line in shown.splitlines())
    for title in GROUPS if not command else ["Commands"]:
        assert f"{title}:" in shown


def test_version_is_that_of_the_distribution(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--version"]) == 0
    name, number = capsys.readouterr().out.split()
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert (name, number) == (project["name"], project["version"])


def test_help_is_printed_without_a_command(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    shown = capsys.readouterr()
    assert main(["--help"]) == 0
    assert shown.out == capsys.readouterr().out
    assert shown.err == ""
    assert "Tab key" in shown.out
    assert "--install-completion" in shown.out.partition("Tab key")[2]


@pytest.mark.parametrize("command", ["", "simulate", "check", "check timing", "examples"])
def test_short_option_prints_the_same_help(
    command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([*command.split(), "-h"]) == 0
    shown = capsys.readouterr().out
    assert main([*command.split(), "--help"]) == 0
    assert shown == capsys.readouterr().out
