"""The largest radius of a contact with non-Hertzian pressure that is closed at its centre."""

import math
from functools import lru_cache

import numpy as np

from derivation.scene.contact_law.solved_contact import MANY, SolvedCase, centres_at, force_at
from generated.arrays import Double as Array

CLOSE = 1e-9
"""Sufficient relative accuracy of the radius."""
ROUNDS = 40
"""Largest number of rounds, far more than are needed."""
EVEN = np.arange(1.0, 9.0) / 9.0
"""Points within an interval, over its length: as many as are solved in one block."""
NEAR = np.array([0.5, 1e-2, 1e-4, 1e-7])
"""Distances of radii from an estimate, over that of the end of the interval."""
USED = 5
"""Number of radii from which an estimate is computed."""


@lru_cache(maxsize=MANY)
def closed_up_to(case: SolvedCase, high: float) -> float:
    """Return the radius [m], at most `high`, up to which a contact is closed at its centre.

    The pressure is non-Hertzian; several laws of a scene share the result. The pressure at the
    centre vanishes at the radius, and beyond it there is no solution. From some radii below,
    inverse interpolation gives an estimate, around which the next radii lie.
    """
    if math.isfinite(force_at(high, case)):
        return high
    low, radii, known = 0.0, high * EVEN, np.empty((2, 0))
    for _ in range(ROUNDS):
        pressures = centres_at(radii, case)
        closed = int(np.argmin(np.append(np.isfinite(pressures), False)))
        low, high = (low, *radii, high)[closed : closed + 2]
        if high - low <= CLOSE * high:
            break
        known = np.hstack((known, [radii[:closed], pressures[:closed]]))[:, -USED:]
        zero = _at_zero(*known)
        radii = low + (high - low) * EVEN
        if low < zero < high:
            radii = np.append(zero - (zero - low) * NEAR, zero + (high - zero) * NEAR[::-1])
    return float(low)


def _at_zero(values: Array, at: Array) -> float:
    """Return the interpolated value at zero from values at other numbers; NaN without any."""
    with np.errstate(all="ignore"):  # equal numbers give no value
        for order in range(1, len(at)):
            first, last = at[:-order], at[order:]
            values = (last * values[:-1] - first * values[1:]) / (last - first)
    return float(values[0]) if len(values) else math.nan
