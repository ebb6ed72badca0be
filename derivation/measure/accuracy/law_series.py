"""The contact law as a polynomial in a/h or a table: series, thin plate, Chebyshev, cubics."""

import math
from collections.abc import Callable

import numpy as np
from flint import arb

from derivation.measure.accuracy.arithmetic import DOUBLE, Arithmetic, Array
from derivation.measure.accuracy.coefficients import closed_form, series
from derivation.measure.accuracy.interface import Call, Method, Regime
from derivation.measure.accuracy.law_sums import exact_for, wrapped
from derivation.reference import contact_balls
from generated import contact_series

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
        x = np.cos(math.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
        A = np.sqrt((high + low) / 2 + (high - low) / 2 * x)
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

    return Method("law", "Chebyshev surrogate", f"degree {degree}", prepare, ar.name)


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

    return Method("law", "table of cubics", f"{knots} knots", prepare)


def hermite(t: Array, values: Array, slopes: Array) -> Call:
    """The piecewise cubic through values and slopes at equidistant t."""
    # Not t[1] - t[0], whose rounding would grow with the knots.
    start, step, most = t[0], (t[-1] - t[0]) / (t.size - 1), t.size - 2
    rises = slopes * step

    def call(x: Array) -> Array:
        u = (x - start) / step
        i = np.clip(u.astype(np.intp), 0, most)
        u -= i
        f0, f1, d0, d1 = values[i], values[i + 1], rises[i], rises[i + 1]
        return f0 + u * (d0 + u * (3 * (f1 - f0) - 2 * d0 - d1 + u * (2 * (f0 - f1) + d0 + d1)))

    return call
