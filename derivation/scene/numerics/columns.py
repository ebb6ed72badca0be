"""Numbers of one scene, or of many scenes as columns."""

import numpy as np

from derivation.scene.kernels import Numbers
from generated.arrays import Double as Array


def at_most_one(change: Numbers) -> Numbers:
    """Return a change of a result [1], at most 1; 1 if it is unknown."""
    capped: Numbers = np.where(np.isfinite(change), np.minimum(change, 1.0), 1.0)
    return capped


def prepended(first: float, values: Array) -> Array:
    """Return the values of each scene with another one before them."""
    start = np.full((*values.shape[:-1], 1), first)
    return np.concatenate((start, values), axis=-1)


def number(x: Array) -> Numbers:
    """Return the number of one scene as a float, those of many scenes as a column."""
    return float(x.item()) if x.ndim == 1 else x


def most(values: Array) -> Array:
    """Return the largest value of each scene; NumPy compares few long rows faster than many."""
    return np.asarray(np.ascontiguousarray(values.T).max(axis=0))[..., None]


def least(values: Array) -> Array:
    """Return the smallest value of each scene."""
    return -most(-values)
