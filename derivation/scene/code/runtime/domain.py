"""Domain of the contact law."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.code.runtime.data import MAX_INDENTATION


def _inside(delta: ArrayLike) -> np.ndarray:
    """Return indentations, at least 0, and NaN outside the domain of the law."""
    return np.where((x := np.maximum(delta, 0.0, dtype=np.float64)) <= MAX_INDENTATION, x, np.nan)
