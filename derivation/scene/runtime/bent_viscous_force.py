"""Force of a viscoelastic contact on a plate that bends, and the rate of its inner state."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.runtime.data import COMPLIANCE, RETARDATION_TIME
from derivation.scene.runtime.elastic_force import elastic_force
from derivation.scene.runtime.stiffness import stiffness


def force(delta: ArrayLike, elastic: ArrayLike) -> np.ndarray:
    """Contact force [N] at indentations [m] and inner states; it cannot pull.

    Formula::

        P = max(0, P_e + (delta - elastic)/COMPLIANCE),   P_e = elastic_force(elastic)

    Parameters
    ----------
    delta : array_like
        Indentation [m]
    elastic : array_like
        Inner state [m], which `elastic_rate` moves; up to MAX_INDENTATION

    Returns
    -------
    float or ndarray
        P [N] in the arguments' broadcast shape; 0 for elastic <= 0; NaN beyond MAX_INDENTATION.
    """
    delta, elastic = np.asarray(delta, dtype=np.float64), np.asarray(elastic, dtype=np.float64)
    bent = np.where(elastic > 0, delta - elastic, 0.0) / COMPLIANCE
    return np.maximum(elastic_force(elastic) + bent, 0.0)


def elastic_rate(delta: ArrayLike, elastic: ArrayLike) -> np.ndarray:
    """Rate [m/s] of the inner state: the indentation at which a relaxed contact has the force P_e.

    Bending follows the force at once, the contact indentation lags it (retardation time A_v)::

        delta = elastic + COMPLIANCE (P - P_e),   P = P_e + A_v dP_e/dt
        d elastic/dt = (delta - elastic)/(A_v COMPLIANCE dP_e/d elastic)

    An impact begins with elastic = 0, where this is infinite; P_e is smooth there and may be
    the state instead: dP_e/dt = (delta - elastic)/(A_v COMPLIANCE). Stiff: its time scale is
    A_v COMPLIANCE dP_e/d elastic. The contact ends where `force` comes down to 0.

    Parameters
    ----------
    delta : array_like
        Indentation [m]
    elastic : array_like
        Inner state [m]; above 0, up to MAX_INDENTATION

    Returns
    -------
    float or ndarray
        In the arguments' broadcast shape; NaN outside the domain.
    """
    delta, elastic = np.asarray(delta, dtype=np.float64), np.asarray(elastic, dtype=np.float64)
    elastic = np.where(elastic > 0, elastic, np.nan)
    return (delta - elastic) / (RETARDATION_TIME * COMPLIANCE * stiffness(elastic))
