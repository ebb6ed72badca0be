"""What generated code refuses or answers with NaN: wrong types, counts, and plates it has not."""

import numpy as np
import pytest

from generated import G, simple_impact
from generated.reversed_series import force_by_series


def test_complex_arguments_are_refused() -> None:
    with pytest.raises(TypeError, match=r"real numbers .*complex128"):
        G(np.array([1.0 + 0.0j]))


def test_a_series_has_a_term() -> None:
    with pytest.raises(ValueError, match="expected at least one term, got terms=0"):
        force_by_series(1e-4, 0.13, 0.1, 1.0, 1e9, 1e9, terms=0)


def test_a_plate_out_of_range_has_no_series() -> None:
    found = force_by_series(1e-5, 0.13, [0.1, np.nan, -1.0], 1.0, 1e9, 1e9, terms=3)
    assert np.isnan(found).tolist() == [False, True, True]


def test_simple_impacts_where_none_is_simple() -> None:
    """c_1 a/h of a thick block is -0.96 a/b or so: a contact as wide as that is no correction."""
    narrow, wide = (
        simple_impact.leading(0.1, 3.0, v0, 1.0, 0.05, 2e9, 3e9) for v0 in (10.0, 300.0)
    )
    assert narrow is not None
    assert wide is None
    assert all(np.isnan(x) for x in simple_impact.plate_of(np.nan))


def test_a_largest_radius_is_sought_where_the_first_correction_is_small() -> None:
    """Up to y s = -2/3, where s^5 (1 + y s) = 1 has the root s = 3^(1/5)."""
    last = -2.0 / 3.0 / 3.0**0.2
    share = simple_impact._share(0.9 * last)
    assert share**5 * (1.0 + 0.9 * last * share) == pytest.approx(1.0, rel=1e-13)
    assert np.isnan(simple_impact._share(1.02 * last))
