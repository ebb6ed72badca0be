"""The paper's motion as printed: truncated gamma_k, xi_k, linear term and first correction.

For figures and comparison only. The sums diverge, so every number here depends
on where they are cut off; that is what the figures show.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros
from generated.influence import K_j

Array = NDArray[np.float64]


class Case(Protocol):
    """Sphere and plate of an impact: R, h, b [m], m [kg], v0 [m/s], lam, mu [Pa]."""

    @property
    def R(self) -> float: ...  # noqa: D102
    @property
    def m(self) -> float: ...  # noqa: D102
    @property
    def v0(self) -> float: ...  # noqa: D102
    @property
    def h(self) -> float: ...  # noqa: D102
    @property
    def b(self) -> float: ...  # noqa: D102
    @property
    def lam(self) -> float: ...  # noqa: D102
    @property
    def mu(self) -> float: ...  # noqa: D102


def plane_strain_modulus(case: Case) -> float:
    """E* = 4 mu (lam + mu)/(lam + 2 mu) of the plate [Pa]."""
    return 4 * case.mu * (case.lam + case.mu) / (case.lam + 2 * case.mu)


def truncated_gamma(case: Case, k: int, modes: int) -> float:
    """gamma_k of (10), its divergent sum cut off after `modes` modes.

    The factor (a/P^(1/3))^(2k-1) follows from (7): a^3/P = 3R/(4E*).
    """
    zeros, J1 = bessel_j0_zeros(modes), bessel_j1_at_j0_zeros(modes)
    phi = zeros / case.b
    total = np.sum(phi ** (2 * k - 1) * K_j(phi, case.h, case.b, case.R, J1))
    radius = (3 * case.R / (4 * plane_strain_modulus(case))) ** ((2 * k - 1) / 3)
    return float((-1) ** k * (2 * k - 2) / _factorial(2 * k - 1) * radius * total)


def _factorial(n: int) -> float:
    return float(np.prod(np.arange(1, n + 1, dtype=np.float64)))


@dataclass(frozen=True)
class PrintedMotion:
    """Coefficients xi_2, xi_3 of (10) with their sums cut off, and the motion they give."""

    case: Case
    xi_2: float
    xi_3: float

    @property
    def contact_time(self) -> float:
        """Contact time 2 t_c of the linear term (15) [s]."""
        return float(np.pi * np.sqrt(self.case.m / self.xi_2))

    def linear(self, t: Array) -> Array:
        """delta_0(t) of (15) [m]."""
        rate = np.sqrt(self.xi_2 / self.case.m)
        return np.asarray(self.case.v0 / rate * np.sin(rate * t))

    def radicand(self, delta: Array) -> Array:
        """What stands under the second root of (18) [m^2/s^2]; negative where (17) breaks."""
        m = self.case.m
        return (
            self.case.v0**2
            - self.xi_2 / m * delta**2
            - 3 * self.xi_3 / (4 * m) * np.cbrt(delta) ** 8
        )

    def corrected(self, t: Array) -> Array:
        """delta_0 + eta of (14)-(18) [m], by the trapezoidal rule on (16); NaN once it breaks.

        `t` runs from 0 in small steps.
        """
        m, delta = self.case.m, self.linear(t)
        radicand = self.radicand(delta)
        alive = np.logical_and.accumulate(radicand > 0)
        speed = np.sqrt(np.where(alive, radicand, 1.0))
        slope = np.sqrt(np.maximum(self.case.v0**2 - self.xi_2 / m * delta**2, 0.0))
        F = delta * (self.xi_2 + self.xi_3 * np.cbrt(delta) ** 2) / (m * speed)
        growth = np.exp(_integral(np.where(alive, F, 0.0), t))
        eta = -_integral(np.where(alive, (slope - speed) * growth, 0.0), t) / growth
        return np.where(alive, delta + eta, np.nan)

    @property
    def breaks_at(self) -> float:
        """Time at which the radicand of (17), (18) vanishes [s]; NaN if it never does.

        On the way up delta_0 is monotonous in t, so that bisection on the
        indentation finds it.
        """
        peak = self.case.v0 * np.sqrt(self.case.m / self.xi_2)
        low, high = 0.0, float(peak)
        if self.radicand(np.asarray(high)) >= 0:
            return float("nan")
        for _ in range(60):
            middle = (low + high) / 2
            if self.radicand(np.asarray(middle)) > 0:
                low = middle
            else:
                high = middle
        rate = np.sqrt(self.xi_2 / self.case.m)
        return float(np.arcsin(low / peak) / rate)


def _integral(values: Array, t: Array) -> Array:
    """Running integral by the trapezoidal rule, zero at the first point."""
    steps = np.diff(t) * (values[1:] + values[:-1]) / 2
    return np.concatenate([[0.0], np.cumsum(steps)])


def printed_motion(case: Case, modes: int, *, corrected: bool = False) -> PrintedMotion:
    """The paper's coefficients with the sums cut off after `modes` modes.

    With `corrected`, xi_3 = -gamma_3/gamma_2^(8/3) instead of the printed
    -gamma_3/gamma_2^3.
    """
    gamma_2 = truncated_gamma(case, 2, modes)
    gamma_3 = truncated_gamma(case, 3, modes)
    power = 8 / 3 if corrected else 3
    return PrintedMotion(case, 1 / gamma_2, -gamma_3 / gamma_2**power)
