"""The base class of failures, and the place of an error in the files of a folder."""

from pathlib import Path
from traceback import extract_tb


class FailedError(AssertionError):
    """A proof fails, or two references contradict each other."""


def location(error: Exception, folder: Path) -> str:
    """Return file and line of a folder's code in which an error occurred, as a prefix, or ""."""
    frames = [f for f in extract_tb(error.__traceback__) if Path(f.filename).parent == folder]
    return f"{Path(frames[-1].filename).name}, line {frames[-1].lineno}: " if frames else ""
