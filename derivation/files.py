"""Files written whole or not at all, and a cache keyed by what its content was computed from."""

import contextlib
import errno
import hashlib
import os
import pickle
import platform
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import TypeVar

Value = TypeVar("Value")

PAGE = 4096
"""Least room for a file that a disk takes, in bytes."""
PACKAGE = Path(__file__).parent
ROOT = PACKAGE.parent
PINNED = ("sympy", "python-flint", "mpmath", "jinja2", "ruff")
"""Libraries whose version may change a cached result."""


def measurements() -> Path:
    """Folder of the committed measurements, of which an installed copy has its own."""
    return ROOT / "reports" / "data" if in_checkout() else PACKAGE / "data"


def in_checkout() -> bool:
    """Whether the package runs from a checkout, which it may write into."""
    return (ROOT / "pyproject.toml").is_file()


def write_file(path: Path, content: str | bytes) -> None:
    """Write a file through a temporary one beside it, so that it is never half there.

    Raises
    ------
    OSError
        If the folder cannot be made or written to.
    """
    write_files({path: content})


def write_files(contents: Mapping[Path, str | bytes]) -> tuple[Path, ...]:
    """Write all of the files or, where there is no leave or no room for one, none; returns them.

    Raises
    ------
    OSError
        Naming the file that cannot be written, why, and how to mend it.
    """
    made: list[Path] = []
    temporaries: dict[Path, Path] = {}
    try:
        for path, content in contents.items():
            expect_writable(path)
            target = path.resolve()
            with _explained(path):
                made += _make_folder(target.parent)
                handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
                temporaries[target] = Path(name)
                with os.fdopen(handle, "wb") as stream:
                    stream.write(content.encode() if isinstance(content, str) else content)
                temporaries[target].chmod(0o644)
        for target, temporary in temporaries.items():
            temporary.replace(target)
    except BaseException:  # Ctrl-C too
        for temporary in temporaries.values():
            temporary.unlink(missing_ok=True)
        for folder in reversed(made):
            with contextlib.suppress(OSError):
                folder.rmdir()
        raise
    return tuple(contents)


def _make_folder(folder: Path) -> list[Path]:
    """Make a folder; returns what had to be made, outermost first."""
    missing = [place for place in (folder, *folder.parents) if not place.exists()][::-1]
    folder.mkdir(parents=True, exist_ok=True)
    return missing


def expect_writable(path: Path) -> None:
    """Refuse a file that cannot be written before minutes are spent on what it is to hold."""
    target = path.resolve()
    with _explained(path):
        there, fine = target.exists(), target.is_file()
        if fine and not os.access(target, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        _try_folder(target.parent)
    if there and not fine:
        kind = "folder" if target.is_dir() else "device"
        raise OSError(f"cannot write {path}: expected a file, got a {kind}; name a file")


def expect_folder(folder: Path) -> None:
    """Refuse a folder that cannot be written into, there or still to be made."""
    with _explained(folder):
        other = folder.exists() and not folder.is_dir()
        if not other:
            _try_folder(folder.resolve())
    if other:
        raise OSError(f"cannot write {folder}: expected a folder, got a file; name a folder")


def _try_folder(folder: Path) -> None:
    """Write a page into a folder, or into that in which it would be made, unseen."""
    there = next(place for place in (folder, *folder.parents) if place.exists())
    with tempfile.TemporaryFile(dir=there) as stream:
        stream.write(bytes(PAGE))


@contextlib.contextmanager
def _explained(path: Path) -> Iterator[None]:
    """Say which file could not be written, and what to do."""
    try:
        yield
    except OSError as error:
        full = error.errno in (errno.ENOSPC, errno.EDQUOT)
        mend = "free some space" if full else "ask for leave to write there"
        raise OSError(
            f"cannot write {path}: {error.strerror}; {mend}, or name another folder"
        ) from None


def sources(*rooms: str) -> Iterator[Path]:
    """Source files of the rooms, templates and data included, in a fixed order."""
    for room in rooms:
        place = PACKAGE / room
        found = place.rglob("*") if place.is_dir() else [place]
        yield from sorted(p for p in found if p.suffix in {".py", ".j2", ".toml"})


def content_hash(paths: Iterable[Path]) -> str:
    """Hash of the files' names and contents, the library versions and Python's."""
    digest = hashlib.sha256(platform.python_version().encode())
    for library in PINNED:
        digest.update(f"{library}={version(library)};".encode())
    for path in paths:
        digest.update(f"{path.relative_to(PACKAGE)}:".encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def cached(name: str, rooms: tuple[str, ...], compute: Callable[[], Value]) -> Value:
    """Result of `compute`, kept as long as the sources of the rooms stay the same.

    The cache is a convenience: one that cannot be read or written is passed over.
    """
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    path = base / "platecontact" / f"{name}-{content_hash(sources(*rooms))[:32]}.pickle"
    try:
        value: Value = pickle.loads(path.read_bytes())
    except Exception:  # whatever a damaged file raises, computing again mends it
        data = pickle.dumps(compute())
        with contextlib.suppress(OSError):
            write_file(path, data)
        # SymPy builds an unpickled expression anew, which may regroup it: so that
        # the first run sees what later ones will, it reads what it has written.
        value = pickle.loads(data)
    return value
