"""Sums over the modes, in blocks; a power of two near a number.

Arithmetic: the wave numbers of a block, sums of shares, and a power of two.
"""

from collections.abc import Callable

import numpy as np

from generated.arrays import Double
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros

BLOCK = 128
"""Modes summed at a time: bounds the memory at BLOCK times the number of points."""


def sum_modes(share: Callable[[Double, Double], np.ndarray], b: Double, modes: int) -> Double:
    """Sum of share(phi, J1) over the modes, the last axis, smallest shares first.

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
        total = total + share(zeros[block] / b, J1[block]).sum(axis=-1)
    return total


def power_of_two(x: Double) -> Double:
    """The power of two next to x towards zero, by which nothing is rounded; x is not negative."""
    unit: Double = np.ldexp(0.5, np.frexp(x)[1])
    return unit
