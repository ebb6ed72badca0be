"""P = (4/3) E* (a^3/R) p(a),   delta = (a^2/R) (1 + a F(a)),   p and F polynomials."""

import numpy as np

from derivation.scene.code.runtime.data import FORCE, GROWTH, MODULUS, R
from derivation.scene.code.runtime.panels import _place, _polynomial


def _law(a: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return force P [N], indentation d [m], dP/da and dd/da at contact radii a [m]."""
    panel, s, half = _place(a)
    growth, growth_s = _polynomial(GROWTH[panel], s)
    delta = a * (a / R) * (1.0 + a * growth)
    delta_a = a / R * (2.0 + 3.0 * a * growth + a * a / half * growth_s)
    force, force_s = _polynomial(FORCE[panel], s)
    stiffness = 4.0 / 3.0 * MODULUS / R
    force_a = stiffness * a * a * (3.0 * force + a / half * force_s)
    return stiffness * a**3 * force, delta, force_a, delta_a
