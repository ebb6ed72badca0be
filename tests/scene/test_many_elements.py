"""Functions of many time elements agree with those of one element and with exact values."""

import numpy as np
import pytest
from numpy.polynomial.legendre import legval

from derivation.scene.numerics.collocation import Element
from derivation.scene.numerics.many_elements import (
    continued,
    largest_values,
    newton_steps,
    values_at,
    zeros_of,
)
from generated.arrays import Double as Array


def decaying(count: int, n: int = 12, seed: int = 1) -> Array:
    """Return random Legendre coefficients that decay like those of time elements."""
    chance = np.random.default_rng(seed)
    return chance.normal(size=(count, n)) * 0.4 ** np.arange(n)


def element(coefficients: Array) -> Element:
    """Return an element from 2 to 5 with one row."""
    return Element(2.0, 3.0, coefficients[None], coefficients)


def test_largest_values_are_those_at_ends_and_zeros_of_the_slope() -> None:
    coefficients = decaying(2000).reshape(1000, 2, 12)
    lowest = np.full((1000, 2), -np.inf)
    actual = largest_values(coefficients, lowest)
    expected = [[element(row).largest(0) for row in pair] for pair in coefficients]
    np.testing.assert_allclose(actual, expected, rtol=0.0, atol=1e-14)
    np.testing.assert_array_equal(largest_values(coefficients, actual), actual)
    assert (largest_values(coefficients, actual + 1.0) == actual + 1.0).all()


def test_zeros_are_where_a_value_falls_through_zero() -> None:
    coefficients = decaying(500)
    coefficients[:, 1] -= 3.0
    one, other = coefficients.sum(axis=-1), (coefficients * (-1.0) ** np.arange(12)).sum(axis=-1)
    falling = coefficients[(other > 0.0) & (one < 0.0)]
    assert len(falling) > 100
    s = zeros_of(falling)
    assert np.abs(values_at(falling, s)).max() < 1e-14
    ends = np.array([element(row).end(0) for row in falling])
    np.testing.assert_allclose(2.0 + 1.5 * (1.0 + s), ends, rtol=1e-14)


def test_a_zero_at_the_end_of_the_element_is_found() -> None:
    assert zeros_of(np.array([[1.0, -1.0, 0.0]])).tolist() == [1.0]


def test_elements_are_continued_beyond_their_ends() -> None:
    coefficients, ahead = decaying(20), np.linspace(-0.5, 1.0, 7)
    expected = legval(1.0 + 2.0 * ahead, coefficients.T, tensor=True)
    actual = continued(coefficients, np.broadcast_to(ahead, (20, 7)))
    assert actual == pytest.approx(expected, rel=1e-9, abs=1e-9)


def test_a_singular_system_has_no_step_and_does_not_change_others() -> None:
    chance = np.random.default_rng(2)
    systems, residuals = chance.normal(size=(3, 4, 4)), chance.normal(size=(3, 4))
    by_x, a = np.broadcast_to(np.eye(4), (3, 4, 4)), np.full((3, 4), 10.0)
    steps, sizes = newton_steps(systems, residuals, by_x, a)
    systems[1] = 0.0
    with np.errstate(all="ignore"):
        again, some = newton_steps(systems, residuals, by_x, a)
    np.testing.assert_array_equal(again[[0, 2]], steps[[0, 2]])
    np.testing.assert_array_equal(some[[0, 2]], sizes[[0, 2]])
    assert np.isnan(some[1])
