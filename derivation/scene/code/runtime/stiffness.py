"""Stiffness of the contact law."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.code.runtime.data import MAX_INDENTATION
from derivation.scene.code.runtime.domain import _inside
from derivation.scene.code.runtime.hertz_law import _law, contact_radius


def stiffness(delta: ArrayLike) -> np.ndarray:
    """Return the slope of the elastic force [N/m]; 0 and NaN where the force is 0 and NaN."""
    delta = _inside(delta)
    _, _, force_a, delta_a = _law(contact_radius(np.where(delta > 0, delta, MAX_INDENTATION)))
    return np.where(delta > 0, force_a / delta_a, delta)[()]
