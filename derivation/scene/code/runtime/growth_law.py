"""P = (4/3) E* a^3/R,   delta = (a^2/R) (1 + a F(a)),   F a polynomial."""

import numpy as np

from derivation.scene.code.runtime.data import GROWTH, MODULUS, R
from derivation.scene.code.runtime.panels import _place, _polynomial
from generated.scene_laws import growth_law


def _law(a: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return force P [N], indentation d [m], dP/da and dd/da at contact radii a [m]."""
    panel, s, half = _place(a)
    growth, growth_s = _polynomial(GROWTH[panel], s)
    return growth_law(a, np.asarray(R), np.asarray(MODULUS), growth, growth_s / half)
