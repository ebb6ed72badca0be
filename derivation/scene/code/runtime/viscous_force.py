"""Force of a viscoelastic contact on a plate that does not bend."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.code.runtime.data import RETARDATION_TIME
from derivation.scene.code.runtime.elastic_force import elastic_force
from derivation.scene.code.runtime.stiffness import stiffness
from generated.viscosity_kernels import viscous_force


def force(delta: ArrayLike, rate: ArrayLike = 0.0) -> np.ndarray:
    """Return the contact force [N] at indentations [m] and rates [m/s], never negative.

    Formula::

        P = max(0, P_e + A_v (dP_e/d delta) rate),   P_e = elastic_force(delta)

    Parameters
    ----------
    delta : array_like
        Indentation [m]; up to MAX_INDENTATION
    rate : array_like
        d delta/dt [m/s], positive while the indentation increases

    Returns
    -------
    float or ndarray
        P [N] in the broadcast shape of the arguments; 0 for delta <= 0, NaN above
        MAX_INDENTATION.
    """
    rate, time = np.asarray(rate, dtype=np.float64), np.asarray(RETARDATION_TIME)
    return np.maximum(viscous_force(elastic_force(delta), stiffness(delta), rate, time), 0.0)
