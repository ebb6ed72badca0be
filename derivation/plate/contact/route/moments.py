"""mpmath reference of kappa_n and M_k: trapezoidal rule, K0 and I0 from their power series."""

from collections.abc import Callable, Iterator
from functools import cache

from mpmath import mp, mpf


@cache
def lateral_moment(n: int, digits: int) -> mpf:
    """Return int_0^oo y^n K0/I0 dy."""
    with mp.workdps(digits):
        return _trapezoids(lambda y: y**n * _lateral(y), n)


@cache
def lateral_moments(count: int, digits: int) -> tuple[mpf, ...]:
    """Return the first `count` of kappa_0, kappa_2, ..., from one set of nodes."""
    with mp.workdps(digits):
        step = 1 / (8 + mpf(4) / 5 * mp.dps + mp.sqrt(2 * count))
        points = list(_nodes(step, 2 * count))
        terms, squares = [w * _lateral(y) for y, w in points], [y * y for y, _ in points]
        moments = []
        for _ in range(count):
            moments.append(step * mp.fsum(terms))
            terms = [s * q for s, q in zip(terms, squares, strict=True)]
        return tuple(moments)


def _lateral(y: mpf) -> mpf:
    """Return K0/I0 = -log(y/2) - gamma + sum H_m (y/2)^(2m)/m!^2 / I0, at raised precision.

    The sums are sums of integers, in units of 2^-bits.
    """
    with mp.workdps(mp.dps + 10 + int(0.9 * y)):
        bits = mp.prec + 20
        square, term = int(mp.ldexp(y * y / 4, bits)), 1 << bits
        below, above, harmonic, m = term, 0, 0, 0
        while term > below >> bits:
            m += 1
            term = (term * square >> bits) // m**2
            harmonic += (1 << bits) // m
            below += term
            above += term * harmonic >> bits
        return mpf(above) / below - mp.log(y / 2) - mp.euler


@cache
def finite_part(k: int, digits: int) -> mpf:
    """Return FP int_0^oo T^(2k-4) (G - 1) dT.

    The powers 1/T^3 and 1/T are subtracted with a factor e^(-T^2); the finite part of
    T^(s-1) e^(-T^2) is Gamma(s/2)/2 without its pole. Near T = 0 the fourth power of T cancels,
    for which the precision is raised.
    """
    m = 2 * k - 4

    def rest(T: mpf) -> mpf:
        if digits * mp.log(10) < -mp.log(T):
            return mpf(0)  # the integrand is of the order of T
        with mp.workdps(6 * digits):
            excess = (mp.sinh(2 * T) / 2 + T) / (mp.sinh(T) ** 2 - T**2) - 1
            return T**m * excess - sum(c * T**p for p, c in poles.items()) * mp.exp(-T * T)

    with mp.workdps(digits):
        # G = 6/T^3 + 6/(5T) + ...; e^(-T^2) turns 1/T^3 into another -1/T.
        poles = {2: {-3: mpf(6), -1: mpf(36) / 5}, 3: {-1: mpf(6)}}.get(k, {})
        known = {-3: (mp.euler - 1) / 2, -1: -mp.euler / 2}
        return _trapezoids(rest, m) + sum(c * known[p] for p, c in poles.items())


def _trapezoids(function: Callable[[mpf], mpf], power: int) -> mpf:
    """Return int_0^oo of f ~ y^power e^(-2y) by equal steps of u, where y = exp(u - e^(-u))."""
    step = 1 / (8 + mpf(4) / 5 * mp.dps + mp.sqrt(power))
    return step * sum((w * function(y) for y, w in _nodes(step, power)), mpf(0))


def _nodes(step: mpf, power: int) -> Iterator[tuple[mpf, mpf]]:
    first = -int(mp.log(4 * mp.dps) / step)
    last = int(mp.log(power + 2 * mp.dps + 20) / step)
    for i in range(first, last + 1):
        fade = mp.exp(-i * step)
        y = mp.exp(i * step - fade)
        yield y, y * (1 + fade)


def leading_lateral_moment(n: mpf) -> mpf:
    """Return pi n!/2^(n+1), the leading term of kappa_n for large n."""
    return mp.pi * mp.factorial(n) / mpf(2) ** (n + 1)


def leading_finite_part(k: mpf) -> mpf:
    """Return (2k-2)!/2^(2k-3), the leading term of M_k for large k."""
    return mp.factorial(2 * k - 2) / mpf(2) ** (2 * k - 3)
