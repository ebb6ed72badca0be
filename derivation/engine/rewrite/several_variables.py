"""Test of the code of a formula in several variables: its range, and the error it states.

Each variable takes the same range of magnitudes. Points are random, next to points at which two
variables are equal, and on the sides of the range; with conditions on the variables, also next to
the ends of their domains.
"""

import math
import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import flint
import numpy as np
import sympy as sp

from derivation.engine.formula.ball import PrecisionError, refine, to_ball
from derivation.engine.formula.grid import domain_grid, inside, joint_points, towards_zeros
from derivation.engine.formula.tape import Tape, recorded
from derivation.engine.formula.ulp import ulp_error
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.rewrite.code_check import stated_error
from derivation.engine.rewrite.terms import UnreachableError
from derivation.engine.rewrite.useful_range import ENOUGH

DECADES = (100, 50, 30, 20, 12, 9, 6, 4, 3)
"""Exponents of ten of the ranges that are tried, the largest first."""
RANDOM, NEAR, SIDES = 400, 40, 20
"""Numbers of random points, of points next to equality for each pair of variables, and of points
on each side of the range."""
USUAL = 3.0, 1.0, 0.3
"""Exponents of ten of the smaller ranges from which as many random points are taken."""
FEW = 150
"""Number of points between which zeros of the formula are sought in each round."""
JOINT = 1500
"""Number of points inside the domains of the variables that are drawn in each round."""
ROUNDS = 3
"""Number of times that a range must pass with new points."""
ENOUGH_POINTS = 100
"""Smallest number of points with a value for a statement."""
LEAST_VALUE, LARGEST_VALUE = 1e-200, 1e200
"""Smallest and largest magnitude that is tested, because parts of other values may overflow."""
MOST_CONDITIONING = 1e8
"""Largest sum of condition numbers that is tested. With a much larger one, such as that of the sine
of a huge product, an error of the product changes the value by more than the sum shows."""
STATED = 0.8, 1.5
"""Errors per sum of the condition numbers that are stated: the first if a form allows it. A product
of variables that is rounded once has an error of up to 0.5, and a function of it near a singular
point one of up to 0.25. A difference of products that are rounded has one of up to 1."""
TESTED = {0.8: 0.5, 1.5: 1.0}
"""Errors per sum of the condition numbers that are allowed in the test, by those stated."""
MARGIN = 0.5
"""Error [ULP] that is added before the limit is stated, because there are more points in several
variables. Among 1,500 other points of 46 formulas, one had 1.04 times the limit without it."""
_DIGITS, MOST_BITS = 25, 4096
Function: TypeAlias = Callable[..., np.ndarray]
Point = tuple[float, ...]


@dataclass(frozen=True)
class SeveralCheck:
    """Result of the test of code in several variables.

    Attributes
    ----------
    low, high
        Range of the magnitude of each variable, both included.
    limit
        The stated error [ULP in addition to `share` times the sum of the condition numbers]: the
        largest one found, with a margin.
    worst, at
        The largest error found [ULP in addition to `TESTED` times that sum], and its point.
    points
        Number of points that were compared.
    share
        One of `STATED`.
    """

    low: float
    high: float
    limit: float
    worst: float
    at: dict[str, float]
    points: int
    share: float


def check_several(
    expression: sp.Expr,
    variables: Sequence[sp.Symbol],
    function: Function,
    share: float = STATED[0],
    words: Vocabulary | None = None,
    within: Callable[..., bool] = lambda *_: True,
) -> SeveralCheck:
    """Return the largest range in which code passes, and the error that it may state.

    Only real values with a magnitude between `LEAST_VALUE` and `LARGEST_VALUE` are compared. The
    share is one of `STATED`. The words state the domains of the variables if these are not all
    positive numbers, and `within` compares them as the code does, rounding included.

    Raises
    ------
    UnreachableError
        If its error stays within `ENOUGH` in no range.
    """
    draw, exact = random.Random(str(expression)), _exact(expression, tuple(variables))
    worst: tuple[float, Point] = math.inf, ()
    for decade, rounds in ((DECADES[-1], 1), *((decade, ROUNDS) for decade in DECADES)):
        errors: dict[Point, float] = {}
        for number in range(rounds):
            if words is None:
                points = list(_points(draw, decade, len(variables)))
            else:
                inside_all = _points_inside(exact, words, decade, number)
                points = [point for point in inside_all if within(*point)]
            errors |= _errors(exact, function, points, TESTED[share])
            worst = max(((error, point) for point, error in errors.items()), default=worst)
            if worst[0] > ENOUGH:
                break
        if rounds == 1 and worst[0] > ENOUGH:
            break  # nor is it accurate in a larger range
        if rounds > 1 and worst[0] <= ENOUGH and len(errors) >= ENOUGH_POINTS:
            at = {str(v): x for v, x in zip(variables, worst[1], strict=True)}
            low, high = float(f"1e-{decade}"), float(f"1e{decade}")
            limit = stated_error(worst[0] + MARGIN)
            return SeveralCheck(low, high, limit, worst[0], at, len(errors), share)
    if worst[0] <= ENOUGH or not worst[1]:
        raise UnreachableError(
            f"{expression} has values from {LEAST_VALUE:g} to {LARGEST_VALUE:g} at {len(errors)} "
            f"of the tested points, expected {ENOUGH_POINTS}; correct the conditions on its "
            "variables"
        )
    where = ", ".join(f"{v} = {x!r}" for v, x in zip(variables, worst[1], strict=True))
    domain = "state the domains of the variables" if words is None else "narrow the domains"
    raise UnreachableError(
        f"no form found for {expression} is accurate: the best one {_error_text(worst[0])} at "
        f"{where}, expected at most {ENOUGH:g} ULP; its terms cancel or overflow there, and no "
        f"rule prevents that: {domain} (--where) if such values do not occur, write the formula "
        "in variables that need not be subtracted, such as a difference of two, or rewrite its "
        "parts by themselves",
        worst[0],
    )


def _error_text(error: float) -> str:
    return "has no finite value" if math.isinf(error) else f"has an error of {error:.2g} ULP"


def _points(draw: random.Random, decade: int, count: int) -> Iterator[Point]:
    """Yield points of a range: random ones, near equality of two variables, and on its sides."""

    def value(most: float = decade) -> float:
        return 10 ** draw.uniform(-most, most)

    for most in (decade, *USUAL):
        for _ in range(RANDOM):
            yield tuple(value(most) for _ in range(count))
    for _ in range(RANDOM):  # products of variables are largest and smallest near the corners
        signs = (draw.choice((-1, 1)) for _ in range(count))
        yield tuple(10 ** (sign * decade * draw.uniform(0.7, 1.0)) for sign in signs)
    for one in range(count):
        for other in range(count):
            for _ in range(NEAR if one != other else 0):
                point = [value(3.0) for _ in range(count)]
                point[one] = point[other] * (1 - 10 ** draw.uniform(-15, -0.5))
                yield tuple(point)
        for side in (float(f"1e-{decade}"), float(f"1e{decade}")):
            for _ in range(SIDES):
                point = [value(draw.choice((3.0, decade))) for _ in range(count)]
                point[one] = side
                yield tuple(point)


class _Exact:
    """Exact values of a formula and its condition numbers at points, each computed once."""

    def __init__(self, expression: sp.Expr, variables: tuple[sp.Symbol, ...]) -> None:
        self.expression, self.variables = expression, variables
        self.tape = _tape(expression, variables)
        self.slopes = [_tape(expression.diff(variable), variables) for variable in variables]
        self.values: dict[Point, flint.arb | None] = {}
        self.sums: dict[Point, float] = {}

    def value(self, point: Point) -> flint.arb | None:
        """Return the value; None if there is none at the point, or none by ball arithmetic."""
        if point not in self.values:
            self.values[point] = _value(self.tape, point, _DIGITS)
        return self.values[point]

    def conditioning(self, point: Point) -> float:
        """Return the sum of the condition numbers at a point with a value."""
        if point not in self.sums:
            total = 0.0
            for slope, x in zip(self.slopes, point, strict=True):
                steep = _value(slope, point, 3)
                if steep is not None:
                    with flint.ctx.workprec(64):
                        total += float(abs(steep * to_ball(x) / self.values[point]).abs_upper())
            self.sums[point] = total
        return self.sums[point]

    def sign(self, point: Point) -> int:
        """Return the sign of the value; 0 without one."""
        value = _value(self.tape, point, 3)
        return 0 if value is None or value == 0 else 1 if value > 0 else -1


@lru_cache(maxsize=4)
def _exact(expression: sp.Expr, variables: tuple[sp.Symbol, ...]) -> _Exact:
    """Return the exact values that the tests of all forms of a formula share."""
    return _Exact(expression, variables)


def _tape(expression: sp.Expr, variables: tuple[sp.Symbol, ...]) -> Tape | None:
    """Return the tape of an expression; None for a function without ball arithmetic."""
    try:
        return recorded(expression, variables)
    except NotImplementedError:
        return None


def _value(tape: Tape | None, point: Point, digits: int) -> flint.arb | None:
    """Return the value of a tape; None if there is none at the point."""
    if tape is None:
        return None
    at = [to_ball(x) for x in point]
    try:
        return refine(lambda: tape.run(at)[-1], digits, "a point", MOST_BITS)
    except PrecisionError:
        return None


@lru_cache(maxsize=64)
def _points_inside(exact: _Exact, words: Vocabulary, decade: int, number: int) -> list[Point]:
    """Return points inside the domains: random, next to their ends, and next to zeros.

    The tests of all forms of a formula use the same points, which take longer than the values.
    """
    names, expression = [str(v) for v in exact.variables], str(exact.expression)
    seed = f"{expression}, round {number}"

    def sign(point: Mapping[str, float]) -> int:
        return exact.sign(tuple(point[name] for name in names))

    drawn = joint_points(seed, names, words, decade, JOINT)
    signs = [(point, sign(point)) for point in drawn[:FEW]]
    found: Iterable[Mapping[str, float]] = (
        *domain_grid(expression, names, words, {}, seed),
        *drawn,
        *(point for point in towards_zeros(signs, sign) if inside(words, point)),
    )
    least, most = float(f"1e-{decade}"), float(f"1e{decade}")
    points = (tuple(point[name] for name in names) for point in found)
    return [p for p in points if all(x == 0 or least <= abs(x) <= most for x in p)]


def _errors(
    exact: _Exact, function: Function, points: Sequence[Point], allowed: float
) -> dict[Point, float]:
    """Return the errors at the points with a value [ULP, minus a part of the conditioning]."""
    with np.errstate(all="ignore"):
        got = function(*np.array(points).T).tolist()
    errors: dict[Point, float] = {}
    for point, computed in zip(points, got, strict=True):
        value = exact.value(point)
        if value is None or not LEAST_VALUE < abs(value) < LARGEST_VALUE:
            continue
        error = ulp_error(computed, value)
        if error > 0.5:
            conditioning = exact.conditioning(point)
            if conditioning > MOST_CONDITIONING:
                continue
            error = max(0.0, error - allowed * conditioning)
        errors[point] = error
    return errors
