"""The panels of polynomials that the code of a scene holds."""

import numpy as np

from derivation.scene.code import _powers


def test_a_polynomial_keeps_its_length_where_its_highest_terms_vanish() -> None:
    """What a fit leaves there is rounding, or on some machines nothing at all."""
    assert _powers(np.array([1.0, 2.0, 1.0, 0.0, 0.0])).tolist() == [0.0, 2.0, 2.0, 0.0, 0.0]
