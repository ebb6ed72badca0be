"""Rows of the manifest for handwritten functions, from their signatures and docstrings."""

from collections.abc import Iterator, Mapping
from typing import Any

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.copies import ListedFunction, listed_functions
from derivation.plate.modules import runtime_files

Row = dict[str, Any]


def listed() -> Iterator[tuple[str, ListedFunction]]:
    """Yield each handwritten module's name with every function that the manifest lists."""
    for name, file in runtime_files().items():
        for function in listed_functions(file):
            yield name, function


def hand_written_rows(budgets: Mapping[str, Budget]) -> tuple[list[Row], list[Row]]:
    """Return the rows listed with the printed formulas, and the rows of all other functions."""
    kernels, others = [], []
    for module, function in listed():
        row = _row(module, function, budgets)
        if function.kernel:
            units = [x.unit for x in function.arguments]
            kernels.append(
                row | {"argument_units": units, "latex": function.symbol, "modes": False}
            )
        else:
            others.append(row)
    return kernels, others


def _row(module: str, function: ListedFunction, budgets: Mapping[str, Budget]) -> Row:
    return {
        "name": function.name,
        "module": module,
        "arguments": tuple(x.name for x in function.arguments),
        "unit": function.unit,
        "symbol": function.symbol,
        "equation": function.equation,
        "meaning": function.meaning,
        "domain": function.domain,
    } | budgets[function.name].row()
