"""Arguments in, result out: what every function of this package does with its arrays.

Arithmetic: the types of results, and whether a number is whole.
"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Double = NDArray[np.float64]
Function = TypeVar("Function", bound=Callable[..., object])

quiet = np.errstate(over="ignore", under="ignore", divide="ignore")
"""Decorator of every public function, whatever its caller's settings are.

A value beyond the doubles is rounded to an infinity or to zero, which is no error, and
so are shares of a value that are too small to count. An invalid operation is one.
"""


def in_manifest(
    symbol: str, equation: str = "", domain: str = "", kernel: bool = False
) -> Callable[[Function], Function]:
    """What the manifest says of a function besides its docstring; it changes nothing.

    Parameters
    ----------
    symbol
        How its result is written, in LaTeX.
    equation
        Number of its equation in the paper, if it has one.
    domain
        Conditions on its arguments, separated by commas; outside it gives NaN.
    kernel
        Whether it is listed with the printed formulas.
    """
    del symbol, equation, domain, kernel
    return lambda function: function


def as_doubles(*arguments: ArrayLike) -> tuple[np.dtype, list[Double]]:
    """Arguments as double arrays, and the type the result is to have.

    Float32 in gives float32 out, computed in double; everything else gives
    double. What is not finite becomes NaN, which every function passes on.

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
    """Refuse masked arrays: the mask would be lost, and numbers come back in its place.

    Raises
    ------
    TypeError
        If an argument is a masked array.
    """
    if any(isinstance(x, np.ma.MaskedArray) for x in arguments):
        raise TypeError(
            "expected arrays without a mask, got a masked array; pass array.filled(numpy.nan)"
        )


def whole(count: int, what: str) -> int:
    """A number of some things as a plain integer.

    Raises
    ------
    ValueError
        If it is negative or not an integer.
    """
    if not count >= 0 or count != np.floor(count) or count == np.inf:
        raise ValueError(f"expected a number of {what}, an integer >= 0, got {count!r}")
    return int(count)


def inside(arguments: list[Double], *conditions: NDArray[np.bool_]) -> list[Double]:
    """The arguments where all conditions hold, NaN elsewhere."""
    holds: NDArray[np.bool_] = np.asarray(True)
    for condition in conditions:
        holds = np.logical_and(holds, condition)
    return arguments if holds.all() else [np.where(holds, x, np.nan) for x in arguments]


def as_result(value: Double, kind: np.dtype) -> np.ndarray:
    """The value in the type asked for, a scalar for scalar arguments."""
    return np.asarray(value, dtype=kind)[()]


def patched(
    value: Double,
    below: NDArray[np.bool_],
    function: Callable[..., np.ndarray],
    arguments: list[Double],
) -> Double:
    """The value, where a seam's variable lies below it replaced by the function's own there.

    Called by the function itself, which computes arguments below the seam alone otherwise.
    """
    if not below.any():
        return value
    shape = np.broadcast_shapes(value.shape, below.shape)
    result, places = np.array(np.broadcast_to(value, shape)), np.broadcast_to(below, shape)
    result[places] = function(
        *(x.reshape(()) if x.size == 1 else np.broadcast_to(x, shape)[places] for x in arguments)
    )
    return result
