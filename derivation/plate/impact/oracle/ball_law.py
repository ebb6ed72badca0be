"""A plate's law for the Arb reference: a power series if possible and faster, else integrals.

Run times were measured on one idle core. On other processors they are accurate within a factor of
two or three, which is sufficient for the choice and for the announced time.
"""

import math
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple, Protocol

import flint
from flint import acb, arb

from derivation.engine.formula.ball import LOG2_10, to_ball
from derivation.plate.contact.oracle import points as contact_points
from derivation.plate.contact.oracle.balls import modulus, ratio_of, refine_to_digits
from derivation.plate.contact.oracle.sums import excess, excess_bound, hankel_bound

Progress = Callable[[str, int, int], None]
"""Called with the current task, the index of the current part, and the number of parts."""


class BallLaw(Protocol):
    """The plate's correction of Hertz's law up to a/b = `reach`, at the current precision."""

    @property
    def reach(self) -> arb:
        """Largest a/b [1] for which the law can be evaluated."""

    def excess(self, name: str, alpha: arb) -> arb:
        """Return `contact.oracle.sums.excess` at alpha = a/b [1]."""

    def slope(self, alpha: arb) -> tuple[flint.arb_poly, arb]:
        """Return exact coefficients of p(t), and a bound of p's error on [0, 1].

        (R/2a) d delta/da = 1 + q p(q^2) at a = q alpha b.
        """


class Integrals(NamedTuple):
    """The law of a plate of h/b = eta by the integrals of `sums`, for any contact."""

    eta: Fraction

    @property
    def reach(self) -> arb:
        """Edge of the plate, alpha = 1."""
        return arb(1)

    def excess(self, name: str, alpha: arb) -> arb:
        """Return `contact.oracle.sums.excess`."""
        return excess(name, alpha, self.eta)

    def slope(self, alpha: arb) -> tuple[flint.arb_poly, arb]:
        """Return the same as `BallLaw.slope`."""
        return _slope_polynomial(alpha, self.eta)


def law_of(
    eta: Fraction, reach: float, digits: int, progress: Progress = lambda *_: None
) -> Callable[[int], BallLaw]:
    """Return the law of the Arb reference: a power series if possible and faster.

    Parameters
    ----------
    eta
        h/b [1].
    reach
        Largest a/b [1] at which it is evaluated.
    digits
        Number of digits, which determines the faster method.
    progress
        Called with each task and, for zeros of J0, with the index of each.
    """
    if not by_series(float(eta), reach, digits):
        progress("Arb: integrals", 1, 1)
        return lambda _: Integrals(eta)

    def law(bits: int) -> BallLaw:
        contact_points.prepare(eta, reach, bits, lambda k, n: progress("Arb: zeros of J0", k, n))
        progress("Arb: power series", 1, 1)
        return contact_points.series(eta, reach, bits)

    return law


def static_contact(
    a: float, R: float, b: float, lam: float, mu: float, law: Callable[[int], BallLaw], digits: int
) -> tuple[arb, ...]:
    """Return indentation [m] and stiffness [N/m] at a contact radius [m]."""
    alpha = ratio_of(a, b)

    def compute(bits: int) -> tuple[arb, arb]:
        known, x = law(bits), to_ball(alpha)
        delta = to_ball(a) ** 2 / to_ball(R) * (1 + known.excess("hertz", x))
        return delta, 2 * modulus(lam, mu) * to_ball(a) / (1 + known.excess("sinc", x))

    return refine_to_digits(compute, digits, f"the law at {a}")


def by_series(eta: float, reach: float, digits: int) -> bool:
    """Return whether the Arb reference uses the power series."""
    if reach > 4 * contact_points.DEEPEST * eta:
        return False
    return series_seconds(eta, digits) < integrals_seconds(digits)


def first_seconds(eta: float, reach: float, digits: int) -> float:
    """Return the approximate run time of the Arb reference [s]."""
    return (
        series_seconds(eta, digits) if by_series(eta, reach, digits) else integrals_seconds(digits)
    )


def series_seconds(eta: float, digits: int) -> float:
    """Return the approximate run time of the power series [s]."""
    modes = contact_points.mode_count(eta, math.ceil(digits * LOG2_10))
    return 0.5 + modes * (3e-4 + 0.02 * (digits / 1000) ** 2) + 50 * (digits / 1000) ** 3


def integrals_seconds(digits: int) -> float:
    """Return the approximate run time of the integrals [s]."""
    return 2 + 220 * (digits / 300) ** 3


def _size(alpha: float, eta: float) -> tuple[float, float]:
    """Return rho of the largest allowed ellipse for L[sinc] in q, foci +-1, and alpha B.

    With half-axes A and B, |Im(alpha z q)| <= alpha (sqrt(A^2 + 4 B^2) y + B) on the ray, where the
    factor of y must be below 1.8, and <= alpha B x on the axis, where that of x must be below
    3.2 eta.
    """
    low, high = 1.0, 1e3
    for _ in range(60):
        rho = (low + high) / 2
        A, B = (rho + 1 / rho) / 2, (rho - 1 / rho) / 2
        fits = alpha * math.hypot(A, 2 * B) < 1.8 and alpha * B < 3.2 * eta
        low, high = (rho, high) if fits else (low, rho)
    return low, alpha * (low - 1 / low) / 2


def _ellipse_bound(alpha: arb, eta: arb, rate: arb) -> arb:
    """Return a bound of |4 alpha/pi L[sinc]| on that ellipse.

    On the axis for T <= 3 the exponential is below e^4.8 < 122 and the excess at most 180 * 13/T^6;
    for T >= 3 it is below 4.9 e^(-2T) (1 + T + T^2), so that the integral with e^(1.6 T) is below
    159. On the ray |H/J0| <= 3 e^(-2y) for |z| >= 4, y >= 1; for y < 2 it is bounded by balls, with
    e^4 for e^(-2y).
    """
    pieces = (arb((2 * k + 1) * arb(1) / 200, arb(1) / 200) for k in range(200))
    near = arb(3)
    for y in pieces:
        near = near.max(hankel_bound(acb(1 + 2 * y, y)) * arb(4).exp())
    side = rate.exp() / 2
    axis = (122 * 468 / (2 * eta) ** 6 + 159 / (2 * eta)) / 2
    ray = arb(5).sqrt() / 2 * near * rate.exp() * 5 * (1 + excess_bound(2 * eta))
    return (4 * alpha / arb.pi() * (side + axis + ray)).abs_upper()


def _slope_polynomial(alpha: arb, eta: Fraction) -> tuple[flint.arb_poly, arb]:
    """Return exact coefficients of p(t), S(q) = 1 + q p(q^2) on [0, 1], and a bound of p's error.

    L[sinc] is even in alpha, hence analytic in t = q^2 inside an ellipse of parameter rho^2, foci 0
    and 1. The error of interpolation at n + 1 Chebyshev nodes is at most 4 M rho^(-2n)/(rho^2 - 1).
    Errors of the values (taken at their midpoints) are amplified at most by (2/pi)
    log(n + 1) + 1 (Trefethen, ATAP, 8.2 and 15.2).
    """
    bits = flint.ctx.prec
    root, rate = _size(float(alpha), float(eta))
    rho = arb(root) ** 2
    bound = _ellipse_bound(alpha, to_ball(eta), arb(rate) * (1 + arb(2) ** -40))
    n = 2 + math.ceil((bits * math.log(2) + max(0.0, float(bound.log()))) / float(rho.log()))
    count, error = n + 1, 4 * bound * rho**-n / (rho - 1)
    xs = [arb.cos_pi_fmpq(flint.fmpq(2 * i + 1, 2 * count)) for i in range(count)]
    values = [excess("sinc", alpha * ((1 + x) / 2).sqrt(), eta) / ((1 + x) / 2).sqrt() for x in xs]
    widest = max((value.rad() for value in values), key=float)
    error += widest * (2 / arb.pi() * arb(count).log() + 1)
    with flint.ctx.workprec(bits + 4 * count + 64):
        polynomial = flint.arb_poly([0])
        before, now = flint.arb_poly([1]), flint.arb_poly([-1, 2])
        for k in range(count):
            cosines = (
                arb.cos_pi_fmpq(flint.fmpq(k * (2 * i + 1), 2 * count)) for i in range(count)
            )
            coefficient = sum((v.mid() * c for v, c in zip(values, cosines, strict=True)), arb(0))
            polynomial += before * (coefficient * (2 if k else 1) / count)
            before, now = now, flint.arb_poly([-2, 4]) * now - before
        return polynomial, error.abs_upper()
