"""The report of the paper, composed and written once for all tests of its files."""

import shutil
from pathlib import Path
from unittest.mock import patch

import pytest

from derivation.engine import report_files
from derivation.engine.report.document import Text
from derivation.plate.paper import PAPER


@pytest.fixture(scope="session")
def texts() -> dict[str, Text]:
    """Return the report and its appendices by name."""
    return report_files.documents(PAPER)


@pytest.fixture(scope="session")
def written(texts: dict[str, Text], tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, ...]:
    """Return the files of the report; the first is in the folder of all. PDFs need LaTeX."""
    folder = tmp_path_factory.mktemp("report")
    with patch.object(report_files, "documents", lambda *_: texts):
        return report_files.write(PAPER, folder, compiled=shutil.which("pdflatex") is not None)
