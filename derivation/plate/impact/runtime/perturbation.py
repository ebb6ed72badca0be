"""The paper's own equations of motion, (14) to (18): for comparison only.

The sums of (10) diverge, so every result depends on the number of terms. The correction (16)
ends where the radicand of (17) and (18) vanishes. This is before the turning point, because
xi_3 > 0 for every number of modes. Up to there the indentation grows, so that (14) has neither
a turning point nor a contact time of its own. One impact is computed at a time.

With s = delta_0/delta_max, delta_max the largest indentation of the linear motion, and
s = last (1 - u^2)^3, where u = 0 at the zero of the radicand, the integrands of (16) are smooth.

Arithmetic: sums over modes; Newton's iteration; the change of variable, and the quadrature on
successively smaller parts of its range.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import leggauss, legint, legval, legvander
from numpy.typing import ArrayLike

from generated.arrays import Double, as_doubles, as_result, inside, quiet
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros
from generated.influence import K_j
from generated.motion_kernels import (
    coefficients,
    cosine_at_end,
    end_of_radicand,
    excess_at_turn,
    radius_cubed,
    turning_point,
)
from generated.perturbation_kernels import integrands, linear, mode_terms

_NODES = 24  # number of Gauss nodes on each part
_PARTS = 27  # [1/2, 1], [1/4, 1/2], ..., [0, 2^-26] of u, for a radicand that vanishes late
_STEPS = 60  # largest number of Newton steps; four to ten are usual


@dataclass(frozen=True)
class PrintedMotion:
    """Motion under the first two terms of the paper's force, m delta'' + P = 0.

    Formula::

        P = xi_2 delta + xi_3 delta^(5/3)

    Attributes
    ----------
    m
        Sphere mass [kg].
    v0
        Impact speed of the sphere [m/s].
    xi_2, xi_3
        Coefficients of (10), their sums truncated [N/m, N/m^(5/3)].
    """

    m: float
    v0: float
    xi_2: float
    xi_3: float

    @property
    @quiet
    def contact_time(self) -> float:
        """Contact time 2 t_c of the linear term, (15) [s]."""
        return float(turning_point(np.float64(self.m), self.v0, self.xi_2)[0])

    @property
    @quiet
    def max_indentation(self) -> float:
        """Largest indentation of the linear term, (15) [m]."""
        return float(turning_point(np.float64(self.m), self.v0, self.xi_2)[1])

    @property
    @quiet
    def excess(self) -> float:
        """Radicand of (17), (18) at the linear motion's turning point, divided by -v0^2 [1]."""
        return float(excess_at_turn(*np.array((self.m, self.v0, self.xi_2, self.xi_3))))

    @property
    def last(self) -> float:
        """Ratio of delta_0 to its largest value where the radicand of (17), (18) vanishes [1].

        Newton's iteration for y^3 + excess y^4 = 1, s^2 = y^3, convex, starts above the root.
        """
        excess = self.excess
        y = min(1.0, excess**-0.25) if excess > 0.0 else np.nan
        for _ in range(_STEPS):
            value, slope = end_of_radicand(y, excess)
            step = value / slope
            y -= step
            if not step > 1e-16 * y:
                break
        return float(np.sqrt(y * y * y))

    @property
    def valid_until(self) -> float:
        """Time at which the radicand of (17), (18) vanishes [s]; later, (16) is not real."""
        return self.valid_fraction / 2 * self.contact_time

    @property
    def valid_fraction(self) -> float:
        """Time `valid_until` divided by t_c, the turning time of the linear motion [1]."""
        s = self.last
        return float(np.arctan2(s, cosine_at_end(self.excess, s))) / (np.pi / 2)

    @quiet
    def linear(self, t: ArrayLike) -> np.ndarray:
        """Compute the indentation delta_0 of the linear term.

        Formula derived for equation (15) of the paper::

            delta_0 = v0 sqrt(m/xi_2) sin(sqrt(xi_2/m) t)

        Parameters
        ----------
        t : array_like
            time since first contact [s]

        Returns
        -------
        float or ndarray
            delta_0 [m] in the shape of t.
        """
        kind, [t] = as_doubles(t)
        return as_result(linear(t, *np.array((self.m, self.v0, self.xi_2))), kind)

    @quiet
    def corrected(self, t: ArrayLike) -> np.ndarray:
        """Compute the indentation with the first correction, (14).

        Formulas derived for equations (16) to (18) of the paper::

            delta = delta_0 + eta,  eta = -exp(-S) int G exp(S) dt,  S = int F dt
            F = (xi_2 delta_0 + xi_3 delta_0^(5/3))/(m V),  G = V_0 - V
            V^2 = V_0^2 - 3 xi_3 delta_0^(8/3)/(4 m),  V_0^2 = v0^2 - xi_2 delta_0^2/m

        Parameters
        ----------
        t : array_like
            time since first contact [s]; 0 <= t <= valid_until

        Returns
        -------
        float or ndarray
            delta [m] in the shape of t; NaN outside the domain. The integrals are accurate to
            1e-14 of the largest indentation.
        """
        kind, [t] = as_doubles(t)
        [t] = inside([t], t >= 0, t <= self.valid_until)
        s = self.linear(t) / self.max_indentation
        u = np.sqrt(np.maximum(1.0 - np.cbrt(s / self.last), 0.0))
        return as_result(self.max_indentation * (s + self._eta(u)), kind)

    def _eta(self, u: Double) -> Double:
        """Return the correction eta divided by the linear motion's largest indentation."""
        nodes, weights = leggauss(_NODES)
        ends = np.append(0.5 ** np.arange(_PARTS), 0.0)
        middle, half = (ends[:-1] + ends[1:]) / 2, (ends[:-1] - ends[1:]) / 2
        F, G = integrands(
            middle[:, None] + half[:, None] * nodes, *np.array((self.excess, self.last))
        )
        series = legvander(nodes, _NODES - 1) * weights[:, None] * (np.arange(_NODES) + 0.5)

        def integral(values: Double) -> tuple[Double, Double]:
            """Return the Legendre series on each part, integrated from its upper end and from 1."""
            parts = -half * legint((values @ series).T, lbnd=1.0)
            return np.append(0.0, np.cumsum(legval(-1.0, parts))[:-1]), parts

        begun, parts = integral(F)
        start, pieces = integral(G * np.exp(begun[:, None] + legval(nodes, parts)))
        _, power = np.frexp(u)
        part = np.where(u > 0.0, np.maximum(-power, 0), _PARTS - 1)
        place = (u - middle[part]) / half[part]
        growth = begun[part] + legval(place, parts[:, part], tensor=False)
        total = start[part] + legval(place, pieces[:, part], tensor=False)
        return -total * np.exp(-growth)


@np.errstate(all="ignore")  # overflow results in NaN
def printed_motion(
    R: float,
    m: float,
    v0: float,
    h: float,
    b: float,
    lam: float,
    mu: float,
    modes: int,
    *,
    corrected: bool = False,
) -> PrintedMotion:
    """Compute the paper's motion with truncated sums.

    Equation (10) of the paper, with the derived K_j::

        gamma_k = (-1)^k (2k-2)/(2k-1)! (a/P^(1/3))^(2k-1) sum over j of phi_j^(2k-1) K_j
        xi_2 = 1/gamma_2,  xi_3 = -gamma_3/gamma_2^3

    Parameters
    ----------
    R, h, b : float
        sphere radius, half the plate's thickness and its radius [m]; above 0
    m : float
        sphere mass [kg]; m > 0
    v0 : float
        impact speed of the sphere [m/s]; v0 > 0
    lam, mu : float
        Lame constants [Pa]; mu > 0, 3 lam > -2 mu
    modes : int
        number of modes after which the divergent sums are truncated; at least 1
    corrected : bool
        use xi_3 = -gamma_3/gamma_2^(8/3), as derived, instead of the published formula, which
        is dimensionally inconsistent: its value depends on the units, here those of the arguments

    Returns
    -------
    PrintedMotion
        Its numbers are NaN outside the domain, and where a coefficient is not a positive double.

    Examples
    --------
    >>> from generated.perturbation import printed_motion
    >>> motion = printed_motion(0.01, 0.0327, 2.0, 0.004, 0.15, 22.5e9, 28.7e9, 100)
    >>> print(f"{motion.contact_time:.6g}")
    0.000308833
    """
    zeros, J1 = bessel_j0_zeros(modes), bessel_j1_at_j0_zeros(modes)
    phi = zeros / b
    K = K_j(phi, h, b, R, J1)
    elastic = mu > 0 and 3 * lam > -2 * mu
    cubed = radius_cubed(R, *map(np.float64, (lam, mu) if elastic else (np.nan, np.nan)))
    xi_2, derived, printed = coefficients(*map(np.sum, mode_terms(phi, K, np.cbrt(cubed))))
    motion = PrintedMotion(m, v0, float(xi_2), float(derived if corrected else printed))
    known = (m, v0, motion.xi_2, motion.xi_3, motion.max_indentation)
    if all(0 < x < np.inf for x in known):
        return motion
    return PrintedMotion(np.nan, np.nan, np.nan, np.nan)
