"""The report of the paper, written once for all tests of its files."""

import shutil
from pathlib import Path

import pytest

from derivation.engine import report_files
from derivation.plate.paper import PAPER


@pytest.fixture(scope="session")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, ...]:
    """Return the files of the report; the first is in the folder of all. PDFs need LaTeX."""
    folder = tmp_path_factory.mktemp("report")
    return report_files.write(PAPER, folder, compiled=shutil.which("pdflatex") is not None)
