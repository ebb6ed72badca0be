"""A contact kernel against its truths: errors in ULP, and what conditioning allows."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import flint
import numpy as np

from derivation.engine.formula.ulp import DOUBLE, Format, spacing_exponent, ulp_error
from derivation.plate.contact.cases.grid import Point
from derivation.plate.contact.cases.truth import ContactTruth

STEP = 1e-5
"""By how much of itself an argument is moved to find a condition number.

The derivative is then right to ten digits, and errors of a kernel of N ULP change the
number by some N 1e-11 only: what a kernel gets wrong does not excuse itself.
"""


@dataclass(frozen=True)
class Ulps:
    """What one kernel did on its points, in one format.

    Parameters
    ----------
    points
        How many were judged.
    max_ulp
        Largest error.
    needed
        Budget that would just do: the largest error beyond what conditioning allows.
    ratio
        Largest error over what is allowed; infinite if a result is not finite.
    worst
        Arguments of that, in hexadecimal.
    dtype
        NumPy name of the results' type.
    """

    points: int
    max_ulp: float
    needed: float
    ratio: float
    worst: tuple[str, ...]
    dtype: str

    @property
    def kept(self) -> bool:
        """Whether the promise is kept."""
        return self.ratio <= 1.0


def results(call: Callable[..., Any], point: Sequence[Any]) -> np.ndarray:
    """A kernel's results at a point, one or several, as an array of one dimension."""
    return np.atleast_1d(np.asarray(call(*point)))


def conditioning(call: Callable[..., Any], point: Point) -> np.ndarray:
    """Sum of |condition numbers| over the arguments, of each result.

    By central differences, or by one side where the other is outside the domain.
    """
    here = results(call, point)
    total = np.zeros(here.shape)
    for index, argument in enumerate(point):
        ahead, behind = (
            results(call, (*point[:index], argument * factor, *point[index + 1 :]))
            for factor in (1.0 + STEP, 1.0 - STEP)
        )
        steps = STEP * (np.isfinite(ahead) * 1.0 + np.isfinite(behind))
        ahead, behind = (np.where(np.isfinite(x), x, here) for x in (ahead, behind))
        total += np.abs((ahead - behind) / np.where(steps > 0, steps * here, np.inf))
    return total


def judge(
    call: Callable[..., Any], found: Sequence[ContactTruth], budget: float, fmt: Format = DOUBLE
) -> Ulps:
    """Hold a kernel to the truth.

    Raises
    ------
    ValueError
        If the kernel gives another number of results than are true.
    """
    errors = [_error(call, true, fmt) for true in found]
    ratios = [ulp / (budget + rounding) for _, ulp, rounding in errors]
    where = max(range(len(found)), key=lambda i: ratios[i])
    wrong_type = {dtype for dtype, _, _ in errors} - {fmt.name}
    return Ulps(
        len(found),
        max(ulp for _, ulp, _ in errors),
        max(0.0, *(ulp - rounding for _, ulp, rounding in errors)),
        math.inf if wrong_type else ratios[where],
        tuple(argument.hex() for argument in found[where].point),
        wrong_type.pop() if wrong_type else fmt.name,
    )


def _error(call: Callable[..., Any], true: ContactTruth, fmt: Format) -> tuple[str, float, float]:
    """Type, ULP of error and ULP that conditioning allows, of the result worst off."""
    got = results(call, [np.dtype(fmt.name).type(x) for x in true.point])
    if got.size != len(true.values):
        raise ValueError(f"{got.size} results at {true.point}, {len(true.values)} are expected")
    pairs = []
    with flint.ctx.workprec(256):
        balls = [flint.arb(value) for value in true.values]
        for value, ball, total in zip(got, balls, conditioning(call, true.point), strict=True):
            size, unit = abs(float(ball)), spacing_exponent(ball, fmt)
            rounding = math.ldexp(size, -fmt.precision - unit) * float(total)
            if not math.isfinite(rounding):  # of a kernel without a value: nothing is allowed
                rounding = 0.0
            pairs.append((ulp_error(float(value), ball, fmt), rounding))
    ulp, rounding = max(pairs, key=lambda pair: pair[0] - pair[1])
    return str(got.dtype), ulp, rounding
