"""What is measured: a function together with the row that says what it promises."""

import importlib
import importlib.util
import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

AS_PRINTED = "as_printed"
"""Module of the formulas as printed: measured for contrast, without a promise."""


@dataclass(frozen=True)
class Kernel:
    """A function to be measured.

    Parameters
    ----------
    name
        Name of the formula it computes, whose truth it is held to.
    module
        The generated module it stands in.
    arguments
        Names of its arguments, in order.
    call
        The function itself: arrays in, array out; modal sums take ``modes=``.
    budget
        Allowed error in ULP before conditioning; None if nothing is promised.
    modes
        Whether it is a modal sum.
    """

    name: str
    module: str
    arguments: tuple[str, ...]
    call: Callable[..., Any]
    budget: float | None
    modes: bool = False

    @property
    def by_count(self) -> bool:
        """Whether it returns a table whose length is its only argument."""
        return self.arguments == ("count",)


def kernel_of_row(package: str, row: Mapping[str, Any]) -> Kernel:
    """The kernel that a row of a package's manifest describes."""
    module = importlib.import_module(f"{package}.{row['module']}")
    return Kernel(
        row["name"],
        row["module"],
        tuple(row["arguments"]),
        getattr(module, row["name"]),
        float(row["budget"]),
        bool(row["modes"]),
    )


def generated_kernels(package: str) -> tuple[Kernel, ...]:
    """Every kernel of a package's manifest, in its order."""
    manifest = importlib.import_module(f"{package}.manifest")
    return tuple(kernel_of_row(package, row) for row in manifest.KERNELS)


def printed_kernels(package: str) -> tuple[Kernel, ...]:
    """Every formula as printed; its name is that of the derived one it is held against."""
    if importlib.util.find_spec(f"{package}.{AS_PRINTED}") is None:
        return ()
    module = importlib.import_module(f"{package}.{AS_PRINTED}")
    own = (
        (name, call)
        for name, call in inspect.getmembers(module, inspect.isfunction)
        if call.__module__ == module.__name__ and not name.startswith("_")
    )
    return tuple(
        Kernel(name, AS_PRINTED, tuple(inspect.signature(call).parameters), call, None)
        for name, call in own
    )
