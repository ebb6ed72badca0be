"""Oracle 2's modal sums as nodes and weights: the first modes, and Abel-Plana for the rest.

The N first modes are added as they stand. The rest is a sum over integers of an
analytic function, since dj/dn = 2/(j J1(j)^2) when j(n) is continued from the
zeros by the phase of the Bessel functions; Abel-Plana's formula turns it into

    sum_(n>=N) phi(n) = phi(N)/2 + int_N^oo phi dn - 2 int_0^oo Im phi(N+iy)/(e^(2 pi y)-1) dy,
    phi(n) = 1/2 f(j(n)) dj/dn,   int_N^oo phi dn = 1/2 int_(j_N)^oo f dx.

For plates that are not thin the part of G - 1 is added by brute force instead: it
dies out within some hundred modes. Nodes and weights of a plate are made once.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from functools import cache, lru_cache
from typing import NamedTuple

from mpmath import mp, mpf
from mpmath.calculus.quadrature import GaussLegendre

from derivation.engine.oracle.agreement import RouteError

PLATES = 64
"""Plates whose numbers are kept: many more would fill the memory."""
THIN = 0.035
"""Below this h/b the poles of G beyond Re n = N weigh less than e^(-4.2/eta) < 10^-52."""

STRIP = 1.0
"""Half-width of the strip that sets the step of the rule for Abel-Plana's integral."""


class Nodes(NamedTuple):
    """Nodes z and weights w of sum_j f(j) G/(j J1^2) = Re sum w z f(z) + rest/2.

    The rest, int f dx from `start` on, has a closed form.
    """

    plain: tuple[tuple[mpf, mpf], ...]
    start: mpf


@cache
def _phase_series(dps: int) -> tuple[mpf, ...]:
    """Coefficients d_k of d theta/dx = sum d_k x^(-2k), the reciprocal of Nicholson's series.

    (pi x/2)(J0^2 + Y0^2) ~ 1 + sum_k (1*3*...(2k-1))/(2*4*...2k) prod (-(2i-1)^2)/(2x)^(2k).
    """
    with mp.workdps(dps):
        size = [mpf(1)]
        for k in range(1, dps + 10):
            factor = -(mpf(2 * k - 1) ** 3) / (2 * k) / 4
            size.append(size[-1] * factor)
        rate = [mpf(1)]
        for k in range(1, len(size)):
            rate.append(-mp.fsum(size[i] * rate[k - i] for i in range(1, k + 1)))
        return tuple(rate)


class _Terms(NamedTuple):
    """d_1, d_2, ... of the phase's slope, d_k/(2k-1) of the phase, decimal logarithms of |d_k|."""

    slope: tuple[mpf, ...]
    phase: tuple[mpf, ...]
    sizes: tuple[float, ...]


@cache
def _terms(dps: int) -> _Terms:
    with mp.workdps(dps):
        slope = _phase_series(dps)[1:]
        phase = tuple(d / (2 * k - 1) for k, d in enumerate(slope, start=1))
        return _Terms(slope, phase, tuple(float(mp.log10(abs(d))) for d in slope))


def _phase(x: mpf) -> tuple[mpf, mpf]:
    """Phase theta of H and its slope at a large x, real or complex, by the asymptotic series.

    Raises
    ------
    RouteError
        If the series turns before its terms are below the working precision.
    """
    terms, size, square = _terms(mp.dps), 2 * float(mp.log10(abs(x))), 1 / (x * x)
    powers, goal = [square], -mp.dps - 3
    for k, coefficient in enumerate(terms.sizes, start=1):
        if coefficient - k * size < goal:
            theta = x - mp.pi / 4 - x * mp.fdot(terms.phase[:k], powers)
            return theta, 1 + mp.fdot(terms.slope[:k], powers)
        powers.append(powers[-1] * square)
    raise RouteError(f"the phase's series does not reach {mp.dps} digits at {mp.nstr(x)}")


def precisions(dps: int) -> list[int]:
    """Digits of Newton's steps, each enough for the next, the last being those worked with."""
    steps = [dps]
    while steps[-1] > 20:
        steps.append(steps[-1] // 2 + 4)
    return steps[::-1]


def _continued_zero(n: mpf) -> tuple[mpf, mpf]:
    """j(n) and dj/dn, where theta(j) = (n - 1/2) pi, by Newton's iteration.

    Raises
    ------
    RouteError
        If the phase at the zero found is not the one asked for.
    """
    target = (n - mpf(1) / 2) * mp.pi
    x = target + mp.pi / 4 + 1 / (8 * target)
    for dps in precisions(mp.dps):
        with mp.workdps(dps):
            theta, rate = _phase(x)
            step = (target - theta) / rate
            x += step
    if not abs(step) < mpf(10) ** (-mp.dps // 2 + 4):
        raise RouteError(f"no zero of J0 continued to n = {mp.nstr(n)}")
    return x, mp.pi / _phase(x)[1]


def by_bessel(dps: int) -> int:
    """How many zeros the phase's asymptotic series does not give to so many digits."""
    return int(0.42 * dps) + 5


@cache
def mode(n: int, dps: int) -> tuple[mpf, mpf]:
    """j_n and 1/(j_n J1(j_n)^2)."""
    with mp.workdps(dps):
        if n >= by_bessel(dps):
            zero, rate = _continued_zero(mpf(n))
            return zero, rate / 2
        with mp.workdps(15):
            zero = mp.besseljzero(0, n)
        for working in precisions(dps):
            with mp.workdps(working + 5):
                zero += mp.besselj(0, zero) / mp.besselj(1, zero)
        return zero, 1 / (zero * mp.besselj(1, zero) ** 2)


@cache
def _gauss(level: int, dps: int) -> tuple[tuple[mpf, mpf], ...]:
    """3 * 2^(level - 1) Gauss-Legendre nodes on [-1, 1]."""
    with mp.workdps(dps):
        rule = GaussLegendre(mp)
        return tuple(rule.calc_nodes(level, mp.prec))


def spread(edges: Sequence[mpf], level: int) -> list[tuple[mpf, mpf]]:
    """Gauss-Legendre nodes and weights on consecutive intervals."""
    found = []
    for low, high in itertools.pairwise(edges):
        middle, half = (low + high) / 2, (high - low) / 2
        found += [(middle + half * x, half * w) for x, w in _gauss(level, mp.dps)]
    return found


def excess(T: mpf) -> mpf:
    """G(T) - 1, with as many digits more as its two cancellations take."""
    lost = max(0, math.ceil(-4 * math.log10(float(abs(T)))))
    with mp.workdps(mp.dps + lost + 5):
        decay = mp.exp(-2 * T)
        numerator = 2 * decay * (1 - decay + 2 * T + 2 * T * T)
        return +(numerator / ((1 - decay) ** 2 - 4 * T * T * decay))


def _exponential(end: mpf) -> list[tuple[mpf, mpf]]:
    """Trapezoidal nodes and weights of int_0^end for what decays beyond: y = e^(t - e^(-t))."""
    step = 2 * mp.pi * STRIP / (mp.dps * mp.log(10))
    first, last = -mp.log(mp.dps * mp.log(10) + 5), mp.log(end)
    found = []
    for k in range(math.floor(first / step), math.ceil(last / step) + 1):
        fall = mp.exp(-k * step)
        y = mp.exp(k * step - fall)
        found.append((y, step * y * (1 + fall)))
    return found


@cache
def _upright(first: int, dps: int) -> tuple[tuple[mpf, mpf], ...]:
    """Abel-Plana's integral on Re n = N, without f; |f| grows by e^(pi y) at most."""
    with mp.workdps(dps):
        found = []
        for y, w in _exponential(mpf(dps) * mp.log(10) / mp.pi + 5):
            z, slope = _continued_zero(mp.mpc(first, y))
            found.append((z, mp.mpc(0, 1) * w * slope / mp.expm1(2 * mp.pi * y)))
        return tuple(found)


@lru_cache(maxsize=PLATES)
def nodes_of(eta: mpf, first: int, level: int, dps: int) -> Nodes:
    """Everything about a plate that does not depend on the contact."""
    with mp.workdps(dps):
        reach = mpf(dps) * mp.log(10)
        factor: Callable[[mpf], mpf] = lambda z: 1 + excess(2 * eta * z)  # noqa: E731
        thin = eta < THIN
        modes = [mode(n, dps) for n in range(1, first)]
        found = [(z, w * factor(z)) for z, w in modes]
        edge, rate = _continued_zero(mpf(first))
        late = factor if thin else (lambda _: mpf(1))
        found.append((edge, rate / 4 * late(edge)))
        found += [(z, w * late(z)) for z, w in _upright(first, dps)]
        if thin:
            edges = [2 * eta * edge]
            while edges[-1] < reach / 2 + 5:
                edges.append(min(2 * edges[-1], edges[-1] + 6))
            smooth = spread(edges, level)
            found += [(T / (2 * eta), w / (4 * eta) * excess(T)) for T, w in smooth]
        else:
            n = first
            while 4 * eta * n * 3 < reach + 15:
                z, w = mode(n, dps)
                found.append((z, w * excess(2 * eta * z)))
                n += 1
        return Nodes(tuple((z, w / z) for z, w in found), edge)
