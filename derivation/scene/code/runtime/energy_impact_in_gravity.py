"""Impact from the energy balance, with gravity."""

import numpy as np

from derivation.scene.code.runtime.data import GRAVITY, LARGEST_RADIUS, LIMIT, MASS, NODES, SPEED
from derivation.scene.code.runtime.energy import _contact_time, _gauss
from derivation.scene.code.runtime.hertz_law import _law
from derivation.scene.code.runtime.outcome import Impact


def impact(v0: float = SPEED) -> Impact:
    """Return the impact at a speed [m/s], by default SPEED; NaN outside the range of the law.

    The largest radius follows from energy, the time 2 int d delta/v from Gauss quadrature.
    """
    a = _turning_radius(v0)
    if not a > 0.0:
        return Impact(*(np.nan,) * 5)
    time, n = np.nan, NODES
    while n <= 32 * NODES:  # a slow, heavy sphere starts abruptly
        before, time = time, _contact_time(a, n)
        if abs(time / before - 1.0) <= 1e-12:
            break
        n *= 2
    P, delta, _, _ = _law(np.asarray(a))
    return Impact(time, float(delta), float(P), a, 1.0)


def _turning_radius(v0: float) -> float:
    """Return the largest contact radius [m], by Newton's iteration in logarithms."""
    if not 0.0 < v0 < np.inf:
        return float("nan")
    x, weights = _gauss(NODES)
    weight = MASS * GRAVITY
    a = min(LARGEST_RADIUS * (v0 / SPEED) ** 0.4, LIMIT)
    for _ in range(60):
        force, delta, _, slope = _law(a * np.append(x, 1.0))
        power = a * force * slope
        energy = float(weights @ power[:-1])
        supplied = 0.5 * MASS * v0 * v0 + weight * float(delta[-1])
        growth = float(power[-1]) / energy - a * weight * float(slope[-1]) / supplied
        step = np.log(supplied / energy) / growth
        if a >= LIMIT and step > 0.0:
            return float("nan")
        a = min(a * float(np.exp(np.clip(step, -1.0, 1.0))), LIMIT)
        if not abs(step) > 1e-15:
            break
    return a
