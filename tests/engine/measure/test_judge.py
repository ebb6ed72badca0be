"""Allowed errors, and errors of values that are not finite."""

import math

import flint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from derivation.engine.formula.ulp import SINGLE
from derivation.engine.measure.judge import judge
from derivation.engine.oracle.reference import exact_reference
from derivation.plate.oracle import reference


def test_allowance_is_budget_plus_half_the_condition_number() -> None:
    """Half a unit is 2^-53 of P = 1/2; the condition numbers 1, 3, 0 and 1 add up to 5."""
    reference_result = reference("P", {"R": 1.0, "a": 1.0, "lam": 0.0, "mu": 0.1875})
    assert float(reference_result.value) == 0.5
    assert judge(0.5, reference_result, 4.0).allowed == pytest.approx(4.0 + 2.5, rel=1e-9)
    assert judge(0.5, reference_result, 4.0, SINGLE).allowed == pytest.approx(4.0 + 2.5, rel=1e-9)


def test_allowance_at_zero_is_the_effect_of_rounding_the_arguments() -> None:
    values = {"z": 0.1, "phi": 11.0, "h": 0.1, "lam": 2.0, "mu": 1.0, "A_j": -1.0}
    reference_result = reference("mode_rz", values)
    slope = float(reference_result.total)
    assert reference_result.value == 0
    assert slope > 0.1
    assert judge(0.0, reference_result, 4.0).allowed * 5e-324 == pytest.approx(
        slope * 2.0**-53, rel=1e-6
    )


def test_allowance_of_underflow_is_a_few_units() -> None:
    reference_result = reference("Omega_3", {"phi": 744.0, "h": 1.0, "mu": 1.0})
    assert reference_result.condition["phi"] > 700
    assert judge(0.0, reference_result, 4.0).allowed < 5.0


def test_error_of_values_that_are_not_finite_is_zero_or_infinite() -> None:
    """NaN and infinities are correct if the reference is the same; else the error is infinite."""
    references = {"nan": flint.arb.nan(), "inf": flint.arb.pos_inf(), "-inf": flint.arb.neg_inf()}
    for text, value in references.items():
        for got in (math.nan, math.inf, -math.inf, 1.0):
            error = judge(got, exact_reference(value), 4.0)
            assert error.ulp == (0.0 if repr(got) == text else math.inf)
            assert error.ulp in (error.ratio, error.needed)
    for got in (math.nan, math.inf, -math.inf):
        assert judge(got, exact_reference(flint.arb(1)), 4.0).ratio == math.inf


def test_budget_is_multiplied_by_the_scale_of_the_reference() -> None:
    error = judge(1.0 + 2.0**-50, exact_reference(flint.arb(1), 3.0), 2.0)
    assert (error.ulp, error.allowed, error.needed) == (4.0, 6.0, pytest.approx(4 / 3))


def test_magnitude_of_a_sum_is_that_of_its_modes() -> None:
    values = {"r": 1.0, "z": 0.05, "h": 0.1, "b": 1.0, "R": 0.5, "a": 0.02, "lam": 1.0, "mu": 1.0}
    reference_result = reference("w", values, 30, 3)
    assert reference_result.value == 0
    assert reference_result.magnitude < flint.arb(2) ** -1000


@given(st.floats(0.0, 1e6), st.floats(1e-3, 1e3), st.floats(1.0, 1e6), st.floats(0.5, 100.0))
def test_the_needed_budget_allows_the_error_and_none_smaller_does(
    ulps: float, value: float, scale: float, factor: float
) -> None:
    """With that budget the ratio of error to allowance is 1, whatever the reference's scale."""
    exact = exact_reference(flint.arb(value), scale)
    got = value + ulps * math.ulp(value)
    needed = judge(got, exact, 1.0).needed
    if needed > 0:
        assert judge(got, exact, needed).ratio == pytest.approx(1.0)
        assert judge(got, exact, needed / (1 + factor)).ratio > 1
        assert judge(got, exact, needed * (1 + factor)).ratio < 1
