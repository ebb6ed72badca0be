"""Impact by Hertz's law."""

import numpy as np

from derivation.scene.code.runtime.data import LIMIT, MASS, MODULUS, SPEED, R
from derivation.scene.code.runtime.outcome import Impact
from generated.scene_impact import hertz_impact


def impact(v0: float = SPEED) -> Impact:
    """Return the impact at a speed [m/s], by default SPEED; NaN outside the range of the law."""
    numbers = hertz_impact(R, MASS, v0 if v0 > 0.0 else np.nan, MODULUS)
    return Impact(*numbers, 1.0) if numbers[-1] <= LIMIT else Impact(*(np.nan,) * 5)
