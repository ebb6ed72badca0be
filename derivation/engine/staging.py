"""Temporary files and folders that replace their target in one step.

A temporary file is locked while the process that writes it is running. A later run can therefore
distinguish files that a killed process left, which it removes, from files that are being written.
"""

import contextlib
import errno
import os
import secrets
import shutil
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

fcntl: ModuleType | None
try:
    import fcntl
except ImportError:  # without such locks nothing is treated as a leftover
    fcntl = None

MARK = ".platecontact-"
"""Prefix of the name of every temporary file or folder."""
TEMPORARY, SET_ASIDE = ".tmp", ".old"
_EXCHANGE, _HERE = 2, -100
"""RENAME_EXCHANGE and AT_FDCWD of Linux."""


class Temporary:
    """A new file or folder with a hidden name, locked until it is closed.

    Attributes
    ----------
    path
        Path of the file or folder.
    """

    def __init__(self, parent: Path, folder: bool = False) -> None:
        while True:
            self.path = parent / f"{MARK}{secrets.token_hex(8)}{TEMPORARY}"
            self._handle = _new_folder(self.path) if folder else _new_file(self.path)
            if self._locked():
                return
            self.close()

    def _locked(self) -> bool:
        """Lock it; return False if another process has already removed it as a leftover."""
        if fcntl is None:
            return True
        with contextlib.suppress(OSError):  # some file systems have no locks
            fcntl.flock(self._handle, fcntl.LOCK_EX)
        try:
            return os.path.samestat(self.path.stat(), os.fstat(self._handle))
        except FileNotFoundError:
            return False

    def write(self, content: bytes) -> None:
        """Write the content of a file, and flush it to the disk."""
        _write(self._handle, content)

    def close(self) -> None:
        """Close it, which releases the lock."""
        os.close(self._handle)

    def discard(self) -> None:
        """Remove it, unless it was renamed."""
        _remove(self.path)


@contextlib.contextmanager
def locked_folder(folder: Path) -> Iterator[None]:
    """Exclude other processes that call this function for the same folder during the block.

    Raises
    ------
    BlockingIOError
        If another process is in such a block.
    """
    if fcntl is None:
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:  # some file systems have no locks
            if isinstance(error, BlockingIOError):
                raise
        yield
    finally:
        os.close(handle)


def _new_file(path: Path) -> int:
    return os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)


def _new_folder(path: Path) -> int:
    path.mkdir()
    return os.open(path, os.O_RDONLY)


def _write(handle: int, content: bytes) -> None:
    rest = memoryview(content)
    while rest:
        rest = rest[os.write(handle, rest) :]
    os.fsync(handle)


def _remove(path: Path) -> None:
    """Remove a file or a folder, if possible."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        with contextlib.suppress(OSError):
            path.unlink()


def flush_folder(folder: Path) -> None:
    """Flush a folder's entries to the disk, where the system supports that."""
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def remove_leftovers(folder: Path) -> None:
    """Remove temporary files and folders whose process has ended."""
    if fcntl is None:
        return
    names = [name for name in os.listdir(folder) if name.startswith(MARK)]  # noqa: PTH208
    for path in (folder / name for name in names if name.endswith(TEMPORARY)):
        with contextlib.suppress(OSError):
            handle = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                _remove(path)
            finally:
                os.close(handle)


def put_folder(target: Path, contents: dict[str, bytes]) -> None:
    """Replace a folder, or create it, with these files in one step.

    Other files of the old folder are kept, except for Python's caches.

    Parameters
    ----------
    target
        The folder, which is not a link; its parent exists.
    contents
        Contents of the files by name.

    Raises
    ------
    OSError
        If the folder cannot be replaced; then nothing has changed.
    """
    if fcntl is None:  # a leftover could not be distinguished from a folder in use
        raise OSError(errno.ENOTSUP, os.strerror(errno.ENOTSUP))
    staged = Temporary(target.parent, folder=True)
    try:
        for name, content in contents.items():
            handle = _new_file(staged.path / name)
            try:
                _write(handle, content)
            finally:
                os.close(handle)
        if target.exists():
            _take_over(target, staged.path, contents)
        flush_folder(staged.path)
        _swap(staged.path, target)
        flush_folder(target.parent)
    finally:
        staged.discard()  # after a swap the old folder, otherwise the new one
        staged.close()


def _take_over(old: Path, new: Path, contents: dict[str, bytes]) -> None:
    """Give a new folder the owner, permissions and other files of the old one.

    Raises
    ------
    OSError
        If the old one contains folders or the working directory.
    """
    if Path.cwd().is_relative_to(old):
        raise OSError(errno.EBUSY, os.strerror(errno.EBUSY))
    known, mine = old.stat(), new.stat()
    if (known.st_uid, known.st_gid) != (mine.st_uid, mine.st_gid):
        os.chown(new, known.st_uid, known.st_gid)
    new.chmod(known.st_mode & 0o7777)
    with os.scandir(old) as entries:
        for entry in entries:
            if entry.name in contents or entry.name == "__pycache__" or entry.name.startswith(MARK):
                continue
            if entry.is_dir(follow_symlinks=False):
                raise OSError(errno.ENOTEMPTY, os.strerror(errno.ENOTEMPTY))
            os.link(entry.path, new / entry.name, follow_symlinks=False)


def _swap(new: Path, target: Path) -> None:
    """Exchange two folders, in one step where the system supports that."""
    if not target.exists():
        new.rename(target)
    elif not _exchange(new, target):
        aside = _aside(target)
        target.rename(aside)
        try:
            new.rename(target)
        except OSError:
            aside.rename(target)
            raise
        _remove(aside)


def _exchange(one: Path, other: Path) -> bool:
    """Exchange two names in one step; return False if the system does not support it."""
    import ctypes

    try:
        call = ctypes.CDLL(None, use_errno=True).renameat2
    except (AttributeError, OSError, TypeError):
        return False
    if call(_HERE, os.fsencode(one), _HERE, os.fsencode(other), _EXCHANGE) == 0:
        return True
    code = ctypes.get_errno()
    if code in (errno.EINVAL, errno.ENOSYS, errno.ENOTSUP):
        return False
    raise OSError(code, os.strerror(code))


def _aside(target: Path) -> Path:
    """Return the name of the old folder between two renames."""
    return target.with_name(f"{MARK}{target.name}{SET_ASIDE}")


def recover(target: Path) -> None:
    """Complete or undo the replacement of a folder, if a process was killed between two renames.

    Raises
    ------
    OSError
        If the folder cannot be moved back.
    """
    aside = _aside(target)
    if not aside.is_dir():
        return
    if target.exists():
        _remove(aside)
    else:
        aside.rename(target)
