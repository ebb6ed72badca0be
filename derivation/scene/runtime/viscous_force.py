"""Force of a viscoelastic contact on a plate that does not bend."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.runtime.data import RETARDATION_TIME
from derivation.scene.runtime.elastic_force import elastic_force
from derivation.scene.runtime.stiffness import stiffness


def force(delta: ArrayLike, rate: ArrayLike = 0.0) -> np.ndarray:
    """Contact force [N] at indentations [m] that grow at rates [m/s]; it cannot pull.

    Formula::

        P = max(0, P_e + A_v (dP_e/d delta) rate),   P_e = elastic_force(delta)

    Parameters
    ----------
    delta : array_like
        Indentation [m]; up to MAX_INDENTATION
    rate : array_like
        d delta/dt [m/s], above 0 while the sphere comes in

    Returns
    -------
    float or ndarray
        P [N] in the arguments' broadcast shape; 0 for delta <= 0; NaN beyond MAX_INDENTATION.
    """
    rate = np.asarray(rate, dtype=np.float64)
    return np.maximum(elastic_force(delta) + RETARDATION_TIME * stiffness(delta) * rate, 0.0)
