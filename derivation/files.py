"""Files written whole or not at all, and a cache keyed by what its content was computed from."""

import contextlib
import hashlib
import os
import pickle
import platform
import tempfile
from collections.abc import Callable, Iterable, Iterator
from importlib.metadata import version
from pathlib import Path
from typing import TypeVar

Value = TypeVar("Value")

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
    path.parent.mkdir(parents=True, exist_ok=True)
    data = content.encode() if isinstance(content, str) else content
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    temporary = Path(name)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(data)
        temporary.chmod(0o644)
        temporary.replace(path)
    finally:
        with contextlib.suppress(FileNotFoundError):
            temporary.unlink()


def expect_writable(path: Path) -> None:
    """Refuse a file that cannot be written before minutes are spent on what it is to hold."""
    folder = next(parent for parent in path.absolute().parents if parent.exists())
    try:
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise OSError(f"cannot write {path}: {error.strerror}; name another folder") from None
    if path.is_dir():
        raise OSError(f"cannot write {path}: expected a file, got a folder")


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
