"""Arb reference of kappa_n and M_k at any index: certified integrals near the integrand's peak.

The product of a power and e^(-2y) has its peak near half the power; the width of the peak is about
the square root of the power. There the integrand is divided by its peak value and integrated in
ball arithmetic; the integrals over the rest of the axis are bounded. For low index the plain
integrals of `balls` are used.
"""

import math
from collections.abc import Callable
from functools import cache

import flint
from flint import acb, arb

from derivation.engine.formula.ball import LOG2_10
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle.balls import refine_to_digits, scaled_i0

LOW_KAPPA, LOW_FINITE_PART = 16, 128
"""Largest powers of the integration variable for which the plain integrals are used."""

_SPARE = 8

NEAR_ZERO = flint.arb(2) ** -20
"""Left end of the integral for kappa_n, unless the peak is far from it; 3 for M_k."""


def kappa_ratio(n: int, bits: int) -> arb:
    """Return kappa_n 2^(n+1)/(pi n!) as a ball with a relative radius below 2^-bits."""
    if n < 0:
        raise ValueError(f"moments are counted from 0, got {n}")
    return _kappa_ratio(n, bits + _SPARE)


def kappa(n: int, bits: int) -> arb:
    """Return kappa_n as a ball with a relative radius below 2^-bits."""
    ratio = kappa_ratio(n, bits)
    with flint.ctx.workprec(bits + 4 * _SPARE):
        return ratio * arb.pi() * arb(n + 1).gamma() / arb(2) ** (n + 1)


@cache
def _kappa_ratio(n: int, bits: int) -> arb:
    digits = math.ceil(bits / LOG2_10)
    if n <= LOW_KAPPA:
        value = contact_balls.kappa(n, digits + 1)
        with flint.ctx.workprec(bits + 4 * _SPARE):
            return value * arb(2) ** (n + 1) / (arb.pi() * math.factorial(n))
    return refine_to_digits(lambda _: (_far_kappa(n),), digits, f"the ratio of kappa_{n}")[0]


def _far_kappa(n: int) -> arb:
    """Return the ratio from kappa_n = int_0^oo y^n/I0^2 dy/(n+1).

    y^n/I0^2 <= 9 (y^n + y^(n+1)) e^(-2y): I0 >= e^y/(3 sqrt y) from y = 1 on (`balls.kappa`), and
    I0 >= 1 >= e^y/3 below. Outside the interval, y^p e^(-2y) is bounded by its values at the ends:
    it increases up to p/2, and then its logarithm decreases at the rate 2 - p/y.
    """

    def shape(y: acb) -> acb:
        return 1 / scaled_i0(y) ** 2

    left, right, scale = _window(n, NEAR_ZERO)
    peak = _body(n, shape, left, right, scale)
    outside = arb(0)
    for p in (n, n + 1):
        outside += 9 * left * _size(p, left, scale)
        outside += 9 * _size(p, right, scale) / (2 - p / right)
    total = peak + arb(0, outside.abs_upper())
    # 2^(n+1)/(pi (n+1)!) e^scale.
    return total * (scale + (n + 1) * arb(2).log() - arb(n + 2).lgamma()).exp() / arb.pi()


def finite_part_ratio(k: int, bits: int) -> arb:
    """Return M_k 2^(2k-3)/(2k-2)! as a ball with a relative radius below 2^-bits."""
    return _finite_part_ratio(k, bits + _SPARE)


def finite_part(k: int, bits: int) -> arb:
    """Return M_k as a ball with a relative radius below 2^-bits."""
    ratio = finite_part_ratio(k, bits)
    with flint.ctx.workprec(bits + 4 * _SPARE):
        return ratio * arb(2 * k - 1).gamma() / arb(2) ** (2 * k - 3)


@cache
def _finite_part_ratio(k: int, bits: int) -> arb:
    digits = math.ceil(bits / LOG2_10)
    if 2 * k - 4 <= LOW_FINITE_PART:
        value = contact_balls.finite_part(k, digits + 1)
        with flint.ctx.workprec(bits + 4 * _SPARE):
            return value * arb(2) ** (2 * k - 3) / math.factorial(2 * k - 2)
    return refine_to_digits(
        lambda _: (_far_finite_part(2 * k - 4),), digits, f"the ratio of M_{k}"
    )[0]


def _far_finite_part(m: int) -> arb:
    """Return the ratio from int_0^oo T^m (G - 1) dT, m = 2k - 4.

    G - 1 <= 7 T^2 e^(-2T) from T = 3 on (`balls.finite_part`); below, 1 - e^(-2T) <= 2T
    and sinh^2 T - T^2 >= T^4/3 give G - 1 <= 6/T^3 + 3/T^2, and 15 3^(m-2) for the integral.
    """

    def shape(T: acb) -> acb:
        E = (-2 * T).exp()
        return 4 * ((1 - E) / 2 + T + T * T) / ((1 - E) ** 2 - 4 * T * T * E)

    left, right, scale = _window(m, arb(3))
    peak = _body(m, shape, left, right, scale)
    p = m + 2
    outside = 7 * (left * _size(p, left, scale) + _size(p, right, scale) / (2 - p / right))
    outside += 15 * (arb(3).log() * (m - 2) - scale).exp()
    total = peak + arb(0, outside.abs_upper())
    # 2^(m+1)/(m+2)! e^scale.
    return total * (scale + (m + 1) * arb(2).log() - arb(m + 3).lgamma()).exp()


def _window(power: int, least: arb) -> tuple[arb, arb, arb]:
    """Return the ends of the peak of y^power e^(-2y), and the logarithm of its peak value.

    Outside the ends the function is below the current precision, unless the left end is `least`.
    The ends are computed in doubles; the caller bounds the integral outside.
    """
    drop, middle = (flint.ctx.prec + 16) * math.log(2), power / 2

    def end(inner: float, outer: float) -> float:
        for _ in range(60):
            y = (inner + outer) / 2
            fallen = power * math.log1p((y - middle) / middle) - 2 * (y - middle) < -drop
            inner, outer = (inner, y) if fallen else (y, outer)
        return outer

    left, right = end(middle, 0.0), end(middle, 4 * middle + 2 * drop)
    peak = arb(power) / 2
    return arb(left).max(least), arb(right), peak.log() * power - 2 * peak


def _size(power: int, y: arb, scale: arb) -> arb:
    """Return y^power e^(-2y) over e^scale."""
    return (y.log() * power - 2 * y - scale).exp()


def _body(power: int, shape: Callable[[acb], acb], left: arb, right: arb, scale: arb) -> arb:
    """Return the integral of y^power e^(-2y) shape(y), over e^scale."""

    def integrand(y: acb, analytic: bool) -> acb:
        return (y.log(analytic=analytic) * power - 2 * y - scale).exp() * shape(y)

    return acb.integral(integrand, acb(left), acb(right)).real
