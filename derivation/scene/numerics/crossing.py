"""Finds where a function of one variable increases through zero, or a condition becomes false."""

import math
from collections.abc import Callable
from typing import NamedTuple

_STEPS = 100


class _Point(NamedTuple):
    """A number and the value of the function there."""

    x: float
    value: float


def last_true(holds: Callable[[float], bool], low: float, high: float, halvings: int) -> float:
    """Return a number at which a condition is true, just below one at which it is false.

    The condition is true at `low` and false at `high`; the interval between them is halved.
    """
    for _ in range(halvings):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


def rise(of: Callable[[float], float], low: float, high: float, close: float = 0.0) -> float:
    """Return where a function increases through zero, to a few ULP or to a given accuracy.

    It is not negative at the result, and negative just below it. Each step uses inverse quadratic
    interpolation if this is reliable, or halves the interval (Chandrupatla 1997).

    Parameters
    ----------
    of
        A function that is not negative at `high`. If it is not negative at `low` either, the
        interval is halved towards it until the function is negative.
    close
        Sufficient accuracy of the result. If it is above 0, any zero that is found is sufficient,
        too.
    """
    below, above, part = _Point(low, of(low)), _Point(high, of(high)), 0.5
    for _ in range(_STEPS):
        length = above.x - below.x
        least = 2.0 * math.ulp(above.x) / length
        if least >= 0.5 or length <= close or (close and not above.value):
            break
        x = below.x + min(max(part, least), 1.0 - least) * length
        new = _Point(x, of(x))
        old, below, above = (below, new, above) if new.value < 0.0 else (above, below, new)
        part = _interpolated(below, above, old)
    return above.x


def _interpolated(below: _Point, above: _Point, old: _Point) -> float:
    """Return the part of the interval below the zero, or half if it cannot be interpolated.

    `old` is the end of the interval before the last step.
    """
    if not below.value < 0.0 <= above.value or old.value in (below.value, above.value):
        return 0.5
    new, other = (above, below) if old.x > above.x else (below, above)
    xi = (new.x - other.x) / (old.x - other.x)
    phi = (new.value - other.value) / (old.value - other.value)
    if not (phi * phi < xi and (1.0 - phi) ** 2 < 1.0 - xi):
        return 0.5
    to_above, to_old = above.value - below.value, old.value - below.value
    at_old = (old.x - below.x) / (above.x - below.x)
    between = above.value - old.value
    return below.value * (old.value / to_above - at_old * above.value / to_old) / between
