"""A .tex file -> its PDF, the same bytes for the same text, without leftovers beside it."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from derivation.engine.files import write_file

PASSES = 4
"""Most runs until what LaTeX notes for the next one no longer changes."""
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


def compile_all(files: Iterable[Path]) -> tuple[Path, ...]:
    """Compile the LaTeX files among some, side by side; returns the PDFs.

    Raises
    ------
    TexError
        If there is no pdflatex, or it refuses a text.
    """
    with ThreadPoolExecutor() as pool:  # LaTeX is another process
        return tuple(pool.map(compile_pdf, (path for path in files if path.suffix == ".tex")))


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
        made = Path(folder) / source.name
        noted: list[bytes] = []
        for count in range(PASSES):
            draft = [] if count else ["-draftmode"]  # the first run is for its notes alone
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
                raise TexError(f"pdflatex refused {source}: {first_error(run.stdout)}")
            before, noted = noted, _notes(made)
            if count and noted == before:
                break
        return made.with_suffix(".pdf").read_bytes(), made.with_suffix(".log").read_text("latin-1")


def _notes(made: Path) -> list[bytes]:
    """What a run noted for the next one."""
    notes = (made.with_suffix(suffix) for suffix in (".aux", ".toc", ".out"))
    return [path.read_bytes() for path in notes if path.is_file()]


def first_error(log: str) -> str:
    """The first error in LaTeX's log with the lines that explain it."""
    lines = log.splitlines()
    start = next(
        (i for i, line in enumerate(lines) if line.startswith("!")), max(0, len(lines) - 5)
    )
    return " ".join(line.strip() for line in lines[start : start + 5])
