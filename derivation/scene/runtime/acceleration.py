"""Acceleration of a sphere without weight."""

import numpy as np

from derivation.scene.runtime.data import MASS


def _acceleration(force: np.ndarray) -> np.ndarray:
    """Acceleration [m/s^2] of the sphere towards the plate under a contact force [N]."""
    return -force / MASS
