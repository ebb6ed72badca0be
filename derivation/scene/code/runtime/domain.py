"""Domain of the contact law."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.code.runtime.data import MAX_INDENTATION


def _inside(delta: ArrayLike) -> np.ndarray:
    """Return indentations, at least 0, and NaN outside the domain of the law."""
    delta = np.maximum(np.asarray(delta, dtype=np.float64), 0.0)
    return np.where(delta <= MAX_INDENTATION, delta, np.nan)
