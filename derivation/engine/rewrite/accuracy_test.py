"""Accuracy test of forms in double precision, against exact values of the original expression."""

import math
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import flint
import sympy as sp

from derivation.engine.formula.ball import Exact, LastPrecision, PrecisionError, evaluate, to_ball
from derivation.engine.formula.operations import FUNCTIONS
from derivation.engine.formula.ulp import neighbours, overflows, ulp_error
from derivation.engine.rewrite.doubles import run
from derivation.engine.rewrite.form import Step, Switch
from derivation.engine.rewrite.shape import Shape, assembled_form
from derivation.engine.rewrite.terms import UnreachableError

DIGITS = 25
LARGE = (36.5, 88.9, 95.0, 177.7, 190.0, 300.0, 355.2, 372.0, 500.0, 690.0, 709.5, 744.0, 800.0)
"""Arguments at which e^x, e^(2x), e^(4x) or their inverses leave the range of a format."""

ANGLES = tuple(
    k * math.pi / 4 * (1 + change) for k in range(1, 9) for change in (-1e-3, -1e-6, 1e-6, 1e-3)
)
"""Arguments next to zeros of trigonometric functions and of their sums."""

LEAST = 40
"""Smallest number of points for a decision."""

SAMPLES = (1.3, 0.7, 2.1, 0.45, 1.7, 0.9)
"""Values of further variables, which are positive."""


KNOWN = {function.__name__ for function in FUNCTIONS} - {"erf", "erfc", "gamma"}
"""Names of the functions that can be evaluated in NumPy, in doubles and in balls."""


def assembled(form: sp.Expr | Shape) -> tuple[tuple[Step, ...], sp.Expr | Switch]:
    """Return steps and value of a form."""
    return assembled_form(form) if isinstance(form, Shape) else ((), form)


@dataclass(frozen=True)
class ExactPoint:
    """A point, the exact value, and half the condition number there.

    Parameters
    ----------
    x
        The point, an exact double.
    value
        Ball around the value.
    slack
        Error in ULP of the value if x is rounded by half a unit in the last place: |x f'/(2 f)|.
    """

    x: float
    value: flint.arb
    slack: float


@dataclass(frozen=True)
class AccuracyTest:
    """Points of an expression at which its forms are compared with exact values.

    Parameters
    ----------
    x, others
        The variable, and values of all others.
    exact
        The points with the exact values.
    lead, beyond
        A power of x, and the points with the exact values of the expression times that power, which
        is tested above a switch point.
    """

    x: sp.Symbol
    others: tuple[tuple[sp.Symbol, float], ...]
    exact: tuple[ExactPoint, ...]
    lead: int = 0
    beyond: tuple[ExactPoint, ...] = ()

    def worst(self, form: sp.Expr | Shape) -> float:
        """Return the largest error in ULP, in addition to conditioning; infinite if none."""
        steps, value = assembled(form)
        if not (isinstance(value, Switch) and self.lead):
            return max(self._error(point, steps, value) for point in self.exact)
        at, kept = float(value.at), float(value.at**self.lead)
        below = (self._error(t, steps, value) for t in self.exact if t.x < at)
        above = (self._error(t, steps, value, kept) for t in self.beyond if t.x >= at)
        return max(*below, *above)

    def errors(
        self, steps: tuple[Step, ...], value: sp.Expr | Switch
    ) -> list[tuple[ExactPoint, float]]:
        """Return the points in ascending order, with the error of a form at each [ULP]."""
        return [(point, self._error(point, steps, value)) for point in self.exact]

    def _error(
        self,
        point: ExactPoint,
        steps: tuple[Step, ...],
        value: sp.Expr | Switch,
        scale: float = 1.0,
    ) -> float:
        try:
            got = run(steps, value, {self.x: point.x, **dict(self.others)}) * scale
        except OverflowError:
            return math.inf
        return max(ulp_error(got, point.value) - point.slack, 0.0)


def with_whole(inner: AccuracyTest, whole: AccuracyTest, lead: int) -> AccuracyTest:
    """Return a test that compares, above a switch point, the expression times x^lead.

    At each point the smaller of the two allowances for conditioning is used.
    """
    excused = {point.x: point.slack for point in inner.exact}
    beyond = (
        replace(point, slack=min(point.slack, excused.get(point.x, math.inf)))
        for point in whole.exact
    )
    return replace(inner, lead=lead, beyond=tuple(beyond))


def points(low: float, high: float, seed: str) -> tuple[float, ...]:
    """Return random points in each decade between the ends, and more from 1e-4 to 50."""
    generator = random.Random(seed)
    first, last = math.log10(low), math.log10(high)
    positions = {low, high}
    exponent = first
    while exponent < last:
        positions.add(10.0 ** min(exponent + generator.random(), last))
        exponent += max(1.0, (last - first) / 60)
    near, far = max(first, -4.0), min(last, 1.7)
    positions |= {10 ** generator.uniform(near, far) for _ in range(90)}
    positions |= {x for x in LARGE if low <= x <= high}
    for switch in (0.25, 0.5, 1.0, 2.0, 4.0):
        positions |= {
            *neighbours(switch, 1),
            *(switch * generator.uniform(1.0, 1.25) for _ in range(12)),
        }
    return tuple(sorted(x for x in positions if low <= x <= high))


def accuracy_test(
    expression: sp.Expr,
    x: sp.Symbol,
    ends: tuple[float, float],
    equal: sp.Expr,
    seed: str = "",
) -> AccuracyTest:
    """Select the points at which forms of an expression are tested.

    Parameters
    ----------
    expression
        The original expression, from which the reference values are computed.
    x
        Its variable; all others have fixed positive values.
    ends
        The interval in which its forms are to be accurate.
    equal
        An expression proved equal, for points at which the original has no ball.
    seed
        Seed of the points; by default the expression itself.

    Raises
    ------
    UnreachableError
        If it contains unknown functions or too many variables, or has a value at too few points.
    """
    unknown = {f.func.__name__ for f in expression.atoms(sp.Function)} - KNOWN
    if unknown:
        raise UnreachableError(
            f"no rule applies to the function {', '.join(sorted(unknown))}, expected functions of "
            "NumPy; rewrite the other parts of the formula by themselves"
        )
    others = sorted(expression.free_symbols - {x}, key=str)
    fixed = tuple(zip(others, SAMPLES, strict=False))
    if len(fixed) < len(others):
        raise UnreachableError(f"expected at most {len(SAMPLES)} further variables, got {others}")
    exact = _exact_points(expression, x, ends, equal, fixed, seed or str(expression))
    if len(exact) < LEAST:
        raise UnreachableError(
            f"{expression!s:.80} has values other than 0, within the range of doubles, at "
            f"{len(exact)} of the tested points {x} > 0, expected {LEAST}; change the formula or "
            "its variable"
        )
    return AccuracyTest(x, fixed, exact)


@lru_cache(maxsize=64)
def _exact_points(
    expression: sp.Expr,
    x: sp.Symbol,
    ends: tuple[float, float],
    equal: sp.Expr,
    fixed: tuple[tuple[sp.Symbol, float], ...],
    seed: str,
) -> tuple[ExactPoint, ...]:
    """Return the points with an exact value; several searches for a form test the same ones."""
    slopes = tuple((given, given.diff(x)) for given in dict.fromkeys((expression, equal)))
    tested = points(*ends, seed)
    if expression.has(sp.sin, sp.cos, sp.tan):
        tested = tuple(sorted({*tested, *(at for at in ANGLES if ends[0] <= at <= ends[1])}))
    exact = []
    last = {each: LastPrecision() for pair in slopes for each in pair}
    for point in tested:
        value, slack = _exact_value(slopes, x, point, fixed, last)
        if value is not None and value != 0 and not overflows(value) and abs(value) > 1e-300:
            exact.append(ExactPoint(point, value, slack))
    return tuple(exact)


def _exact_value(
    slopes: Sequence[tuple[sp.Expr, sp.Expr]],
    x: sp.Symbol,
    point: float,
    fixed: Sequence[tuple[sp.Symbol, float]],
    last: Mapping[sp.Expr, LastPrecision],
) -> tuple[flint.arb | None, float]:
    """Return the value and its slack, by equal expressions with slopes; None without a ball."""
    at: dict[sp.Symbol, Exact] = {x: point, **dict(fixed)}
    for candidate, derivative in slopes:
        try:
            value = evaluate(candidate, at, DIGITS, last[candidate])
        except (PrecisionError, NotImplementedError):
            continue
        try:
            slope = evaluate(derivative, at, 3, last[derivative])
        except (PrecisionError, NotImplementedError):
            return value, 0.0  # without conditioning
        with flint.ctx.workprec(64):
            return value, float(abs(slope * to_ball(point) / value).abs_upper()) / 2
    return None, 0.0
