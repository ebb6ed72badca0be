"""Source code of generated functions for the report, without docstrings."""

import ast
from collections.abc import Iterator, Mapping
from typing import Any

from derivation.engine.formula.record import Record
from derivation.engine.report.equations import body

SHOWN = {
    "G": "influence",
    "K_j": "influence",
    "A_j": "pressure",
    "P": "pressure",
    "sonine": "pressure",
    "Omega_3": "omega",
}
"""Short functions of one formula each, and the module of `generated` that contains them."""
LAW = {"_forces": "plate_arrays", "_contact": "plate_arrays"}
"""Functions without a formula: the inverse law, which solves for the contact radius."""


def listings_context(sources: Mapping[str, str], formulas: Mapping[str, Record]) -> dict[str, Any]:
    """Return each function with its formula.

    Parameters
    ----------
    sources
        Text of the generated modules by name.
    formulas
        Every formula by name.
    """
    return {
        "listings": [
            {
                "name": name,
                "module": module,
                "meaning": formulas[name].meaning,
                "body": body(formulas[name]),
                "code": function_source(sources[module], name),
            }
            for name, module in SHOWN.items()
        ],
        "law": [function_source(sources[module], name) for name, module in LAW.items()],
        "lines": sum(text.count("\n") for text in sources.values()),
        "modules": len(sources),
    }


def function_source(text: str, name: str) -> str:
    """Return the source of a function without its docstring.

    Raises
    ------
    ValueError
        If the module has no such function.
    """
    functions = [
        n for n in ast.parse(text).body if isinstance(n, ast.FunctionDef) and n.name == name
    ]
    if not functions:
        raise ValueError(f"expected a function {name} in the generated module, got none")
    return "\n".join(_lines(text, functions[0]))


def _lines(text: str, function: ast.FunctionDef) -> Iterator[str]:
    """Yield the lines of a function except those of its docstring."""
    first = function.body[0]
    documented = ast.get_docstring(function) is not None
    skipped = range(first.lineno, (first.end_lineno or 0) + 1) if documented else range(0)
    start = min([function.lineno, *(d.lineno for d in function.decorator_list)])
    for number, line in enumerate(text.splitlines(), start=1):
        if start <= number <= (function.end_lineno or 0) and number not in skipped:
            yield line
