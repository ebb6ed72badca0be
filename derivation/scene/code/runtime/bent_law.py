"""P = (4/3) E* a^3/R,   delta = (a^2/R) (1 + BEND a)."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.code.runtime.data import BEND, MODULUS, R
from derivation.scene.code.runtime.domain import _inside


def contact_radius(delta: ArrayLike) -> np.ndarray:
    """Return the contact radius [m] at indentations [m]; same domain as the force."""
    hertz = np.sqrt(R * _inside(delta))
    # a = hertz/t, t^3 - t = BEND hertz, whose root is t = (2/sqrt(3)) cos(arccos(w)/3).
    w = 1.5 * np.sqrt(3.0) * BEND * hertz
    near, far = np.arccos(np.minimum(w, 1.0)), np.arccosh(np.maximum(w, 1.0))
    return 0.5 * np.sqrt(3.0) * hertz / np.where(w <= 1.0, np.cos(near / 3.0), np.cosh(far / 3.0))


def _law(a: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return force P [N], indentation d [m], dP/da and dd/da at contact radii a [m]."""
    stiffness = 4.0 / 3.0 * MODULUS / R
    depth, slope = 1.0 + BEND * a, 2.0 + 3.0 * BEND * a
    return stiffness * a**3, a * a / R * depth, 3.0 * stiffness * a * a, a / R * slope
