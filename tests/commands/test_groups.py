"""The help of the command line: every command once, each line whole."""

import pytest

from derivation.cli import app, main
from derivation.commands.groups import GROUPS


def test_every_command_is_in_one_group() -> None:
    visible = [
        command.name or command.callback.__name__
        for command in app.registered_commands
        if command.callback is not None and not command.hidden
    ]
    assert sorted(name for names in GROUPS.values() for name in names) == sorted(visible)


def test_no_line_is_cut(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--help"]) == 0
    shown = capsys.readouterr().out
    assert "..." not in shown.partition("Scenes:")[2]
    assert all(len(line) <= 80 for line in shown.splitlines())
    for title in GROUPS:
        assert f"{title}:" in shown
