"""Loading of a paper from any folder, and creation of a new one."""

import importlib
import sys
from collections.abc import Iterable
from pathlib import Path
from types import ModuleType

from derivation.engine.failed import FailedError, location
from derivation.engine.files import PACKAGE, sources, write_files
from derivation.engine.paper import Paper

SKELETON = Path(__file__).parent / "skeleton"
PREFIX = "paper_in_"
"""Prefix of the name under which a folder is imported, to avoid the names of other modules."""


class PaperError(ValueError):
    """A folder does not contain a paper; the message states what is expected, and a remedy."""


def load(folder: Path) -> Paper:
    """Return the paper of a folder: the object PAPER of its module `paper`.

    Raises
    ------
    PaperError
        If there is no paper, the folder's modules cannot be imported, or they import a file that is
        not one of the sources.
    derivation.engine.failed.FailedError
        If a proof fails during the import.
    """
    path = folder.resolve()
    if not (path / "paper.py").is_file():
        new = "NAME" if path.exists() else folder
        raise PaperError(
            f"--paper: expected a folder with a file paper.py, got {folder}; "
            f"create one with `platecontact new {new}`"
        )
    name = PREFIX + "".join(c if c.isalnum() else "_" for c in path.name)
    others = {known for known in sys.modules if not known.startswith(f"{name}.")}
    try:
        paper = _imported(name, path).PAPER
    except FailedError:
        raise
    except Exception as error:  # any exception that a module of the folder raises
        raise PaperError(
            f"--paper: {folder} cannot be imported: {location(error, path)}"
            f"{type(error).__name__}: {error}; correct it"
        ) from error
    if not isinstance(paper, Paper):
        raise PaperError(f"--paper: expected PAPER to be a Paper, got {type(paper).__name__}")
    _expect_sources(paper, path, sys.modules.keys() - others)
    return paper


def _expect_sources(paper: Paper, folder: Path, imported: Iterable[str]) -> None:
    """Reject a paper that imports files which are not among its sources.

    Cached proofs would be used again after such a file has changed.
    """
    known = {path.resolve() for path in sources(*paper.chain.sources)}
    for name in sorted(imported):
        file = Path(getattr(sys.modules[name], "__file__", None) or __file__).resolve()
        if file not in known and not _is_installed(file):
            raise PaperError(
                f"--paper: {folder.name} imports {file}, which is not one of its sources; "
                "write Chain(..., sources=(..., *files_of_paper(HERE))) with files_of_paper of "
                "derivation.engine.files, and add files from other folders"
            )


def _is_installed(file: Path) -> bool:
    """Return whether a file belongs to Python, to a library or to this program."""
    rooms = PACKAGE, *(Path(room).resolve() for room in (sys.prefix, sys.base_prefix))
    libraries = {"site-packages", "dist-packages"} & set(file.parts)
    return bool(libraries) or any(map(file.is_relative_to, rooms))


def _imported(name: str, path: Path) -> ModuleType:
    """Return the module `paper` of a folder, imported as a package of the given name."""
    for known in [known for known in sys.modules if known == name or known.startswith(f"{name}.")]:
        del sys.modules[known]  # it may be from another folder of this name, or from older files
    package = ModuleType(name)
    package.__path__ = [str(path)]
    sys.modules[name] = package
    importlib.invalidate_caches()
    return importlib.import_module(f"{name}.paper")


def location_in_paper(error: Exception) -> str:
    """Return file and line of a loaded paper's code in which an error occurred, or ""."""
    papers = [module for name, module in sys.modules.items() if name.startswith(PREFIX)]
    folders = {Path(path) for module in papers for path in getattr(module, "__path__", ())}
    return "".join(location(error, folder) for folder in folders)


def create_paper(folder: Path) -> tuple[Path, ...]:
    """Write a small working paper into a folder, as a start for a new paper; return its files.

    Raises
    ------
    PaperError
        If the folder is not empty, or is a file.
    OSError
        If it cannot be written to.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise PaperError(f"new: expected an empty folder or a new one, got {folder}; name another")
    files = sorted(path for path in SKELETON.iterdir() if path.is_file())
    sources = [path for path in files if path.name != "__init__.py"]
    return write_files({folder / path.name: path.read_text() for path in sources})
