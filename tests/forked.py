"""Commands in processes that are forked from a server, which has loaded the modules once.

Otherwise each process would load SymPy and the engine again, which takes a second.
"""

import multiprocessing
import os
import sys
import tempfile
import traceback
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

LOADED = ["derivation.cli", "derivation.engine.build", "derivation.engine.report_files"]
"""Modules that the server loads; no paper is among them."""
_SERVED = multiprocessing.get_context("forkserver")
_SERVED.set_forkserver_preload(LOADED)


class Ended(NamedTuple):
    """Exit status and output of a command."""

    status: int | None
    out: str
    err: str


def command(*arguments: str, folder: Path, environment: Mapping[str, str]) -> Ended:
    """Run a command of the program in a separate process.

    Parameters
    ----------
    folder
        Working directory of the command.
    environment
        Variables in addition to those of the server.
    """
    with tempfile.TemporaryDirectory() as logs:
        files = Path(logs) / "out", Path(logs) / "err"
        child = _SERVED.Process(target=_run, args=(arguments, folder, dict(environment), *files))
        child.start()
        child.join()
        return Ended(child.exitcode, *(file.read_text() for file in files))


def _run(
    arguments: tuple[str, ...], folder: Path, environment: dict[str, str], out: Path, err: Path
) -> None:
    """Run the command with its output in files, and end the process with its exit status."""
    os.environ.update(environment)
    os.chdir(folder)
    with out.open("w") as sys.stdout, err.open("w") as sys.stderr:
        for stream, descriptor in ((sys.stdout, 1), (sys.stderr, 2)):
            os.dup2(stream.fileno(), descriptor)
        try:
            from derivation.cli import main

            status = main(arguments)
        except Exception:
            traceback.print_exc()
            status = 3
    os._exit(status)
