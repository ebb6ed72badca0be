"""Piecewise polynomials of the contact law: Horner's rule with slope, and cells in 1/eta.

Arithmetic: Horner's rule, and the scaling of a variable to [-1, 1] in its cell.
"""

from collections.abc import Iterator

import numpy as np

from generated.arrays import Double

Cells = tuple[tuple[float, float, Double], ...]
"""Cells of b/h: the first and last b/h of each, and the rows of its polynomials."""


def in_cells(v: Double, cells: Cells) -> Iterator[tuple[np.ndarray, Double, float, Double]]:
    """Yield for each cell the indices of the v in it, their positions in [-1, 1], half-width, rows.

    Cells without any v are skipped.
    """
    for first, last, rows in cells:
        chosen = np.flatnonzero((v > first) & (v <= last))
        if chosen.size:
            half = 0.5 * (last - first)
            yield chosen, (v[chosen] - 0.5 * (first + last)) / half, half, rows[:, :, None]


def horner(coefficients: list[Double] | list[float] | Double, t: Double) -> tuple[Double, Double]:
    """Return a polynomial and its derivative with respect to t, in place (blocks fit the cache)."""
    value: Double = coefficients[-1] * t + coefficients[-2]
    slope = np.full_like(value, coefficients[-1])
    for coefficient in coefficients[-3::-1]:
        slope *= t
        slope += value
        value *= t
        value += coefficient
    return value, slope
