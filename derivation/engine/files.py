"""Reading of files with checks, and writing of whole files only."""

import contextlib
import errno
import hashlib
import os
import platform
import stat
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path

from derivation.engine.staging import Temporary, put_folder, recover, remove_leftovers, settle

PAGE = 4096
"""Smallest space for a file on a disk, in bytes."""
PACKAGE = Path(__file__).parents[1]
ROOT = PACKAGE.parent
PINNED = ("sympy", "python-flint", "mpmath", "jinja2", "ruff")
"""Libraries whose version may change a cached result."""


def measurements() -> Path:
    """Return the folder of the committed measurements; an installed copy has its own."""
    return ROOT / "reports" / "data" if in_checkout() else PACKAGE / "data"


def in_checkout() -> bool:
    """Return whether the package runs from a checkout, into which it may write."""
    return (ROOT / "pyproject.toml").is_file()


def write_file(path: Path, content: str | bytes) -> None:
    """Write a file through a temporary one in its folder, so that it is never incomplete.

    Raises
    ------
    OSError
        If the folder cannot be created or written to.
    """
    write_files({path: content})


def write_files(contents: Mapping[Path, str | bytes]) -> tuple[Path, ...]:
    """Write all of the files or, if one cannot be written, none; return them.

    Raises
    ------
    OSError
        Naming the file that cannot be written, the reason, and a remedy.
    """
    made: list[Path] = []
    temporaries: dict[Path, Temporary] = {}
    cleaned = set[Path]()
    try:
        for path, content in contents.items():
            expect_writable(path)
            target = real(path)
            with _explained(path):
                made += _make_folder(target.parent)
                if target.parent not in cleaned:
                    remove_leftovers(target.parent)
                    cleaned.add(target.parent)
                temporaries[target] = Temporary(target.parent)
                temporaries[target].write(_bytes(content))
        for target, temporary in temporaries.items():
            temporary.path.replace(target)
    except BaseException:  # Ctrl-C too
        for temporary in temporaries.values():
            temporary.discard()
        _remove_empty(made)
        raise
    finally:
        for temporary in temporaries.values():
            temporary.close()
    for folder in cleaned:
        settle(folder)
    return tuple(contents)


def write_folder(folder: Path, contents: Mapping[str, str | bytes]) -> tuple[Path, ...]:
    """Write files of a folder in one step, so that no reader finds old and new ones mixed.

    They are written one by one if the folder cannot be moved: it contains other folders, is a mount
    point, or is the working directory.

    Raises
    ------
    OSError
        Naming the file that cannot be written, the reason, and a remedy.
    """
    target = real(folder)
    with _explained(folder):
        recover(target)
        made = _make_folder(target.parent)
        remove_leftovers(target.parent)
    try:
        put_folder(target, {name: _bytes(content) for name, content in contents.items()})
    except OSError:
        _remove_empty(made)
        return write_files({folder / name: content for name, content in contents.items()})
    except BaseException:
        _remove_empty(made)
        raise
    return tuple(folder / name for name in contents)


def real(path: Path) -> Path:
    """Return the file behind a link; a link to itself is returned as it is."""
    return Path(os.path.realpath(path))


def _bytes(content: str | bytes) -> bytes:
    return content.encode() if isinstance(content, str) else content


def _make_folder(folder: Path) -> list[Path]:
    """Create a folder; return the folders that were created, outermost first."""
    missing = [place for place in (folder, *folder.parents) if not place.exists()][::-1]
    folder.mkdir(parents=True, exist_ok=True)
    return missing


def _remove_empty(folders: Sequence[Path]) -> None:
    """Remove folders that were created in vain, outermost first in the list."""
    for folder in reversed(folders):
        with contextlib.suppress(OSError):
            folder.rmdir()


def read_file(path: Path, most: int) -> bytes:
    """Return the content of a file.

    Raises
    ------
    OSError
        If it cannot be read, is a folder or a device, or has more than `most` bytes.
    """
    if not stat.S_ISREG(path.stat().st_mode):
        raise OSError(errno.EINVAL, "a folder or a device, not a file")
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as stream:
        content = stream.read(most + 1)
    if len(content) > most:
        raise OSError(errno.EFBIG, f"more than {most} bytes")
    return content


def expect_writable(path: Path) -> None:
    """Refuse a file that cannot be written, before minutes are spent on its content."""
    target = real(path)
    with _explained(path):
        there, fine = target.exists(), target.is_file()
        if fine and not os.access(target, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        _try_folder(target.parent)
    if there and not fine:
        kind = "folder" if target.is_dir() else "device"
        raise OSError(f"cannot write {path}: expected a file, got a {kind}; name a file")


def expect_folder(folder: Path) -> None:
    """Refuse a folder that cannot be written into or created."""
    with _explained(folder):
        other = folder.exists() and not folder.is_dir()
        if not other:
            _try_folder(real(folder))
    if other:
        raise OSError(f"cannot write {folder}: expected a folder, got a file; name a folder")


def _try_folder(folder: Path) -> None:
    """Write a test file into a folder, or into that in which it would be created."""
    there = next(place for place in (folder, *folder.parents) if place.exists())
    with tempfile.TemporaryFile(dir=there) as stream:
        stream.write(bytes(PAGE))


@contextlib.contextmanager
def _explained(path: Path) -> Iterator[None]:
    """Raise an error that names the file that could not be written, and a remedy."""
    try:
        yield
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT)
        remedy = "free some space" if full else "obtain permission to write there"
        raise OSError(
            f"cannot write {path}: {error.strerror}; {remedy}, or name another folder"
        ) from None


def sources(*rooms: str | Path) -> Iterator[Path]:
    """Return the named source files, templates and data included, in a fixed order.

    A name is a folder or a file of the package, or a pattern like ``paper/*/theory*``.
    """
    for room in rooms:
        for place in sorted(PACKAGE.glob(room)) if isinstance(room, str) else [room]:
            found = place.rglob("*") if place.is_dir() else [place]
            yield from sorted(p for p in found if p.suffix in {".py", ".j2", ".toml"})


def content_hash(paths: Iterable[Path]) -> str:
    """Return a hash of the files' names and contents, and versions of libraries and Python."""
    digest = hashlib.sha256(platform.python_version().encode())
    for library in PINNED:
        digest.update(f"{library}={version(library)};".encode())
    for path in paths:
        own = path.is_relative_to(PACKAGE)
        digest.update(f"{path.relative_to(PACKAGE) if own else path}:".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()
