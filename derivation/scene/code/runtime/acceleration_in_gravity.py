"""Acceleration of the sphere with gravity."""

import numpy as np

from derivation.scene.code.runtime.data import GRAVITY, MASS


def _acceleration(force: np.ndarray) -> np.ndarray:
    """Return the acceleration [m/s^2] towards the plate under a contact force [N]."""
    return GRAVITY - force / MASS
