"""A .tex file -> its PDF, the same bytes for the same text, without leftovers beside it."""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from derivation.engine.files import write_file

PASSES = 3
"""The table of contents and longtable's columns settle by the third run."""
PACKAGES = "texlive-latex-base texlive-latex-recommended lmodern"


class TexError(OSError):
    """There is no PDF; the message says why and how to get one."""


def compile_pdf(source: Path) -> Path:
    """Compile a LaTeX file with pdflatex; returns the PDF beside it.

    Raises
    ------
    TexError
        If there is no pdflatex, or it refuses the text: the message quotes its
        first error.
    """
    target = source.with_suffix(".pdf")
    write_file(target, typeset(source)[0])
    return target


def typeset(source: Path) -> tuple[bytes, str]:
    """The PDF of a LaTeX file and the log of the last run.

    Raises
    ------
    TexError
        If there is no pdflatex, or it refuses the text: the message quotes its
        first error.
    """
    engine = shutil.which("pdflatex")
    if engine is None:
        raise TexError(f"{source} is written, but not compiled: apt-get install {PACKAGES}")
    with tempfile.TemporaryDirectory() as folder:
        command = [
            engine,
            "-no-shell-escape",
            "-interaction=nonstopmode",
            "-halt-on-error",
            f"-output-directory={folder}",
        ]
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "0", "FORCE_SOURCE_DATE": "1"}
        environment["TEXINPUTS"] = f"{source.parent.resolve()}:"  # where the figures are
        environment["max_print_line"] = "1000"  # or the log breaks its lines
        for _ in range(PASSES):
            run = subprocess.run(
                [*command, source.resolve()],
                env=environment,
                cwd=folder,
                capture_output=True,
                text=True,
                errors="replace",
                check=False,
            )
            if run.returncode:
                raise TexError(f"pdflatex refused {source}: {first_error(run.stdout)}")
        made = Path(folder) / source.name
        return made.with_suffix(".pdf").read_bytes(), made.with_suffix(".log").read_text("latin-1")


def first_error(log: str) -> str:
    """The first error in LaTeX's log with the lines that explain it."""
    lines = log.splitlines()
    start = next(
        (i for i, line in enumerate(lines) if line.startswith("!")), max(0, len(lines) - 5)
    )
    return " ".join(line.strip() for line in lines[start : start + 5])
