"""What generated code refuses or answers with NaN: wrong types, counts, and plates it has not."""

import numpy as np
import pytest

from generated import G
from generated.reversed_series import force_by_series


def test_complex_arguments_are_refused() -> None:
    with pytest.raises(TypeError, match="expected real numbers or arrays of them, got complex128"):
        G(np.array([1.0 + 0.0j]))


def test_a_series_has_a_term() -> None:
    with pytest.raises(ValueError, match="expected at least one term, got terms=0"):
        force_by_series(1e-4, 0.13, 0.1, 1.0, 1e9, 1e9, terms=0)


def test_a_plate_out_of_range_has_no_series() -> None:
    found = force_by_series(1e-5, 0.13, [0.1, np.nan, -1.0], 1.0, 1e9, 1e9, terms=3)
    assert np.isnan(found).tolist() == [False, True, True]
