"""The piecewise polynomials in the generated code of a scene."""

import numpy as np

from derivation.scene.code.code import _powers


def test_polynomial_keeps_vanishing_highest_terms() -> None:
    """The highest coefficients of a fit may be exactly zero on some machines."""
    assert _powers(np.array([1.0, 2.0, 1.0, 0.0, 0.0])).tolist() == [0.0, 2.0, 2.0, 0.0, 0.0]
