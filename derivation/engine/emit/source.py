"""Templates in, Python as ruff formats it out; starts without SymPy."""

import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import jinja2

TEMPLATES = Path(__file__).parent / "templates"


def filled(template: str, context: Mapping[str, Any], folder: Path = TEMPLATES) -> str:
    """A template's text; every name in it must be in the context.

    Parameters
    ----------
    template
        Its name, without the ending.
    context
        What goes in.
    folder
        Where it is looked for first.
    """
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader([folder, TEMPLATES]),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["repr"] = repr
    return environment.get_template(f"{template}.py.j2").render(**context)


def format_files(source: Mapping[str, str]) -> dict[str, str]:
    """Stage 4: the files as ruff formats them.

    Raises
    ------
    RuntimeError
        With ruff's message, if a file is not Python.
    """
    with tempfile.TemporaryDirectory() as folder:
        for name, text in source.items():
            (Path(folder) / name).write_text(text)
        for task in (["check", "--fix", "--select", "I,F401"], ["format", "--line-length", "100"]):
            command = [
                sys.executable,
                "-m",
                "ruff",
                task[0],
                "--isolated",
                "--no-cache",
                "--quiet",
                *task[1:],
                folder,
            ]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode:
                raise RuntimeError(
                    f"ruff {task[0]} failed:\n{done.stdout:.2000}{done.stderr:.2000}"
                )
        return {name: (Path(folder) / name).read_text() for name in source}
