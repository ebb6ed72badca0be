"""P = (4/3) E* a^3/R,   delta = (a^2/R) (1 + a F(a)),   F a polynomial."""

import numpy as np

from derivation.scene.code.runtime.data import GROWTH, MODULUS, R
from derivation.scene.code.runtime.panels import _place, _polynomial


def _law(a: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return force P [N], indentation d [m], dP/da and dd/da at contact radii a [m]."""
    panel, s, half = _place(a)
    growth, growth_s = _polynomial(GROWTH[panel], s)
    delta = a * (a / R) * (1.0 + a * growth)
    delta_a = a / R * (2.0 + 3.0 * a * growth + a * a / half * growth_s)
    stiffness = 4.0 / 3.0 * MODULUS / R
    return stiffness * a**3, delta, 3.0 * stiffness * a * a, delta_a
