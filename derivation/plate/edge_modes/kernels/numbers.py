"""Constants for the generated code of clamped and supported plates."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import factorial

import flint
import numpy as np
import sympy as sp

from derivation.engine.emit.modules import Numbers
from derivation.engine.emit.tables import Constant
from derivation.engine.formula.ball import to_ball
from derivation.mathematics.bessel.kernels import (
    TOLERANCE,
    asymptotic_start,
    first_true,
    nearest_double,
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
from derivation.plate.edge_modes.kernels.edges import curl_powers

NODES = 20
"""Nodes of the integral of the first supported mode's square, a smooth function of r."""
SMALL = 2.0
"""y below which J0 - 1, I0 - 1 and the means under a punch minus 1 are power series."""
WIDEST = 6
"""|y| up to which power series in y = -k^2 or k2^2 are used; it exceeds j_1^2 = 5.78."""


def powers(order: int, count: int) -> tuple[sp.Rational, ...]:
    """Return I0 (order 0) or 2 I1/sqrt(y) (order 1) in powers of y."""
    return tuple(sp.Rational(1, 4**m * factorial(m) * factorial(m + order)) for m in range(count))


def means(count: int) -> tuple[sp.Rational, ...]:
    """Return sinh(y)/y in powers of y^2."""
    return tuple(sp.Rational(1, factorial(2 * m + 1)) for m in range(count))


def enough(coefficients: tuple[sp.Rational, ...]) -> int:
    """Return the number of coefficients that are not negligible up to the widest argument."""
    limit = sp.Rational(TOLERANCE) * coefficients[1]
    return first_true(lambda n: n > 2 and bool(coefficients[n] * WIDEST**n <= limit), 32) + 1


def series_terms(start: Fraction) -> int:
    """Return the number of terms of I1/I0 at infinity for a relative error below the tolerance."""
    limit = to_ball(TOLERANCE)

    def enough(terms: int) -> bool:
        if terms < 3:
            return False
        within = ratio_bound(terms, start), logarithm_bound(terms, start)
        return all(bool(bound <= limit) for bound in within)

    return first_true(enough, int(start))


def turns(steps: int) -> tuple[flint.arb, ...]:
    """Return 1 - cos t over half a turn, the largest first."""
    halves = (flint.arb.sin_pi_fmpq(flint.fmpq(i, steps)) for i in reversed(range(steps // 2 + 1)))
    return tuple(2 * half**2 for half in halves)


def turn_steps(largest: Fraction) -> int:
    """Return an even number of steps of Bessel's integral for I0, I1, I2 up to the largest."""
    least = int(largest) // 2 + 4

    def within(n: int) -> bool:
        steps = 2 * (least + n)
        return max(sum_bound(steps, largest), fourth_bound(steps, largest)) <= TOLERANCE

    return 2 * (least + first_true(within))


def _doubles(values: Iterable[sp.Rational]) -> tuple[float, ...]:
    return tuple(nearest_double(to_ball(Fraction(int(v.p), int(v.q)))) for v in values)


def _counted(values: tuple[sp.Rational, ...]) -> tuple[sp.Rational, ...]:
    return values[: enough(values)]


def _of_turns(steps: int) -> tuple[Constant, ...]:
    """Return Bessel's integral as a sum over half a turn; the end points have half weight."""
    points = turns(steps)
    count = len(points) - 1
    weights = [flint.arb(1) / (count if 0 < i < count else 2 * count) for i in range(count + 1)]
    rows = {
        "TURNS": (points, "x = 1 - cos t over half a turn."),
        "MEAN": (weights, "Weights of e^(-y x) whose sum is I0 e^(-y)."),
        "SECOND": (_times_sine(weights, points), "Weights of e^(-y x) whose sum is I1 e^(-y)/y."),
        "FOURTH": (
            _times_sine(_times_sine(weights, points), points),
            "Weights of e^(-y x) whose sum is 3 I2 e^(-y)/y^2.",
        ),
    }
    return tuple(
        Constant(name, np.array([nearest_double(v) for v in values]), meaning)
        for name, (values, meaning) in rows.items()
    )


def _times_sine(values: Sequence[flint.arb], places: Sequence[flint.arb]) -> list[flint.arb]:
    """Return the weights times sin^2 t, where x = 1 - cos t."""
    return [value * x * (2 - x) for value, x in zip(values, places, strict=True)]


def _of_series() -> tuple[Constant, ...]:
    curl = _counted(curl_powers(32))
    series = ratio_series(series_terms(asymptotic_start()))
    logarithm = tuple(-v / (m - 1) for m, v in enumerate(series) if m > 1)
    rows = {
        "RATIO": (series, "I1/I0 of y, in powers of 1/y."),
        "LOGARITHM": (logarithm, "y log(I0 sqrt(2 pi y) e^(-y)), in powers of 1/y."),
        "EVEN": (_counted(powers(0, 32)), "I0 of sqrt(y), in powers of y."),
        "ODD": (_counted(powers(1, 32)), "2 I1/sqrt(y) of sqrt(y), in powers of y."),
        "PUNCH": (_counted(means(32)), "sinh(y)/y, in powers of y^2."),
        "CURL": (curl, "R/y, R = y/8 I0 - I2 of sqrt(y), in powers of y."),
        "CURL_SLOPE": (tuple((m + 1) * v for m, v in enumerate(curl)), "R', in powers of y."),
    }
    return tuple(Constant(name, _doubles(v), meaning) for name, (v, meaning) in rows.items())


def numbers() -> Numbers:
    """Return the limits of the methods, and coefficients of series and sums."""
    start = asymptotic_start()
    with flint.ctx.workprec(BITS):
        places, weights = (np.array(x) for x in gauss_legendre(NODES))
        return Numbers(
            "edge_mode_numbers",
            "Constants of clamped and supported plates: coefficients, and limits of series.",
            (
                Constant("START", float(start), "y above which I0 is a series at infinity."),
                Constant("SMALL", SMALL, "y below which J0 - 1, I0 - 1 and others are series."),
                *_of_series(),
                *_of_turns(turn_steps(start)),
                Constant("NODES", places, "Nodes of Gauss' rule on (0, 1)."),
                Constant("WEIGHTS", weights, "Weights of Gauss' rule on (0, 1)."),
            ),
        )
