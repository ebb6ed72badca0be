"""Files and folders written in one step: whatever kills a run, they are whole, and nothing is left.

Runs are killed for certain at every step that touches the disk, not at random moments.
"""

import contextlib
import os
import signal
import sys
from collections.abc import Callable, Iterator, Mapping
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from derivation.cli import main
from derivation.engine import package, staging
from derivation.engine.files import read_file, write_file, write_files, write_folder
from derivation.engine.staging import Temporary, recover, remove_leftovers

STEPS = {
    "open", "os.chmod", "os.chown", "os.fsync", "os.link", "os.listdir", "os.mkdir", "os.remove",
    "os.rename", "os.rmdir", "os.scandir", "fcntl.flock", "shutil.rmtree",
}  # fmt: skip
OLD = {"a.py": "old a", "b.py": "old b", "stray.py": "of somebody's"}
NEW = {"a.py": "new a", "b.py": "new b", "c.py": "new c"}
Act = Callable[[], object]
needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="no processes can be forked")


def killed(step: int, act: Act) -> bool:
    """Act in a child that is killed before its n-th step; False if it has fewer."""
    child = os.fork()
    if child == 0:
        left = step

        def kill(event: str, _: Any = ()) -> None:
            nonlocal left
            left -= event in STEPS
            if left == 0:
                left = -1  # to kill is a step too
                os.kill(os.getpid(), signal.SIGKILL)

        settle = os.fsync
        os.fsync = lambda handle: (kill("os.fsync"), settle(handle))[1]
        sys.addaudithook(kill)
        with contextlib.suppress(BaseException):
            act()
        os._exit(0)
    _, status = os.waitpid(child, 0)
    return os.WIFSIGNALED(status)


def kills(act: Act, prepare: Act) -> Iterator[None]:
    """One round per step: prepared, and killed there."""
    for step in count(1):
        prepare()
        if not killed(step, act):
            assert step > 10
            return
        yield


def content(folder: Path) -> Mapping[str, str]:
    return {path.name: path.read_text() for path in folder.iterdir()} if folder.exists() else {}


# --- kill -9


@needs_fork
@pytest.mark.parametrize("exchange", [True, False])
def test_a_folder_is_old_or_new_wherever_a_run_is_killed(
    exchange: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At once if the system exchanges folders, from the next start on if it does not."""
    if not exchange:
        monkeypatch.setattr(staging, "_exchange", lambda *_: False)
    elif not exchanges(tmp_path):
        pytest.skip("the system does not exchange folders")
    place = tmp_path / "here" / "package"
    either = [OLD, OLD | NEW]

    def prepare() -> None:
        write_folder(place, {**OLD})
        (place / "c.py").unlink(missing_ok=True)

    prepare()
    for _ in kills(lambda: write_folder(place, NEW), prepare):
        if exchange:
            assert content(place) in either
        recover(place)
        assert content(place) in either
        write_folder(place, NEW)
        assert content(place) == OLD | NEW
        assert list(place.parent.iterdir()) == [place]


@needs_fork
def test_a_new_folder_is_whole_or_not_there(tmp_path: Path) -> None:
    place = tmp_path / "package"

    def prepare() -> None:
        for path in place.glob("*"):
            path.unlink()
        if place.exists():
            place.rmdir()

    for _ in kills(lambda: write_folder(place, NEW), prepare):
        assert content(place) in ({}, NEW)
        write_folder(place, NEW)
        assert list(tmp_path.iterdir()) == [place]


@needs_fork
def test_files_are_whole_and_what_a_killed_run_leaves_is_removed(tmp_path: Path) -> None:
    files = {tmp_path / name: text for name, text in NEW.items()}
    for _ in kills(
        lambda: write_files(files), lambda: write_files({tmp_path / k: v for k, v in OLD.items()})
    ):
        for path, text in files.items():
            assert not path.exists() or path.read_text() in (OLD.get(path.name), text)
        write_file(tmp_path / "another.py", "written where the others were to be")
        assert {path.name for path in tmp_path.iterdir()} <= {*OLD, *NEW, "another.py"}


def test_a_package_is_swapped_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By `generate`: a broken folder of a killed run comes back before it is compared."""
    monkeypatch.setattr(package, "files_of", lambda *_: dict(NEW))
    place = tmp_path / "package"
    assert main(["generate", "--out", str(place)]) == 0
    before = place.stat().st_ino
    assert main(["generate", "--out", str(place)]) == 0
    assert place.stat().st_ino != before, "written into piece by piece"
    place.rename(staging._aside(place))
    assert main(["generate", "--check", "--out", str(place)]) == 0
    assert list(tmp_path.iterdir()) == [place]


# --- what has to stay


def exchanges(folder: Path) -> bool:
    one, other = folder / "one", folder / "other"
    one.mkdir()
    other.mkdir()
    able = staging._exchange(one, other)
    one.rmdir()
    other.rmdir()
    return able


def test_a_temporary_that_is_being_written_is_no_leftover(tmp_path: Path) -> None:
    held = Temporary(tmp_path)
    remove_leftovers(tmp_path)
    assert list(tmp_path.iterdir()) == [held.path]
    held.close()
    remove_leftovers(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_leftovers_are_told_by_their_name_and_links_are_not_followed(tmp_path: Path) -> None:
    mine, folder = tmp_path / ".hidden.tmp", tmp_path / "folder"
    mine.write_text("mine")
    folder.mkdir()
    (folder / "file").write_text("mine")
    link = tmp_path / f"{staging.MARK}1{staging.TEMPORARY}"
    link.symlink_to(folder)
    remove_leftovers(tmp_path)
    assert (folder / "file").is_file()
    assert mine.is_file()


@pytest.mark.parametrize("why", ["cwd", "folder"])
def test_a_folder_that_cannot_be_moved_is_written_into(
    why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The one in which the process works, and one with folders of its own."""
    place = tmp_path / "package"
    write_folder(place, {**OLD})
    known = place.stat().st_ino
    if why == "cwd":
        monkeypatch.chdir(place)
    else:
        (place / "folder").mkdir()
    written = write_folder(Path() if why == "cwd" else place, {**NEW})
    assert [path.name for path in written] == list(NEW)
    assert place.stat().st_ino == known
    assert {path.name for path in place.iterdir()} - {"folder"} == {*OLD, *NEW}
    assert list(tmp_path.iterdir()) == [place]


def test_rights_and_links_of_a_folder_stay(tmp_path: Path) -> None:
    place, link = tmp_path / "package", tmp_path / "link"
    write_folder(place, {**OLD})
    place.chmod(0o750)
    link.symlink_to(place)
    write_folder(link, {**NEW})
    assert link.is_symlink()
    assert place.stat().st_mode & 0o777 == 0o750
    assert content(place) == OLD | NEW


def test_if_a_swap_fails_half_way_the_old_folder_is_put_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place, rename = tmp_path / "package", Path.rename
    write_folder(place, {**OLD})

    def fail(self: Path, target: Path) -> Path:
        if self.name.endswith(staging.TEMPORARY):
            raise OSError("no")
        return rename(self, target)

    monkeypatch.setattr(staging, "_exchange", lambda *_: False)
    monkeypatch.setattr(Path, "rename", fail)
    write_folder(place, {**NEW})  # one by one then
    assert content(place) == OLD | NEW
    assert list(tmp_path.iterdir()) == [place]


# --- reading


def test_only_files_of_a_sane_size_are_read(tmp_path: Path) -> None:
    path, loop, pipe = tmp_path / "file", tmp_path / "loop", tmp_path / "pipe"
    path.write_bytes(b"12345")
    assert read_file(path, 5) == b"12345"
    with pytest.raises(OSError, match="more than 4 bytes"):
        read_file(path, 4)
    loop.symlink_to(loop)
    os.mkfifo(pipe)
    for bad in (tmp_path, loop, pipe, Path("/dev/zero"), tmp_path / "absent"):
        with pytest.raises(OSError, match=r"."):
            read_file(bad, 5)
