"""How many digits a method gets right, and whether truncation or rounding takes the rest."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import flint
import numpy as np
from flint import arb

from derivation.engine.formula.ball import LOG2_10
from derivation.plate.benchmark.arithmetic import as_ball
from derivation.plate.benchmark.interface import Call, Method
from derivation.plate.benchmark.problems import Problem


@dataclass(frozen=True)
class BenchmarkErrors:
    """Digits of the worst point: -log10 of the relative error; None where it was not measured.

    Attributes
    ----------
    total
        The method against the truth; minus infinity where it gives no number.
    truncation
        The same truncated method without rounding, in balls or long numbers, against the truth.
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
    """Prepare a method and hold its results to the truth."""
    begin = clock()
    call = method.prepare(problem.regime)
    middle = clock()
    points = problem.points[-1:] if method.certified else problem.points
    values = list(np.atleast_1d(np.asarray(call(points), dtype=object)))
    end = clock()
    errors = certified(values, points) if method.certified else split(method, problem, values)
    return Judged(call, errors, middle - begin, (end - middle) / points.size)


def certified(values: Sequence[arb], points: Any) -> BenchmarkErrors:
    """Of balls that enclose the truth: their radii, which are rounding.

    A radius holds a bound of what the method leaves out as well. But at each precision the
    oracles leave out less than its last bit: without that bound the radius is the same to
    more digits than it has of its own. Hence nothing is truncated that a ball tells.
    """
    with flint.ctx.workprec(64):
        worst = max(float((x.rad() / abs(x).abs_lower()).log()) for x in values)
    found = -worst / math.log(10)
    return BenchmarkErrors(found, None, found, float(points[0]).hex())


def split(method: Method, problem: Problem, values: Sequence[Any]) -> BenchmarkErrors:
    """Total, truncation and rounding; total <= truncation + rounding as errors at each point."""
    most = problem.digits
    with flint.ctx.workprec(math.ceil(most * LOG2_10) + 128):
        total = [digits(v, t, most) for v, t in zip(values, problem.truths, strict=True)]
        same, unsplit = _same(method, problem)
        truncation, rounding = None, min(total) if method.exact else None
        if same is not None:
            balls = [as_ball(value) for value in same]
            truncation = min(digits(s, t, most) for s, t in zip(balls, problem.truths, strict=True))
            rounding = min(digits(v, s, most) for v, s in zip(values, balls, strict=True))
    place = int(np.argmin(total))
    worst = float(problem.points[place]).hex()
    remark = None if same is None else method.remark
    return BenchmarkErrors(total[place], truncation, rounding, worst, unsplit, remark)


def _same(method: Method, problem: Problem) -> tuple[Sequence[Any] | None, str | None]:
    """Results without rounding; or why there are none."""
    if method.same is None:
        return None, None if method.exact else "the method exists in this arithmetic alone"
    try:
        found: Sequence[Any] = method.same(problem.regime)(problem.points)
    except NotImplementedError as reason:
        return None, str(reason)
    return found, None


def digits(value: Any, true: arb, most: float) -> float:
    """-log10 of a relative error, at most as many as the truth has."""
    ball = as_ball(value)
    if not ball.is_finite():
        return -math.inf
    error = (abs(ball - true) / abs(true)).abs_upper()
    return min(float(most), -float(error.log()) / math.log(10)) if error > 0 else float(most)
