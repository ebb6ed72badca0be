"""Polynomials on panels."""

import numpy as np

from derivation.scene.code.runtime.data import ENDS, GROWTH


def _place(a: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return panels of contact radii [m], positions in them from -1 to 1, and half widths [m]."""
    panel = np.searchsorted(ENDS[1:-1], a) if len(GROWTH) > 1 else np.array(0)
    half = 0.5 * (ENDS[panel + 1] - ENDS[panel])
    return panel, (a - ENDS[panel]) / half - 1.0, half


def _polynomial(rows: np.ndarray, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return a polynomial and its slope at s, by Horner's rule."""
    value, slope = rows[..., -1], np.zeros_like(s)
    for column in range(rows.shape[-1] - 2, -1, -1):
        slope = slope * s + value
        value = value * s + rows[..., column]
    return value, slope
