"""Contact radius at an indentation, by Newton's iteration."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.code.runtime.data import LIMIT, MAX_INDENTATION, R
from derivation.scene.code.runtime.domain import _inside
from derivation.scene.code.runtime.growth_law import _law

_STEPS, _CLOSE = 40, 1e-9  # the size of the next Newton step is the square of the last one


def contact_radius(delta: ArrayLike) -> np.ndarray:
    """Return the contact radius [m] at indentations [m]; same domain as the force."""
    delta = _inside(delta)
    touching = np.where(delta > 0, delta, MAX_INDENTATION)
    # Newton's iteration for log a, from Hertz's radius or that of a thin plate.
    a = np.minimum(np.sqrt(R) * np.sqrt(touching), LIMIT * np.cbrt(touching / MAX_INDENTATION))
    for _ in range(_STEPS):
        _, radius, _, slope = _law(a)
        step = np.log(touching / radius) * radius / (a * slope)
        a = np.minimum(a * np.exp(np.clip(step, -1.0, 1.0)), LIMIT)
        if not (np.abs(step) > _CLOSE).any():
            break
    return np.where(delta > 0, a, delta)[()]
