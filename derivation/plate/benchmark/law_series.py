"""The contact law as a polynomial in a/h or a table: series, thin plate, Chebyshev, cubics."""

import math
from collections.abc import Callable
from functools import cache

import numpy as np
from flint import arb

from derivation.plate.benchmark.arithmetic import DOUBLE, Arithmetic, Array
from derivation.plate.benchmark.coefficients import closed_form, series
from derivation.plate.benchmark.interface import Call, Method, Regime
from derivation.plate.benchmark.law_sums import EXACT, exact_for, wrapped
from derivation.plate.contact.oracle import balls as contact_balls
from generated import contact_series

SURE_DIGITS = 26
"""Of the law where a surrogate is made without rounding: a truncation below it is a bound."""

Coefficients = Callable[[float, float, int, int], list[arb]]


def _horner(ar: Arithmetic, regime: Regime, found: list[arb]) -> Call:
    """(a^2/R) (1 + A (c_1 + c_3 A^2 + ...))."""
    with ar.context():
        R, h, c = ar.array(regime.R), ar.array(regime.h), list(ar.array(found))

    def call(a: Array) -> Array:
        A = a / h
        t = A * A
        value = c[-1] + 0 * t
        for coefficient in c[-2::-1]:
            value = value * t + coefficient
        return (1 + value * A) * (a * a / R)

    return wrapped(ar, call)


def _series(
    family: str, coefficients: Coefficients, fails: Callable[[Regime], str | None], count: int,
    ar: Arithmetic, quick: bool,
) -> Method:  # fmt: skip
    exact = exact_for(ar)

    def prepare(regime: Regime) -> Call:
        return _horner(ar, regime, coefficients(regime.h, regime.b, count, exact.digits))

    def same(regime: Regime) -> Call:
        return _horner(exact, regime, coefficients(regime.h, regime.b, count, exact.digits))

    return Method(
        "law", family, f"{count} terms", prepare, ar.name, same, fails, ar.wide, quick=quick
    )  # fmt: skip


def small_contacts(count: int, ar: Arithmetic = DOUBLE, quick: bool = True) -> Method:
    """Power series in a/h with coefficients for this h/b."""

    def fails(regime: Regime) -> str | None:
        radius = min(4.0, 2 / regime.eta)
        if regime.high < radius:
            return None
        return f"diverges: a/h up to {regime.high:g}, its radius is {radius:g}"

    return _series("small-a series", series, fails, count, ar, quick)


def thin_plate(count: int, ar: Arithmetic = DOUBLE, quick: bool = True) -> Method:
    """The thin plate's closed form, in powers of a/h too."""

    def fails(regime: Regime) -> str | None:
        return f"diverges: a/h up to {regime.high:g}, its radius is 4" if regime.high >= 4 else None

    return _series("thin-plate closed form", closed_form, fails, count, ar, quick)


def chebyshev(degree: int, ar: Arithmetic = DOUBLE) -> Method:
    """Interpolation of F/A in A^2 between the smallest and the largest contact."""

    def prepare(regime: Regime) -> Call:
        low, high = regime.low**2, regime.high**2
        A, x = _places(regime, degree), _chebyshev(degree)
        shares = [contact_balls.departure(float(r) * regime.h, regime.h, regime.b, 20) for r in A]
        values = np.array([float(F) for F in shares]) / A
        fitted = np.polynomial.chebyshev.chebfit(x, values, degree)
        c = ar.array(np.polynomial.chebyshev.cheb2poly(fitted))
        R, h = ar.array(regime.R), ar.array(regime.h)
        middle, scale = ar.array((high + low) / 2), ar.array(2 / (high - low))

        def call(a: Array) -> Array:
            A = a / h
            t = A * A
            t -= middle
            t *= scale
            value = t * c[-1]
            value += c[-2]
            for coefficient in c[-3::-1]:
                value *= t
                value += coefficient
            value *= A
            value += 1
            value *= a
            value *= a
            value /= R
            return value

        return wrapped(ar, call)

    def same(regime: Regime) -> Call:
        A = _places(regime, degree)
        return wrapped(EXACT, _interpolant([float(r) * regime.h for r in A], regime))

    return Method("law", "Chebyshev surrogate", f"degree {degree}", prepare, ar.name, same)


def _places(regime: Regime, degree: int) -> Array:
    """a/h of the Chebyshev nodes in A^2."""
    low, high = regime.low**2, regime.high**2
    return np.sqrt((high + low) / 2 + (high - low) / 2 * _chebyshev(degree))


def _chebyshev(degree: int) -> Array:
    return np.cos(math.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))


def _interpolant(radii: list[float], regime: Regime) -> Call:
    """The polynomial in A^2 through F/A at contact radii, by divided differences in balls."""
    with EXACT.context():
        h, R = arb(regime.h), arb(regime.R)
        A = [arb(a) / h for a in radii]
        t = [x * x for x in A]
        rows = [_lift(a, regime) / x for a, x in zip(radii, A, strict=True)]
        for k in range(1, len(rows)):
            for i in reversed(range(k, len(rows))):
                rows[i] = (rows[i] - rows[i - 1]) / (t[i] - t[i - k])

    def call(a: Array) -> Array:
        A = a / h
        value = 0 * A
        for row, place in zip(reversed(rows), reversed(t), strict=True):
            value = value * (A * A - place) + row
        return (1 + A * value) * a * a / R

    return call


@cache
def _departures(a: float, h: float, b: float) -> tuple[arb, arb]:
    """F, and A F' = 2 ((R/2a) d delta/da - 1 - F), in balls."""
    with EXACT.context():
        lift = contact_balls.departure(a, h, b, SURE_DIGITS)
        slope = contact_balls.slope(a, 1.0, h, b, SURE_DIGITS) / (2 * arb(a)) - 1
        return lift, 2 * (slope - lift)


def _lift(a: float, regime: Regime) -> arb:
    return contact_balls.departure(a, regime.h, regime.b, SURE_DIGITS)


def table(knots: int) -> Method:
    """Cubics between knots at equal steps of A^2, through the values and slopes of F/A."""

    def prepare(regime: Regime) -> Call:
        t = np.linspace(regime.low**2, regime.high**2, knots)
        A = np.sqrt(t)
        plates = contact_series.plates_of(np.array([regime.eta]))
        F, rise = contact_series.correction_with_slope(A, plates, None)
        cubic = hermite(t, F / A, (rise - F) / (2 * A * t))

        def call(a: Array) -> Array:
            A = a / regime.h
            return (1 + A * cubic(A * A)) * a * a / regime.R

        return call

    def same(regime: Regime) -> Call:
        t = np.linspace(regime.low**2, regime.high**2, knots)
        return wrapped(EXACT, lambda a: np.array([_cubic(x, t, regime) for x in a]))

    return Method("law", "table of cubics", f"{knots} knots", prepare, same=same)


def _cubic(a: arb, t: Array, regime: Regime) -> arb:
    """The indentation by the cubic between the two knots about a contact radius.

    Knots are radii a in doubles: that moves them by half a unit in the last place.
    """
    h, R = arb(regime.h), arb(regime.R)
    A = a / h
    step = (t[-1] - t[0]) / (t.size - 1)
    first = min(max(int((float(A) ** 2 - t[0]) / step), 0), t.size - 2)
    radii = [math.sqrt(t[0] + (first + k) * step) * regime.h for k in (0, 1)]
    places, values, slopes = [], [], []
    for radius in radii:
        lift, rise = _departures(radius, regime.h, regime.b)
        share = arb(radius) / h
        places.append(share * share)
        values.append(lift / share)
        slopes.append((rise - lift) / (2 * share**3))
    width = places[1] - places[0]
    bent = _between((A * A - places[0]) / width, *values, *(width * slope for slope in slopes))
    return (1 + A * bent) * a * a / R


def hermite(t: Array, values: Array, slopes: Array) -> Call:
    """The piecewise cubic through values and slopes at equidistant t."""
    # Not t[1] - t[0], whose rounding would grow with the knots.
    start, step, most = t[0], (t[-1] - t[0]) / (t.size - 1), t.size - 2
    rises = slopes * step

    def call(x: Array) -> Array:
        u = (x - start) / step
        i = np.clip(u.astype(np.intp), 0, most)
        u -= i
        return _between(u, values[i], values[i + 1], rises[i], rises[i + 1])

    return call


def _between(u: Array, f0: Array, f1: Array, d0: Array, d1: Array) -> Array:
    """The cubic on [0, 1] through two values with two slopes."""
    return f0 + u * (d0 + u * (3 * (f1 - f0) - 2 * d0 - d1 + u * (2 * (f0 - f1) + d0 + d1)))
