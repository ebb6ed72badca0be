"""A tested NumPy module for a stable form of one variable, as `platecontact rewrite` prints it."""

import textwrap
from importlib.metadata import version

import numpy as np
import sympy as sp

from derivation.engine.emit.copies import function_text
from derivation.engine.emit.kernels import lines, switch_text
from derivation.engine.emit.package import RUNTIME, Module, fill
from derivation.engine.emit.printer import to_numpy
from derivation.engine.emit.source import format_files
from derivation.engine.rewrite.form import Switch
from derivation.engine.rewrite.series import POLYNOMIAL
from derivation.engine.rewrite.stabilise import Stable
from derivation.engine.rewrite.tested import ENDS, CodeCheck, Function, tested

_WIDTH = 90


def standalone(stable: Stable) -> tuple[str, CodeCheck]:
    """Return the source of a module with the form as a function `f`, and the result of its test.

    Raises
    ------
    UnreachableError
        If the code is not accurate in any useful range.
    """
    x = stable.variable
    found = tested(stable, _compiled(_source(stable, *ENDS, "")))
    statement = (
        f"Error at most {found.limit:g} ULP plus half the condition number |{x} f'/f|. "
        f"Tested, not proved: with NumPy {np.__version__} against exact values at {found.points} "
        "points, including the ends of the range, and points next to zeros and overflow limits "
        f"of the formula and its parts; largest error {found.worst:.2f} ULP, at {x} = {found.at!r}."
    )
    return _source(stable, found.low, found.high, statement), found


def _compiled(source: str) -> Function:
    space: dict[str, Function] = {}
    exec(compile(source, "f.py", "exec"), space)  # generated from a parsed formula
    return space["f"]


def _source(stable: Stable, low: float, high: float, statement: str) -> str:
    switch = switch_text(stable.value) if isinstance(stable.value, Switch) else None
    sides = (stable.value.below, stable.value.above) if isinstance(stable.value, Switch) else ()
    powers = any(
        part.has(POLYNOMIAL)
        for side in sides
        for part in (side.value, *(step.expression for step in side.steps))
    )
    context = {
        "summary": f"Stable form of a formula, by platecontact {version('platecontact')}.",
        "name": "f",
        "variable": str(stable.variable),
        "formula": sp.sstr(stable.expression),
        "low": repr(low),
        "high": repr(high),
        "statement": textwrap.wrap(statement, _WIDTH),
        "polynomial": function_text(RUNTIME / "polynomials.py", "polynomial") if powers else "",
        "function": {
            "steps": lines(stable.steps),
            "switch": switch,
            "value": "" if switch else to_numpy(stable.value),
        },
    }
    return format_files({"f.py": fill(Module("f", "standalone", context))})["f.py"]
