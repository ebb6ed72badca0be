"""Acceleration of a sphere that its weight presses on."""

import numpy as np

from derivation.scene.runtime.data import GRAVITY, MASS


def _acceleration(force: np.ndarray) -> np.ndarray:
    """Acceleration [m/s^2] of the sphere towards the plate under a contact force [N]."""
    return GRAVITY - force / MASS
