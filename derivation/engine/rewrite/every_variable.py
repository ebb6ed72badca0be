"""Accuracy test of a form in several variables, in each of them over its domain."""

import math
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import lru_cache
from itertools import chain, cycle, islice
from typing import NamedTuple

import flint
import sympy as sp

from derivation.engine.formula.ball import PrecisionError, evaluate, to_ball
from derivation.engine.formula.grid import (
    ZEROS,
    domain_grid,
    joint_points,
    plain_grid,
    towards_zeros,
)
from derivation.engine.formula.ulp import overflows, ulp_error
from derivation.engine.rewrite.doubles import run
from derivation.engine.rewrite.form import Block, Step, Switch, switch_points
from derivation.engine.rewrite.products import Stated
from derivation.engine.rewrite.terms import UnreachableError
from derivation.engine.rewrite.useful_range import ENOUGH

DIGITS = 25
ENOUGH_POINTS = 20
"""Smallest number of points with a value for a decision."""
SMALLEST = 1e-150
"""Smallest value of an argument; products of smaller ones underflow."""
LEAST_VALUE = sys.float_info.min
"""Smallest value that is tested; smaller ones are subnormal and have fewer digits."""
DECAYING = sp.exp, sp.sinh, sp.cosh, sp.tanh, sp.coth
"""Functions that, as part of a form, may leave the range of doubles before its value does."""

DECADES = 100, 30, 12, 6
"""Exponents of ten of the ranges of all arguments in which forms are tested, the largest first."""
HALF = 0.5
"""Allowed error per sum of the condition numbers, if every argument is rounded."""
FEW = 150
"""Number of points of a first, quick test of a form."""
OVERFLOWS = 72
"""Number of pairs of points between which the value overflows."""
JOINT = 1500
"""Number of points at which several arguments are extreme, next to ends, or nearly equal."""


class LargestError(NamedTuple):
    """Largest error [ULP in addition to half the condition numbers], its point, point count.

    `whole` is the largest error with the part that conditioning explains [ULP], and `lost` the mean
    number of bits by which errors exceed one ULP.
    """

    error: float
    at: Mapping[str, float]
    points: int
    whole: float
    lost: float


class Accuracy(NamedTuple):
    """The largest of `DECADES` up to which a form is accurate, and its errors as above."""

    decades: int
    error: float
    whole: float
    lost: float


def accurate(
    formula: Stated, steps: tuple[Step, ...], value: sp.Expr | Switch, blocks: Mapping[str, Block]
) -> float:
    """Return the largest error [ULP] of a form that is accurate in every variable of its formula.

    Parameters
    ----------
    formula
        The formula, whose arguments have domains.
    steps, value
        The form.
    blocks
        Building blocks of forms.

    Raises
    ------
    UnreachableError
        If it is not accurate; the message states the point with the largest error.
    """
    worst = measured_error(formula, steps, value, blocks)
    if worst.error > ENOUGH:
        raise UnreachableError(_inaccurate(formula, worst), worst.error)
    return worst.error


def _inaccurate(formula: Stated, worst: LargestError) -> str:
    where = ", ".join(f"{name} = {x!r}" for name, x in worst.at.items())
    return (
        f"the form found for {formula.name} has an error of {worst.error:.2g} ULP at {where}, "
        f"expected at most {ENOUGH:g}; narrow the domains of its arguments if such values do "
        "not occur, or state a form"
    )


def measured_error(
    formula: Stated, steps: tuple[Step, ...], value: sp.Expr | Switch, blocks: Mapping[str, Block]
) -> LargestError:
    """Return the largest error of a form at difficult points of every variable.

    Raises
    ------
    UnreachableError
        If too few of the points have a value.
    """
    names = [argument.name for argument in formula.arguments]
    grid = domain_grid(formula.name, names, formula.vocabulary, switch_points([value]))
    return _largest(formula, _with_values(formula, grid), steps, value, blocks)


Known = list[tuple[dict[str, float], flint.arb]]
"""Points with the exact values there."""


class JointTest:
    """Test of forms of a formula at points where several arguments are extreme or nearly equal.

    Parameters
    ----------
    formula
        The formula, whose arguments have domains.
    """

    def __init__(self, formula: Stated) -> None:
        self.formula = formula
        self.known: dict[int, Known] = {}
        self.nearer: Known | None = None

    def range_of(
        self,
        steps: tuple[Step, ...],
        value: sp.Expr | Switch,
        blocks: Mapping[str, Block],
        share: float = HALF,
    ) -> Accuracy:
        """Return the largest of `DECADES` up to which a form is accurate, and its errors [ULP].

        The share is the error that is allowed per sum of the condition numbers.

        Raises
        ------
        UnreachableError
            If there is none; the message states the point with the largest error.
        """
        worst = None
        for decades in DECADES:
            points = self._points(decades)
            if len(points) >= ENOUGH_POINTS:
                few = points[:: max(1, len(points) // FEW)]
                worst = _largest(self.formula, few, steps, value, blocks, share)
                if worst.error > ENOUGH:
                    continue
                worst = _largest(self.formula, points, steps, value, blocks, share)
                if worst.error <= ENOUGH:
                    return Accuracy(decades, worst.error, worst.whole, worst.lost)
        if worst is None:
            raise UnreachableError(
                f"{self.formula.name} has values at {len(points)} test points, expected "
                f"{ENOUGH_POINTS}; correct the domains of its arguments"
            )
        raise UnreachableError(_inaccurate(self.formula, worst), worst.error)

    def _points(self, decades: int) -> Known:
        if decades not in self.known:
            names = [argument.name for argument in self.formula.arguments]
            words, most = self.formula.vocabulary, 10.0**decades
            grid = plain_grid(self.formula.name, tuple(names), words)
            if decades < DECADES[0]:
                grid = tuple(
                    p for p in grid if all(x == 0 or 1 / most <= abs(x) <= most for x in p.values())
                )
            joint = joint_points(self.formula.name, names, words, decades, JOINT)
            known = _with_values(self.formula, (*grid, *joint))
            if self.nearer is None:  # these points are of moderate size, and tested in every range
                signs = [(point, _sign(value)) for point, value in known]
                nearer = towards_zeros(signs, lambda point: self._side(point, _sign))
                ends = chain(nearer, self._underflow(joint), self._overflow(joint))
                self.nearer = _with_values(self.formula, ends)
            self.known[decades] = known + [
                (point, value)
                for point, value in self.nearer
                if all(abs(x) <= most for x in point.values())
            ]
        return self.known[decades]

    def _underflow(self, points: Iterable[dict[str, float]]) -> Iterator[dict[str, float]]:
        """Yield points successively closer to where a normal value becomes a smaller one."""
        if not self.formula.expression.has(*DECAYING):
            return

        def side(point: dict[str, float]) -> int:
            return self._side(point, lambda value: 1 if abs(value) > LEAST_VALUE else -1)

        sides = [(point, side(point)) for point in islice(points, FEW)]
        yield from towards_zeros(sides, side)

    def _overflow(self, points: Iterable[dict[str, float]]) -> Iterator[dict[str, float]]:
        """Yield points successively closer to where a value that is a finite double becomes larger.

        Parts of a form may overflow there before the value does.
        """

        def side(point: dict[str, float]) -> int:
            return self._side(point, lambda value: 1 if overflows(value) else -1)

        signs = [(point, side(point)) for point in points]
        above, below = ([p for p, sign in signs if sign == one] for one in (1, -1))
        for start in range(0, OVERFLOWS if above else 0, ZEROS):
            pairs = islice(zip(cycle(above), below, strict=False), start, start + ZEROS)
            yield from towards_zeros(
                [(p, sign) for pair in pairs for p, sign in zip(pair, (1, -1), strict=True)], side
            )

    def _side(self, point: dict[str, float], of: Callable[[flint.arb], int]) -> int:
        """Return what a function returns for the value at a point; 0 without a value."""
        at = {argument.symbol: point[argument.name] for argument in self.formula.arguments}
        try:
            return of(evaluate(self.formula.expression, at, 3))
        except (PrecisionError, NotImplementedError):
            return 0


def _sign(value: flint.arb) -> int:
    return int(value > 0) - int(value < 0)


def _with_values(formula: Stated, points: Iterable[dict[str, float]]) -> Known:
    symbols = {argument.name: argument.symbol for argument in formula.arguments}
    known = []
    for point in points:
        if all(x == 0 or abs(x) >= SMALLEST for x in point.values()):
            at = {symbols[name]: x for name, x in point.items()}
            reference = _reference(formula.expression, at)
            if reference is not None:
                known.append((point, reference))
    return known


def _largest(
    formula: Stated,
    known: Known,
    steps: tuple[Step, ...],
    value: sp.Expr | Switch,
    blocks: Mapping[str, Block],
    share: float = HALF,
) -> LargestError:
    symbols = {argument.name: argument.symbol for argument in formula.arguments}
    errors, whole = [], []
    for point, reference in known:
        at = {symbols[name]: x for name, x in point.items()}
        got = _computed(steps, value, at, blocks)
        whole.append(ulp_error(got, reference))
        errors.append((_beyond(formula.expression, whole[-1], at, share), point))
    if len(errors) < ENOUGH_POINTS:
        raise UnreachableError(
            f"{formula.name} has values at {len(errors)} test points, expected {ENOUGH_POINTS}"
        )
    error, at_worst = max(errors, key=lambda pair: pair[0])
    lost = sum(math.log2(max(one, 1.0)) for one in whole) / len(whole)
    return LargestError(error, at_worst, len(errors), max(whole), lost)


def _reference(expression: sp.Expr, at: Mapping[sp.Symbol, float]) -> flint.arb | None:
    """Return the value; None if it has no ball, overflows, or may be subnormal."""
    try:
        value = evaluate(expression, at, DIGITS)
    except (PrecisionError, NotImplementedError):
        return None
    return None if overflows(value) or not abs(value) > LEAST_VALUE else value


def _computed(
    steps: tuple[Step, ...],
    value: sp.Expr | Switch,
    at: Mapping[sp.Symbol, float],
    blocks: Mapping[str, Block],
) -> float:
    try:
        return run(steps, value, at, blocks)
    except (OverflowError, ZeroDivisionError):
        return math.nan


def _beyond(
    expression: sp.Expr,
    error: float,
    at: Mapping[sp.Symbol, float],
    share: float = HALF,
) -> float:
    """Return the error [ULP], minus a share of the condition numbers if it is large."""
    if not ENOUGH / 2 < error < math.inf:
        return error
    return max(error - share * _conditioning(expression, tuple(at.items())), 0.0)


@lru_cache(maxsize=1 << 15)
def _conditioning(expression: sp.Expr, at: tuple[tuple[sp.Symbol, float], ...]) -> float:
    """Return the sum of the condition numbers, without those that cannot be evaluated."""
    total, values = 0.0, dict(at)
    for symbol, x in at:
        try:
            slope = evaluate(_slope(expression, symbol), values, 3)
        except (PrecisionError, NotImplementedError):
            continue
        with flint.ctx.workprec(64):
            reference = evaluate(expression, values, 3)
            total += float(abs(slope * to_ball(x) / reference).abs_upper())
    return total


@lru_cache(maxsize=256)
def _slope(expression: sp.Expr, symbol: sp.Symbol) -> sp.Expr:
    return expression.diff(symbol)
