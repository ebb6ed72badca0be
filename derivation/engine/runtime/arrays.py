"""Conversion of arguments and results, common to all functions of this package.

Arithmetic: the types of results, and the test for integers.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Double = NDArray[np.float64]
Function = TypeVar("Function", bound=Callable[..., object])

quiet = np.errstate(over="ignore", under="ignore", divide="ignore")
"""Decorator of public functions: no warnings of overflow, underflow and division by zero.

Contributions to a result may be negligibly small or infinite. For invalid operations, the settings
of the caller apply.
"""


def in_manifest(
    symbol: str, equation: str = "", domain: str = "", kernel: bool = False
) -> Callable[[Function], Function]:
    """Describe a function for the manifest, in addition to its docstring; it is not changed.

    Parameters
    ----------
    symbol
        LaTeX symbol of its result.
    equation
        Number of its equation in the paper, if it has one.
    domain
        Conditions on its arguments, separated by commas; outside the domain the result is NaN.
    kernel
        Whether it is listed with the printed formulas.
    """
    del symbol, equation, domain, kernel
    return lambda function: function


def as_doubles(*arguments: ArrayLike) -> tuple[np.dtype, list[Double]]:
    """Return the arguments as arrays of doubles, and the type of the result.

    If NumPy's common type of the arguments is float32 or float16, the result is float32, computed
    in double precision; otherwise it is float64. Infinite arguments become NaN, which every
    function propagates.

    Raises
    ------
    TypeError
        If an argument is not real, or a masked array, whose mask would be lost.
    """
    refuse_masked(*arguments)
    given = [x if isinstance(x, (int, float)) else np.asarray(x) for x in arguments]
    kind = np.result_type(*given)
    if kind.kind not in "biuf":
        raise TypeError(f"expected real numbers or arrays of them, got {kind}")
    single = kind.kind == "f" and kind.itemsize <= 4
    doubles = [np.asarray(x, dtype=np.float64) for x in given]
    finite = [x if np.isfinite(x).all() else np.where(np.isfinite(x), x, np.nan) for x in doubles]
    return np.dtype(np.float32 if single else np.float64), finite


def refuse_masked(*arguments: ArrayLike) -> None:
    """Reject masked arrays, because the mask would be lost and masked numbers would be used.

    Raises
    ------
    TypeError
        If an argument is a masked array.
    """
    # There are no masked arrays before numpy.ma is loaded, which takes time.
    if "numpy.ma" in sys.modules and any(isinstance(x, np.ma.MaskedArray) for x in arguments):
        raise TypeError(
            "expected arrays without a mask, got a masked array; pass array.filled(numpy.nan)"
        )


def whole(count: int, what: str) -> int:
    """Return a number of items as a plain integer.

    Raises
    ------
    ValueError
        If it is negative or not an integer.
    """
    if not count >= 0 or count != np.floor(count) or count == np.inf:
        raise ValueError(f"expected a number of {what}, an integer >= 0, got {count!r}")
    return int(count)


def inside(arguments: list[Double], *conditions: NDArray[np.bool_]) -> list[Double]:
    """Return the arguments where all conditions are met, and NaN elsewhere."""
    holds: NDArray[np.bool_] = np.asarray(True)
    for condition in conditions:
        holds = np.logical_and(holds, condition)
    return arguments if holds.all() else [np.where(holds, x, np.nan) for x in arguments]


def as_result(value: Double, kind: np.dtype) -> np.ndarray:
    """Return the value in the given type, as a NumPy scalar if it has no dimensions."""
    return np.asarray(value, dtype=kind)[()]


def patched(
    value: Double,
    below: NDArray[np.bool_],
    function: Callable[..., np.ndarray],
    arguments: list[Double],
) -> Double:
    """Return the value, replaced by the function's result where a mask is true.

    A function passes itself as `function`. It is called again for the points below its switch point
    alone, and evaluates the branch below directly, so that the recursion ends.
    """
    if not below.any():
        return value
    shape = np.broadcast_shapes(value.shape, below.shape)
    result, places = np.array(np.broadcast_to(value, shape)), np.broadcast_to(below, shape)
    result[places] = function(
        *(x.reshape(()) if x.size == 1 else np.broadcast_to(x, shape)[places] for x in arguments)
    )
    return result
