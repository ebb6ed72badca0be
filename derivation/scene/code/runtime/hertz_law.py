"""P = (4/3) E* a^3/R,   delta = a^2/R."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.code.runtime.data import MODULUS, R
from derivation.scene.code.runtime.domain import _inside
from generated.scene_laws import hertz_law


def contact_radius(delta: ArrayLike) -> np.ndarray:
    """Return the contact radius [m] at indentations [m]; same domain as the force."""
    return np.sqrt(R * _inside(delta))


def _law(a: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return force P [N], indentation d [m], dP/da and dd/da at contact radii a [m]."""
    return hertz_law(a, np.asarray(R), np.asarray(MODULUS))
