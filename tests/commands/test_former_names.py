"""Former names of options and commands: accepted with a notice, or rejected with the new name."""

import json

import pytest
from typer.main import get_command

from derivation import pipeline
from derivation.cli import app, main
from derivation.commands.check import MOVED, SUBCOMMANDS
from derivation.commands.command import RENAMED
from derivation.engine import build

Captured = pytest.CaptureFixture[str]


@pytest.mark.parametrize("option", MOVED)
@pytest.mark.parametrize("form", ["{}", "{}=3", "--digits 30 {} 3", "{} --record"])
def test_former_option_of_check_is_rejected_with_the_new_command(
    option: str, form: str, capsys: Captured
) -> None:
    assert main(["check", *form.format(option).split()]) == 2
    shown = capsys.readouterr()
    [line] = shown.err.strip().splitlines()
    assert f"`platecontact check {MOVED[option]}`" in line
    assert shown.out == ""


def test_new_commands_and_options_exist() -> None:
    for command in MOVED.values():
        name, *options = command.split()
        known = get_command(app).commands["check"].commands[name]  # type: ignore[attr-defined]
        names = {name for parameter in known.params for name in parameter.opts}
        assert {option for option in options if option.startswith("-")} <= names
    assert {command.split()[0] for command in MOVED.values()} == set(SUBCOMMANDS)


def test_former_option_is_accepted_with_one_notice(
    monkeypatch: pytest.MonkeyPatch, capsys: Captured
) -> None:
    calls = list[object]()

    def rewriting_effects(_: object, update: bool, __: object) -> tuple[()]:
        calls.append(update)
        return ()

    monkeypatch.setattr(build, "rewriting_effects", rewriting_effects)
    assert main(["rewrite", "--record", "--json", "-"]) == 0
    shown = capsys.readouterr()
    assert json.loads(shown.out) == {"rows": []}
    assert shown.err.count("--record") == 1
    assert "--update" in shown.err
    assert main(["rewrite", "--update", "--json", "-"]) == 0
    assert "--record" not in capsys.readouterr().err
    assert calls == [True, True]


def test_former_option_with_a_value_is_accepted(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = list[object]()

    def search(time: str, seed: int, functions: list[str], *_: object) -> None:
        calls.append((time, seed, functions))
        raise ValueError

    monkeypatch.setattr(pipeline, "search_worse", search)
    assert main(["check", "search", "--kernel", "G", "--kernel=P", "--seed", "4"]) == 2
    assert calls == [("60s", 4, ["G", "P"])]


@pytest.mark.parametrize(
    "arguments", [["simulate", "x.toml", "--record"], ["check", "scenes", "-n", "1", "--record"]]
)
def test_former_option_is_rejected_without_the_new_option(
    arguments: list[str], capsys: Captured
) -> None:
    assert main(arguments) == 2
    assert "No such option: --record" in capsys.readouterr().err


def test_former_names_are_not_in_any_help(capsys: Captured) -> None:
    for arguments in (["check"], ["check", "search"], ["rewrite"], ["benchmark"]):
        assert main([*arguments, "--help"]) == 0
        shown = capsys.readouterr().out.split()
        assert not {*RENAMED, *MOVED} & set(shown)


@pytest.mark.parametrize(
    ("arguments", "command"),
    [
        (["check", "timing", "--nonsense"], "check timing"),
        (["check", "nonsense"], "check"),
        (["check", "inertia"], "check inertia"),
        (["simulate"], "simulate"),
        (["nonsense"], ""),
    ],
)
def test_mistyped_command_refers_to_its_help(
    arguments: list[str], command: str, capsys: Captured
) -> None:
    assert main(arguments) == 2
    assert f"(see `{f'platecontact {command}'.strip()} --help`)" in capsys.readouterr().err
