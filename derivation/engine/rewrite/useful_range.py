"""The largest range of a variable in which the errors of a form are small."""

import math
from collections.abc import Callable, Sequence

ENDS = (1e-150, 1e150)
"""The range that is tested first."""
ENOUGH = 8.0
"""Error in ULP above which a form is rejected."""
QUIET = ENOUGH / 2
"""Largest error [ULP] at the ends of a range."""
LEAST_RATIO = 10.0
"""Smallest accepted ratio of the upper to the lower end."""
_STILL = 4
_SIGNIFICANT = 4


def useful_range(
    errors: Sequence[tuple[float, float]], ends: tuple[float, float]
) -> tuple[float, float]:
    """Return the largest range without errors above the limit, and with small errors at its ends.

    Ranges are compared by the ratio of their ends, first within 1e-9 to 1e9, then in total. Without
    such a range the lower end is above the upper one.

    Parameters
    ----------
    errors
        Points in ascending order, with the error at each [ULP].
    ends
        Ends that are not rounded.
    """
    runs: list[list[tuple[float, float]]] = [[]]
    for point, error in errors:
        if error > ENOUGH:
            runs.append([])
        else:
            runs[-1].append((point, error))
    ranges = []
    for run in runs:
        first = 0 if run and run[0][0] == errors[0][0] else _quiet([e for _, e in run])
        last = 0 if run and run[-1][0] == errors[-1][0] else _quiet([e for _, e in reversed(run)])
        kept = run[first : len(run) - last]
        if kept:
            low, high = kept[0][0], kept[-1][0]
            ranges.append((rounded(low, math.ceil, ends), rounded(high, math.floor, ends)))
    return max(ranges, key=range_size, default=(1.0, 0.0))


def _quiet(errors: Sequence[float]) -> int:
    """Return the number of points to omit before several successive errors are small."""
    for start in range(len(errors)):
        if max(errors[start : start + _STILL]) <= QUIET:
            return start
    return len(errors)


def range_size(ends: tuple[float, float]) -> tuple[float, float]:
    """Return the size by which ranges are compared."""
    low, high = ends
    if not low < high:
        return -math.inf, 0.0
    usual = min(max(low, 1e-9), 1e9), min(max(high, 1e-9), 1e9)
    return math.log(usual[1] / usual[0]), math.log10(high) - math.log10(low)


def rounded(end: float, how: Callable[[float], int], ends: tuple[float, float]) -> float:
    """Return an end with few digits, moved inwards."""
    if end in ends:
        return end
    unit = 10.0 ** (math.floor(math.log10(end)) - _SIGNIFICANT + 1)
    return float(f"{how(end / unit) * unit:.{_SIGNIFICANT}g}")
