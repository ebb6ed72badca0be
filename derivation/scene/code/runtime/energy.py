"""Contact time from energy, by Gauss quadrature."""

import numpy as np
from numpy.polynomial.legendre import leggauss

from derivation.scene.code.runtime.acceleration import _acceleration
from derivation.scene.code.runtime.data import NODES
from derivation.scene.code.runtime.hertz_law import _law


def _contact_time(a: float, n: int) -> float:
    """Return the contact time [s] for a largest radius a [m], by n nodes in time.

    With q = 1 - u^2 the radius over a, v^2 = (2/m) times the energy absorbed from q to 1.
    """
    x, weights = _gauss(NODES)
    u, in_time = _gauss(n)
    q = 1.0 - u * u
    force, _, _, slope = _law(a * (q[:, None] + (1.0 - q)[:, None] * x))
    mean = (-_acceleration(force) * slope) @ weights
    return float(4.0 * a * in_time @ (_law(a * q)[3] / np.sqrt(2.0 * a * mean)))


def _gauss(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss nodes and weights on [0, 1]."""
    nodes, weights = leggauss(n)
    return 0.5 + 0.5 * nodes, 0.5 * weights
