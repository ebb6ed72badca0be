"""mpmath reference for clamped and supported plates: power series in r.

nabla^4 r^p = p^2 (p - 2)^2 r^(p - 4), so that two series, starting with 1 and with r^2, are all
solutions that are regular on the axis. No Bessel function is used: the two edge conditions form a
determinant whose changes of sign are counted from k = 0, and the norm is a quadrature.
"""

from typing import NamedTuple

from mpmath import mp, mpf

from derivation.engine.oracle.agreement import RouteError

STEP = mpf("0.25")
"""Step of k in the count, far below the distance of modes, about pi."""


class RouteMode(NamedTuple):
    """Wave number times plate radius, part of I0, and weight."""

    k: mpf
    c: mpf
    weight: mpf


def mode(edge: str, n: int, nu: float = 0.0, digits: int = 30) -> RouteMode:
    """Return the n-th mode of a plate with the given edge, "clamped" or "supported".

    The run time is proportional to n^2, because all lower modes are passed.
    """
    with mp.workdps(digits + 4 * n + 25):
        low, high = _interval(edge, n, mpf(nu))
        k = _bisected(edge, low, high, mpf(nu), digits + 3 * n + 15)
        one, other = (_series(start, k**4) for start in (0, 2))
        edge_one, edge_other = _at(one, 0, mpf(1)), _at(other, 2, mpf(1))

        def squared(r: mpf) -> mpf:
            return r * (edge_other * _at(one, 0, r) - edge_one * _at(other, 2, r)) ** 2

        norm = mp.quad(squared, mp.linspace(0, 1, n + 1))
        # w(0) = A (1 - c), nabla^2 w(0) = -k^2 A (1 + c), and nabla^2 r^2 = 4.
        ratio = k**2 * edge_other / (4 * edge_one)
        return RouteMode(k, (1 - ratio) / (1 + ratio), edge_other**2 / (2 * mp.pi * norm))


def _series(start: int, strength: mpf) -> list[mpf]:
    """Return the coefficients of r^start, r^(start + 4), ..."""
    coefficients = [mpf(1)]
    power = start
    while power < 20 or abs(coefficients[-1]) > mp.eps * mpf(10) ** -5:
        power += 4
        coefficients.append(coefficients[-1] * strength / mpf(power * (power - 2)) ** 2)
    return coefficients


def _at(series: list[mpf], start: int, r: mpf, slopes: int = 0) -> mpf:
    """Return the sum, or its first or second derivative, at r > 0."""
    fourth, total = r**4, mpf(0)
    for i in reversed(range(len(series))):
        power = start + 4 * i
        factor = (1, power, power * (power - 1))[slopes]
        total = total * fourth + factor * series[i]
    return total * r ** (start - slopes)


def _determinant(edge: str, k: mpf, nu: mpf) -> mpf:
    rows = []
    for start in (0, 2):
        series = _series(start, k**4)
        value, slope, bend = (_at(series, start, mpf(1), order) for order in range(3))
        rows.append((value, slope if edge == "clamped" else bend + nu * slope))
    return rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]


def _interval(edge: str, n: int, nu: mpf) -> tuple[mpf, mpf]:
    k, before, roots = mpf(0), _determinant(edge, mpf(0), nu), 0
    while k < 4 * (n + 1):
        value = _determinant(edge, k + STEP, nu)
        roots += (value > 0) != (before > 0)
        if roots == n:
            return k, k + STEP
        k, before = k + STEP, value
    raise RouteError(f"fewer than {n} modes up to k = {mp.nstr(k, 5)}")


def _bisected(edge: str, low: mpf, high: mpf, nu: mpf, digits: int) -> mpf:
    """Return the root by the Illinois variant of false position."""
    at_low, at_high = (_determinant(edge, k, nu) for k in (low, high))
    for _ in range(40 + 4 * digits):
        k = high - at_high * (high - low) / (at_high - at_low)
        value = _determinant(edge, k, nu)
        if (value > 0) != (at_high > 0):
            low, at_low = high, at_high
        else:
            at_low /= 2
        moved, high, at_high = abs(k - high), k, value
        if value == 0 or moved < mpf(10) ** -digits * high:
            return k
    raise RouteError(f"no root of the determinant near k = {mp.nstr(high, 8)}")
