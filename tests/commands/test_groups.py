"""The help of the command line: every command once, each line whole."""

import pytest
from typer.main import get_command

from derivation.cli import app, main
from derivation.commands.groups import GROUPS


def test_every_command_is_in_one_group() -> None:
    found = get_command(app).commands  # type: ignore[attr-defined]
    visible = [name for name, command in found.items() if not command.hidden]
    assert sorted(name for names in GROUPS.values() for name in names) == sorted(visible)


@pytest.mark.parametrize("command", ["", "check"])
def test_no_line_is_cut(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*command.split(), "--help"]) == 0
    shown = capsys.readouterr().out
    assert "..." not in shown.partition("Options:")[2]
    assert all(len(line) <= 80 for line in shown.splitlines())
    for title in GROUPS if not command else ["Commands"]:
        assert f"{title}:" in shown
