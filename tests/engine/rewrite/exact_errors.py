"""Errors of a function at points, from exact values and condition numbers."""

import math
from collections.abc import Callable, Iterable, Sequence

from mpmath import mp, mpf

from derivation.engine.rewrite.several_variables import MOST_CONDITIONING

DIGITS = 600


def check_errors(
    exact: Callable[..., mpf],
    computed: Iterable[tuple[Sequence[float], float]],
    limit: float,
    share: float,
    least: float,
    most: float = MOST_CONDITIONING,
) -> None:
    """Check that errors are at most a limit plus a share of the sum of the condition numbers [ULP].

    Points with a sum above `most`, or without a value, are not checked; more than `least` must be.
    The condition numbers, which take most of the time, are computed until so many points are
    checked; then only for errors above the limit.
    """
    checked = 0
    for point, value in computed:
        with mp.workdps(DIGITS):
            exactly = exact(*map(mpf, point))
            if mp.im(exactly) != 0 or not 1e-200 < abs(exactly) < 1e200:
                continue
            error = float(abs(mpf(value) - exactly) / mpf(math.ulp(float(exactly))))
            if checked > least and error <= limit:
                continue
            conditioning = conditioning_of(exact, point, exactly)
        if conditioning <= most:
            assert error <= limit + share * conditioning, point
            checked += 1
    assert checked > least


def conditioning_of(exact: Callable[..., mpf], point: Sequence[float], value: mpf) -> float:
    """Return the sum of the condition numbers of a function with a value at a point."""
    at, total = [mpf(x) for x in point], mpf(0)
    for index, x in enumerate(at):
        step = x * mpf(10) ** -120
        moved = exact(*(y + step * (i == index) for i, y in enumerate(at)))
        total += abs((moved - value) / value / mpf(10) ** -120)
    return float(total)
