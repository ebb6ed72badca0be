"""Inversion and impact by the law's power series in a/h, in any arithmetic.

With A = a/h, delta = (h^2/R) A^2 (1 + F), F = A (c_1 + c_3 A^2 + ...). These are methods by
themselves; and, in mpmath with terms enough, truncated methods without their rounding.
"""

from collections.abc import Callable

import flint
import numpy as np
from flint import arb

from derivation.plate.benchmark.arithmetic import DOUBLE, Arithmetic, Array, Mpmath
from derivation.plate.benchmark.coefficients import series
from derivation.plate.benchmark.interface import Call, Method, Regime, deepest
from derivation.plate.benchmark.law_sums import bits_for, wrapped

LONG_NUMBERS = Mpmath(40)
"""What stands for exact arithmetic beside doubles where a root is sought, which balls do not do."""

STEPS = 60


def exact_for(ar: Arithmetic) -> Mpmath:
    """The same beside any arithmetic."""
    return LONG_NUMBERS if ar.digits < LONG_NUMBERS.digits - 5 else Mpmath(ar.digits + 20)


def diverges(regime: Regime) -> str | None:
    """Why the series does not serve a regime's impacts, or None."""
    radius, most = min(4.0, 2 / regime.eta), deepest(regime) / regime.h
    return None if most < radius else f"diverges: a/h up to {most:.3g}, its radius is {radius:g}"


class BenchmarkLaw:
    """The law of a regime's plate in an arithmetic, made in its context, and its inverses.

    Attributes
    ----------
    c, s, e
        Coefficients in `variable` of what A multiplies in `lift`, `slope` and `work`.
    """

    c: list[Array]
    s: list[Array]
    e: list[Array]

    def __init__(self, regime: Regime, ar: Arithmetic) -> None:
        self.R, self.h, self.m = (ar.array(x) for x in (regime.R, regime.h, regime.m))
        lam, mu = ar.array(regime.lam), ar.array(regime.mu)
        self.modulus = 4 * mu * (lam + mu) / (lam + 2 * mu)
        self.top = ar.array(1.05 * deepest(regime) / regime.h)
        self.close = 10.0 ** (-0.6 * ar.digits)

    def variable(self, A: Array) -> Array:
        """What the polynomials are in."""
        return A * A

    def lift(self, A: Array) -> Array:
        """delta R/a^2 = 1 + F."""
        return 1 + A * horner(self.c, self.variable(A))

    def slope(self, A: Array) -> Array:
        """S = (R/2a) d delta/da."""
        return 1 + A * horner(self.s, self.variable(A))

    def work(self, A: Array) -> Array:
        """Stored energy over that on a half-space: 5/A^5 int_0^A x^4 S dx."""
        return 1 + A * horner(self.e, self.variable(A))

    def quotient(self, A: Array, q: Array) -> Array:
        """(1 - W(q A)/W(A))/(1 - q) of the stored energy W."""
        raise NotImplementedError

    def share(self, delta: Array) -> Array:
        """A at indentations above 0."""
        goal = delta * self.R / (self.h * self.h)

        def miss(A: Array) -> tuple[Array, Array]:
            return A * A * self.lift(A) - goal, 2 * A * self.slope(A)

        return self.root(np.sqrt(goal), miss)

    def largest(self, v0: Array) -> Array:
        """A where a sphere of speed v0 stops: its energy is stored."""
        h5 = self.h * self.h * self.h * self.h * self.h
        goal = 3 * self.m * v0 * v0 * self.R * self.R / (16 * self.modulus * h5)

        def miss(A: Array) -> tuple[Array, Array]:
            square = A * A
            fourth = square * square
            return fourth * A * self.work(A) / 5 - goal, fourth * self.slope(A)

        return self.root((5 * goal) ** 0.2, miss)

    def root(self, start: Array, miss: Callable[[Array], tuple[Array, Array]]) -> Array:
        """Newton's iteration, from no more than the largest contact there is."""
        A = np.minimum(start, self.top)
        for _ in range(STEPS):
            value, slope = miss(A)
            step = value / slope
            A = np.minimum(np.maximum(A - step, 0.3 * A), self.top)
            if not (abs(step) > self.close * A).any():
                break
        return A

    def force(self, delta: Array) -> Array:
        """P = 4 E* a^3/(3 R)."""
        a = self.share(delta) * self.h
        return 4 * self.modulus * a * a * a / (3 * self.R)


class SeriesLaw(BenchmarkLaw):
    """By the power series in a/h, cut off."""

    def __init__(self, regime: Regime, terms: int, ar: Arithmetic) -> None:
        super().__init__(regime, ar)
        digits = max(40, ar.digits + 5)
        self.c = list(ar.array(series(regime.h, regime.b, terms, digits)))
        self.s = [c * (2 * k + 3) / 2 for k, c in enumerate(self.c)]
        self.e = [5 * s / (2 * k + 6) for k, s in enumerate(self.s)]

    def quotient(self, A: Array, q: Array) -> Array:
        """With W = q^5 + sum e q^(2k+6) its terms are sums of the e that follow."""
        square, power, e = A * A, A, []
        for coefficient in self.e:
            e.append(coefficient * power)
            power = power * square
        tails = list(np.cumsum(np.array(e[::-1]), axis=0)[::-1])
        rest = tails[0] + q * (1 + q) * horner([*tails[1:], 0 * A], q * q)
        return (1 + q * (1 + q * (1 + q * (1 + q)))) + q**5 * rest / (1 + tails[0])


def horner(coefficients: list[Array], x: Array) -> Array:
    """A polynomial."""
    value = coefficients[-1] + 0 * x
    for coefficient in coefficients[-2::-1]:
        value = value * x + coefficient
    return value


def inverse(terms: int, ar: Arithmetic) -> Callable[[Regime], Call]:
    """Force over indentation by so many terms, prepared for a regime."""

    def prepare(regime: Regime) -> Call:
        with ar.context():
            return wrapped(ar, SeriesLaw(regime, terms, ar).force)

    return prepare


def newton(terms: int, ar: Arithmetic = DOUBLE) -> Method:
    """Newton's iteration on the series."""
    return Method(
        "inversion", "Newton, small-a series", f"{terms} terms", inverse(terms, ar), ar.name,
        inverse(terms, exact_for(ar)), diverges, ar.wide,
    )  # fmt: skip


def duration(
    nodes: int, made: Callable[[Regime, Arithmetic], BenchmarkLaw], ar: Arithmetic
) -> Callable[[Regime], Call]:
    """Contact time over speed by a law and so many Gauss-Legendre nodes, prepared for a regime.

    At a contact radius q a_m, q = 1 - u^2, and with W(q) the energy stored there,
    T = 8 h^2 A^2/(R v0) int_0^1 q S(q A)/sqrt(H(q)) du, H = (1 - W(q)/W(1))/(1 - q).
    """

    def prepare(regime: Regime) -> Call:
        with flint.ctx.workprec(bits_for(ar)):
            rule = [arb.legendre_p_root(nodes, k, weight=True) for k in range(nodes)]
            places, weights = [(1 + x) / 2 for x, _ in rule], [w / 2 for _, w in rule]
        with ar.context():
            law, u, w = made(regime, ar), ar.array(places), ar.array(weights)

            def call(v0: Array) -> Array:
                A = law.largest(v0)
                q = 1 - u * u
                slope = q * law.slope(A[:, None] * q)
                integral = (w * slope / np.sqrt(law.quotient(A[:, None], q))).sum(axis=1)
                return 8 * law.h * law.h * A * A * integral / (law.R * v0)

            return wrapped(ar, call)

    return prepare


def gauss(nodes: int, terms: int, ar: Arithmetic = DOUBLE) -> Method:
    """Gauss-Legendre on the series."""

    def made(regime: Regime, ar: Arithmetic) -> BenchmarkLaw:
        return SeriesLaw(regime, terms, ar)

    return Method(
        "impact", "Gauss-Legendre, small-a series", f"{nodes} nodes, {terms} terms",
        duration(nodes, made, ar), ar.name, duration(nodes, made, exact_for(ar)), diverges,
        ar.wide,
    )  # fmt: skip
