"""The integral of the finite radius as a finite sum, to any number of digits, with a proved bound.

For g even and entire with |g(y)| <= e^|Re y| the trapezoidal rule is applied to

    int_0^oo g(y)/I0(y)^2 dy = 1/2 int F(t) dt,   F = g(y) y'/I0(y)^2,   y = 2 sinh t.

The zeros of I0 are the points +-i j_n, j_1 > 2.4. For |Im t| < pi/2 the real part of y vanishes
only with that of t, and |y| < 2 there: F is analytic in that strip, and decreases doubly
exponentially along it. With M = int |F(t + i d)| dt, the error of the rule of step s is at most
2 M/(e^(2 pi d/s) - 1) (Trefethen & Weideman 2014, theorem 5.1); M is bounded in balls. Neither
nodes nor weights depend on plate or contact.
"""

import math
from functools import cache
from typing import NamedTuple

import flint
from flint import acb, arb

from derivation.engine.formula.ball import PrecisionError

SHIFT = 1.35
"""d, the distance from the real axis of the line on which F is bounded."""

NEAR, PIECES = 1.6, 320
"""Largest t up to which balls cover the shifted line, and their number."""

_SPARE = 24


class Points(NamedTuple):
    """A sum or an integral of g as a sum of weight times g(place), and a bound of its error.

    Attributes
    ----------
    places, weights
        Balls [1]; all weights are positive.
    rest
        Upper bound of the error [1], for every g admitted by the function that returns this.
    """

    places: tuple[arb, ...]
    weights: tuple[arb, ...]
    rest: arb


@cache
def shifted_bound() -> arb:
    """Return M (see the module), 2 int_0^oo |F(t + i d)| dt, for every g with |g| <= e^|Re y|.

    Up to NEAR balls cover the line. Beyond, |y| >= 2 sinh t >= 4 and Re y = 2 cos d sinh t
    >= 1. There |I0(y)| is |J0| at Im y + i Re y, half the sum of two Hankel functions, of
    which one is above 0.89 sqrt(2/(pi |y|)) e^(Re y) and the other below 1.07 of the same
    with e^(-Re y) (DLMF 10.17.14, l = 1, variations pi/2 and 1 over |y|): |I0| >=
    0.29 e^(Re y)/sqrt|y|. As |y| and |y'| are at most 2 cosh t, |F| <= 48 cosh^2 t
    e^(-c s) with s = sinh t, c = 2 cos d, and cosh t <= 1 + s leaves a closed integral.

    Raises
    ------
    PrecisionError
        If a ball on the line reaches a zero of I0.
    """
    with flint.ctx.workprec(64):
        width, total = arb(NEAR) / PIECES, arb(0)
        for k in range(PIECES):
            t = acb(arb((k + arb(0.5)) * width, (width / 2).upper()), SHIFT)
            y, slope = 2 * t.sinh(), 2 * t.cosh()
            least = y.bessel_i(0).abs_lower()
            if not least > 0:
                raise PrecisionError(f"no bound of 1/I0 near {y}")
            total += width * abs(y.real).exp() * slope.abs_upper() / least**2
        s, c = arb(NEAR).sinh(), 2 * arb(SHIFT).cos()
        if not (s >= 2 and c * s >= 1):
            raise PrecisionError(f"the far bound of I0 is not valid from t = {NEAR} on")
        total += 48 * (-c * s).exp() * ((1 + s) / c + 1 / c**2)
        return (2 * total).abs_upper()


def step_bound(step: arb) -> arb:
    """Return a bound of the error of the trapezoidal rule of a step, for the half line."""
    return (shifted_bound() / ((2 * arb.pi() * arb(SHIFT) / step).exp() - 1)).abs_upper()


def trapezoidal(step: arb, end: float) -> tuple[list[arb], list[arb]]:
    """Return nodes y and weights of the rule of a step; the last y is the first one above `end`."""
    count = math.ceil(math.asinh(end / 2) / float(step))
    places, weights = [arb(0)], [step]
    for k in range(1, count + 1):
        y = 2 * (step * k).sinh()
        places.append(y)
        weights.append(step * (4 + y * y).sqrt() / y.bessel_i(0) ** 2)
    return places, weights


@cache
def lateral_points(bits: int) -> Points:
    """Return nodes and weights of int_0^oo g/I0^2 dy = sum weight g(y), for |g(y)| <= e^|Re y|.

    The sum ends at a y >= 2. Because I0 >= e^y/(3 sqrt y) from y = 1 on (`balls.kappa`), the
    following terms are below 9 y e^(-y) y', which decreases with t: its logarithm has the slope
    y'/y + y/y' - y' < 0. Their sum is below the integral, 9 (y + 1) e^(-y).

    Parameters
    ----------
    bits
        The error is below 2^-bits; the relative radii of the balls are about 2^-bits.

    Raises
    ------
    PrecisionError
        If the sum ends before its bound is valid.
    """
    with flint.ctx.workprec(bits + _SPARE):
        need = (bits + 1) * math.log(2) + float(shifted_bound().log())
        step = arb(2 * math.pi * SHIFT / (need + 1))
        places, weights = trapezoidal(step, bits * math.log(2) + math.log(bits) + 8)
        end = places[-1]
        if not end >= 2:
            raise PrecisionError(
                f"the lateral surface's sum ends at {end}, too early for its bound"
            )
        rest = step_bound(step) + 9 * (end + 1) * (-end).exp()
        return Points(tuple(places), tuple(weights), rest.abs_upper())
