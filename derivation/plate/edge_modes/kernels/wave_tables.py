"""Turns the theory of held plates with a thickness into the numbers their generated code needs."""

from collections.abc import Iterable
from fractions import Fraction
from math import factorial

import flint
import sympy as sp

from derivation.engine.formula.ball import to_ball
from derivation.mathematics.bessel.kernels import (
    TOLERANCE,
    asymptotic_start,
    first_true,
    nearest_double,
    wrapped,
)
from derivation.mathematics.bessel.theory.modified import (
    fourth_bound,
    logarithm_bound,
    ratio_bound,
    ratio_series,
    sum_bound,
)
from derivation.plate.contact.kernels.moments import BITS
from derivation.plate.contact.kernels.tables import gauss_legendre
from derivation.plate.edge_modes.kernels.wave_forms import blocks, curls, forms
from derivation.plate.edge_modes.theory.mindlin import ROTARY, slack

NODES = 20
"""Of the integral of the first supported mode's square, a smooth function of r."""
WIDEST = 6
"""Above j_1^2: |y| up to which power series in y = -k^2 or k2^2 serve."""


def powers(order: int, count: int) -> tuple[sp.Rational, ...]:
    """I0 (order 0) or 2 I1/sqrt(y) (order 1) by powers of y."""
    return tuple(sp.Rational(1, 4**m * factorial(m) * factorial(m + order)) for m in range(count))


def means(count: int) -> tuple[sp.Rational, ...]:
    """sinh(y)/y by powers of y^2."""
    return tuple(sp.Rational(1, factorial(2 * m + 1)) for m in range(count))


def enough(coefficients: tuple[sp.Rational, ...]) -> int:
    """How many coefficients count up to the widest argument."""
    limit = sp.Rational(TOLERANCE) * coefficients[1]
    return first_true(lambda n: n > 2 and bool(coefficients[n] * WIDEST**n <= limit), 32) + 1


def series_terms(start: Fraction) -> int:
    """Terms of I1/I0 at infinity, so that neither it nor I0 is off by more than the tolerance."""
    limit = to_ball(TOLERANCE)

    def enough(terms: int) -> bool:
        if terms < 3:
            return False
        within = ratio_bound(terms, start), logarithm_bound(terms, start)
        return all(bool(bound <= limit) for bound in within)

    return first_true(enough, int(start))


def turns(steps: int) -> tuple[flint.arb, ...]:
    """1 - cos t over half a turn, the largest first."""
    halves = (flint.arb.sin_pi_fmpq(flint.fmpq(i, steps)) for i in reversed(range(steps // 2 + 1)))
    return tuple(2 * half**2 for half in halves)


def turn_steps(largest: Fraction) -> int:
    """Steps of Bessel's integral, an even number, for I0, I1 and I2 up to the largest."""
    least = int(largest) // 2 + 4

    def within(n: int) -> bool:
        steps = 2 * (least + n)
        return max(sum_bound(steps, largest), fourth_bound(steps, largest)) <= TOLERANCE

    return 2 * (least + first_true(within))


def _row(values: Iterable[sp.Rational]) -> tuple[str, ...]:
    doubles = (nearest_double(to_ball(Fraction(int(v.p), int(v.q)))) for v in values)
    return wrapped(repr(value) for value in doubles)


def held_wave_context() -> dict[str, object]:
    """What the template of the generated held waves needs."""
    forms()
    start = asymptotic_start()
    tables = {"curl": curls(32), "even": powers(0, 32), "odd": powers(1, 32), "punch": means(32)}
    with flint.ctx.workprec(BITS):
        series = ratio_series(series_terms(start))
        logarithm = tuple(-v / (m - 1) for m, v in enumerate(series) if m > 1)
        rows = {name: _row(v[: enough(v)]) for name, v in tables.items()}
        places, weights = gauss_legendre(NODES)
        return {
            "blocks": blocks(),
            "cutoff": sp.sqrt(3 * (slack() + ROTARY) / slack()),
            "start": repr(float(start)),
            "nodes": wrapped(map(repr, places)),
            "weights": wrapped(map(repr, weights)),
            "series": rows | {"ratio": _row(series), "logarithm": _row(logarithm)},
            "turns": wrapped(repr(nearest_double(v)) for v in turns(turn_steps(start))),
        }
