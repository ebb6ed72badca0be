"""Force over indentation: reversed series, Newton's iteration, table, oracle."""

import math
from typing import Any

import numpy as np
from flint import arb
from mpmath import mp, mpf

from derivation.plate.benchmark.arithmetic import DOUBLE, Arithmetic, Array, BallArithmetic
from derivation.plate.benchmark.by_series import LONG_NUMBERS, BenchmarkLaw, horner
from derivation.plate.benchmark.coefficients import series
from derivation.plate.benchmark.interface import Call, Doubles, Method, Regime, deepest
from derivation.plate.benchmark.law_series import hermite
from derivation.plate.benchmark.law_sums import EXACT, wrapped
from derivation.plate.benchmark.reference_law import sure_law
from derivation.plate.contact.oracle import balls as contact_balls
from generated import contact_law, contact_series
from generated.reversed_series import _reversed

SPAN = 100.0
"""Largest contact radius of a regime's impacts over the smallest one looked at."""


def hertz() -> Method:
    """P = (4/3) E* sqrt(R) delta^(3/2)."""

    def prepare(regime: Regime) -> Call:
        stiff = 4 / 3 * regime.modulus * math.sqrt(regime.R)
        return lambda delta: stiff * (delta * np.sqrt(delta))

    def same(regime: Regime) -> Call:
        with EXACT.context():
            factor = 4 * contact_balls.modulus(regime.lam, regime.mu) / 3
            R = EXACT.array(regime.R)
        return wrapped(EXACT, lambda delta: factor * np.sqrt(R * delta) * delta)

    return Method("inversion", "Hertz", "", prepare, same=same)


def reversed_series(terms: int, ar: Arithmetic = DOUBLE) -> Method:
    """Lagrange's inversion cut off, NaN beyond its radius of convergence."""

    def prepare(regime: Regime) -> Call:
        plates = contact_series.plates_of(np.array([regime.eta]))
        # The generated function seeks the radius anew at every call: here that is set-up.
        radius, generated = _reversed(plates, 0, terms)
        long = ar.digits > DOUBLE.digits
        known = _reversed_balls(regime, terms, radius) if long else list(generated)
        return _lagrange(regime, known, radius, ar)

    def same(regime: Regime) -> Call:
        radius, _ = _reversed(contact_series.plates_of(np.array([regime.eta])), 0, 1)
        return _lagrange(regime, _reversed_balls(regime, terms, radius), radius, EXACT)

    def fails(regime: Regime) -> str | None:
        plates = contact_series.plates_of(np.array([regime.eta]))
        radius, _ = _reversed(plates, 0, 1)
        a = deepest(regime)
        delta = contact_law.indentation(a, regime.R, regime.h, regime.b)
        eps = math.sqrt(delta * regime.R) / regime.h
        if eps < radius:
            return None
        return f"beyond its radius: sqrt(R delta)/h up to {eps:.3g}, radius {radius:.3g}"

    return Method(
        "inversion", "reversed series", f"{terms} terms", prepare, ar.name, same, fails=fails
    )  # fmt: skip


def _lagrange(regime: Regime, coefficients: list[Any], radius: float, ar: Arithmetic) -> Call:
    """(4/3) E* sqrt(R delta) delta (p_0 + p_1 eps + ...), eps = sqrt(R delta)/(h radius) < 1."""
    with ar.context():
        p, R = list(ar.array(coefficients)), ar.array(regime.R)
        reach = ar.array(regime.h) * ar.array(radius)
        lam, mu = ar.array(regime.lam), ar.array(regime.mu)
        stiff = 16 * mu * (lam + mu) / (3 * (lam + 2 * mu))

    def call(delta: Array) -> Array:
        hertz = np.sqrt(delta * R)
        eps = hertz / reach
        return stiff * hertz * delta * horner(p, np.where(eps < 1, eps, ar.array(math.nan)))

    return wrapped(ar, call)


def _reversed_balls(regime: Regime, terms: int, radius: float) -> list[arb]:
    """p_n radius^n = 3/(n + 3) [A^n] (1 + F)^(-(n + 3)/2) radius^n, n < terms."""
    with EXACT.context():
        lifted = [arb(1)]
        for c in series(regime.h, regime.b, max(1, terms // 2), EXACT.digits):
            lifted += [c, arb(0)]
        return [
            3 * _power(lifted, arb(-n - 3) / 2, n) * arb(radius) ** n / (n + 3)
            for n in range(terms)
        ]


def _power(lifted: list[arb], exponent: arb, order: int) -> arb:
    """Coefficient of some order of a power of 1 + ..., by Euler's recurrence."""
    found = [arb(1)]
    for n in range(1, order + 1):
        known = range(1, min(n, len(lifted) - 1) + 1)
        terms = ((exponent * k - (n - k)) * lifted[k] * found[n - k] for k in known)
        found.append(sum(terms, arb(0)) / n)
    return found[order]


def newton(dtype: type[np.float32 | np.float64] = np.float64) -> Method:
    """`force`, the generated code's Newton iteration."""

    def prepare(regime: Regime) -> Call:
        r = regime
        others = [dtype(x) for x in (r.R, r.h, r.b, r.lam, r.mu)]
        return lambda delta: contact_law.force(delta.astype(dtype), *others)

    name = np.dtype(dtype).name
    return Method("inversion", "Newton (production)", "as called", prepare, name, exact=True)


def _knots(regime: Regime, count: int) -> Doubles:
    """ln(R delta/h^2) at equal steps."""
    top = deepest(regime)
    ends = contact_law.indentation(
        np.array([0.999 * top / SPAN, top]), regime.R, regime.h, regime.b
    )
    low, high = np.log(ends * regime.R / regime.h**2).tolist()
    t = np.linspace(low, high, count)
    # The last knot must not lie beyond the largest contact by rounding.
    t[-1] = np.nextafter(t[-1], 0 if t[-1] > 0 else -np.inf)
    return t


def table(knots: int, dtype: type[np.float32 | np.float64] = np.float64) -> Method:
    """Cubics in ln(R delta/h^2) of ln(a/h): equal steps serve all sizes of contact."""

    def prepare(regime: Regime) -> Call:
        t = _knots(regime, knots)
        A = _inverse(t, regime)
        plates = contact_series.plates_of(np.array([regime.eta]))
        F, rise = contact_series.correction_with_slope(A, plates, None)
        columns = t, np.log(A), (1 + F) / (2 * (1 + F) + rise)
        cubic = hermite(*(column.astype(dtype) for column in columns))
        scale = 4 * regime.modulus * regime.h**3 / (3 * regime.R)

        def call(delta: Array) -> Array:
            t = np.log(delta.astype(dtype) * (regime.R / regime.h**2))
            return scale * np.exp(3 * cubic(t))

        return call

    def same(regime: Regime) -> Call:
        law, t = sure_law(regime), _knots(regime, knots)
        return wrapped(LONG_NUMBERS, lambda delta: _cubics_without_rounding(law, t, delta))

    name = np.dtype(dtype).name
    return Method("inversion", "table of cubics", f"{knots} knots", prepare, name, same)


def _cubics_without_rounding(law: BenchmarkLaw, t: Doubles, delta: Array) -> Array:
    """Force by the cubic between the two knots about each indentation."""
    start, step, per_h = mpf(t[0]), (mpf(t[-1]) - mpf(t[0])) / (t.size - 1), law.R / law.h**2
    found = []
    for x in delta:
        place = mp.log(x * per_h)
        first = min(max(int((place - start) / step), 0), t.size - 2)
        ends = np.array([start + first * step, start + (first + 1) * step])
        A = law.share(np.array([mp.exp(end) / per_h for end in ends]))
        logs = np.array([mp.log(y) for y in A])
        bent = hermite(ends, logs, law.lift(A) / (2 * law.slope(A)))(np.array([place]))[0]
        found.append(4 * law.modulus * (law.h * mp.exp(bent)) ** 3 / (3 * law.R))
    return np.array(found)


def _inverse(t: Doubles, regime: Regime) -> Doubles:
    """a/h at ln(R delta/h^2) = t."""
    delta = np.exp(t) * regime.h**2 / regime.R
    a: Doubles = contact_law.contact_radius(delta, regime.R, regime.h, regime.b)
    return a / regime.h


def oracle(digits: int, quick: bool = True) -> Method:
    """A root enclosed in balls."""

    def prepare(regime: Regime) -> Call:
        def one(delta: float) -> object:
            r, ar = regime, BallArithmetic(digits)
            with ar.context():
                a = contact_balls.contact_radius(delta, r.R, r.h, r.b, digits)
                return 4 * contact_balls.modulus(r.lam, r.mu) * a**3 / (3 * ar.array(r.R))

        return lambda delta: [one(float(x)) for x in np.atleast_1d(delta)]

    return Method(
        "inversion", "enclosed root", f"{digits} digits", prepare, BallArithmetic(digits).name,
        one_by_one=True, certified=True, quick=quick,
    )  # fmt: skip
