"""The functions to be measured, with their budgets."""

import importlib
import importlib.util
import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from derivation.engine.formula.ulp import DOUBLE, Format
from derivation.engine.measure.point import Point

Results = np.ndarray[Any, np.dtype[Any]]

AS_PRINTED = "as_printed"
"""Module of the formulas as published, which are measured for comparison, without a budget."""


@dataclass(frozen=True)
class Kernel:
    """A function to be measured.

    Parameters
    ----------
    name
        Name of the formula that it computes, with which it is compared.
    module
        The generated module that contains it.
    arguments
        Names of its arguments, in order.
    call
        The function, from arrays to an array; modal sums also take ``modes=``.
    budget
        Allowed error in ULP, without conditioning; None without a budget.
    modes
        Whether it is a modal sum.
    share
        Allowed error per sum of the condition numbers.
    """

    name: str
    module: str
    arguments: tuple[str, ...]
    call: Callable[..., Any]
    budget: float | None
    modes: bool = False
    share: float = 0.5

    @property
    def by_count(self) -> bool:
        """Whether it returns a table whose length is its only argument."""
        return self.arguments == ("count",)

    def results(self, points: Sequence[Point], fmt: Format = DOUBLE) -> Results:
        """Return the results at the points, of the type that the function returns.

        The function is called once for each number of modes.
        """
        if self.by_count:
            last = [int(point.values["count"]) for point in points]
            table: Results = np.asarray(self.call(max(last)))
            entries: Results = table[np.array(last) - 1]
            return entries
        columns = [
            np.array([point.values[key] for point in points], dtype=fmt.name)
            for key in self.arguments
        ]
        if not self.modes:
            return np.asarray(self.call(*columns))
        counts = np.array([point.modes for point in points])
        parts = {
            count: self.call(*(column[counts == count] for column in columns), modes=count)
            for count in sorted({point.modes or 0 for point in points})
        }
        values = np.empty(len(points), dtype=np.result_type(*parts.values()))
        for count, part in parts.items():
            values[counts == count] = part
        return values


@dataclass(frozen=True)
class Stating(Kernel):
    """A function that states its error, because its budget depends on the arguments.

    Parameters
    ----------
    stated
        Function of the arguments that returns the largest error of every result, in the result's
        unit and shape.
    """

    stated: Callable[..., Any] = field(kw_only=True)


def kernel_of_row(package: str, row: Mapping[str, Any]) -> Kernel:
    """Return the function that a row of a package's manifest describes."""
    module = importlib.import_module(f"{package}.{row['module']}")
    return Kernel(
        row["name"],
        row["module"],
        tuple(row["arguments"]),
        getattr(module, row["name"]),
        float(row["budget"]),
        bool(row["modes"]),
        float(row.get("share", 0.5)),
    )


def generated_kernels(package: str) -> tuple[Kernel, ...]:
    """Return every function of a package's manifest, in its order."""
    manifest = importlib.import_module(f"{package}.manifest")
    return tuple(kernel_of_row(package, row) for row in manifest.KERNELS)


def printed_kernels(package: str) -> tuple[Kernel, ...]:
    """Return the formulas as published, each with the name of the derived formula."""
    if importlib.util.find_spec(f"{package}.{AS_PRINTED}") is None:
        return ()
    module = importlib.import_module(f"{package}.{AS_PRINTED}")
    kernels = (
        (name, call)
        for name, call in inspect.getmembers(module, inspect.isfunction)
        if call.__module__ == module.__name__ and not name.startswith("_")
    )
    return tuple(
        Kernel(name, AS_PRINTED, tuple(inspect.signature(call).parameters), call, None)
        for name, call in kernels
    )
