"""Force of an elastic contact."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.code.runtime.hertz_law import _law, contact_radius


def force(delta: ArrayLike) -> np.ndarray:
    """Return the contact force [N] at indentations [m].

    Parameters
    ----------
    delta : array_like
        Indentation [m]; up to MAX_INDENTATION

    Returns
    -------
    float or ndarray
        P [N]; 0 without contact (delta <= 0), NaN above MAX_INDENTATION.
    """
    return _law(contact_radius(delta))[0]
