"""Impact by Hertz's law."""

import numpy as np

from derivation.scene.code.runtime.data import HERTZ_TIME, LIMIT, MASS, MODULUS, SPEED, R
from derivation.scene.code.runtime.hertz_law import _law
from derivation.scene.code.runtime.outcome import Impact


def impact(v0: float = SPEED) -> Impact:
    """Return the impact at a speed [m/s], by default SPEED; NaN outside the range of the law.

    a = (15 m v0^2 R^2/(16 E*))^(1/5); the contact time is that of Hertz.
    """
    a = (0.9375 * MASS * v0 * v0 / MODULUS * R * R) ** 0.2
    if not (v0 > 0.0 and a <= LIMIT):
        return Impact(*(np.nan,) * 5)
    P, delta, _, _ = (float(x) for x in _law(np.asarray(a)))
    return Impact(HERTZ_TIME * delta / v0, delta, P, a, 1.0)
