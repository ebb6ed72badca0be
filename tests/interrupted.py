"""A program that is interrupted by Ctrl-C."""

import os
import signal
import subprocess
import sys
from collections.abc import Mapping

from derivation.engine.files import ROOT


def interrupted(
    program: str, argument: object, line: str, environment: Mapping[str, str] | None = None
) -> tuple[str, str]:
    """Run a program, interrupt it when it has printed a line, and return what it wrote.

    The program must end with status 2 and a message, and without a traceback.
    """
    run = subprocess.Popen(
        [sys.executable, "-c", program, str(argument)], cwd=ROOT,
        env={**os.environ, **(environment or {})},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert run.stdout is not None
    assert run.stdout.readline() == f"{line}\n"
    run.send_signal(signal.SIGINT)
    shown, message = run.communicate(timeout=60)
    assert run.returncode == 2, message
    assert "interrupted" in message
    assert "Traceback" not in message
    return shown, message
