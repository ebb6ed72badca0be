"""Rendering of templates, and formatting by ruff; this module does not import SymPy."""

import subprocess
import tempfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any

import jinja2
from ruff.__main__ import find_ruff_bin

TEMPLATES = Path(__file__).parent / "templates"


def rendered_template(template: str, context: Mapping[str, Any], folder: Path = TEMPLATES) -> str:
    """Return a rendered template; the context must contain every name in it.

    Parameters
    ----------
    template
        Name of the template, without the suffix.
    context
        Values of its variables.
    folder
        Folder that is searched before that of the engine.
    """
    return _environment(folder).get_template(f"{template}.py.j2").render(**context)


@cache
def _environment(folder: Path) -> jinja2.Environment:
    """Return the environment of a folder, which compiles each template once."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader([folder, TEMPLATES]),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["repr"] = repr
    return environment


def format_files(source: Mapping[str, str]) -> dict[str, str]:
    """Return Python files by name, formatted by ruff, with sorted and used imports only.

    Raises
    ------
    RuntimeError
        If ruff fails, for example because a file is not valid Python.
    """
    with tempfile.TemporaryDirectory() as folder:
        for name, text in source.items():
            (Path(folder) / name).write_text(text)
        for task in (["check", "--fix", "--select", "I,F401"], ["format", "--line-length", "100"]):
            options = ["--isolated", "--no-cache", "--quiet", *task[1:]]
            command = [find_ruff_bin(), task[0], *options, folder]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode:
                raise RuntimeError(
                    f"ruff {task[0]} failed:\n{done.stdout:.2000}{done.stderr:.2000}"
                )
        return {name: (Path(folder) / name).read_text() for name in source}
