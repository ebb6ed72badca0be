"""Sums over the modes, computed in blocks, and powers of two for scaling.

Arithmetic: the wave numbers of a block, sums of contributions, and a power of two.
"""

from collections.abc import Callable

import numpy as np

from generated.arrays import Double
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros

BLOCK = 128
"""Number of modes in one block: limits the memory to BLOCK times the number of points."""


def sum_modes(term: Callable[[Double, Double], np.ndarray], b: Double, modes: int) -> Double:
    """Return the sum of term(phi, J1) over the modes, the last axis, smallest terms first.

    Raises
    ------
    ValueError
        If there is no mode.
    """
    if modes < 1:
        raise ValueError(f"expected at least one mode, got modes={modes}")
    zeros, J1 = bessel_j0_zeros(modes), bessel_j1_at_j0_zeros(modes)
    total: Double = np.zeros(())
    for start in reversed(range(0, modes, BLOCK)):
        block = slice(start, min(start + BLOCK, modes))
        total = total + term(zeros[block] / b, J1[block]).sum(axis=-1)
    return total


def power_of_two(x: Double) -> Double:
    """Return the largest power of two not above x; multiplication by it is exact. x >= 0."""
    unit: Double = np.ldexp(0.5, np.frexp(x)[1])
    return unit
