"""Polynomials of the contact law: Horner's rule with slope, and cells of plates of like thickness.

Arithmetic: Horner's rule, and a variable scaled to [-1, 1] in a cell.
"""

from collections.abc import Iterator

import numpy as np

from generated.arrays import Double

Cells = tuple[tuple[float, float, Double], ...]
"""Polynomials in b/h: for each its first and last b/h, and its rows."""


def in_cells(v: Double, cells: Cells) -> Iterator[tuple[np.ndarray, Double, float, Double]]:
    """Which v are in a cell, where in [-1, 1] of it, half its width, its rows for such points."""
    for first, last, rows in cells:
        chosen = np.flatnonzero((v > first) & (v <= last))
        if chosen.size:
            half = 0.5 * (last - first)
            yield chosen, (v[chosen] - 0.5 * (first + last)) / half, half, rows[:, :, None]


def horner(coefficients: list[Double] | list[float] | Double, t: Double) -> tuple[Double, Double]:
    """A polynomial and its slope, in place, as blocks of points stay in the cache."""
    value: Double = coefficients[-1] * t + coefficients[-2]
    slope = np.full_like(value, coefficients[-1])
    for coefficient in coefficients[-3::-1]:
        slope *= t
        slope += value
        value *= t
        value += coefficient
    return value, slope
