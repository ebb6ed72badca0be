"""Input that generated functions reject, or for which they return NaN."""

import numpy as np
import pytest

from generated import G, simple_impact
from generated.reversed_series import force_by_series


def test_complex_arguments_are_rejected() -> None:
    with pytest.raises(TypeError, match=r"real numbers .*complex128"):
        G(np.array([1.0 + 0.0j]))


def test_series_needs_at_least_one_term() -> None:
    with pytest.raises(ValueError, match="expected at least one term, got terms=0"):
        force_by_series(1e-4, 0.13, 0.1, 1.0, 1e9, 1e9, terms=0)


def test_series_is_nan_for_an_invalid_plate() -> None:
    actual = force_by_series(1e-5, 0.13, [0.1, np.nan, -1.0], 1.0, 1e9, 1e9, terms=3)
    assert np.isnan(actual).tolist() == [False, True, True]


def test_leading_correction_is_none_for_wide_contacts() -> None:
    """For a thick block c_1 a/h is about -0.96 a/b, which is not small for a wide contact."""
    narrow, wide = (
        simple_impact.leading(0.1, 3.0, v0, 1.0, 0.05, 2e9, 3e9) for v0 in (10.0, 300.0)
    )
    assert narrow is not None
    assert wide is None
    assert all(np.isnan(x) for x in simple_impact.plate_of(np.nan))


def test_maximum_radius_exists_only_for_small_corrections() -> None:
    """s^5 (1 + y s) = 1 has a root up to y s = -2/3, where s = 3^(1/5)."""
    limit = -2.0 / 3.0 / 3.0**0.2
    root = simple_impact._radius_ratio(0.9 * limit)
    assert root**5 * (1.0 + 0.9 * limit * root) == pytest.approx(1.0, rel=1e-13)
    assert np.isnan(simple_impact._radius_ratio(1.02 * limit))
