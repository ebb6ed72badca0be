"""Compilation of LaTeX files by pdflatex; equal texts give equal bytes."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from derivation.engine.files import write_file

PASSES = 4
"""Largest number of runs of LaTeX until its auxiliary files no longer change."""
PACKAGES = "texlive-latex-base texlive-latex-recommended lmodern"


class TexError(OSError):
    """The PDF cannot be made; the message states the reason, and a remedy if LaTeX is missing."""


def compile_pdf(source: Path) -> Path:
    """Compile a LaTeX file with pdflatex; return the path of the PDF, in the same folder.

    Raises
    ------
    TexError
        If pdflatex is not installed or fails; the message quotes its first error.
    """
    target = source.with_suffix(".pdf")
    write_file(target, typeset(source)[0])
    return target


def compile_all(files: Iterable[Path]) -> tuple[Path, ...]:
    """Compile those files that end in .tex, in parallel; return the paths of the PDFs.

    Raises
    ------
    TexError
        If pdflatex is not installed or fails.
    """
    with ThreadPoolExecutor() as pool:  # LaTeX is another process
        return tuple(pool.map(compile_pdf, (path for path in files if path.suffix == ".tex")))


def typeset(source: Path) -> tuple[bytes, str]:
    """Return the PDF of a LaTeX file, and the log of the last run.

    Raises
    ------
    TexError
        If pdflatex is not installed or fails; the message quotes its first error.
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
        environment["TEXINPUTS"] = f"{source.parent.resolve()}:"  # the folder of the figures
        environment["max_print_line"] = "1000"  # otherwise the log breaks lines
        made = Path(folder) / source.name
        noted: list[bytes] = []
        for count in range(PASSES):
            draft = [] if count else ["-draftmode"]  # the first run only writes auxiliary files
            run = subprocess.run(
                [*command, *draft, source.resolve()],
                env=environment,
                cwd=folder,
                capture_output=True,
                text=True,
                errors="replace",
                check=False,
            )
            if run.returncode:
                raise TexError(f"pdflatex failed on {source}: {first_error(run.stdout)}")
            before, noted = noted, _notes(made)
            if count and noted == before:
                break
        return made.with_suffix(".pdf").read_bytes(), made.with_suffix(".log").read_text("latin-1")


def _notes(made: Path) -> list[bytes]:
    """Return the content of the auxiliary files that a run leaves for the next one."""
    notes = (made.with_suffix(suffix) for suffix in (".aux", ".toc", ".out"))
    return [path.read_bytes() for path in notes if path.is_file()]


def first_error(log: str) -> str:
    """Return the first error in LaTeX's log with the lines after it, or the last lines."""
    lines = log.splitlines()
    start = next(
        (i for i, line in enumerate(lines) if line.startswith("!")), max(0, len(lines) - 5)
    )
    return " ".join(line.strip() for line in lines[start : start + 5])
