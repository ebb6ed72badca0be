"""P = (4/3) E* a^3/R,   delta = a^2/R."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.runtime.data import MODULUS, R
from derivation.scene.runtime.domain import _inside


def contact_radius(delta: ArrayLike) -> np.ndarray:
    """Contact radius [m] at indentations [m]; domain and NaN as those of the force."""
    return np.sqrt(R * _inside(delta))


def _law(a: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Force [N], indentation [m], and their slopes by the contact radius, at radii [m]."""
    return 4.0 / 3.0 * MODULUS / R * a**3, a * a / R, 4.0 * MODULUS / R * a * a, 2.0 * a / R
