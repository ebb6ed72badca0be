"""Errors of a contact function, relative to its conditioning, which is found by differences."""

from collections.abc import Callable, Sequence
from typing import Any

import flint
import numpy as np

from derivation.engine.formula.ulp import DOUBLE, Format
from derivation.engine.measure.judge import Errors, PointReference, measured_errors
from derivation.engine.measure.kernels import Kernel, Results
from derivation.engine.measure.point import Point
from derivation.engine.oracle.reference import Reference
from derivation.plate.contact.cases.reference_values import ContactReference

STEP = 1e-5
"""Relative change of an argument for a condition number.

The derivative is then accurate to ten digits. An error of N ULP in the function changes the
condition number by about N 1e-11 only, so that errors do not enlarge their own tolerance.
"""


def results(call: Callable[..., Any], point: Sequence[Any]) -> np.ndarray:
    """Return a function's results at a point, one or several, as a one-dimensional array."""
    return np.atleast_1d(np.asarray(call(*point)))


def conditioning(call: Callable[..., Any], point: Sequence[float]) -> np.ndarray:
    """Return the sum of |condition numbers| over the arguments, for each result.

    Central differences are used, or one-sided ones at the boundary of the domain.
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


class OneByOne(Kernel):
    """A function called with plain numbers; many functions use another method for these."""

    def results(self, points: Sequence[Point], fmt: Format = DOUBLE) -> Results:
        """Return every result for every point."""
        kind = np.dtype(fmt.name).type
        rows = [results(self.call, [kind(x) for x in p.values.values()]) for p in points]
        return np.stack(rows, -1)


def judge(
    call: Callable[..., Any],
    references: Sequence[ContactReference],
    budget: float,
    fmt: Format = DOUBLE,
) -> Errors:
    """Return the errors of a function against the reference values.

    Raises
    ------
    ValueError
        If the number of results differs from that of the reference.
    """
    names = tuple(str(index) for index in range(len(references[0].point)))
    kernel = OneByOne("the kernel", "", names, call, budget)
    with flint.ctx.workprec(256):  # to read the balls from text and to round the errors
        reference_values = [
            PointReference(
                Point(dict(zip(names, true.point, strict=True))), _references(call, true)
            )
            for true in references
        ]
        return measured_errors(kernel, reference_values, fmt=fmt)


def _references(call: Callable[..., Any], true: ContactReference) -> tuple[Reference, ...]:
    totals = conditioning(call, true.point)
    if totals.size != len(true.values):
        raise ValueError(f"{totals.size} results at {true.point}, {len(true.values)} are expected")
    # Without a value of the function there is no conditioning, and no error is allowed.
    conditions = np.where(np.isfinite(totals), totals, 0.0).tolist()
    balls = [flint.arb(value) for value in true.values]
    return tuple(
        Reference(ball, {"all": flint.arb(abs(float(ball)) * condition)}, abs(ball))
        for ball, condition in zip(balls, conditions, strict=True)
    )
