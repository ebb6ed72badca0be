"""Impact with a viscoelastic contact, by time steps."""

import numpy as np
from numpy.polynomial.chebyshev import chebfit, chebval

from derivation.scene.code.runtime.data import LARGEST_RADIUS, LIMIT, RISE, SPEED
from derivation.scene.code.runtime.outcome import Impact
from derivation.scene.code.runtime.steps import (
    _MOST,
    _ORDER,
    _TIMES,
    _TOLERANCE,
    _end,
    _extrapolated,
    _largest,
)
from derivation.scene.code.runtime.viscous_motion import _forces, _start, _time


def impact(v0: float = SPEED) -> Impact:
    """Return the impact at a speed [m/s], by default SPEED; NaN outside the range of the law.

    The equation of motion is integrated until P = 0 by extrapolated midpoint steps. The result is
    also NaN if the sphere does not rebound.
    """
    nothing = Impact(*(np.nan,) * 5)
    if not 0.0 < v0 < np.inf:
        return nothing
    # Approximate radius and time of the impact are the units of the steps and of their errors.
    unit = LARGEST_RADIUS * (v0 / SPEED) ** 0.4
    state, scale, length = _start(v0, unit, RISE * (SPEED / v0) ** 0.2)
    largest = np.zeros(3)
    for _ in range(_MOST):
        states, error = _extrapolated(state, length * _TIMES, unit)
        series = chebfit(2.0 * _TIMES - 1.0, (states / scale).T, _ORDER)
        off = max(np.max(np.abs(error[:, -1:] / scale)), np.max(np.abs(series[-2:])))
        change = 0.9 * (_TOLERANCE / max(off, 1e-300)) ** (1.0 / _ORDER)
        if not off <= _TOLERANCE:
            length *= min(0.8, max(0.1, change)) if off < np.inf else 0.1
            continue
        P, _, depth, a = _forces(states, unit)
        rows = chebfit(2.0 * _TIMES - 1.0, np.array([depth, P, a]).T, _ORDER).T
        largest = np.maximum(largest, [_largest(row) for row in rows])
        if not largest[2] <= LIMIT or state[1, 0] < 0.0 < states[1, -1]:
            return nothing
        if P[-1] <= 0.0:
            last = chebval(_end(rows[1]), series) * scale[:, 0]
            depth_most, force_most, radius_most = (float(x) for x in largest)
            rebound = float(-last[1] / v0)
            return Impact(_time(last), depth_most, force_most, radius_most, rebound)
        state = states[:, -1:]
        length *= min(2.0, change)
    return nothing
