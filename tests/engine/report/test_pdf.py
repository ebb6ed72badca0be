"""LaTeX runs without shell escape, so that the text of a report cannot start a program."""

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


def test_shell_escape_is_disabled_on_the_command_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    engine = tmp_path / "pdflatex"
    engine.write_text(ENGINE)
    engine.chmod(engine.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    source = tmp_path / "text.tex"
    source.write_text("")
    pdf, log = typeset(source)
    assert pdf == b"made\n"
    assert "-no-shell-escape" in log.split()


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex")
def test_text_cannot_start_a_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """This holds even if an environment variable enables shell escape."""
    monkeypatch.setenv("shell_escape", "t")
    source, trace = tmp_path / "text.tex", tmp_path / "trace"
    source.write_text(
        rf"\documentclass{{article}}\begin{{document}}\immediate\write18{{touch {trace}}}x"
        r"\end{document}"
    )
    with contextlib.suppress(TexError):
        typeset(source)
    assert not trace.exists()
