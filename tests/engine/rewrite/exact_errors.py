"""Errors of a function at a point, from exact values and condition numbers."""

import math
from collections.abc import Callable, Sequence

from mpmath import mp, mpf


def allowed_errors(
    exact: Callable[..., mpf], point: Sequence[float], computed: float
) -> tuple[float, float] | None:
    """Return the error and the sum of the condition numbers [ULP]; None without a value."""
    with mp.workdps(600):
        at = [mpf(x) for x in point]
        value = exact(*at)
        if mp.im(value) != 0 or not 1e-200 < abs(value) < 1e200:
            return None
        conditioning = mpf(0)
        for index, x in enumerate(at):
            step = x * mpf(10) ** -120
            moved = exact(*(y + step * (i == index) for i, y in enumerate(at)))
            conditioning += abs((moved - value) / value / mpf(10) ** -120)
        return float(abs(mpf(computed) - value) / mpf(math.ulp(float(value)))), float(conditioning)
