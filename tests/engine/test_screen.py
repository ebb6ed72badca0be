"""What is shown: text of a user's steers nothing, and who stops reading loses no file."""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest
from given import PAPER

from derivation.cli import main
from derivation.engine.console import MOST, UNREAD, listing, table, warn
from derivation.engine.files import ROOT
from derivation.engine.printable import in_json, one_line, printable
from derivation.scene import SceneError, load, read

Captured = pytest.CaptureFixture[str]
EVIL = "\x1b[31m[bold red]x\x9b2J\u202e\ud800:smile:\x07"
"""An escape sequence, markup, a one-byte escape, reversed direction, half a character, a picture's
name, a bell."""
SAFE = r"\x1b[31m[bold red]x\x9b2J\u202e\ud800:smile:\x07"


# --- text of a user's


def test_nothing_that_steers_a_terminal_is_left() -> None:
    assert printable(EVIL + "\n\tü") == SAFE + "\n\tü"
    assert one_line("a\nb" * 100, 20) == "a\\nba\\nba\\nba\\nba\\nba\\n..."
    assert json.loads(in_json(json.dumps(EVIL, ensure_ascii=False))) == EVIL
    assert "\x9b" not in in_json(json.dumps(EVIL, ensure_ascii=False))


def test_tables_lists_and_warnings_show_it_as_it_is(capsys: Captured) -> None:
    table(EVIL, (EVIL, "#" + EVIL), [(EVIL, EVIL)])
    listing(EVIL, [EVIL])
    warn([EVIL])
    shown = capsys.readouterr()
    assert shown.out.count(SAFE) >= 3  # titles and a line; cells are folded
    assert SAFE in shown.err
    for text in (shown.out, shown.err):
        assert not set(text) & set("\x1b\x9b\u202e\ud800\x07")


@pytest.mark.parametrize("bad", [True, False], ids=["refused", "shown"])
def test_names_of_scene_files_steer_nothing(bad: bool, tmp_path: Path, capsys: Captured) -> None:
    path = tmp_path / (EVIL.replace("\ud800", "") + "\nplatecontact: fine.toml")
    text = PAPER.read_text().replace("speed = 1.0", 'speed = "\\u001b[2J"') if bad else None
    path.write_text(text or PAPER.read_text())
    assert main(["simulate", str(path)]) == (2 if bad else 0)
    shown = capsys.readouterr()
    assert not set(shown.out + shown.err) & set("\x1b\x9b\u202e\x07")
    assert "\nplatecontact: fine" not in shown.out + shown.err


def test_keys_and_values_steer_nothing() -> None:
    with pytest.raises(SceneError) as caught:
        read({"sphere": {EVIL: 1, "radius": EVIL}, EVIL + "\nx": {}})
    assert not set(str(caught.value)) & set("\x1b\x9b\u202e\ud800\x07")
    assert SAFE in str(caught.value)
    assert "\nx" not in str(caught.value)


# --- very much of it


def test_of_very_many_problems_the_first_are_listed(capsys: Captured, tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    keys = "".join(f"key{n} = 1\n" for n in range(20_000))
    path.write_text(f"{PAPER.read_text()}\n[accuracy]\nrtol = 1e-3\n{keys}")
    assert main(["simulate", str(path)]) == 2
    said = capsys.readouterr().err
    assert len(said.splitlines()) <= 25
    assert len(said) < 5000
    assert "20,000 problems" in said
    assert "19,980 more" in said


def test_long_keys_and_values_are_cut_short() -> None:
    with pytest.raises(SceneError) as caught:
        read({"sphere": {"x" * 10**6: 1, "radius": "y" * 10**6}})
    assert len(str(caught.value)) < 2000


def test_of_very_many_warnings_the_first_are_shown(capsys: Captured) -> None:
    warn([f"number {n}" for n in range(1, 1001)])
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == MOST + 1
    assert "980 more" in lines[-1]


def test_what_is_no_small_file_is_one_message(tmp_path: Path, capsys: Captured) -> None:
    loop, other, huge, pipe = (tmp_path / name for name in ("loop", "other", "huge.toml", "pipe"))
    loop.symlink_to(other)
    other.symlink_to(loop)
    with huge.open("wb") as stream:
        stream.truncate(2**33)
    os.mkfifo(pipe)
    for path in (loop, huge, pipe, tmp_path, Path("/dev/zero"), tmp_path / ("x" * 300)):
        for arguments in (["simulate", str(path), "--csv", str(tmp_path / "x.csv")],
                          ["reference", str(path)], ["explain", str(path)]):  # fmt: skip
            assert main(arguments) == 2
            [line] = capsys.readouterr().err.strip().splitlines()
            assert "cannot read the scene file" in line
    assert not (tmp_path / "x.csv").exists()


# --- who stops reading


@pytest.mark.parametrize(
    ("arguments", "written"),
    [
        (["simulate", "SCENE", "--csv", "h.csv", "--json", "r.json", "--plot", "p.svg"],
         ["h.csv", "p.svg", "r.json"]),
        (["simulate", "SCENE", "--sweep", "impact.speed=1:2:2", "--json", "r.json"], ["r.json"]),
        (["indent", "SCENE", "--force", "10", "--json", "r.json"], ["r.json"]),
        (["explain", "SCENE", "--json", "r.json"], ["r.json"]),
        (["misprints", "--json", "r.json"], ["r.json"]),
        (["rewrite", "x", "--json", "r.json"], ["r.json"]),
        (["simulate", "SCENE", "--json", "-"], []),
        (["schema"], []),
    ],
    ids=lambda value: " ".join(value[:1]),
)  # fmt: skip
def test_files_are_written_though_nobody_reads_the_screen(
    arguments: Sequence[str], written: Sequence[str], tmp_path: Path
) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    run = subprocess.run(
        [sys.executable, "-m", "derivation.cli", *(str(PAPER) if a == "SCENE" else a
         for a in arguments)],
        stdout=writer, stderr=subprocess.PIPE, cwd=tmp_path, text=True, check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    os.close(writer)
    assert run.returncode == UNREAD
    assert "Traceback" not in run.stderr
    assert "Error" not in run.stderr
    assert "Exception" not in run.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == list(written)


def test_remarks_that_nobody_reads_stop_nothing(tmp_path: Path) -> None:
    """As in `platecontact ... 2>&1 | head -1`."""
    reader, writer = os.pipe()
    os.close(reader)
    arguments = ["simulate", str(PAPER), "--sweep", "impact.speed=0:2:3", "--csv", "x.csv"]
    run = subprocess.run(
        [sys.executable, "-m", "derivation.cli", *arguments], stdout=writer, stderr=writer,
        cwd=tmp_path, check=False, env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    os.close(writer)
    assert run.returncode == 0
    assert len((tmp_path / "x.csv").read_text().splitlines()) == 4


def test_without_any_standard_output_files_are_written(tmp_path: Path) -> None:
    code = "import os; os.close(1); os.execv({0!r}, [{0!r}, '-m', 'derivation.cli', *{1!r}])"
    arguments = ["simulate", str(PAPER), "--csv", str(tmp_path / "h.csv")]
    run = subprocess.run(
        [sys.executable, "-c", code.format(sys.executable, arguments)],
        stderr=subprocess.PIPE, cwd=ROOT, text=True, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "h.csv").is_file()


# --- options


@pytest.mark.parametrize(
    ("arguments", "option"),
    [
        (["simulate", str(PAPER), *2 * ["--sweep", "impact.speed=1:2:2"]], "--sweep"),
        (["simulate", str(PAPER), "--csv", "a.csv", "--csv", "b.csv"], "--csv"),
        (["simulate", str(PAPER), "--json", "-", "--json", "b.json"], "--json"),
        (["check", "--digits", "30", "--digits", "40"], "--digits"),
    ],
)
def test_an_option_given_twice_is_refused(
    arguments: Sequence[str], option: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: Captured,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(list(arguments)) == 2
    said = capsys.readouterr().err
    assert option in said
    assert "2 times" in said
    assert list(tmp_path.iterdir()) == []


def test_options_that_take_several_values_still_do(capsys: Captured) -> None:
    assert main(["indent", str(PAPER), "--force", "1", "--force", "2", "--json", "-"]) == 0
    assert len(json.loads(capsys.readouterr().out)) == 2


@pytest.mark.parametrize(
    ("tables", "meant"),
    [
        ({"plate": {"thicknes": 1.0}}, "did you mean thickness?"),
        ({"sphere": {"Mas": 1.0}}, "did you mean mass?"),
        ({"sphere": {"speeds": 1.0}}, "did you mean impact.speed?"),
        ({"impackt": {}}, "did you mean impact?"),
        ({"impact": {"xyzzy": 1.0}}, "remove it"),
    ],
)
def test_the_nearest_known_key_is_named(tables: dict[str, dict[str, float]], meant: str) -> None:
    with pytest.raises(SceneError, match=meant.replace("?", r"\?")):
        read(load(PAPER).to_json() | tables)
