"""Oracle 2 to many digits: law and impact from the power series of `residues`.

The impact's time is an integral of an even function of u, a = a_m (1 - u^2), over
[-1, 1], where Fejer's first rule serves: its nodes are cosines, and its weights take no more
than sums of them. All that is summed is in fixed-point numbers.
"""

import cmath
import math
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

from mpmath import mp, mpf

from derivation.engine.oracle.agreement import RouteError
from derivation.plate.contact.route import sums as contact_routes
from derivation.plate.contact.route.residues import ResidueSeries, Scaled, fixed, floating, series
from derivation.plate.contact.route.sums import RouteImpact

ELLIPSE = 1.8
"""Axes' sum of an ellipse about [-1, 1] that the integrand is analytic in: in a stiff
half-space 2.02 and in a plate that bends alone 1.93, by where 1 - q^5 and 1 - q^6 vanish."""

_EXTRA = 30
"""Digits that arguments are worked out with beyond those asked for."""

_STEPS = 60


class ResidueLaw(NamedTuple):
    """A plate's law up to some contact radius, its argument q = a/(reach b)."""

    known: ResidueSeries
    h: float
    b: float

    def ratio(self, a: float) -> mpf:
        """q of a contact radius [m]."""
        return mpf(a) / mpf(self.b) / self.known.reach

    def depth(self, q: mpf) -> mpf:
        """delta R/a^2."""
        return 1 + q * self._sum([x // (2 * j + 3) for j, x in enumerate(self.known.terms)], q)

    def slope(self, q: mpf) -> mpf:
        """(R/2a) d delta/da."""
        return 1 + q * self._sum(self.known.terms, q) / 2

    def work(self, q: mpf) -> mpf:
        """int_0^q x^4 (slope at x) dx."""
        return q**5 * (mpf(1) / 5 + q * self._sum(self.works(), q))

    def works(self) -> Scaled:
        """What is left of s_j in `work`."""
        return [x // (4 * j + 12) for j, x in enumerate(self.known.terms)]

    def _sum(self, terms: Sequence[int], q: mpf) -> mpf:
        bits = self.known.bits
        return floating(_horner(terms, fixed(q * q, bits), bits), bits)


def _horner(terms: Sequence[int], x: int, bits: int) -> int:
    total = 0
    for term in reversed(terms):
        total = (total * x >> bits) + term
    return total


def law(h: float, b: float, reach: float, digits: int) -> ResidueLaw:
    """The law of a plate.

    Parameters
    ----------
    h, b
        Half-thickness and radius [m].
    reach
        Largest a/b [1] to serve, below 1: only a scale, on which no digit depends.
    digits
        Digits asked for.

    Raises
    ------
    ValueError
        Unless 0 < reach < 1.
    """
    if not 0 < reach < 1:
        raise ValueError(f"the law has meaning for 0 < a/b < 1, got {reach}")
    with mp.workdps(digits + _EXTRA):
        return ResidueLaw(series(mpf(h) / mpf(b), mpf(reach), digits), h, b)


def indentation(a: float, R: float, of: ResidueLaw, digits: int) -> mpf:
    """Indentation [m] at a contact radius [m]."""
    with mp.workdps(digits + _EXTRA):
        return mpf(a) ** 2 / mpf(R) * of.depth(of.ratio(a))


def stiffness(a: float, R: float, lam: float, mu: float, of: ResidueLaw, digits: int) -> mpf:
    """dP/d delta [N/m] at a contact radius [m]: (dP/da)/(d delta/da)."""
    with mp.workdps(digits + _EXTRA):
        steep = 3 * contact_routes.hertz_stiffness(mpf(R), lam, mu) * mpf(a) ** 2
        return steep / (2 * mpf(a) / mpf(R) * of.slope(of.ratio(a)))


def impact(
    R: float, m: float, v0: float, lam: float, mu: float, of: ResidueLaw, digits: int
) -> RouteImpact:
    """The conservative impact of a sphere of mass m [kg] at speed v0 [m/s].

    Raises
    ------
    RouteError
        If no largest contact radius is found.
    """
    with mp.workdps(digits + _EXTRA):
        stiff, reach = contact_routes.hertz_stiffness(mpf(R), lam, mu), of.known.reach * mpf(of.b)
        unit = 2 * stiff * reach**5 / mpf(R)
        largest = _largest(of, mpf(m) * mpf(v0) ** 2 / 2 / unit)
        radius = largest * reach
        time = 2 * radius**2 / mpf(R) * mp.sqrt(mpf(m) / (2 * unit)) * _quarter(of, largest, digits)
        deepest = radius**2 / mpf(R) * of.depth(largest)
        return RouteImpact(2 * time, deepest, stiff * radius**3, radius)


def _largest(of: ResidueLaw, target: mpf) -> mpf:
    """q at which the work reaches a value: Newton's iteration in logarithms."""
    q, close = mpf(1), mpf(10) ** (-mp.dps // 2 - 4)
    for _ in range(_STEPS):
        work = of.work(q)
        step = mp.log(target / work) * work / (q**5 * of.slope(q))
        q *= mp.exp(step)
        if abs(step) < close:
            return q
    raise RouteError(f"no largest contact radius found near {mp.nstr(q * of.known.reach)} b")


def _quarter(of: ResidueLaw, largest: mpf, digits: int) -> mpf:
    """int_0^1 2 u r S/sqrt(E(largest) - E(q)) du of slope S and work E, q = largest (1 - u^2)."""
    count = 2 * math.ceil((digits + 10) / math.log10(_ellipse(of, largest)) / 2)
    bits, whole, total = of.known.bits, of.work(largest), mpf(0)
    works = of.works()
    for u, w in _fejer(count, bits):
        r = 1 - u * u
        q = largest * r
        x = fixed(q * q, bits)
        slope = 1 + q * floating(_horner(of.known.terms, x, bits), bits) / 2
        work = q**5 * (mpf(1) / 5 + q * floating(_horner(works, x, bits), bits))
        total += w * 2 * u * r * slope / mp.sqrt(whole - work)
    return total


def _ellipse(of: ResidueLaw, largest: mpf) -> float:
    """Axes' sum of an ellipse for deep contacts too: the law is singular at a = +-4 i h."""
    square = complex(1, -4 * of.h / (of.b * float(largest * of.known.reach)))
    u = cmath.sqrt(square)
    half = (abs(u - 1) + abs(u + 1)) / 2
    return min(ELLIPSE, half + math.sqrt(half * half - 1))


@lru_cache(maxsize=2)
def _fejer(count: int, bits: int) -> tuple[tuple[mpf, mpf], ...]:
    """Positive nodes and weights of Fejer's first rule on [-1, 1]; `count` is even.

    u_k = cos t_k, t_k = (2k + 1) pi/(2 count), with the weights
    2/count (1 - 2 sum cos(2 i t_k)/(4 i^2 - 1)), i = 1 ... count/2; the cosines are those of
    multiples of one angle.
    """
    more = bits + 64
    with mp.workprec(more):
        angle = mp.pi / (2 * count)
        twice, cosines = fixed(2 * mp.cos(angle), more), [1 << more, fixed(mp.cos(angle), more)]
        for _ in range(2, 4 * count):
            cosines.append((twice * cosines[-1] >> more) - cosines[-2])
    found = []
    for k in range(count // 2):
        rest = sum(
            cosines[2 * i * (2 * k + 1) % (4 * count)] // (4 * i * i - 1)
            for i in range(1, count // 2 + 1)
        )
        weight = floating((1 << more) - 2 * rest, more) * 2 / count
        found.append((floating(cosines[2 * k + 1], more), weight))
    return tuple(found)
