"""How many digits a method gets right, and whether truncation or rounding takes the rest.

Rounding is what a method differs by from itself in 60 digits or more, or in long doubles where
that would take minutes. What integrates in time, in doubles alone, is run again in other units of
length and of time, which change nothing but rounding (stochastic arithmetic after Vignes, 1993).
Rounding in ratios of lengths alone stays the same there: sums and polynomials are not judged so.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import flint
import numpy as np
from flint import arb

from derivation.engine.formula.ball import LOG2_10, PrecisionError
from derivation.plate.benchmark.arithmetic import HAS_LONG, LONG, as_ball, exact_for
from derivation.plate.benchmark.interface import Call, Method
from derivation.plate.benchmark.problems import Problem

RUNS, SEED = 5, 5
"""Runs in other units, and the seed of these."""

ESTIMATE = (
    "an estimate: rounding is the spread of runs in other units of length and of time, which "
    "change nothing but rounding, and by it the choice of steps; truncation below it is not seen"
)


@dataclass(frozen=True)
class BenchmarkErrors:
    """Digits of the worst point: -log10 of the relative error; None where it was not measured.

    Attributes
    ----------
    total
        The method against the truth; minus infinity where it gives no number.
    truncation
        The same truncated method without rounding against the truth.
    rounding
        The method against the same without rounding; the total where nothing is truncated.
    worst
        Argument of the worst point, in hexadecimal.
    unsplit
        Why truncation and rounding are not told apart, or None.
    remark
        What is to be said of how they are, or None.
    """

    total: float
    truncation: float | None
    rounding: float | None
    worst: str
    unsplit: str | None = None
    remark: str | None = None


@dataclass(frozen=True)
class Judged:
    """A prepared method with its errors; time of the set-up, and of the first call a point [s]."""

    call: Call
    errors: BenchmarkErrors
    setup: float
    first: float


def judge(method: Method, problem: Problem, clock: Callable[[], float]) -> Judged:
    """Prepare a method and compare its results with the truth."""
    begin = clock()
    call = method.ready(problem.regime)
    middle = clock()
    points = problem.points[-1:] if method.split == "ball" else problem.points
    values = list(np.atleast_1d(np.asarray(call(points), dtype=object)))
    end = clock()
    errors = certified if method.split == "ball" else split
    return Judged(
        call, errors(method, problem, values), middle - begin, (end - middle) / points.size
    )


def certified(method: Method, problem: Problem, values: Sequence[arb]) -> BenchmarkErrors:  # noqa: ARG001
    """Of balls that enclose the truth: their radii, which are rounding.

    A radius holds a bound of what the method leaves out as well. But at each precision the
    oracles leave out less than its last bit.
    """
    with flint.ctx.workprec(64):
        worst = max(float((x.rad() / abs(x).abs_lower()).log()) for x in values)
    found = -worst / math.log(10)
    return BenchmarkErrors(found, None, found, float(problem.points[-1]).hex())


def split(method: Method, problem: Problem, values: Sequence[Any]) -> BenchmarkErrors:
    """Total, truncation and rounding; total <= truncation + rounding as errors at each point."""
    most, truncation, unsplit, same = problem.digits, None, None, None
    with flint.ctx.workprec(math.ceil(most * LOG2_10) + 128):
        total = [digits(v, t, most) for v, t in zip(values, problem.truths, strict=True)]
        rounding = min(total) if method.split == "all" else None
        if method.split != "all" and min(total) > -math.inf:
            try:
                same = without_rounding(method, problem)
            except (NotImplementedError, PrecisionError) as reason:
                unsplit = str(reason)
        if same is not None:
            truncation = min(map(digits, same, problem.truths, [most] * len(same)))
            rounding = min(map(digits, values, same, [most] * len(same)))
    place = int(np.argmin(total))
    remark = ESTIMATE if method.split == "units" and same is not None else None
    worst = float(problem.points[place]).hex()
    return BenchmarkErrors(total[place], truncation, rounding, worst, unsplit, remark)


def without_rounding(method: Method, problem: Problem) -> list[arb]:
    """Results next to without rounding, or what runs in random units have in common.

    Those are means, with the deviation of a single run as their radii. In exact arithmetic all
    runs would be the same; what is rounded where differs in each.
    """
    if method.split == "long" and not HAS_LONG:
        raise NotImplementedError("the platform's long double is no longer than double")
    if method.split != "units":
        other = LONG if method.split == "long" else exact_for(method.ar)
        return [as_ball(value) for value in method.ready(problem.regime, other)(problem.points)]
    runs = []
    for length, time in np.random.default_rng(SEED).uniform(1, 2, (RUNS, 2)).tolist():
        given = time / length if method.task == "impact" else 1 / length
        call = method.ready(problem.regime.in_units(length, time))
        factor = {"law": arb(length), "inversion": arb(length) / arb(time) ** 2,
                  "impact": arb(time)}[method.task]  # fmt: skip
        # The points are scaled in doubles: that too is rounding.
        runs.append([factor * as_ball(value) for value in call(problem.points * given)])
    found = [spread(list(values)) for values in zip(*runs, strict=True)]
    if not all(ball.is_finite() for ball in found):
        raise NotImplementedError("in other units it gives no number")
    return found


def spread(values: list[arb]) -> arb:
    """Mean of some values, and the standard deviation of one of them as its radius."""
    mean = sum(values, arb(0)) / len(values)
    square = sum(((x - mean) ** 2 for x in values), arb(0)) / (len(values) - 1)
    return mean + arb(0, square.sqrt().abs_upper())


def digits(value: Any, true: arb, most: float) -> float:
    """-log10 of a relative error, at most as many as the truth has."""
    ball = as_ball(value)
    if not ball.is_finite():
        return -math.inf
    error = (abs(ball - true) / abs(true)).abs_upper()
    return min(float(most), -float(error.log()) / math.log(10)) if error > 0 else float(most)
