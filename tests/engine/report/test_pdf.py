"""How LaTeX is run: the text of a report can start no program."""

import contextlib
import os
import shutil
import stat
from pathlib import Path

import pytest

from derivation.engine.report.pdf import TexError, typeset

ENGINE = """#!/bin/sh
for argument; do case "$argument" in -output-directory=*) folder="${argument#*=}";; esac; done
echo "$@" > "$folder/text.log"
echo made > "$folder/text.pdf"
"""


def test_the_engine_is_told_to_start_no_program(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    engine = tmp_path / "pdflatex"
    engine.write_text(ENGINE)
    engine.chmod(engine.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    source = tmp_path / "text.tex"
    source.write_text("")
    made, log = typeset(source)
    assert made == b"made\n"
    assert "-no-shell-escape" in log.split()


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex")
def test_a_program_in_the_text_is_not_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not even where the environment allows it."""
    monkeypatch.setenv("shell_escape", "t")
    source, trace = tmp_path / "text.tex", tmp_path / "trace"
    source.write_text(
        rf"\documentclass{{article}}\begin{{document}}\immediate\write18{{touch {trace}}}x"
        r"\end{document}"
    )
    with contextlib.suppress(TexError):
        typeset(source)
    assert not trace.exists()
