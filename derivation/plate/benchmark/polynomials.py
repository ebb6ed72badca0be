"""The contact law as a polynomial in a/h or a table: series, thin plate, Chebyshev, cubics."""

import math
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from typing import Any

import flint
import numpy as np
from flint import arb, arb_mat

from derivation.engine.formula.ball import to_ball
from derivation.plate.benchmark.arithmetic import DOUBLE, Arithmetic, Array, as_fraction, horner
from derivation.plate.benchmark.coefficients import closed_form, coefficients
from derivation.plate.benchmark.interface import BenchmarkCase, Call, Method
from derivation.plate.contact.oracle import balls as contact_balls
from generated import contact_series

REFERENCE_DIGITS = 32
"""Digits of the law that a surrogate interpolates; smaller errors are not resolved."""


def polynomial(
    case: BenchmarkCase,
    ar: Arithmetic,
    factors: list[arb],
    middle: float = 0.0,
    scale: float = 1.0,
) -> Call:
    """Return (a^2/R) (1 + A (c_0 + c_1 t + ...)) as a function of a; t = scale (A^2 - middle)."""
    R, h, c = ar.number(case.R), ar.number(case.h), list(ar.array(factors))
    start, factor = ar.number(middle), ar.number(scale)

    def call(a: Array) -> Array:
        A = a / h
        t = A * A
        if scale != 1.0:
            t -= start
            t *= factor
        value = horner(c, t)
        value *= A
        value += 1
        value *= a
        value *= a
        value /= R
        return value

    return call


def small_contacts(count: int, ar: Arithmetic = DOUBLE, quick: bool = True) -> Method:
    """Return the method of the power series in a/h with coefficients for this h/b."""

    def fails(case: BenchmarkCase) -> str | None:
        radius = min(4.0, 2 / case.eta)
        if case.high < radius:
            return None
        return f"diverges: a/h up to {case.high:g}, radius of convergence {radius:g}"

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        return polynomial(case, ar, coefficients(case, count, ar.constants))

    return Method("law", "series in a/h", _terms(count), prepare, ar, fails=fails, quick=quick)


def thin_plate(count: int) -> Method:
    """Return the method of the thin plate's closed form, also a power series in a/h."""

    def fails(case: BenchmarkCase) -> str | None:
        return (
            f"diverges: a/h up to {case.high:g}, radius of convergence 4"
            if case.high >= 4
            else None
        )

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        return polynomial(case, ar, closed_form(case.h, case.b, count, ar.constants))

    return Method("law", "thin-plate closed form", _terms(count), prepare, fails=fails)


def _terms(count: int) -> str:
    """Return a number of terms in words."""
    return f"{count} term{'s' if count > 1 else ''}"


def chebyshev(degree: int, ar: Arithmetic = DOUBLE) -> Method:
    """Return the method of interpolation of F/A in A^2 between smallest and largest contact."""

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        low, high = case.low**2, case.high**2
        middle, scale = (high + low) / 2, 2 / (high - low)
        return polynomial(
            case, ar, interpolant(case, degree, middle, scale, ar.bits), middle, scale
        )  # fmt: skip

    return Method("law", "Chebyshev polynomial", f"degree {degree}", prepare, ar)


def interpolant(
    case: BenchmarkCase, degree: int, middle: float, scale: float, bits: int
) -> list[arb]:  # fmt: skip
    """Return the coefficients of the polynomial in t that interpolates F/A at Chebyshev nodes."""
    nodes = np.cos(math.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
    radii = (np.sqrt(middle + nodes / scale) * case.h).tolist()
    with flint.ctx.workprec(bits):
        A = [arb(a) / arb(case.h) for a in radii]
        values = [_departure(a, case.h, case.b) / x for a, x in zip(radii, A, strict=True)]
        powers = [[(arb(scale) * (x * x - arb(middle))) ** k for k in range(degree + 1)] for x in A]
        coefficients = arb_mat(powers).solve(arb_mat([[value.mid()] for value in values]))
        return list(coefficients.entries())


@cache
def _departure(a: float, h: float, b: float) -> arb:
    return contact_balls.relative_correction(a, h, b, REFERENCE_DIGITS)


def table(knots: int) -> Method:
    """Return the method of cubics through values and slopes of F/A at equal steps of A^2."""

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        R, h = ar.number(case.R), ar.number(case.h)
        ends = case.low**2, case.high**2

        def node(t: Array) -> tuple[Array, Array]:
            A = np.sqrt(t)
            F, rise = correction(case, ar, A)
            return F / A, (rise - F) / (2 * A * t)

        cubic = hermite(ar, ends, knots, node)

        def call(a: Array) -> Array:
            A = a / h
            return (1 + A * cubic(A * A)) * a * a / R

        return call

    return Method("law", "cubic interpolation", f"{knots} knots", prepare)


def correction(case: BenchmarkCase, ar: Arithmetic, A: Array) -> tuple[Array, Array]:
    """Return F and A F' at A = a/h, from the generated code or, in wide arithmetic, from Arb."""
    if not ar.wide:
        plates = contact_series.plates_of(np.array([case.eta]))
        F, rise = contact_series.correction_with_slope(A, plates, None)
        return F, rise
    corrections = [_corrections(as_fraction(x) * Fraction(case.h), case.h, case.b) for x in A]
    F, rise = (ar.array(list(column)) for column in zip(*corrections, strict=True))
    return F, rise


@cache
def _corrections(a: Fraction, h: float, b: float) -> tuple[arb, arb]:
    with flint.ctx.workprec(200):
        F = contact_balls.relative_correction(a, h, b, REFERENCE_DIGITS)
        slope = contact_balls.slope(a, 1.0, h, b, REFERENCE_DIGITS) / (2 * to_ball(a)) - 1
        return F, 2 * (slope - F)


def hermite(
    ar: Arithmetic, ends: tuple[float, float], knots: int, node: Callable[[Array], Any]
) -> Call:
    """Return the piecewise cubic through values and slopes at equidistant knots.

    Floats use a table of the knots; wide arithmetic computes the knots that are needed.
    """
    start, last = (ar.number(end) for end in ends)
    # Not the difference of two knots, whose rounding would grow with their number.
    step = (last - start) / (knots - 1)

    def at(i: Array) -> tuple[Array, Array]:
        value, slope = node(start + i * step)
        return value, slope * step

    if not ar.wide:
        values, rises = (ar.array(column) for column in at(np.arange(knots)))
        at = lambda i: (values[i], rises[i])  # noqa: E731

    def call(x: Array) -> Array:
        u = (x - start) / step
        i = np.clip(u.astype(np.intp), 0, knots - 2)
        u -= i
        (f0, d0), (f1, d1) = at(i), at(i + 1)
        return f0 + u * (d0 + u * (3 * (f1 - f0) - 2 * d0 - d1 + u * (2 * (f0 - f1) + d0 + d1)))

    return call
