"""Reading of files with checks, and writing of files that are never incomplete."""

import contextlib
import errno
import hashlib
import os
import platform
import re
import stat
import sys
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path

from derivation.engine.staging import Temporary, flush_folder, put_folder, recover, remove_leftovers

PAGE = 4096
"""Smallest space for a file on a disk, in bytes."""
PACKAGE = Path(__file__).parents[1]
ROOT = PACKAGE.parent
DESCRIPTOR = re.compile(r"-|/dev/stdin|(?:/dev|/proc/self)/fd/(\d{1,9})")
"""Names of open descriptors: standard input, and those of the shell's process substitution."""
PINNED = ("sympy", "python-flint", "mpmath", "jinja2", "ruff")
"""Libraries whose version may change a cached result."""


def measurements() -> Path:
    """Return the folder of the committed measurements, in the checkout or the installed copy."""
    return ROOT / "reports" / "data" if in_checkout() else PACKAGE / "data"


def in_checkout() -> bool:
    """Return whether the package runs from a checkout; only there may it write its own files."""
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
    """Write all of the files or, if one cannot be written, none; return their paths.

    Raises
    ------
    OSError
        If a file cannot be written; the message states the file, the reason, and a remedy.
    """
    made: list[Path] = []
    temporaries: dict[Path, Temporary] = {}
    cleaned = set[Path]()
    try:
        for path, content in contents.items():
            expect_writable(path)
            target = real(path)
            with explained(path):
                made += _make_folder(target.parent)
                if target.parent not in cleaned:
                    remove_leftovers(target.parent)
                    cleaned.add(target.parent)
                temporaries[target] = Temporary(target.parent)
                temporaries[target].write(_bytes(content))
        for target, temporary in temporaries.items():
            temporary.path.replace(target)
    except BaseException:  # also Ctrl-C
        for temporary in temporaries.values():
            temporary.discard()
        _remove_empty(made)
        raise
    finally:
        for temporary in temporaries.values():
            temporary.close()
    for folder in cleaned:
        flush_folder(folder)
    return tuple(contents)


def write_folder(folder: Path, contents: Mapping[str, str | bytes]) -> tuple[Path, ...]:
    """Write files of a folder in one step, so that readers never find old and new files together.

    They are written one by one if the folder cannot be replaced: if it contains other folders, is a
    mount point, or contains the working directory.

    Raises
    ------
    OSError
        If a file cannot be written; the message states the file, the reason, and a remedy.
    """
    target = real(folder)
    with explained(folder):
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
    """Return the file to which a link leads; a link to itself is returned unchanged."""
    return Path(os.path.realpath(path))


def _bytes(content: str | bytes) -> bytes:
    return content.encode() if isinstance(content, str) else content


def _make_folder(folder: Path) -> list[Path]:
    """Create a folder; return the folders that were created, outermost first."""
    missing = [parent for parent in (folder, *folder.parents) if not parent.exists()][::-1]
    folder.mkdir(parents=True, exist_ok=True)
    return missing


def _remove_empty(folders: Sequence[Path]) -> None:
    """Remove empty folders, given with the outermost first."""
    for folder in reversed(folders):
        with contextlib.suppress(OSError):
            folder.rmdir()


def read_file(path: Path, most: int) -> bytes:
    """Return the content of a file or, for `-` or a name such as /dev/fd/63, of an open pipe.

    Raises
    ------
    OSError
        If it cannot be read, is a folder or a device, or has more than `most` bytes.
    """
    with os.fdopen(_opened(path), "rb") as stream:
        content = stream.read(most + 1)
    if len(content) > most:
        raise OSError(errno.EFBIG, f"more than {most} bytes")
    return content


def _opened(path: Path) -> int:
    """Return the descriptor of a file, or a copy of the open descriptor that a name denotes."""
    known = DESCRIPTOR.fullmatch(str(path))
    if known:
        if not int(known[1] or 0) and sys.stdin is None:  # descriptor 0 may belong to another file
            raise OSError(errno.EBADF, "standard input is closed")
        handle = os.dup(int(known[1] or 0))
        if os.name == "posix":
            os.set_blocking(
                handle, True
            )  # otherwise a pipe of another program may return only a part
        return handle
    if not stat.S_ISREG(path.stat().st_mode):
        raise OSError(errno.EINVAL, "a folder or a device, not a file")
    return os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))


def expect_writable(path: Path) -> None:
    """Reject a file that cannot be written, before its content is computed.

    Raises
    ------
    OSError
        If it cannot be written; the message states the reason, and a remedy.
    """
    target = real(path)
    with explained(path):
        exists, fine = target.exists(), target.is_file()
        if fine and not os.access(target, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        _try_folder(target.parent)
    if exists and not fine:
        kind = "folder" if target.is_dir() else "device"
        raise OSError(f"cannot write {path}: expected a file, got a {kind}; name a file")


def expect_folder(folder: Path) -> None:
    """Reject a folder that cannot be written to or created.

    Raises
    ------
    OSError
        If it cannot be written to; the message states the reason, and a remedy.
    """
    with explained(folder):
        other = folder.exists() and not folder.is_dir()
        if not other:
            _try_folder(real(folder))
    if other:
        raise OSError(f"cannot write {folder}: expected a folder, got a file; name a folder")


def _try_folder(folder: Path) -> None:
    """Write a test file into a folder, or into its nearest existing parent."""
    existing = next(parent for parent in (folder, *folder.parents) if parent.exists())
    with tempfile.TemporaryFile(dir=existing) as stream:
        stream.write(bytes(PAGE))


@contextlib.contextmanager
def explained(path: Path) -> Iterator[None]:
    """Replace an OSError in the block by one that states the file, the reason and a remedy."""
    try:
        yield
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT)
        remedy = "free some space" if full else "obtain permission to write there"
        raise OSError(
            f"cannot write {path}: {error.strerror or error}; {remedy}, or name another folder"
        ) from None


def sources(*rooms: str | Path) -> Iterator[Path]:
    """Yield source files in a fixed order: of folders those in ``.py``, ``.j2`` and ``.toml``.

    Text names a folder or a file of this package, or is a pattern like
    ``mathematics/*/theory*``; other folders and files are given by path. Compiled modules are no
    sources: they differ between checkouts, and are younger than the process that compiles them.
    """
    for room in rooms:
        for path in sorted(PACKAGE.glob(room)) if isinstance(room, str) else [room]:
            if path.parent.name == "__pycache__":
                continue
            if path.is_dir():
                own = (p for p in path.rglob("*") if p.suffix in {".py", ".j2", ".toml"})
                yield from sorted(own)
            else:
                yield path


def files_of_paper(folder: Path) -> tuple[Path, ...]:
    """Return the files of a paper's folder and its subfolders, data included.

    Files that the program writes there, and hidden files, are omitted.
    """
    written = {"generated", "reports"}
    parts = ((path, path.relative_to(folder).parts) for path in folder.rglob("*") if path.is_file())
    return tuple(
        sorted(
            path
            for path, names in parts
            if names[0] not in written
            and not any(name.startswith((".", "__pycache__")) for name in names)
        )
    )


def content_hash(paths: Iterable[Path]) -> str:
    """Return a hash of names and contents of files, and of versions of Python and `PINNED`."""
    digest = hashlib.sha256(platform.python_version().encode())
    for library in PINNED:
        digest.update(f"{library}={version(library)};".encode())
    for path in paths:
        is_internal = path.is_relative_to(PACKAGE)
        digest.update(f"{path.relative_to(PACKAGE) if is_internal else path}:".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()
