"""Force over indentation: reversed series, Newton's iteration, table, oracle."""

import math

import numpy as np

from derivation.measure.accuracy.arithmetic import Array, Balls
from derivation.measure.accuracy.interface import Call, Doubles, Method, Regime
from derivation.measure.accuracy.law_series import hermite
from derivation.reference import contact_balls
from generated import contact_law, contact_series
from generated.impact import impact
from generated.reversed_series import _reversed

SPAN = 100.0
"""Largest contact radius of a regime's impacts over the smallest one looked at."""


def deepest(regime: Regime) -> float:
    """Contact radius that an impact at the regime's speed reaches [m]."""
    r = regime
    return float(impact(r.R, r.m, r.speed, r.h, r.b, r.lam, r.mu).max_contact_radius)


def hertz() -> Method:
    """P = (4/3) E* sqrt(R) delta^(3/2)."""

    def prepare(regime: Regime) -> Call:
        stiff = 4 / 3 * regime.modulus * math.sqrt(regime.R)
        return lambda delta: stiff * (delta * np.sqrt(delta))

    return Method("inversion", "Hertz", "", prepare)


def reversed_series(terms: int) -> Method:
    """Lagrange's inversion cut off, NaN beyond its radius of convergence."""

    def prepare(regime: Regime) -> Call:
        plates = contact_series.plates_of(np.array([regime.eta]))
        # The generated function seeks the radius anew at every call: here that is set-up.
        radius, coefficients = _reversed(plates, 0, terms)
        stiff = 4 / 3 * regime.modulus

        def call(delta: Array) -> Array:
            hertz = np.sqrt(delta * regime.R)
            eps = hertz / (regime.h * radius)
            eps = np.where(eps < 1, eps, np.nan)
            value = np.full_like(eps, coefficients[-1])
            for coefficient in coefficients[-2::-1]:
                value = value * eps + coefficient
            return stiff * hertz * delta * value

        return call

    def fails(regime: Regime) -> str | None:
        plates = contact_series.plates_of(np.array([regime.eta]))
        radius, _ = _reversed(plates, 0, 1)
        a = deepest(regime)
        delta = contact_law.indentation(a, regime.R, regime.h, regime.b)
        eps = math.sqrt(delta * regime.R) / regime.h
        if eps < radius:
            return None
        return f"beyond its radius: sqrt(R delta)/h up to {eps:.3g}, radius {radius:.3g}"

    return Method("inversion", "reversed series", f"{terms} terms", prepare, fails=fails)


def newton() -> Method:
    """`force`, the generated code's Newton iteration."""

    def prepare(regime: Regime) -> Call:
        r = regime
        return lambda delta: contact_law.force(delta, r.R, r.h, r.b, r.lam, r.mu)

    return Method("inversion", "Newton (production)", "as called", prepare)


def table(knots: int) -> Method:
    """Cubics in ln(R delta/h^2) of ln(a/h): equal steps serve all sizes of contact."""

    def prepare(regime: Regime) -> Call:
        top = deepest(regime)
        ends = contact_law.indentation(
            np.array([0.999 * top / SPAN, top]), regime.R, regime.h, regime.b
        )
        low, high = np.log(ends * regime.R / regime.h**2).tolist()
        t = np.linspace(low, high, knots)
        # The last knot must not lie beyond the largest contact by rounding.
        t[-1] = np.nextafter(t[-1], 0 if t[-1] > 0 else -np.inf)
        A = _inverse(t, regime)
        plates = contact_series.plates_of(np.array([regime.eta]))
        F, rise = contact_series.correction_with_slope(A, plates, None)
        cubic = hermite(t, np.log(A), (1 + F) / (2 * (1 + F) + rise))
        scale = 4 * regime.modulus * regime.h**3 / (3 * regime.R)

        def call(delta: Array) -> Array:
            return scale * np.exp(3 * cubic(np.log(delta * (regime.R / regime.h**2))))

        return call

    return Method("inversion", "table of cubics", f"{knots} knots", prepare)


def _inverse(t: Doubles, regime: Regime) -> Doubles:
    """a/h at ln(R delta/h^2) = t."""
    delta = np.exp(t) * regime.h**2 / regime.R
    a: Doubles = contact_law.contact_radius(delta, regime.R, regime.h, regime.b)
    return a / regime.h


def oracle(digits: int, quick: bool = True) -> Method:
    """A root enclosed in balls."""

    def prepare(regime: Regime) -> Call:
        def one(delta: float) -> object:
            r, ar = regime, Balls(digits)
            with ar.context():
                a = contact_balls.contact_radius(delta, r.R, r.h, r.b, digits)
                return 4 * contact_balls.modulus(r.lam, r.mu) * a**3 / (3 * ar.array(r.R))

        return lambda delta: [one(float(x)) for x in np.atleast_1d(delta)]

    return Method(
        "inversion", "enclosed root", f"{digits} digits", prepare, Balls(digits).name,
        one_by_one=True, certified=True, quick=quick,
    )  # fmt: skip
