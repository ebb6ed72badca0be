"""Correct digits of a method, separated into truncation and rounding errors.

The rounding error is the difference between the results of a method in its own arithmetic and in at
least 60 digits; long doubles are used instead if 60 digits would take minutes. Methods that
integrate in time exist in double precision only. They are repeated in other units of length and
time, which change only the rounding errors (stochastic arithmetic, Vignes 1993). This is not
applied to sums and polynomials: they depend on ratios of lengths, which units do not change.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import flint
import numpy as np
from flint import arb

from derivation.engine.formula.ball import LOG2_10, PrecisionError
from derivation.plate.benchmark.arithmetic import HAS_LONG_DOUBLE, LONG_DOUBLE, as_ball, exact_for
from derivation.plate.benchmark.interface import Call, Method
from derivation.plate.benchmark.problems import Problem

RUNS, SEED = 5, 5
"""Number of runs in other units, and the seed for these units."""

ESTIMATE = (
    "an estimate: rounding is the spread of runs in other units of length and time, which change "
    "only rounding and, through it, the step sizes; a smaller truncation error is not detected"
)


@dataclass(frozen=True)
class BenchmarkErrors:
    """Correct digits at the worst point, -log10 of the relative error.

    Attributes
    ----------
    total
        From the difference between method and reference value; minus infinity for NaN.
    truncation
        From the difference between the method without rounding and the reference value, or None.
    rounding
        From the difference between the method with and without rounding, or None. Equal to the
        total if the method truncates nothing.
    worst
        Argument of the worst point, in hexadecimal.
    unsplit
        Reason why truncation and rounding are not separated, or None.
    remark
        Remark on the method of separation, or None.
    """

    total: float
    truncation: float | None
    rounding: float | None
    worst: str
    unsplit: str | None = None
    remark: str | None = None


@dataclass(frozen=True)
class MeasuredMethod:
    """A prepared method with its errors, its set-up time, and the time per point of a call [s]."""

    call: Call
    errors: BenchmarkErrors
    setup: float
    first: float


def measure_errors(method: Method, problem: Problem, clock: Callable[[], float]) -> MeasuredMethod:
    """Prepare a method and compare its results with the reference values."""
    begin = clock()
    call = method.prepared(problem.case)
    middle = clock()
    points = problem.points[-1:] if method.split == "ball" else problem.points
    values = list(np.atleast_1d(np.asarray(call(points), dtype=object)))
    end = clock()
    errors = certified_errors if method.split == "ball" else separated_errors
    return MeasuredMethod(
        call, errors(method, problem, values), middle - begin, (end - middle) / points.size
    )


def certified_errors(method: Method, problem: Problem, values: Sequence[arb]) -> BenchmarkErrors:  # noqa: ARG001
    """Return the errors of a method in interval arithmetic: the radii, which are rounding errors.

    The radii also include a bound on the truncation error. It is negligible, because at each
    precision the references are truncated below the last bit.
    """
    with flint.ctx.workprec(64):
        worst = max(float((x.rad() / abs(x).abs_lower()).log()) for x in values)
    digits = -worst / math.log(10)
    return BenchmarkErrors(digits, None, digits, float(problem.points[-1]).hex())


def separated_errors(method: Method, problem: Problem, values: Sequence[Any]) -> BenchmarkErrors:
    """Return the errors of a method, separated according to `Method.split`.

    The total error is at most the sum of truncation and rounding error.
    """
    most, truncation, unsplit, same = problem.digits, None, None, None
    with flint.ctx.workprec(math.ceil(most * LOG2_10) + 128):
        total = [digits(v, t, most) for v, t in zip(values, problem.reference_values, strict=True)]
        rounding = min(total) if method.split == "all" else None
        if method.split != "all" and min(total) > -math.inf:
            try:
                same = without_rounding(method, problem)
            except (NotImplementedError, PrecisionError) as reason:
                unsplit = str(reason)
        if same is not None:
            truncation = min(map(digits, same, problem.reference_values, [most] * len(same)))
            rounding = min(map(digits, values, same, [most] * len(same)))
    index = int(np.argmin(total))
    remark = ESTIMATE if method.split == "units" and same is not None else None
    worst = float(problem.points[index]).hex()
    return BenchmarkErrors(total[index], truncation, rounding, worst, unsplit, remark)


def without_rounding(method: Method, problem: Problem) -> list[arb]:
    """Return results with negligible rounding errors, or the mean of runs in random units.

    In exact arithmetic all runs would be equal. Because each run rounds other numbers, their
    standard deviation estimates the rounding error of a run; it is the radius of the mean.
    """
    if method.split == "long" and not HAS_LONG_DOUBLE:
        raise NotImplementedError("the platform's long double is no longer than double")
    if method.split != "units":
        other = LONG_DOUBLE if method.split == "long" else exact_for(method.ar)
        return [as_ball(value) for value in method.prepared(problem.case, other)(problem.points)]
    runs = []
    for length, time in np.random.default_rng(SEED).uniform(1, 2, (RUNS, 2)).tolist():
        given = time / length if method.task == "impact" else 1 / length
        call = method.prepared(problem.case.in_units(length, time))
        factor = {"law": arb(length), "inversion": arb(length) / arb(time) ** 2,
                  "impact": arb(time)}[method.task]  # fmt: skip
        # The scaled points are rounded to doubles, which contributes to the spread.
        runs.append([factor * as_ball(value) for value in call(problem.points * given)])
    spreads = [spread(list(values)) for values in zip(*runs, strict=True)]
    if not all(ball.is_finite() for ball in spreads):
        raise NotImplementedError("in other units it gives no number")
    return spreads


def spread(values: list[arb]) -> arb:
    """Return the mean of values as a ball; its radius is their standard deviation."""
    mean = sum(values, arb(0)) / len(values)
    square = sum(((x - mean) ** 2 for x in values), arb(0)) / (len(values) - 1)
    return mean + arb(0, square.sqrt().abs_upper())


def digits(value: Any, true: arb, most: float) -> float:
    """Return -log10 of the relative error, at most the digits `most` of the reference value."""
    ball = as_ball(value)
    if not ball.is_finite():
        return -math.inf
    error = (abs(ball - true) / abs(true)).abs_upper()
    return min(float(most), -float(error.log()) / math.log(10)) if error > 0 else float(most)
