"""Output on a terminal: text of the user is escaped, and a closed pipe loses no file."""

import io
import json
import os
import re
import shlex
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import platecontact as pc
import pytest
from shared_scenes import PAPER

from derivation.cli import main
from derivation.engine import console
from derivation.engine.console import (
    MOST_WARNINGS,
    UNREAD_STATUS,
    Screen,
    listing,
    table,
    transient_bar,
    warn,
)
from derivation.engine.files import ROOT
from derivation.engine.printable import in_json, one_line, printable
from derivation.engine.text import WIDTH, with_items
from derivation.scene import SceneError, load, read

Captured = pytest.CaptureFixture[str]
EVIL = "\x1b[31m[bold red]x\x9b2J\u202e\ud800:smile:\x07"
"""An escape sequence, markup, a one-byte escape, reversed text direction, a lone surrogate, the
name of an emoji, and a bell."""
SAFE = r"\x1b[31m[bold red]x\x9b2J\u202e\ud800:smile:\x07"


# --- text of the user


@pytest.mark.parametrize(("encoding", "tick"), [("ascii", ""), ("utf-8", "✓ ")])
def test_stages_end_with_a_tick_that_the_encoding_has(
    encoding: str, tick: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = io.TextIOWrapper(io.BytesIO(), encoding, errors="backslashreplace", write_through=True)
    monkeypatch.setattr(console, "NOTES", Screen(file=file))
    with console.stage("derive"):
        pass
    assert file.buffer.getvalue().decode(encoding).startswith(f"{tick}derive ")


def test_control_characters_are_escaped() -> None:
    assert printable(EVIL + "\n\tü") == SAFE + "\n\tü"
    assert one_line("a\nb" * 100, 20) == "a\\nba\\nba\\nba\\nba\\nba\\n..."
    assert json.loads(in_json(json.dumps(EVIL, ensure_ascii=False))) == EVIL
    assert "\x9b" not in in_json(json.dumps(EVIL, ensure_ascii=False))


def test_tables_lists_and_warnings_escape_text(capsys: Captured) -> None:
    table(EVIL, (EVIL, "#" + EVIL), [(EVIL, EVIL)])
    listing(EVIL, [EVIL])
    warn([EVIL])
    shown = capsys.readouterr()
    assert shown.out.count(SAFE) >= 3  # titles and a list entry; table cells are wrapped
    assert SAFE in shown.err
    for text in (shown.out, shown.err):
        assert not set(text) & set("\x1b\x9b\u202e\ud800\x07")


@pytest.mark.parametrize("bad", [True, False], ids=["rejected", "accepted"])
def test_names_of_scene_files_are_escaped(bad: bool, tmp_path: Path, capsys: Captured) -> None:
    path = tmp_path / (EVIL.replace("\ud800", "") + "\nplatecontact: fine.toml")
    text = PAPER.read_text().replace("speed = 1.0", 'speed = "\\u001b[2J"') if bad else None
    path.write_text(text or PAPER.read_text())
    assert main(["simulate", str(path)]) == (2 if bad else 0)
    shown = capsys.readouterr()
    assert not set(shown.out + shown.err) & set("\x1b\x9b\u202e\x07")
    assert "\nplatecontact: fine" not in shown.out + shown.err


def test_keys_and_values_are_escaped() -> None:
    with pytest.raises(SceneError) as caught:
        read({"sphere": {EVIL: 1, "radius": EVIL}, EVIL + "\nx": {}})
    assert not set(str(caught.value)) & set("\x1b\x9b\u202e\ud800\x07")
    assert SAFE in str(caught.value)
    assert "\nx" not in str(caught.value)


# --- long output


def test_list_of_problems_is_shortened(capsys: Captured, tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    keys = "".join(f"key{n} = 1\n" for n in range(20_000))
    path.write_text(f"{PAPER.read_text()}\n[accuracy]\nrtol = 1e-3\n{keys}")
    assert main(["simulate", str(path)]) == 2
    message = capsys.readouterr().err
    assert len(message.splitlines()) <= 25
    assert len(message) < 5000
    assert "20,000 problems" in message
    assert "19,980 more" in message


def test_long_keys_and_values_are_shortened() -> None:
    with pytest.raises(SceneError) as caught:
        read({"sphere": {"x" * 10**6: 1, "radius": "y" * 10**6}})
    assert len(str(caught.value)) < 2000


def test_items_fit_the_screen_and_are_not_broken() -> None:
    items = [f"x_{i}={1 / 3**i!r} ({(1 / 3**i).hex()})" for i in range(20)]
    lines = with_items("f:", items).split("\n")
    assert max(map(len, lines)) <= WIDTH
    assert len(lines) < len(items)
    assert " ".join(line.strip() for line in lines) == " ".join(["f:", *items])


def test_time_that_is_left_is_shown_if_parts_are_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    for alike in False, True:
        shown = io.StringIO()
        terminal = Screen(file=shown, width=60, force_terminal=True, color_system=None)
        monkeypatch.setattr("derivation.engine.console.NOTES", terminal)
        with transient_bar("sweep", alike=alike) as progress:
            for number in range(1, 4):
                progress("points", number, 100)
                time.sleep(0.15)
        assert (" left" in shown.getvalue()) == alike


def test_progress_is_written_in_lines_where_there_is_no_terminal(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In the log of a cluster a study of hours would otherwise be silent."""
    for interval, expected in (0.0, 3), (3600.0, 0):
        shown = io.StringIO()
        monkeypatch.setattr(console, "NOTES", Screen(file=shown, width=60))
        monkeypatch.setattr(console, "LOG_INTERVAL", interval)
        with transient_bar("sweep", alike=True) as progress:
            for number in 1, 31, 61:
                progress("points", number, 100)
                time.sleep(0.05)
        lines = shown.getvalue().splitlines()
        assert len(lines) == expected
        if lines:
            assert lines[0] == "sweep: 0 of 100"
            assert re.fullmatch(r"sweep: 60 of 100, 0:00:\d\d left", lines[-1])


def test_list_of_warnings_is_shortened(capsys: Captured) -> None:
    warn([f"number {n}" for n in range(1, 1001)])
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == MOST_WARNINGS + 1
    assert "980 more" in lines[-1]


def test_unreadable_scene_files_give_one_message(tmp_path: Path, capsys: Captured) -> None:
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


def unread(pipe: int) -> int:
    """Return the number of bytes in a pipe."""
    import fcntl
    import termios

    return int.from_bytes(fcntl.ioctl(pipe, termios.FIONREAD, bytes(4)), sys.byteorder)


def test_scene_is_read_from_a_pipe() -> None:
    """The scene arrives in two parts: the command waits for the second one."""
    text = PAPER.read_text()
    script = (
        "import os, sys\nfrom derivation.cli import main\n"
        "os.set_blocking(int(sys.argv[1]), False)\nsys.exit(main(sys.argv[2:]))"
    )
    for name in ("-", "/dev/stdin", "/dev/fd/{}"):
        reading, writing = os.pipe()
        own = "{" in name
        command = [sys.executable, "-c", script, str(reading if own else 0), "explain",
                   name.format(reading), "--json", "-"]  # fmt: skip
        with subprocess.Popen(
            command, stdin=subprocess.DEVNULL if own else reading, stdout=subprocess.PIPE,
            pass_fds=[reading] if own else [], cwd=ROOT,
        ) as process:  # fmt: skip
            os.write(writing, text[:200].encode())
            while process.poll() is None and unread(reading):
                time.sleep(0.01)
            os.write(writing, text[200:].encode())
            os.close(writing)
            os.close(reading)
            output, _ = process.communicate()
        assert process.returncode == 0
        assert json.loads(output)["included"] == pc.explain(pc.load(PAPER)).to_json()["included"]


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ("simulate - </dev/null", "standard input: 3 problems"),
        ("simulate - <&-", "standard input: cannot read the scene file (standard input is closed)"),
        ("explain /dev/fd/99", "/dev/fd/99: cannot read the scene file"),
        ("sweep - --vary impact.speed=1 </dev/null", "standard input: 3 problems"),
    ],
)
def test_invalid_pipes_give_one_message(command: str, message: str) -> None:
    shell = f"{shlex.quote(sys.executable)} -m derivation.cli {command}"
    done = subprocess.run(
        ["sh", "-c", shell], capture_output=True, text=True, check=False, cwd=ROOT
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"platecontact: {message}")


# --- closed output


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
def test_files_are_written_if_standard_output_is_closed(
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
    assert run.returncode == UNREAD_STATUS
    assert "Traceback" not in run.stderr
    assert "Error" not in run.stderr
    assert "Exception" not in run.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == list(written)


def test_warnings_to_a_closed_pipe_do_not_stop_the_command(tmp_path: Path) -> None:
    """An example is `platecontact ... 2>&1 | head -1`."""
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


def test_files_are_written_without_standard_output(tmp_path: Path) -> None:
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
def test_repeated_option_is_rejected(
    arguments: Sequence[str], option: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: Captured,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(list(arguments)) == 2
    message = capsys.readouterr().err
    assert option in message
    assert "2 times" in message
    assert list(tmp_path.iterdir()) == []


def test_option_with_several_values_may_be_repeated(capsys: Captured) -> None:
    assert main(["indent", str(PAPER), "--force", "1", "--force", "2", "--json", "-"]) == 0
    assert len(json.loads(capsys.readouterr().out)) == 2


@pytest.mark.parametrize(
    ("tables", "hint"),
    [
        ({"plate": {"thicknes": 1.0}}, "did you mean thickness?"),
        ({"sphere": {"Mas": 1.0}}, "did you mean mass?"),
        ({"sphere": {"speeds": 1.0}}, "did you mean impact.speed?"),
        ({"impackt": {}}, "did you mean impact?"),
        ({"impact": {"xyzzy": 1.0}}, "remove it"),
    ],
)
def test_most_similar_key_is_suggested(tables: dict[str, dict[str, float]], hint: str) -> None:
    with pytest.raises(SceneError, match=hint.replace("?", r"\?")):
        read(load(PAPER).to_json() | tables)
