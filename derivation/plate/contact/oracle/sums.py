"""The untruncated modal sum in ball arithmetic: integrals without poles, with proved bounds.

The sum over the modes of an even entire k with |k(w)| <= e^|Im w|, taken as
residues of Y0/J0 between x = 1 < j_1 and infinity, becomes integrals:

    sum k(alpha j) G(2 eta j)/(j J1(j)^2) = 1/2 int_0^oo k(alpha x) dx + L,
    L = -1/2 int_0^1 k(alpha x) dx + 1/2 int_1^oo k(alpha x) (G - 1) dx
        -1/2 Re int k(alpha z) G(2 eta z) H(z)/J0(z) dz,   z = 1 + (2 + i) y, y > 0,

H being the first Hankel function of order 0. No pole is crossed. J0 has real zeros only; and for
T = x + iy, x > 0, |y| <= x, sinh^2 T = T^2 would need |sinh T|^2 = |T|^2, but
sinh^2 x + sin^2 y - x^2 - y^2 >= (x^4 - y^4)/3 + 2 x^6/45 > 0, because
sinh^2 x >= x^2 + x^4/3 + 2 x^6/45 and sin^2 y >= y^2 - y^4/3. Every integral is a Gauss-Legendre
sum with the error bound of Bernstein's ellipse; the run time does not depend on the plate's
thickness. alpha = a/b and eta = h/b.
"""

import math
from collections.abc import Callable
from fractions import Fraction
from functools import cache, lru_cache
from typing import NamedTuple

import flint
from flint import acb, acb_poly, arb

from derivation.engine.formula.ball import PrecisionError, to_ball

PANELS = 512
"""Number of cached panels, of several plates, limited by memory."""
SERIES_REACH = 2
"""|w| and |T| below which power series are used, and closed forms above."""

PIECES = 600
"""Number of balls around an ellipse on which a factor is bounded."""

COEFFICIENTS: dict[str, Callable[[int], flint.fmpq]] = {
    "hertz": lambda k: flint.fmpq(3 * (2 * k + 2), math.factorial(2 * k + 3)),
    "sinc": lambda k: flint.fmpq(1, math.factorial(2 * k + 1)),
    "work": lambda k: flint.fmpq(1, math.factorial(2 * k + 1) * (2 * k + 6)),
}
"""Magnitudes of the power series in w^2, alternating; each at most 1/(2k+1)!."""

_CLOSED: dict[str, Callable[[acb], acb]] = {
    "hertz": lambda w: 3 * (w.sin() - w * w.cos()) / w**3,
    "sinc": lambda w: w.sin() / w,
    "work": lambda w: (
        (4 * w**3 - 24 * w) * w.sin() + (12 * w**2 - 24 - w**4) * w.cos() + 24
    ) / w**6,
}  # fmt: skip
"""3 (sin w - w cos w)/w^3, sin w/w, and int_0^1 t^5 sinc(w t) dt; all below e^|Im w|."""

FACTORS = {"hertz": flint.fmpq(8, 3), "sinc": flint.fmpq(4), "work": flint.fmpq(20)}


class Weight(NamedTuple):
    """An even entire factor of the modes, |value(z)| <= |z|^power e^(rate |Im z|), rate <= 1.

    Rates are powers of two, so that few sets of nodes are needed.
    """

    value: Callable[[acb], acb]
    power: int = 0
    rate: float = 1.0


class Panel(NamedTuple):
    """Nodes with their weights times a fixed factor, and a bound of the quadrature error.

    `bound` is for a weight of power 0 and is multiplied by size^power; |z| is between `nearest` and
    `size` on the ellipse.
    """

    nodes: tuple[tuple[acb, acb], ...]
    bound: arb
    size: arb
    nearest: arb


def _widened(value: acb, radius: arb) -> acb:
    error = arb(0, radius.abs_upper())
    return value + acb(error, error)


@cache
def _kernel_series(name: str, bits: int) -> tuple[acb_poly, arb]:
    """Return the series in w^2 and a bound of its truncation error for |w| <= 2.

    Terms are below 4^k/(2k+1)!, each less than half of the previous one from k = 2 on, so that the
    remainder is below twice the next term.
    """
    count = 3
    while arb(4) ** count / math.factorial(2 * count + 1) > arb(2) ** -bits:
        count += 1
    terms = [(-1) ** k * COEFFICIENTS[name](k) for k in range(count)]
    return acb_poly(terms), 2 * arb(4) ** count / math.factorial(2 * count + 1)


def kernel(name: str, w: acb) -> acb:
    """Return one of the weight functions `hertz`, `sinc`, `work` on a complex ball."""
    if w.abs_upper() < SERIES_REACH:
        series, rest = _kernel_series(name, flint.ctx.prec)
        return _widened(series(w * w), rest)
    return _CLOSED[name](w)


@cache
def _denominator_series(bits: int) -> tuple[acb_poly, arb]:
    """Return the series of (sinh^2 T - T^2)/T^4 in T^2, and a bound of its remainder for |T| <= 2.

    It is sum_(k>=2) 2^(2k-1) T^(2k-4)/(2k)!. The ratio of successive terms is at most
    16/((2k+1)(2k+2)) < 1/2 from k = 3 on; the k-th is below 4^(2k)/(2k)!.
    """
    count = 4
    while arb(4) ** (2 * count) / math.factorial(2 * count) > arb(2) ** -bits:
        count += 1
    terms = [flint.fmpq(2 ** (2 * k - 1), math.factorial(2 * k)) for k in range(2, count)]
    return acb_poly(terms), 2 * arb(4) ** (2 * count) / math.factorial(2 * count)


def plate_excess(T: acb) -> acb:
    """Return G(T) - 1 of the contact face on a complex ball."""
    decay = (-2 * T).exp()
    numerator = (1 - decay) / 2 + T + T**2
    if T.abs_upper() < SERIES_REACH:
        series, rest = _denominator_series(flint.ctx.prec)
        return numerator / (T**4 * _widened(series(T * T), rest))
    return 4 * decay * numerator / ((1 - decay) ** 2 - 4 * T**2 * decay)


def excess_bound(T: arb) -> arb:
    """Return a bound of |G - 1| on |arg T| <= 45 degrees.

    |numerator| <= 1 + |T| + |T|^2 and |sinh^2 T - T^2| >= 2 (Re T)^6/45 >= |T|^6/180 (see the
    module). The bound decreases with |T|.
    """
    return 180 * (1 + T + T**2) / T**6


def hankel_over_j0(z: acb) -> acb:
    """Return H(z)/J0(z) = (2/(pi i)) K0(-iz)/I0(-iz) for Re z > 0, away from the cut of K0."""
    if not z.real > 0:
        raise ValueError(f"a ball across the cut: {z}")
    w = acb(z.imag, -z.real)
    return w.bessel_k(0) / w.bessel_i(0) * acb(0, -2) / arb.pi()


def hankel_bound(z: acb) -> arb:
    """Return a bound of |H/J0| on a small ball within 45 degrees of the axis.

    For |z| >= 4 and y = Im z >= 1: |H| <= sqrt(2/(pi |z|)) e^-y, and the other
    Hankel function, half of J0 with it, is at least 0.89 sqrt(2/(pi |z|)) e^y
    (DLMF 10.17.14 with l = 1, variation pi/2), so |H/J0| <= 3 e^(-2y).
    """
    if not z.real > abs(z.imag):
        raise ValueError(f"G is bounded between -45 and 45 degrees, not at {z}")
    if z.imag > 1 and z.abs_lower() > 4:
        return 3 * (-2 * z.imag).exp().abs_upper()
    return hankel_over_j0(z).abs_upper()


@cache
def _gauss(count: int, bits: int) -> tuple[tuple[arb, arb], ...]:
    """Return Gauss-Legendre nodes and weights on [-1, 1]."""
    with flint.ctx.workprec(bits):
        return tuple(arb.legendre_p_root(count, k, weight=True) for k in range(count))


def _ellipse(low: acb, high: acb, rho: arb, pieces: int) -> list[acb]:
    """Return balls that cover the boundary of Bernstein's ellipse around a straight path."""
    middle, half = (low + high) / 2, (high - low) / 2
    major, minor = (rho + 1 / rho) / 2, (rho - 1 / rho) / 2
    step = 2 * arb.pi() / pieces
    radius = (half.abs_upper() * major * step / 2).abs_upper()
    angles = (k * step for k in range(pieces))
    return [_widened(middle + half * acb(major * t.cos(), minor * t.sin()), radius) for t in angles]


def _panel(
    low: acb,
    high: acb,
    rho: arb,
    factor: Callable[[acb], acb],
    bound: Callable[[acb], arb],
    rate: float = 1.0,
) -> Panel:
    """Return Gauss-Legendre nodes on one path; `bound` is that of |factor| on a ball.

    The error of n + 1 nodes is at most 64/15 M rho^(-2n)/(1 - rho^-2) on [-1, 1], M the largest
    magnitude on the ellipse, taken on its boundary (Trefethen, ATAP, 19.3).
    """
    bits, half = flint.ctx.prec, (high - low) / 2
    with flint.ctx.workprec(64):
        cover = _ellipse(low, high, rho, PIECES)
        largest = arb(0)
        for z in cover:
            here = bound(z) * (rate * abs(z.imag)).exp().abs_upper()
            if not here.is_finite():
                raise PrecisionError(f"no bound on the ellipse near {z}")
            largest = largest.max(here)
        size = max((z.abs_upper() for z in cover), key=float)
        nearest = min((z.abs_lower() for z in cover), key=float)
        extra = max(0.0, float(largest.log()) / math.log(2))
        degree = math.ceil((bits + extra) / (32 * math.log2(float(rho)))) * 16 + 15
        error = 5 * largest * rho ** (-2 * degree) / (1 - rho**-2) * half.abs_upper()
    middle = (low + high) / 2
    nodes = ((middle + half * x, half * w) for x, w in _gauss(degree + 1, flint.ctx.prec))
    return Panel(tuple((z, w * factor(z)) for z, w in nodes), error.abs_upper(), size, nearest)


@cache
def _bare_ray(k: int, bits: int) -> Panel:
    """Return the ray's k-th panel with H/J0 alone: y in [0, 1/2], [1/2, 1], [1, 2], [2, 4], ..."""
    # K0's power series cancels by e^(2 |z|), 3 |z| bits; its asymptotic series does not.
    spare = 32 + (4 * 2**k if 2**k <= bits else 0)
    with flint.ctx.workprec(bits + spare):
        first = arb(0) if k == 0 else arb(2) ** (k - 2)
        ends = [acb(1 + 2 * y, y) for y in (first, arb(2) ** (k - 1))]
        return _panel(ends[0], ends[1], arb(2), hankel_over_j0, hankel_bound)


def _ray_panels(end: int, eta: Fraction | None) -> list[Panel]:
    """Return the ray's panels with H/J0 G; |G| is bounded at the ellipse's smallest |z|."""
    panels = []
    for k in range(end + 1):
        bare = _bare_ray(k, flint.ctx.prec)
        if eta is None:
            panels.append(bare)
            continue
        scale = 2 * to_ball(eta)
        nodes = tuple((z, w * (1 + plate_excess(scale * z))) for z, w in bare.nodes)
        bound = bare.bound * (1 + excess_bound(scale * bare.nearest))
        panels.append(bare._replace(nodes=nodes, bound=bound))
    return panels


@lru_cache(maxsize=PANELS)
def _axis_panel(eta: Fraction, k: int, rate: float, bits: int) -> Panel:
    """Return G - 1 on x in [2^k, 2^(k+1)]; on the ellipse |arg z| < 45 degrees, |z| > 0.66 2^k."""
    with flint.ctx.workprec(bits):
        low, scale = acb(arb(2) ** k), 2 * to_ball(eta)
        bound = excess_bound(scale * arb("0.66") * arb(2) ** k)
        return _panel(
            low, 2 * low, arb(3), lambda z: plate_excess(scale * z), lambda _: bound, rate
        )


@lru_cache(maxsize=PANELS)
def _panels(
    eta: Fraction | None, power: int, rate: float, bits: int
) -> tuple[tuple[Panel, ...], arb]:
    """Return all panels of L's real part, and a bound of both tails.

    The ray ends at y = 2^(end-1) >= 4 power. From there on the integrand is below
    5 |z|^power (1 + |G - 1|) e^(-y), and the tail is below 4 times its value at the end, since
    y^power e^(-y/2) decreases from 2 power on. On the axis, for T >= 3,
    (1 - e^(-2T))^2 - 4 T^2 e^(-2T) > 0.8 and the numerator is below 1.4 T^2, so
    G - 1 < 7 T^2 e^(-2T), and from T = power + 3 on T^(power+2) e^(-2T) decreases at least like
    e^-T.
    """
    need = 0.7 * bits + 4 * power + 10
    need += 0 if eta is None else max(0.0, -6 * math.log(2 * float(eta)))
    end = math.ceil(math.log2(need)) + 1
    side = _panel(acb(0), acb(1), arb(4), lambda _: acb(-1), lambda _: arb(1))
    rays = (
        panel._replace(nodes=tuple((z, -w) for z, w in panel.nodes))
        for panel in _ray_panels(end, eta)
    )
    last = arb(2) ** (end - 1)
    size = (1 + 5 * last).abs_upper()
    factor = arb(1) if eta is None else 1 + excess_bound(2 * to_ball(eta) * last)
    tail = 20 * size**power * factor * (-last).exp()
    if eta is None:
        return (side, *rays), tail.abs_upper()
    deep = 3 + 2 * power + 0.5 * bits
    count = max(0, math.ceil(math.log2(deep / (2 * float(eta)))))
    T = 2 * to_ball(eta) * arb(2) ** count
    tail += arb(2) ** (count * power) * 7 * T**2 * (-2 * T).exp() / (2 * to_ball(eta))
    axis = (_axis_panel(eta, k, rate, bits) for k in range(count))
    return (side, *rays, *axis), tail.abs_upper()


def functional(weight: Weight, eta: Fraction | None) -> arb:
    """Return L (see the module); eta = None means G = 1, the finite radius alone."""
    panels, tail = _panels(eta, weight.power, weight.rate, flint.ctx.prec)
    total = arb(0, tail)
    for panel in panels:
        value = sum((w * weight.value(z) for z, w in panel.nodes), acb(0)).real
        total += value + arb(0, (panel.bound * panel.size**weight.power).abs_upper())
    return total / 2


def excess(name: str, alpha: arb, eta: Fraction | None) -> arb:
    """Return the plate's correction of Hertz for a weight function, at the current precision.

    Raises
    ------
    ValueError
        Unless 0 < alpha = a/b < 1.
    """
    if not (alpha > 0 and alpha < 1):
        raise ValueError(f"the law is defined for 0 < a/b < 1, got {alpha}")
    rate = 2.0 ** math.ceil(math.log2(float(alpha.abs_upper())))
    weight = Weight(lambda z: kernel(name, alpha * z), rate=min(1.0, 2 * rate))
    return FACTORS[name] * alpha / arb.pi() * functional(weight, eta)
