"""Force over indentation: the reversed series, and a table."""

import math

import flint
import numpy as np
from flint import arb, arb_series

from derivation.plate.benchmark.arithmetic import DOUBLE, Arithmetic, Array, horner
from derivation.plate.benchmark.coefficients import coefficients
from derivation.plate.benchmark.interface import BenchmarkCase, Call, Method, largest_contact_radius
from derivation.plate.benchmark.laws import SeriesLaw
from derivation.plate.benchmark.polynomials import correction, hermite
from derivation.plate.benchmark.problems import SPAN
from derivation.plate.benchmark.ready_methods import stiffness
from generated import contact_law, contact_series
from generated.reversed_series import _reversed


def reversed_series(terms: int, ar: Arithmetic = DOUBLE) -> Method:
    """Return the method of Lagrange's truncated inversion, NaN beyond its convergence radius."""

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        """Return (4/3) E* sqrt(R delta) delta (p_0 + p_1 eps + ...) as a function of delta.

        eps = sqrt(R delta)/(h radius).
        """
        radius = radius_of(case)
        p, R = list(ar.array(reversed_balls(case, terms, radius, ar))), ar.number(case.R)
        reach = ar.number(case.h) * ar.number(radius)
        lam, mu = ar.number(case.lam), ar.number(case.mu)
        stiff = 16 * mu * (lam + mu) / (3 * (lam + 2 * mu))

        def call(delta: Array) -> Array:
            hertz = np.sqrt(delta * R)
            eps = hertz / reach
            return stiff * hertz * delta * horner(p, np.where(eps < 1, eps, ar.number(math.nan)))

        return call

    def fails(case: BenchmarkCase) -> str | None:
        radius, a = radius_of(case), largest_contact_radius(case)
        delta = contact_law.indentation(a, case.R, case.h, case.b)
        eps = math.sqrt(delta * case.R) / case.h
        if eps < radius:
            return None
        return f"diverges: sqrt(R delta)/h up to {eps:.3g}, radius of convergence {radius:.3g}"

    return Method("inversion", "reversed series", f"{terms} terms", prepare, ar, fails=fails)


def radius_of(case: BenchmarkCase) -> float:
    """Return a lower bound of the radius of convergence in sqrt(R delta)/h."""
    radius, _ = _reversed(contact_series.plates_of(np.array([case.eta])), 0, 1)
    return float(radius)


def reversed_balls(case: BenchmarkCase, terms: int, radius: float, ar: Arithmetic) -> list[arb]:
    """Return the coefficients of (A/x)^3 in x/radius, A the inverse of x = A sqrt(1 + F)."""
    before = flint.ctx.cap
    with flint.ctx.workprec(ar.bits):
        lifted = [arb(1)]
        for c in coefficients(case, max(1, terms // 2), ar.constants):
            lifted += [c, arb(0)]
        try:
            flint.ctx.cap = terms + 1  # the number of terms of the truncated series
            x = arb_series([0, 1])
            cube = ((x * arb_series(lifted).sqrt()).reversion() / x) ** 3
        finally:
            flint.ctx.cap = before
        return [cube[n] * arb(radius) ** n for n in range(terms)]


def table(knots: int, ar: Arithmetic = DOUBLE) -> Method:
    """Return the method of cubics for ln(a/h) in ln(R delta/h^2), with equal steps."""

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        r, top = case, largest_contact_radius(case)
        ends = contact_law.indentation(np.array([0.999 * top / SPAN, top]), r.R, r.h, r.b)
        low, high = np.log(ends * r.R / r.h**2).tolist()
        # The last knot must not lie beyond the largest contact by rounding.
        high = float(np.nextafter(high, 0 if high > 0 else -math.inf))
        R, h = ar.number(r.R), ar.number(r.h)
        law = SeriesLaw(r, ar) if ar.wide else GeneratedLaw(r)

        def node(t: Array) -> tuple[Array, Array]:
            A = law.radius_ratio(ar.exp(t) * h * h / R)
            return ar.log(A), law.lift(A) / (2 * law.slope(A))

        cubic = hermite(ar, (low, high), knots, node)
        scale = stiffness(r, ar) * h * h * h / (R * np.sqrt(R))
        return lambda delta: scale * ar.exp(3 * cubic(ar.log(delta * (R / (h * h)))))

    return Method("inversion", "cubic interpolation", f"{knots} knots", prepare, ar)


class GeneratedLaw:
    """The law of a case's plate by the generated code, like `SeriesLaw`."""

    def __init__(self, case: BenchmarkCase) -> None:
        self.case = case

    def radius_ratio(self, delta: Array) -> Array:
        """Return A = a/h at indentations [m] above 0."""
        r = self.case
        return contact_law.contact_radius(delta, r.R, r.h, r.b) / r.h

    def lift(self, A: Array) -> Array:
        """Return 1 + F."""
        return 1 + correction(self.case, DOUBLE, A)[0]

    def slope(self, A: Array) -> Array:
        """Return S = 1 + F + A F'/2."""
        F, rise = correction(self.case, DOUBLE, A)
        return 1 + F + rise / 2
