"""Relaxed force of a viscoelastic contact."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.runtime.hertz_law import _law, contact_radius


def elastic_force(delta: ArrayLike) -> np.ndarray:
    """Contact force without viscosity [N] at indentations [m].

    Parameters
    ----------
    delta : array_like
        Indentation, or the inner state where there is one [m]; up to MAX_INDENTATION

    Returns
    -------
    float or ndarray
        P_e [N]; 0 where nothing touches, delta <= 0; NaN beyond MAX_INDENTATION.
    """
    return _law(contact_radius(delta))[0]
