"""Narrows an interval of trial values that encloses the constant of a measured restitution."""

import math
from collections.abc import Callable

from derivation.scene.measured.trial import Point
from derivation.scene.numerics.crossing import rise

ROUGH = 1e-2
"""Interval of the logarithm of a value that ends a rough search; the relative difference from the
measured restitution that does so, too."""
AGREES = 0.1
"""Relative difference from the measured restitution that suffices, over the error bound."""


def near_solution(at: Callable[[float], Point], low: Point, high: Point, close: float) -> Point:
    """Return a trial value whose restitution is close to the measured one, or where it jumps.

    Parameters
    ----------
    at
        Simulates with the value whose logarithm is given.
    low, high
        Trial values that enclose the solution.
    close
        Difference of the restitution that suffices.
    """
    while True:
        near = min(low, high, key=lambda point: abs(point.above))
        if abs(near.above) <= close or abs(high.x - low.x) <= ROUGH:
            return near
        x = (low.x * high.above - high.x * low.above) / (high.above - low.above)
        # Not at an end of the interval again, near which the restitution is not linear.
        margin = 0.1 * (high.x - low.x)
        point = at(min(max(x, low.x + margin), high.x - margin))
        low, high = (point, high) if point.above * low.above > 0.0 else (low, point)


def solution(
    at: Callable[[float], Point], low: Point, high: Point, goal: float, close: float
) -> float:
    """Return the value whose restitution agrees with the measured one within its error.

    Parameters
    ----------
    at, low, high
        As in `near_solution`.
    goal
        The measured restitution.
    close
        Relative accuracy of the value that suffices [1].
    """
    sign = math.copysign(1.0, high.above)

    def above(x: float) -> float:
        """Return an increasing difference from the measured restitution; 0 within its error."""
        point = at(x)
        error = point.above + goal - point.least
        return 0.0 if abs(point.above) <= AGREES * error else sign * point.above

    return math.exp(rise(above, low.x, high.x, close))
