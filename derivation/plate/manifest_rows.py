"""Rows of the manifest for handwritten functions, from their signatures and docstrings."""

from collections.abc import Iterator, Mapping
from typing import Any

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.copies import ListedFunction, listed_functions
from derivation.engine.emit.handwritten import manifest_row
from derivation.plate.modules import runtime_files

Row = dict[str, Any]


def listed() -> Iterator[tuple[str, ListedFunction]]:
    """Yield each handwritten module's name with every function that the manifest lists."""
    for name, file in runtime_files().items():
        for function in listed_functions(file):
            yield name, function


def hand_written_rows(budgets: Mapping[str, Budget]) -> tuple[list[Row], list[Row]]:
    """Return the rows listed with the printed formulas, and the rows of all other functions."""
    kernels: list[Row] = []
    others: list[Row] = []
    for module, function in listed():
        row = manifest_row(module, function, budgets)
        (kernels if function.kernel else others).append(row)
    return kernels, others
