"""Bounds on the errors of the results (derivation step 18) for many laws: vectorised law_errors."""

import numpy as np
from numpy.typing import NDArray

from generated.arrays import Double as Array
from generated.simple_impact import SLACK, TOP
from generated.simple_impact_kernels import elasticities


def law_errors(
    low: Array, up: Array, fall: Array, rise: Array, energy: Array | float = 0.0
) -> tuple[Array, Array, Array, Array]:
    """Return bounds on the relative errors of the results if S is 1 - low to 1 + up times S_1.

    Parameters
    ----------
    low, up
        Not negative [1]; valid up to 1.02 times the largest radius by S_1.
    fall, rise
        d log S_1/d log a is between -fall and rise [1].
    energy
        Logarithm of the factor by which the contact may absorb more than the kinetic energy; not
        negative [1].

    Returns
    -------
    tuple of ndarray
        Errors of contact time, largest indentation, force and contact radius [1]; infinite where
        there is no bound.
    """
    known = (low < 1.0) & (up < np.inf) & (fall < 2.0)
    loss, gain = -np.log1p(-np.where(known, low, 0.0)), np.log1p(np.where(known, up, 0.0))
    elasticity, depth, shorter, longer = elasticities(fall, rise)  # type: ignore[arg-type]
    wider, narrower = (loss + energy) / elasticity, gain / elasticity
    known = known & np.less(wider, np.log(TOP))
    longer = np.maximum(0.0, longer)
    time = np.maximum(
        gain + 0.5 * loss + 0.5 * energy + np.maximum(longer * wider, shorter * narrower),
        loss + 0.5 * gain + np.maximum(shorter * wider, longer * narrower),
    )
    deeper = np.maximum(gain + depth * wider, loss + depth * narrower)
    radius = np.maximum(wider, narrower)
    return (
        _relative(time, known),
        _relative(deeper, known),
        _relative(3.0 * radius, known),
        _relative(radius, known),
    )


def _relative(logarithm: Array, known: NDArray[np.bool_]) -> Array:
    """Return the relative error from the logarithm of a factor."""
    return np.where(known & (logarithm < 700.0), np.expm1(logarithm) * SLACK, np.inf)
