"""Files and folders are replaced atomically, even if the process is killed.

The process is killed once at every step that accesses the disk, not at random times.
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
OLD = {"a.py": "old a", "b.py": "old b", "unrelated.py": "not generated"}
NEW = {"a.py": "new a", "b.py": "new b", "c.py": "new c"}
Action = Callable[[], object]
needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="no processes can be forked")


def is_killed(step: int, action: Action) -> bool:
    """Return whether the action, in a child process, reaches its n-th step and is killed there."""
    child = os.fork()
    if child == 0:
        remaining = step

        def kill(event: str, _: Any = ()) -> None:
            nonlocal remaining
            remaining -= event in STEPS
            if remaining == 0:
                remaining = -1  # os.kill is an audited step, too
                os.kill(os.getpid(), signal.SIGKILL)

        fsync = os.fsync
        os.fsync = lambda handle: (kill("os.fsync"), fsync(handle))[1]
        sys.addaudithook(kill)
        with contextlib.suppress(BaseException):
            action()
        os._exit(0)
    _, status = os.waitpid(child, 0)
    return os.WIFSIGNALED(status)


def killed_at_every_step(action: Action, prepare: Action) -> Iterator[None]:
    """Prepare, and kill the action at step 1, 2, ...; yield after each."""
    for step in count(1):
        prepare()
        if not is_killed(step, action):
            assert step > 10
            return
        yield


def content(folder: Path) -> Mapping[str, str]:
    return {path.name: path.read_text() for path in folder.iterdir()} if folder.exists() else {}


# --- processes that are killed


@needs_fork
@pytest.mark.parametrize("exchange", [True, False])
def test_folder_is_old_or_new_after_a_kill(
    exchange: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """This holds at once if the system can exchange folders, else after `recover`."""
    if not exchange:
        monkeypatch.setattr(staging, "_exchange", lambda *_: False)
    elif not exchanges(tmp_path):
        pytest.skip("the system does not exchange folders")
    package_folder = tmp_path / "parent" / "package"
    either = [OLD, OLD | NEW]

    def prepare() -> None:
        write_folder(package_folder, {**OLD})
        (package_folder / "c.py").unlink(missing_ok=True)

    prepare()
    for _ in killed_at_every_step(lambda: write_folder(package_folder, NEW), prepare):
        if exchange:
            assert content(package_folder) in either
        recover(package_folder)
        assert content(package_folder) in either
        write_folder(package_folder, NEW)
        assert content(package_folder) == OLD | NEW
        assert list(package_folder.parent.iterdir()) == [package_folder]


@needs_fork
def test_new_folder_is_complete_or_absent_after_a_kill(tmp_path: Path) -> None:
    package_folder = tmp_path / "package"

    def prepare() -> None:
        for path in package_folder.glob("*"):
            path.unlink()
        if package_folder.exists():
            package_folder.rmdir()

    for _ in killed_at_every_step(lambda: write_folder(package_folder, NEW), prepare):
        assert content(package_folder) in ({}, NEW)
        write_folder(package_folder, NEW)
        assert list(tmp_path.iterdir()) == [package_folder]


@needs_fork
def test_files_are_complete_and_leftovers_are_removed_after_a_kill(tmp_path: Path) -> None:
    files = {tmp_path / name: text for name, text in NEW.items()}
    for _ in killed_at_every_step(
        lambda: write_files(files), lambda: write_files({tmp_path / k: v for k, v in OLD.items()})
    ):
        for path, text in files.items():
            assert not path.exists() or path.read_text() in (OLD.get(path.name), text)
        write_file(tmp_path / "another.py", "written to the same folder")
        assert {path.name for path in tmp_path.iterdir()} <= {*OLD, *NEW, "another.py"}


def test_package_is_replaced_as_a_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """`generate --check` first restores a folder that an interrupted run has moved aside."""
    monkeypatch.setattr(package, "files_of", lambda *_: dict(NEW))
    package_folder = tmp_path / "package"
    assert main(["generate", "--out", str(package_folder)]) == 0
    before = package_folder.stat().st_ino
    assert main(["generate", "--out", str(package_folder)]) == 0
    assert package_folder.stat().st_ino != before, "files were replaced one by one"
    package_folder.rename(staging._aside(package_folder))
    assert main(["generate", "--check", "--out", str(package_folder)]) == 0
    assert list(tmp_path.iterdir()) == [package_folder]


# --- what must not be changed


def exchanges(folder: Path) -> bool:
    """Return whether the system can exchange two folders."""
    one, other = folder / "one", folder / "other"
    one.mkdir()
    other.mkdir()
    able = staging._exchange(one, other)
    one.rmdir()
    other.rmdir()
    return able


def test_temporary_file_in_use_is_not_removed(tmp_path: Path) -> None:
    temporary = Temporary(tmp_path)
    remove_leftovers(tmp_path)
    assert list(tmp_path.iterdir()) == [temporary.path]
    temporary.close()
    remove_leftovers(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_only_files_with_the_name_of_leftovers_are_removed(tmp_path: Path) -> None:
    mine, folder = tmp_path / ".hidden.tmp", tmp_path / "folder"
    mine.write_text("mine")
    folder.mkdir()
    (folder / "file").write_text("mine")
    link = tmp_path / f"{staging.MARK}1{staging.TEMPORARY}"
    link.symlink_to(folder)
    remove_leftovers(tmp_path)
    assert (folder / "file").is_file()
    assert mine.is_file()


@pytest.mark.parametrize("reason", ["cwd", "folder"])
def test_files_are_written_one_by_one_if_the_folder_cannot_be_moved(
    reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The current folder is not moved, nor a folder that contains other folders."""
    package_folder = tmp_path / "package"
    write_folder(package_folder, {**OLD})
    inode = package_folder.stat().st_ino
    if reason == "cwd":
        monkeypatch.chdir(package_folder)
    else:
        (package_folder / "folder").mkdir()
    written = write_folder(Path() if reason == "cwd" else package_folder, {**NEW})
    assert [path.name for path in written] == list(NEW)
    assert package_folder.stat().st_ino == inode
    assert {path.name for path in package_folder.iterdir()} - {"folder"} == {*OLD, *NEW}
    assert list(tmp_path.iterdir()) == [package_folder]


def test_permissions_and_symbolic_links_are_kept(tmp_path: Path) -> None:
    package_folder, link = tmp_path / "package", tmp_path / "link"
    write_folder(package_folder, {**OLD})
    package_folder.chmod(0o750)
    link.symlink_to(package_folder)
    write_folder(link, {**NEW})
    assert link.is_symlink()
    assert package_folder.stat().st_mode & 0o777 == 0o750
    assert content(package_folder) == OLD | NEW


def test_files_are_written_one_by_one_if_the_exchange_fails(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package_folder, rename = tmp_path / "package", Path.rename
    write_folder(package_folder, {**OLD})

    def fail(self: Path, target: Path) -> Path:
        if self.name.endswith(staging.TEMPORARY):
            raise OSError("no")
        return rename(self, target)

    monkeypatch.setattr(staging, "_exchange", lambda *_: False)
    monkeypatch.setattr(Path, "rename", fail)
    write_folder(package_folder, {**NEW})
    assert content(package_folder) == OLD | NEW
    assert list(tmp_path.iterdir()) == [package_folder]


# --- reading


def test_only_regular_files_up_to_a_size_are_read(tmp_path: Path) -> None:
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
