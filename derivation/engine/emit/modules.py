"""Source text of the modules of a generated package: from templates, printed, or copied."""

import hashlib
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any

import sympy as sp

from derivation.engine.emit import copies, tables
from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.printed_fraction import expect_reason
from derivation.engine.emit.routine import ARRAYS, QUIET_SCALARS, Dialect, Routine
from derivation.engine.emit.routine import text as routine_text
from derivation.engine.emit.source import TEMPLATES, format_files, rendered_template


@dataclass(frozen=True)
class Module:
    """A module from a template: its name, template, context, and the template's folder."""

    name: str
    template: str
    context: Mapping[str, Any]
    folder: Path = TEMPLATES


@dataclass(frozen=True)
class Numbers:
    """A module of constants: its name, the first line of its docstring, and the constants."""

    name: str
    title: str
    constants: tuple[tables.Constant, ...]


@dataclass(frozen=True)
class Routines:
    """A module of routines.

    Parameters
    ----------
    name, title
        Name of the module, and first line of its docstring.
    routines
        Its functions, in order.
    imports
        For each other module of the package, names that the functions may import from it.
    dialect
        The way in which expressions are printed: for arrays or for single numbers.
    """

    name: str
    title: str
    routines: tuple[Routine, ...]
    imports: Mapping[str, tuple[str, ...]]
    dialect: Dialect = ARRAYS


@dataclass(frozen=True)
class CopiedModule:
    """A handwritten module that is copied.

    Parameters
    ----------
    name
        Name of the module in the package.
    file
        The original.
    package
        Import name of the package in the original.
    budgets
        Error budgets of the functions that the manifest lists, by name.
    notes
        Lines about errors, by function, for functions that the manifest does not list.
    """

    name: str
    file: Path
    package: str = "generated"
    budgets: Mapping[str, Budget] = field(default_factory=dict)
    notes: Mapping[str, Sequence[str]] = field(default_factory=dict)


Planned = Module | Numbers | Routines | CopiedModule


def module_files(planned: Sequence[Planned]) -> dict[str, str]:
    """Return the contents of a package's files by name; equal modules give equal bytes.

    Copies keep their lines; all other files are formatted by ruff.
    """
    copied = {
        f"{part.name}.py": _copied(part) for part in planned if isinstance(part, CopiedModule)
    }
    printed = {
        f"{part.name}.py": _text(part) for part in planned if not isinstance(part, CopiedModule)
    }
    return copied | format_files(printed) | {"py.typed": ""}


def _copied(part: CopiedModule) -> str:
    expect_reason(part.name, part.file.read_text())
    remarks = sorted(part.budgets.items()), *sorted(part.notes.items())
    source = f"{part.file.read_text()}{''.join(map(str, remarks))}"
    return copies.copy_text(part.file, part.package, header(source), part.budgets, part.notes)


def _text(part: Module | Numbers | Routines) -> str:
    if isinstance(part, Numbers):
        return tables.module_text(part.title, header(repr(part.constants)), part.constants)
    if isinstance(part, Routines):
        return _routines_text(part)
    return module_source(part)


def _routines_text(part: Routines) -> str:
    """Return the source of a module of routines.

    Raises
    ------
    ValueError
        If the routines use names that no import provides; the message states them.
    """
    needed = {name for r in part.routines for name in r.calls | r.constants}
    given = {name for names in part.imports.values() for name in names}
    if missing := needed - given - {r.name for r in part.routines}:
        raise ValueError(f"{part.name}: expected modules for {', '.join(sorted(missing))}")
    printed = [routine_text(r, part.dialect) for r in part.routines]
    lines = _first_lines(printed, part.dialect)
    for module, names in sorted(part.imports.items()):
        used = sorted(needed & set(names))
        lines += [f"from .{module} import {', '.join(used)}"] if used else []
    body = "\n\n\n".join(["\n".join(lines), *printed])
    return f'"""{part.title}"""\n{header(body)}\n\n{body}\n'


def _first_lines(printed: Sequence[str], dialect: Dialect) -> list[str]:
    """Return the imports from outside the package."""
    code = "\n".join(printed)
    lines = ["from collections.abc import Sequence"] if dialect.rows in code else []
    if dialect is ARRAYS:
        return [*lines, "import numpy as np", "", "from .arrays import Double"]
    if dialect is QUIET_SCALARS:
        return [*lines, "import numpy as np", ""]
    if functions := sorted(set(re.findall(r"(?<!\.)\b[a-z]+\w*\b", code)) & set(vars(math))):
        lines.append(f"from math import {', '.join(functions)}")
    return [*lines, ""]


def module_source(module: Module) -> str:
    """Return a module's source code; the header states versions and a hash of the input."""
    source = repr(sorted(module.context.items()))
    source += (module.folder / f"{module.template}.py.j2").read_text()
    source += (TEMPLATES / "macros.j2").read_text()
    return rendered_template(
        module.template, {"header": header(source), **module.context}, module.folder
    )


def header(source: str) -> str:
    """Return the comment that names the generator, and a hash of its input."""
    digest = hashlib.sha256(source.encode()).hexdigest()
    versions = f"platecontact {version('platecontact')} with SymPy {sp.__version__}"
    return (
        f"# Generated by {versions} from {digest[:16]}.\n"
        "# Do not edit: run `platecontact generate` instead."
    )
