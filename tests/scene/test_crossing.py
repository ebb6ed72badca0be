"""Test the search for the point where a function rises through zero."""

import math
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from derivation.scene.numerics.crossing import last_true, rise

RISES: dict[str, tuple[Callable[[float], float], float]] = {
    "cube": (lambda x: x**3 - 0.2, math.cbrt(0.2)),
    "exponential": (lambda x: math.expm1(5.0 * (x - 0.8)), 0.8),
    "flat": (lambda x: (x - 0.3) ** 9, 0.3),
    "step": (lambda x: 1.0 if x >= 0.3 else -1.0, 0.3),
    "near the start": (lambda x: x - 1e-8, 1e-8),
    "near the end": (lambda x: x - (1.0 - 1e-15), 1.0 - 1e-15),
    "zero at the start": (lambda x: x * (x - 0.7), 0.7),
    "zero at both ends": (lambda x: x * (x - 0.5) * (1.0 - x), 0.5),
    "constant beyond the rise": (lambda x: min(x - 0.3, 0.1), 0.3),
    "constant below the rise": (lambda x: max(x - 0.8, -0.1), 0.8),
    "no value at the end": (lambda x: x - 0.3 if x < 0.9 else math.nan, 0.3),
}


@pytest.mark.parametrize("name", RISES)
def test_rise_is_found_to_the_last_digits(name: str) -> None:
    function, expected = RISES[name]
    found = rise(function, 0.0, 1.0)
    assert not function(found) < 0.0
    assert function(found - 8.0 * math.ulp(found)) < 0.0 or name == "flat"
    assert found == pytest.approx(expected, rel=4e-15, abs=0.0)


@given(st.floats(1e-6, 1.0), st.floats(0.1, 1e3), st.floats(-0.9, 0.9))
def test_smooth_function_takes_few_steps(root: float, steepness: float, curvature: float) -> None:
    calls = []

    def function(x: float) -> float:
        calls.append(x)
        y = x - root
        return steepness * y * (1.0 + curvature * y)

    assert abs(rise(function, 0.0, 1.0) - root) <= 8.0 * math.ulp(1.0)
    assert len(calls) < 25


@given(st.floats(0.0, 1.0, exclude_max=True))
def test_last_number_of_a_condition(last: float) -> None:
    found = last_true(lambda x: x <= last, 0.0, 1.0, 60)
    assert found <= last < found + 2.0**-52


@pytest.mark.parametrize("name", ["exponential", "flat"])
def test_accuracy_that_suffices_saves_evaluations(name: str) -> None:
    of, zero = RISES[name]
    exact: list[float] = []
    close: list[float] = []
    rise(lambda x: exact.append(x) or of(x), 0.0, 1.0)
    found = rise(lambda x: close.append(x) or of(x), 0.0, 1.0, close=1e-6)
    assert abs(found - zero) <= 1e-6
    assert len(close) < len(exact)


def test_a_zero_within_an_error_suffices() -> None:
    """The function is 0 in an interval, like a difference that is set to 0 within its error."""
    found = rise(lambda x: 0.0 if abs(x - 0.4) < 0.01 else x - 0.4, 0.0, 1.0, close=1e-12)
    assert abs(found - 0.4) < 0.01
