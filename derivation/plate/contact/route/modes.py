"""mpmath reference of the modes: zeros of J0 with their weights, and the plate factor."""

import math
from functools import cache

from mpmath import mp, mpf

_FAR = 30
"""Number of zeros for which an asymptotic expansion has too few digits."""


@cache
def mode(n: int, dps: int) -> tuple[mpf, mpf]:
    """Return j_n and 1/(j_n J1(j_n)^2)."""
    known = _known_digits(n)
    with mp.workdps(known + 5):
        zero = _far_zero(n) if n > _FAR else mp.besseljzero(0, n)
    steps = [dps + 5]
    while steps[-1] > 2 * known - 8:
        steps.append(steps[-1] // 2 + 4)
    for working in reversed(steps):  # each of Newton's steps doubles the digits
        with mp.workdps(working):
            value, slope = mp.besselj(0, zero), mp.besselj(1, zero)
            change = value / slope
            slope += change * (value - slope / zero)  # J1' = J0 - J1/z
            zero += change
    with mp.workdps(dps):
        return zero, 1 / (zero * slope**2)


def _known_digits(n: int) -> int:
    """Return digits of j_n before Newton's iteration; the expansion's next term is 1e9/(8 n pi)^9.

    For n up to `_FAR` they are those with which mpmath computes the zero.
    """
    return max(15, int(9 * math.log10(8 * math.pi * n)) - 10)


def _far_zero(n: int) -> mpf:
    """Return j_n for large n, by McMahon's expansion (Olver and Maximon, DLMF 10.21.19)."""
    beta = (n - mpf(1) / 4) * mp.pi
    e = 1 / (8 * beta) ** 2
    return beta + (1 - e * (mpf(124) / 3 - e * (mpf(120928) / 15 - e * 401743168 / 105))) / (
        8 * beta
    )


def excess(T: mpf) -> mpf:
    """Return G(T) - 1, with additional digits for its two cancellations."""
    lost = max(0, math.ceil(-4 * math.log10(float(abs(T)))))
    with mp.workdps(mp.dps + lost + 5):
        decay = mp.exp(-2 * T)
        numerator = 2 * decay * (1 - decay + 2 * T + 2 * T * T)
        return +(numerator / ((1 - decay) ** 2 - 4 * T * T * decay))
