"""mpmath reference of contact law and impact to any number of digits, by `residues`.

The impact's time is an integral of an even function of u, a = a_m (1 - u^2), over [-1, 1], where
Fejer's first rule is used: its nodes are cosines, and its weights are sums of cosines. All sums use
fixed-point numbers. No result is repeated with more digits to estimate its error, because results
are compared with certified ones.
"""

import cmath
import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import NamedTuple

from mpmath import mp, mpf

from derivation.engine.oracle.agreement import RouteError
from derivation.plate.contact.route.residues import ResidueSeries, Scaled, fixed, floating, series

ELLIPSE = 1.8
"""Sum of the half-axes of an ellipse with foci -1 and 1 in which the integrand is analytic.

The zeros of 1 - q^5 limit it to 2.02 for a half-space, those of 1 - q^6 to 1.93 for bending alone.
"""

SHALLOW, DEEPEST = 1.5, 96.0
"""Largest a/h of the first and of the last series of a plate; each reaches twice as far as the one
before. The run time grows with the 2.5th power of it."""

EDGE = mpf("0.9999")
"""Largest a/b at which a root is searched for."""

_EXTRA = 30
"""Number of additional digits with which arguments are computed."""

_FEW = 25
"""Series are computed for multiples of this number of digits; roots are located with it first."""

_STEPS = 60


class RouteImpact(NamedTuple):
    """Contact time [s], and largest indentation [m], force [N] and contact radius [m]."""

    contact_time: mpf
    max_indentation: mpf
    max_force: mpf
    max_contact_radius: mpf


class ResidueLaw(NamedTuple):
    """A plate's law up to some contact radius, in terms of q = a/(reach b)."""

    known: ResidueSeries
    eta: mpf

    def depth(self, q: mpf) -> mpf:
        """Return delta R/a^2."""
        return 1 + q * self._sum([x // (2 * j + 3) for j, x in enumerate(self.known.terms)], q)

    def slope(self, q: mpf) -> mpf:
        """Return (R/2a) d delta/da."""
        return 1 + q * self._sum(self.known.terms, q) / 2

    def work(self, q: mpf) -> mpf:
        """Return int_0^q x^4 (slope at x) dx."""
        return q**5 * (mpf(1) / 5 + q * self._sum(self.works(), q))

    def works(self) -> Scaled:
        """Return s_j/(4j + 12), the coefficients in `work`, times 2^bits."""
        return [x // (4 * j + 12) for j, x in enumerate(self.known.terms)]

    def _sum(self, terms: Sequence[int], q: mpf) -> mpf:
        bits = self.known.bits
        return floating(_horner(terms, fixed(q * q, bits), bits), bits)


def _horner(terms: Sequence[int], x: int, bits: int) -> int:
    total = 0
    for term in reversed(terms):
        total = (total * x >> bits) + term
    return total


def supported_depth(depth: float) -> float:
    """Return the largest a/h for which the series for contacts of a/h = depth is used.

    Raises
    ------
    RouteError
        If depth exceeds DEEPEST.
    """
    # Near a root just within the reach of a series, the law is evaluated on both sides of the root.
    served: float = SHALLOW * 2 ** max(0, math.ceil(math.log2(depth / SHALLOW) - 1e-6))
    if served > DEEPEST:
        raise RouteError(f"this method is for contacts up to a = {DEEPEST:g} h, got {depth:.4g} h")
    return served


def seconds(eta: float, reach: float, digits: int) -> float:
    """Return the approximate run time of the law up to a/b = reach and an impact [s]."""
    powers = 30 * (digits / 1000) ** 3 * (1 + (supported_depth(reach / eta) / 2.5) ** 2.5)
    return float(powers + 100 * eta * (digits / 1000) ** 2.2)


def _law(h: float, b: float, x: mpf, digits: int) -> tuple[ResidueLaw, mpf]:
    """Return the law of a plate for contacts up to at least a/b = x, and q there."""
    digits = _FEW * math.ceil(digits / _FEW)
    with mp.workdps(digits + _EXTRA):
        eta = mpf(h) / mpf(b)
        reach = min(mpf(1), eta * supported_depth(float(x / eta)))
        return ResidueLaw(series(eta, reach, digits), eta), x / reach


def _ratio(a: float, b: float) -> mpf:
    if not 0 < a < b:
        raise ValueError(f"the law is defined for 0 < a/b < 1, got {mp.nstr(mpf(a) / mpf(b))}")
    return mpf(a) / mpf(b)


def indentation(a: float, R: float, h: float, b: float, digits: int = 40) -> mpf:
    """Return the indentation [m] at a contact radius [m]."""
    with mp.workdps(digits + _EXTRA):
        law, q = _law(h, b, _ratio(a, b), digits)
        return mpf(a) ** 2 / mpf(R) * law.depth(q)


def slope(a: float, R: float, h: float, b: float, digits: int = 40) -> mpf:
    """Return d delta/da [1] at a contact radius [m]."""
    with mp.workdps(digits + _EXTRA):
        law, q = _law(h, b, _ratio(a, b), digits)
        return 2 * mpf(a) / mpf(R) * law.slope(q)


def hertz_stiffness(R: mpf, lam: float, mu: float) -> mpf:
    """Return P/a^3 = 4 E*/(3 R) [N/m^3]."""
    first, second = mpf(lam), mpf(mu)
    return 16 * second * (first + second) / (first + 2 * second) / (3 * R)


def stiffness(
    a: float, R: float, h: float, b: float, lam: float, mu: float, digits: int = 40
) -> mpf:
    """Return dP/d delta [N/m] at a contact radius [m]: (dP/da)/(d delta/da)."""
    with mp.workdps(digits + _EXTRA):
        return 3 * hertz_stiffness(mpf(R), lam, mu) * mpf(a) ** 2 / slope(a, R, h, b, digits)


def contact_radius(delta: float, R: float, h: float, b: float, digits: int = 40) -> mpf:
    """Return the contact radius [m] at an indentation [m]."""

    def function(x: mpf, digits: int) -> tuple[mpf, mpf]:
        law, q = _law(h, b, x, digits)
        depth = law.depth(q)
        return x**2 * depth, 2 * law.slope(q) / depth

    with mp.workdps(digits + _EXTRA):
        target = mpf(delta) * mpf(R) / mpf(b) ** 2
        # Hertz's radius, or that of bending alone, x^3/(4 pi eta^3) = target, if it is smaller.
        start = min(mp.sqrt(target), mp.cbrt(4 * mp.pi * target) * mpf(h) / mpf(b))
        return mpf(b) * _root(function, target, start, digits)


def force_of_radius(a: float, R: float, lam: float, mu: float, digits: int = 40) -> mpf:
    """Return the force [N] at a contact radius [m]."""
    with mp.workdps(digits + _EXTRA):
        return hertz_stiffness(mpf(R), lam, mu) * mpf(a) ** 3


def radius_of_force(P: float, R: float, lam: float, mu: float, digits: int = 40) -> mpf:
    """Return the contact radius [m] at a force [N]."""
    with mp.workdps(digits + _EXTRA):
        return mp.cbrt(mpf(P) / hertz_stiffness(mpf(R), lam, mu))


def max_pressure(a: float, R: float, lam: float, mu: float, digits: int = 40) -> mpf:
    """Return p_0 = 3 P/(2 pi a^2) [Pa]."""
    with mp.workdps(digits + _EXTRA):
        return 3 * force_of_radius(a, R, lam, mu, digits) / (2 * mp.pi * mpf(a) ** 2)


def force(
    delta: float, R: float, h: float, b: float, lam: float, mu: float, digits: int = 40
) -> mpf:
    """Return the force [N] at an indentation [m]."""
    with mp.workdps(digits + _EXTRA):
        return force_of_radius(contact_radius(delta, R, h, b, digits), R, lam, mu, digits)


def impact(
    R: float, m: float, v0: float, h: float, b: float, lam: float, mu: float, digits: int = 30
) -> RouteImpact:
    """Return the results of an elastic impact of a sphere of mass m [kg] at speed v0 [m/s]."""

    def function(x: mpf, digits: int) -> tuple[mpf, mpf]:
        law, q = _law(h, b, x, digits)
        work = law.work(q)
        return (x / q) ** 5 * work, q**5 * law.slope(q) / work

    with mp.workdps(digits + _EXTRA):
        stiff = hertz_stiffness(mpf(R), lam, mu)
        unit = 2 * stiff * mpf(b) ** 5 / mpf(R)
        target = mpf(m) * mpf(v0) ** 2 / 2 / unit
        # Hertz's x^5/5, or x^6/(16 pi eta^3) of bending alone, if it gives the smaller x.
        bent = mp.root(16 * mp.pi * target * (mpf(h) / mpf(b)) ** 3, 6)
        x = _root(function, target, min(mp.root(5 * target, 5), bent), digits)
        law, largest = _law(h, b, x, digits)
        radius, unit = x * mpf(b), unit * (x / largest) ** 5
        depth, time = radius**2 / mpf(R), mp.sqrt(mpf(m) / (2 * unit))
        time *= 4 * depth * _quarter(law, largest, digits)
        return RouteImpact(time, depth * law.depth(largest), stiff * radius**3, radius)


def _root(
    function: Callable[[mpf, int], tuple[mpf, mpf]], target: mpf, start: mpf, digits: int
) -> mpf:
    """Return x in (0, 1) where an increasing function reaches its target: Newton in logarithms.

    The function returns its value and d log value/d log x to a number of digits, which is small at
    first. Its values at relative distances of 10^-(digits + 4) from the root must enclose the
    target.

    Raises
    ------
    ValueError
        If the target is reached only beyond the edge of the plate.
    RouteError
        If no root is found.
    """
    x = min(start, mpf(1) / 2)
    for shown in (min(_FEW, digits), digits):
        for _ in range(_STEPS):
            value, steepness = function(x, shown)
            step = mp.log(target / value) / steepness
            proposed = x * mp.exp(step)
            if proposed > EDGE and not function(EDGE, shown)[0] > target:
                raise ValueError("the contact would reach the edge of the plate")
            x = min(proposed, (x + EDGE) / 2)
            if abs(step) < mpf(10) ** (-shown // 2 - 4):
                break
    margin = x * mpf(10) ** (-digits - 4)
    if not function(x - margin, digits)[0] < target < function(x + margin, digits)[0]:
        raise RouteError(f"no root found near {mp.nstr(x)}")
    return x


def _quarter(of: ResidueLaw, largest: mpf, digits: int) -> mpf:
    """Return int_0^1 2 u r S/sqrt(E(largest) - E(q)) du: slope S, work E, q = largest (1 - u^2)."""
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
    """Return the sum of the half-axes of an ellipse without the singularities at a = +-4 i h."""
    square = complex(1, -4 * float(of.eta / (largest * of.known.reach)))
    u = cmath.sqrt(square)
    half = (abs(u - 1) + abs(u + 1)) / 2
    return min(ELLIPSE, half + math.sqrt(half * half - 1))


@lru_cache(maxsize=2)
def _fejer(count: int, bits: int) -> tuple[tuple[mpf, mpf], ...]:
    """Return positive nodes and weights of Fejer's first rule on [-1, 1]; `count` is even.

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
    nodes = []
    for k in range(count // 2):
        rest = sum(
            cosines[2 * i * (2 * k + 1) % (4 * count)] // (4 * i * i - 1)
            for i in range(1, count // 2 + 1)
        )
        weight = floating((1 << more) - 2 * rest, more) * 2 / count
        nodes.append((floating(cosines[2 * k + 1], more), weight))
    return tuple(nodes)
