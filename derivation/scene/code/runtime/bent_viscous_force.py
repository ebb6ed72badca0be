"""Force of a viscoelastic contact on a plate that bends, and the rate of its internal state."""

import numpy as np
from numpy.typing import ArrayLike

from derivation.scene.code.runtime.data import COMPLIANCE, RETARDATION_TIME
from derivation.scene.code.runtime.elastic_force import elastic_force
from derivation.scene.code.runtime.stiffness import stiffness
from generated.viscosity_kernels import bent_viscous_force


def force(delta: ArrayLike, elastic: ArrayLike) -> np.ndarray:
    """Return the contact force [N] at indentations [m] and internal states, never negative.

    Formula::

        P = max(0, P_e + (delta - elastic)/COMPLIANCE),   P_e = elastic_force(elastic)

    Parameters
    ----------
    delta : array_like
        Indentation [m]
    elastic : array_like
        Internal state [m], whose rate is `elastic_rate`; up to MAX_INDENTATION

    Returns
    -------
    float or ndarray
        P [N] in the broadcast shape of the arguments; 0 for elastic <= 0, NaN above
        MAX_INDENTATION.
    """
    delta, elastic = np.asarray(delta, dtype=np.float64), np.asarray(elastic, dtype=np.float64)
    lag = np.where(elastic > 0, delta - elastic, 0.0)
    plate = np.asarray(COMPLIANCE), np.asarray(RETARDATION_TIME)
    return np.maximum(bent_viscous_force(elastic_force(elastic), lag, *plate)[0], 0.0)


def elastic_rate(delta: ArrayLike, elastic: ArrayLike) -> np.ndarray:
    """Return the rate [m/s] of the internal state, the relaxed indentation under the force P_e.

    Bending is elastic; the local indentation lags the force (retardation time A_v)::

        delta = elastic + COMPLIANCE (P - P_e),   P = P_e + A_v dP_e/dt
        d elastic/dt = (delta - elastic)/(A_v COMPLIANCE dP_e/d elastic)

    An impact begins with elastic = 0, where the rate is infinite; P_e is smooth there and can
    be used as the state instead: dP_e/dt = (delta - elastic)/(A_v COMPLIANCE). The equation is
    stiff, with the time scale A_v COMPLIANCE dP_e/d elastic. The contact ends when `force`
    falls to 0.

    Parameters
    ----------
    delta : array_like
        Indentation [m]
    elastic : array_like
        Internal state [m]; above 0, up to MAX_INDENTATION

    Returns
    -------
    float or ndarray
        Rate in the broadcast shape of the arguments; NaN outside the domain.
    """
    delta, elastic = np.asarray(delta, dtype=np.float64), np.asarray(elastic, dtype=np.float64)
    elastic = np.where(elastic > 0, elastic, np.nan)
    plate = np.asarray(COMPLIANCE), np.asarray(RETARDATION_TIME)
    return bent_viscous_force(np.asarray(0.0), delta - elastic, *plate)[1] / stiffness(elastic)
