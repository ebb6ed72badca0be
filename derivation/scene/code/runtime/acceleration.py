"""Acceleration of the sphere without gravity."""

import numpy as np

from derivation.scene.code.runtime.data import MASS


def _acceleration(force: np.ndarray) -> np.ndarray:
    """Return the acceleration [m/s^2] towards the plate under a contact force [N]."""
    return -force / MASS
