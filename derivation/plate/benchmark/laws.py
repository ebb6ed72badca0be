"""Inversion and impact from the power series of the contact law in a/h, in any arithmetic.

With A = a/h, delta = (h^2/R) A^2 (1 + F), F = A (c_1 + c_3 A^2 + ...). The truncated series is a
method of the benchmark. With all terms and many digits, it represents the law without rounding.
"""

from collections.abc import Callable

import flint
import numpy as np
from flint import arb

from derivation.plate.benchmark.arithmetic import DOUBLE, Arithmetic, Array, horner
from derivation.plate.benchmark.coefficients import coefficients, exact_law
from derivation.plate.benchmark.interface import BenchmarkCase, Call, Method, largest_contact_radius

STEPS = 60


def diverges(case: BenchmarkCase) -> str | None:
    """Return why the series cannot be used for a test case's impacts, or None."""
    radius, most = min(4.0, 2 / case.eta), largest_contact_radius(case) / case.h
    if most < radius:
        return None
    return f"diverges: a/h up to {most:.3g}, radius of convergence {radius:g}"


class SeriesLaw:
    """The contact law of a test case in an arithmetic, and its inverse functions.

    Without a number of terms it is the whole law, to forty digits.
    """

    def __init__(self, case: BenchmarkCase, ar: Arithmetic, terms: int | None = None) -> None:
        factors = (
            exact_law(case) if terms is None else coefficients(case, terms, ar.constants)
        )  # fmt: skip
        self.R, self.h, self.m = (ar.number(x) for x in (case.R, case.h, case.m))
        lam, mu = ar.number(case.lam), ar.number(case.mu)
        self.modulus = 4 * mu * (lam + mu) / (lam + 2 * mu)
        self.top = ar.number(1.05 * largest_contact_radius(case) / case.h)
        self.close = 10.0 ** (-0.6 * ar.digits)
        self.c = list(ar.array(factors))
        self.s = [c * (2 * k + 3) / 2 for k, c in enumerate(self.c)]
        self.e = [5 * s / (2 * k + 6) for k, s in enumerate(self.s)]

    def lift(self, A: Array) -> Array:
        """Return delta R/a^2 = 1 + F."""
        return 1 + A * horner(self.c, A * A)

    def slope(self, A: Array) -> Array:
        """Return S = (R/2a) d delta/da."""
        return 1 + A * horner(self.s, A * A)

    def quotient(self, A: Array, q: Array) -> Array:
        """Return (1 - W(q A)/W(A))/(1 - q) of the stored energy W.

        With W = q^5 + sum e_k q^(2k+6) the coefficients of the quotient are sums of the later e_k.
        """
        square, power, e = A * A, A, []
        for coefficient in self.e:
            e.append(coefficient * power)
            power = power * square
        tails = list(np.cumsum(np.array(e[::-1]), axis=0)[::-1])
        rest = tails[0] + q * (1 + q) * horner([*tails[1:], 0 * A], q * q + 0 * A)
        return (1 + q * (1 + q * (1 + q * (1 + q)))) + q**5 * rest / (1 + tails[0])

    def radius_ratio(self, delta: Array) -> Array:
        """Return A = a/h at indentations [m] above 0."""
        goal = delta * self.R / (self.h * self.h)

        def miss(A: Array) -> tuple[Array, Array]:
            return A * A * self.lift(A) - goal, 2 * A * self.slope(A)

        return self._root(np.sqrt(goal), miss)

    def force(self, delta: Array) -> Array:
        """Return P = 4 E* a^3/(3 R) at indentations [m]."""
        a = self.radius_ratio(delta) * self.h
        return 4 * self.modulus * a * a * a / (3 * self.R)

    def largest(self, v0: Array) -> Array:
        """Return A = a/h at which a sphere of speed v0 [m/s] stops."""
        h5 = self.h * self.h * self.h * self.h * self.h
        goal = 3 * self.m * v0 * v0 * self.R * self.R / (16 * self.modulus * h5)

        def miss(A: Array) -> tuple[Array, Array]:
            fourth = A * A * A * A
            work = 1 + A * horner(self.e, A * A)
            return fourth * A * work / 5 - goal, fourth * self.slope(A)

        return self._root((5 * goal) ** 0.2, miss)

    def _root(self, start: Array, miss: Callable[[Array], tuple[Array, Array]]) -> Array:
        """Return a root by Newton's iteration, limited to the largest contact."""
        A = np.minimum(start, self.top)
        for _ in range(STEPS):
            value, slope = miss(A)
            step = value / slope
            A = np.minimum(np.maximum(A - step, 0.3 * A), self.top)
            if not (abs(step) > self.close * A).any():
                break
        return A

    def duration(self, nodes: int, ar: Arithmetic) -> Call:
        """Return the contact time as a function of speed, by this number of Gauss-Legendre nodes.

        At a contact radius q a_m, q = 1 - u^2, and with W(q) the energy stored there,
        T = 8 h^2 A^2/(R v0) int_0^1 q S(q A)/sqrt(H(q)) du, H = (1 - W(q)/W(1))/(1 - q).
        """
        with flint.ctx.workprec(ar.bits):
            rule = [arb.legendre_p_root(nodes, k, weight=True) for k in range(nodes)]
            u, w = ar.array([(1 + x) / 2 for x, _ in rule]), ar.array([w / 2 for _, w in rule])

        def call(v0: Array) -> Array:
            A = self.largest(v0)
            q = 1 - u * u
            slope = q * self.slope(A[:, None] * q)
            integral = (w * slope / np.sqrt(self.quotient(A[:, None], q))).sum(axis=1)
            return 8 * self.h * self.h * A * A * integral / (self.R * v0)

        return call


def newton(terms: int, ar: Arithmetic = DOUBLE) -> Method:
    """Return the method of Newton's iteration on the power series."""

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        return SeriesLaw(case, ar, terms).force

    return Method("inversion", "Newton, series in a/h", f"{terms} terms", prepare, ar,
                  fails=diverges)  # fmt: skip


def gauss(nodes: int, terms: int, ar: Arithmetic = DOUBLE) -> Method:
    """Return the method of Gauss-Legendre quadrature on the power series."""

    def prepare(case: BenchmarkCase, ar: Arithmetic) -> Call:
        return SeriesLaw(case, ar, terms).duration(nodes, ar)

    return Method("impact", "Gauss-Legendre, series in a/h", f"{nodes} nodes, {terms} terms",
                  prepare, ar, fails=diverges)  # fmt: skip
