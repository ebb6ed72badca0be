"""Test of the code of a stable form, which determines the range and the error that it states."""

import math
import random
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import flint
import numpy as np
import sympy as sp

from derivation.engine.formula.ball import LastPrecision, PrecisionError, enclose, refine, to_ball
from derivation.engine.formula.ulp import from_ordinal, neighbours, ordinal, overflows, ulp_error
from derivation.engine.rewrite.difficult_points import derivative, difficult_points
from derivation.engine.rewrite.stabilise import Stable
from derivation.engine.rewrite.terms import UnreachableError
from derivation.engine.rewrite.useful_range import ENDS, ENOUGH, LEAST_RATIO, rounded, useful_range

MOST_CONDITIONING = 1e3
"""Half condition number above which a point counts as next to a zero."""
CONDITION_FACTOR = 0.6
"""Fraction of half the condition number that is subtracted from an error in the test; the stated
limit allows all of it, because other points may have larger errors than the tested ones."""
_NEAR_ZERO, _MOST_ZEROS = 150, 12
_NEAR_END = 300
_DIGITS = 25
_ROUNDS = 8
_OTHER_ERRORS = 2.0
"""Error [ULP] that is added to that by the rounding of powers of the variable."""
_PATIENT, _MARGIN = 3, 0.03
"""Number of rounds after which an end that still moves is moved further, and by what fraction."""
_RANDOM, _USUAL = 500, 1500
"""Numbers of random points among the doubles of the range, and from 1e-6 to 1e4."""
_LOW_PRECISION, _HIGH_PRECISION = 4096, 1 << 16
Function: TypeAlias = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class CodeCheck:
    """Result of the test of a form's code.

    Parameters
    ----------
    low, high
        Ends of the range, both included.
    limit
        The stated error [ULP in addition to half the condition number]: the largest one found,
        with a margin.
    worst, at
        The largest error found [ULP in addition to `CONDITION_FACTOR` times half the condition
        number], and its point.
    points
        Number of points in the range that were compared.
    undefined
        Points in the range at which the formula has no value, and the code gives NaN.
    """

    low: float
    high: float
    limit: float
    worst: float
    at: float
    points: int
    undefined: tuple[float, ...] = ()


class _Reference:
    """Exact values of an expression at doubles, each computed once."""

    def __init__(self, stable: Stable) -> None:
        self.x = stable.variable
        forms = stable.expression, stable.equal
        self.candidates = [(form, derivative(form, self.x)) for form in forms]
        self.roundings = stable.roundings
        self.known: dict[float, tuple[flint.arb, float] | None] = {}
        self.last: dict[tuple[sp.Expr, int, int], LastPrecision] = {}

    def at(self, point: float) -> tuple[flint.arb, float] | None:
        """Return the value, and half the condition number; None if there is no certified value."""
        if point not in self.known:
            self.known[point] = self._value(point)
        return self.known[point]

    def is_undefined(self, point: float) -> bool:
        """Return whether there is no value at a point, but at both of its neighbours."""
        if not ENDS[0] < point < ENDS[1] or self.at(point) is not None:
            return False
        return all(self.at(from_ordinal(ordinal(point) + step)) is not None for step in (-1, 1))

    def _value(self, point: float) -> tuple[flint.arb, float] | None:
        for most in (_LOW_PRECISION, _HIGH_PRECISION):
            for form, slope in self.candidates:
                if most == _HIGH_PRECISION and not self._finite(form, point):
                    continue  # its exponent exceeds the range of balls, at any precision
                value = self._refined(form, point, _DIGITS, most)
                if value is None:
                    continue
                if value == 0:
                    return value, 0.0
                steep = self._refined(slope, point, 3, most)
                if steep is None:
                    return value, 0.0  # without conditioning
                with flint.ctx.workprec(64):
                    condition = abs(steep * to_ball(point) / value).abs_upper()
                return value, float(condition) / 2
        return None

    def by_rounding(self, point: float) -> float:
        """Return a bound of the error [ULP] by the rounding of powers of the variable.

        A tested point shows a part of it only, because the rounding errors are smaller there.
        """
        known, total = self.at(point), 0.0
        if known is None or not self.roundings or known[0] == 0 or overflows(known[0]):
            return 0.0
        for argument, effect in self.roundings:
            change = self._refined(effect, point, 3, _HIGH_PRECISION)
            power = self._refined(argument, point, 3, _LOW_PRECISION)
            if change is None or power is None:
                return math.inf
            units = 0.5 if argument in (self.x**2, 1 / self.x, sp.sqrt(self.x)) else 1.0
            relative = units * math.ulp(float(power)) / float(power)
            total += relative * float(abs(change).abs_upper()) / math.ulp(float(known[0]))
        return total + _OTHER_ERRORS

    def _finite(self, form: sp.Expr, point: float) -> bool:
        with flint.ctx.workprec(_LOW_PRECISION):
            return bool(enclose(form, {self.x: to_ball(point)}).is_finite())

    def _refined(self, form: sp.Expr, point: float, digits: int, most: int) -> flint.arb | None:
        last = self.last.setdefault((form, digits, most), LastPrecision())
        try:
            return refine(
                lambda: enclose(form, {self.x: to_ball(point)}), digits, "a point", most, last
            )
        except PrecisionError:
            return None


def check_code(stable: Stable, function: Function) -> CodeCheck:
    """Test the code of a form, and return the range and the error that it may state.

    Errors are computed from exact values at random points, next to zeros, overflow and underflow
    limits of the formula and its parts, next to switch points, and at both ends.

    Parameters
    ----------
    stable
        The formula and its form.
    function
        The code, for arrays of doubles in `ENDS`.

    Raises
    ------
    UnreachableError
        If its error stays within `ENOUGH` in no useful range.
    """
    reference = _Reference(stable)
    draw = random.Random(str(stable.expression))
    low, high = ENDS
    errors: dict[float, float] = {}
    new = {*ENDS, *around(difficult_points(stable, low, high)), *_random(draw, low, high)}
    for count in range(_ROUNDS):
        errors |= _errors(function, reference, sorted(new - errors.keys()))
        further = _next_to_zeros(draw, reference, low, high) - errors.keys()
        errors |= _errors(function, reference, sorted(further))
        inside = {p: e for p, e in errors.items() if low <= p <= high}
        if max(inside.values()) <= ENOUGH:
            worst, at = max((e, p) for p, e in inside.items())
            without = (p for p in inside if reference.at(p) is None)
            limit = stated_error(worst)
            return CodeCheck(low, high, limit, worst, at, len(inside), tuple(without))
        before = low, high
        low, high = useful_range(sorted(inside.items()), ENDS)
        if count >= _PATIENT:  # errors that rise slowly towards an end would take many rounds
            low = rounded(low * (1 + _MARGIN), math.ceil, ENDS) if low > before[0] else low
            high = rounded(high * (1 - _MARGIN), math.floor, ENDS) if high < before[1] else high
        if not low * LEAST_RATIO <= high:
            break
        new = {low, high, *_towards(draw, low, high), *_random(draw, low, high)}
    raise UnreachableError(
        f"the form found for {stable.expression} is not accurate to {ENOUGH:g} ULP in any range "
        f"of {stable.variable} that was tested"
    )


def stated_error(worst: float) -> float:
    """Return the stated limit for a largest error: 40 % and 0.4 more, rounded up to halves.

    Among 12,000 other points, about five times as many, the largest errors of eight formulas were
    up to 31 % larger.
    """
    return math.ceil(2 * (1.4 * worst + 0.4)) / 2


def around(points: Iterable[float]) -> set[float]:
    """Return doubles next to the given numbers, and at distances of 2^2, 2^5, ..., 2^56 doubles."""
    last = ordinal(ENDS[1])
    values: set[float] = set()
    for point in points:
        values.update(neighbours(point, 2))
        start = ordinal(point)
        for power in range(2, 57, 3):
            for position in (start - (1 << power), start + (1 << power)):
                if 0 < position <= last:
                    values.add(from_ordinal(position))
    return {x for x in values if ENDS[0] <= x <= ENDS[1]}


def _random(draw: random.Random, low: float, high: float) -> set[float]:
    """Return random doubles: uniform among the doubles of the range, and more in 1e-6 to 1e4."""
    first, last = ordinal(low), ordinal(high)
    values = {from_ordinal(draw.randint(first, last)) for _ in range(_RANDOM)}
    near, far = max(low, 1e-6), min(high, 1e4)
    if near < far:
        values |= {10 ** draw.uniform(math.log10(near), math.log10(far)) for _ in range(_USUAL)}
    return {min(max(x, low), high) for x in values}


def _next_to_zeros(
    draw: random.Random, reference: _Reference, low: float, high: float
) -> set[float]:
    """Return random doubles around the points with the largest condition numbers."""
    steep = [
        (known[1], point)
        for point, known in sorted(reference.known.items())
        if low <= point <= high and known is not None and known[1] > MOST_CONDITIONING
    ]
    peaks: list[tuple[float, float]] = []
    for slack, point in sorted(steep, reverse=True):
        if all(abs(point / other - 1) > 1e-3 for _, other in peaks):
            peaks.append((slack, point))
        if len(peaks) == _MOST_ZEROS:
            break
    values = {
        point * (1 + draw.choice((-1, 1)) * 10 ** draw.uniform(-15, -1))
        for _, point in peaks
        for _ in range(_NEAR_ZERO)
    }
    return {x for x in values if low <= x <= high}


def _towards(draw: random.Random, low: float, high: float) -> set[float]:
    """Return doubles next to the ends of the range, and random ones within a factor of 2 of them.

    Errors are largest near an end behind which they exceed the limit.
    """
    values = around([low, high])
    for end, sign in ((low, 1), (high, -1)):
        values |= {end * (1 + sign * 10 ** draw.uniform(-4, -0.3)) for _ in range(_NEAR_END)}
    return {x for x in values if low <= x <= high}


def _errors(
    function: Function, reference: _Reference, points: Sequence[float]
) -> dict[float, float]:
    """Return errors [ULP in addition to `CONDITION_FACTOR` times half the condition number].

    The error is infinite if there is no certified value, or if it overflows.
    """
    if not points:
        return {}
    with np.errstate(all="ignore"):
        got = function(np.array(points)).tolist()
    errors_by_point = {}
    for point, value in zip(points, got, strict=True):
        known = reference.at(point)
        if math.isnan(value) and reference.is_undefined(point):
            errors_by_point[point] = 0.0
        elif known is None or overflows(known[0]):
            errors_by_point[point] = math.inf
        else:
            error = ulp_error(value, known[0]) - CONDITION_FACTOR * known[1]
            errors_by_point[point] = max(error, reference.by_rounding(point) - known[1], 0.0)
    return errors_by_point
