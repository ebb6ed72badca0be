"""Sample points, at which corrections are tested in 448-bit ball arithmetic.

The first point is followed by copies of it in which one symbol is doubled; they determine the
exponents of a monomial. Further random points make an accidental agreement unlikely.
"""

import math
import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import log2

import flint
import sympy as sp

from derivation.engine.formula.ball import enclose, to_ball
from derivation.engine.formula.domain import violated_conditions
from derivation.engine.formula.proof import sample_points
from derivation.engine.formula.vocabulary import applicable

BITS = 448
INTEGRAL_BITS = 160
"""Precision of comparisons of integrals, which take longer."""
_RANDOM = 3
_CLOSE = 1e-11
_ATTEMPTS = 300
_ROOTS, _POWERS_OF_PI = (1, 2, 3), (0, 1, -1, 2, -2)
"""Roots and powers of pi in a constant ratio."""

Values = Sequence[flint.acb]
"""One complex ball per sample point."""


@dataclass(frozen=True, eq=False)
class Sample:
    """Sample points, and the values that are already known at each point.

    Parameters
    ----------
    symbols
        The independent symbols, in the order in which the points double them.
    known
        For each point, the known values of symbols and expressions.
    inside
        Whether all points satisfy the conditions that were given.
    """

    symbols: tuple[sp.Symbol, ...]
    known: tuple[dict[sp.Basic, flint.acb], ...]
    inside: bool = True

    def value(self, expression: sp.Expr, point: int) -> flint.acb:
        """Return a ball around the expression's value at one point."""
        known = self.known[point]
        if expression in known:
            return known[expression]
        return flint.acb(enclose(expression, known))

    def applied(self, function: type[sp.Basic], value: flint.acb) -> flint.acb:
        """Return a ball around a function of an argument that has the given value."""
        argument = sp.Dummy()
        return flint.acb(enclose(function(argument), {argument: value}))

    def values(self, expression: sp.Expr) -> list[flint.acb]:
        """Return balls around the expression's values at all points."""
        return [self.value(expression, point) for point in range(len(self.known))]

    def learn(self, expression: sp.Expr) -> None:
        """Store the values of an expression and of all its parts."""
        for node in () if isinstance(expression, sp.Integral) else expression.args:
            self.learn(node)
        for point, known in enumerate(self.known):
            if expression not in known:
                known[expression] = self.value(expression, point)

    def evaluable(self, expressions: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
        """Return the expressions that do not contain a variable of integration."""
        known = self.known[0]
        return tuple(e for e in expressions if _symbols(e) <= known.keys())

    def same(self, expression: sp.Expr, values: Values) -> bool:
        """Return whether an expression has these values at every point."""
        return all(
            agree(self.value(expression, point), value) for point, value in enumerate(values)
        )


@lru_cache(maxsize=4096)
def _symbols(expression: sp.Expr) -> set[sp.Basic]:
    """Return the free symbols, which SymPy collects again in each call."""
    symbols: set[sp.Basic] = expression.free_symbols
    return symbols


def agree(x: flint.acb, y: flint.acb) -> bool:
    """Return whether two balls are finite and overlap."""
    return bool(x.is_finite() and y.is_finite() and x.overlaps(y))


def sample(
    expressions: Sequence[sp.Expr],
    relations: Mapping[sp.Symbol, sp.Expr],
    within: Mapping[sp.Symbol, Fraction],
    conditions: Sequence[str] = (),
) -> Sample:
    """Return sample points for all symbols of some expressions.

    Values of the symbols in `relations` follow from those of the others. Random values of the
    symbols in `within` are multiplied by the factors there, and by powers of 1/2 with which the
    points violate the fewest conditions.
    """
    symbols: set[sp.Symbol] = set().union(*(e.free_symbols for e in expressions))
    dependent = [s for s in relations if s in symbols]
    for symbol in dependent:
        symbols |= relations[symbol].free_symbols
    free = tuple(sorted(symbols - set(relations), key=str))
    first, *others = sample_points(free, _RANDOM)
    doubled = [first | {symbol: 2 * first[symbol]} for symbol in free]
    conditions = applicable(conditions, {symbol.name for symbol in free})
    generator, drawn = random.Random(2), []
    for attempt in range(_ATTEMPTS if conditions else 1):
        halvings = {s: generator.randrange(6) if attempt else 0 for s in free}
        scaled = [
            {s: v * within.get(s, 1) / 2 ** halvings[s] for s, v in point.items()}
            for point in (first, *doubled, *others)
        ]
        drawn.append(
            (sum(len(violated_conditions(conditions, p)) for p in scaled), attempt, scaled)
        )
        if drawn[-1][0] == 0:
            break
    violated, _, points = min(drawn, key=lambda one: one[:2])
    known: list[dict[sp.Basic, flint.acb]] = []
    for point in points:
        values: dict[sp.Basic, flint.acb] = {s: flint.acb(to_ball(v)) for s, v in point.items()}
        values[sp.I] = flint.acb(0, 1)  # roots of negative numbers, in candidates of the search
        for symbol in sorted(dependent, key=lambda s: len(relations[s].free_symbols)):
            values[symbol] = flint.acb(enclose(relations[symbol], values))
        known.append(values)
    return Sample(free, tuple(known), violated == 0)


def real(value: flint.acb) -> float | None:
    """Return the value as a float, or None if it is not real, finite and of moderate size."""
    if not value.is_finite():
        return None
    number = complex(value)
    ordinary = 1e-250 < abs(number.real) < 1e250
    return number.real if ordinary and abs(number.imag) < 1e-30 * abs(number.real) else None


def rational(number: float, denominator: int) -> Fraction | None:
    """Return the simple fraction that equals a number; None if there is none."""
    if not abs(number) < 1e6:
        return None
    fraction = Fraction(number).limit_denominator(denominator)
    return fraction if abs(number - fraction) <= _CLOSE * max(1.0, abs(number)) else None


def constant(values: Values) -> sp.Expr | None:
    """Return the simple fraction times a power of pi, or a root of it, that equals all values."""
    number = real(values[0])
    if number is None or not agree(values[0], values[-1]):
        return None
    for root in _ROOTS:
        for power in _POWERS_OF_PI:
            fraction = rational(abs(number) ** root / math.pi**power, 64)
            if fraction:
                inside = sp.Rational(fraction.numerator, fraction.denominator) * sp.pi**power
                found = (1 if number > 0 else -1) * inside ** sp.Rational(1, root)
                ball = flint.acb(enclose(found, {}))
                if all(agree(ball, value) for value in values):
                    return found
    return None


def monomial(values: Values, points: Sample) -> sp.Expr | None:
    """Return the constant times powers of symbols that has these values; None if none has."""
    first = real(values[0])
    if first is None:
        return None
    power = sp.Integer(1)
    for index, symbol in enumerate(points.symbols, start=1):
        other = real(values[index])
        if other is None or other / first <= 0:
            return None
        exponent = rational(log2(other / first), 3)
        if exponent is None or abs(exponent) > 12:
            return None
        power *= symbol ** sp.Rational(exponent.numerator, exponent.denominator)
    factor = constant([v / p for v, p in zip(values, points.values(power), strict=True)])
    return None if factor is None else factor * power
