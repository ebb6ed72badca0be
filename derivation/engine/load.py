"""A paper from a folder, which may stand anywhere; and a new one to begin with."""

import importlib
import sys
from pathlib import Path
from traceback import extract_tb
from types import ModuleType

from derivation.engine.failed import FailedError
from derivation.engine.files import write_files
from derivation.engine.paper import Paper

SKELETON = Path(__file__).parent / "skeleton"
PREFIX = "paper_in_"
"""Of the name under which a folder is imported, so that it hides no other module."""


class PaperError(ValueError):
    """A folder that holds no paper; the message says what was expected and what to do."""


def load(folder: Path) -> Paper:
    """The paper of a folder: the object PAPER of its module `paper`.

    Raises
    ------
    PaperError
        If there is none, or the folder's modules cannot be imported.
    """
    place = folder.resolve()
    if not (place / "paper.py").is_file():
        raise PaperError(
            f"--paper: expected a folder with a file paper.py, got {folder}; "
            f"begin one with `platecontact new {folder}`"
        )
    name = PREFIX + "".join(c if c.isalnum() else "_" for c in place.name)
    try:
        paper = _imported(name, place).PAPER
    except FailedError:
        raise
    except Exception as error:  # whatever a module of the folder does
        raise PaperError(
            f"--paper: {folder} cannot be imported: {_place(error, place)}"
            f"{type(error).__name__}: {error}; correct it"
        ) from error
    if not isinstance(paper, Paper):
        raise PaperError(f"--paper: expected PAPER to be a Paper, got {type(paper).__name__}")
    return paper


def _imported(name: str, place: Path) -> ModuleType:
    """The module `paper` of a folder, the folder being a package of the given name."""
    for known in [known for known in sys.modules if known == name or known.startswith(f"{name}.")]:
        del sys.modules[known]  # of another folder of this name, or of files since edited
    package = ModuleType(name)
    package.__path__ = [str(place)]
    sys.modules[name] = package
    importlib.invalidate_caches()
    return importlib.import_module(f"{name}.paper")


def _place(error: Exception, folder: Path) -> str:
    """The line of the folder's files in which an error arose, as text in front of it."""
    frames = [f for f in extract_tb(error.__traceback__) if Path(f.filename).parent == folder]
    return f"{Path(frames[-1].filename).name}, line {frames[-1].lineno}: " if frames else ""


def begin(folder: Path) -> tuple[Path, ...]:
    """Write a small paper that works, to be changed into one's own; returns its files.

    Raises
    ------
    PaperError
        If the folder holds something already.
    OSError
        If it cannot be written to.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise PaperError(f"new: expected an empty folder or a new one, got {folder}; name another")
    found = sorted(path for path in SKELETON.iterdir() if path.is_file())
    sources = [path for path in found if path.name != "__init__.py"]
    return write_files({folder / path.name: path.read_text() for path in sources})
