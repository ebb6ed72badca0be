"""P = (4/3) E* (a^3/R) p(a),   delta = (a^2/R) (1 + a F(a)),   p and F polynomials."""

import numpy as np

from derivation.scene.code.runtime.data import FORCE, GROWTH, MODULUS, R
from derivation.scene.code.runtime.panels import _place, _polynomial
from generated.scene_laws import pressure_law


def _law(a: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return force P [N], indentation d [m], dP/da and dd/da at contact radii a [m]."""
    panel, s, half = _place(a)
    growth, growth_s = _polynomial(GROWTH[panel], s)
    force, force_s = _polynomial(FORCE[panel], s)
    bodies = np.asarray(R), np.asarray(MODULUS)
    return pressure_law(a, *bodies, growth, growth_s / half, force, force_s / half)
