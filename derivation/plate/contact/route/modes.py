"""mpmath reference of the modes: zeros of J0 with their weights, and the plate factor."""

import math
from functools import cache

from mpmath import mp, mpf

_COARSE = 15
"""Digits of a zero at the start of Newton's iteration, each step of which doubles them."""


@cache
def mode(n: int, dps: int) -> tuple[mpf, mpf]:
    """Return j_n and 1/(j_n J1(j_n)^2)."""
    with mp.workdps(_COARSE):
        zero = mp.besseljzero(0, n)
    steps = [dps + 5]
    while steps[-1] > _COARSE:
        steps.append(steps[-1] // 2 + 4)
    for working in reversed(steps):
        with mp.workdps(working):
            zero += mp.besselj(0, zero) / mp.besselj(1, zero)
    with mp.workdps(dps):
        return zero, 1 / (zero * mp.besselj(1, zero) ** 2)


def excess(T: mpf) -> mpf:
    """Return G(T) - 1, with additional digits for its two cancellations."""
    lost = max(0, math.ceil(-4 * math.log10(float(abs(T)))))
    with mp.workdps(mp.dps + lost + 5):
        decay = mp.exp(-2 * T)
        numerator = 2 * decay * (1 - decay + 2 * T + 2 * T * T)
        return +(numerator / ((1 - decay) ** 2 - 4 * T * T * decay))
