"""The largest values of polynomials in time elements, and how many zeros of slopes are sought."""

from typing import Any

import numpy as np
import pytest
from numpy.polynomial.legendre import legval
from shared_scenes import EXAMPLES, result_of

from derivation.scene.dynamic import results
from derivation.scene.dynamic.time_element import P
from derivation.scene.numerics import collocation
from derivation.scene.numerics.collocation import Element, largest_of

POINTS = np.linspace(-1.0, 1.0, 20001)
RISING = [1.0, 0.5, 0.03, -0.01, 0.002]
"""Coefficients whose slope 0.5 + 0.09 s - 0.05 (3 s^2 - 1)/2 + ... has no zero."""


def element(values: Any) -> Element:
    rows = np.array(values, dtype=float)[None]
    return Element(0.0, 1.0, rows, np.zeros(rows.shape[1]))


@pytest.mark.parametrize("seed", range(40))
def test_largest_value_is_that_of_many_points(seed: int) -> None:
    """Some rows have their largest value inside the element, others at either end."""
    draw = np.random.default_rng(seed)
    rows = [
        draw.normal(size=12) / (1.0 + np.arange(12)) ** power + slope * (np.arange(12) == 1)
        for power in (0.5, 2.0, 4.0)
        for slope in (-9.0, 0.0, 9.0)
    ]
    largest = [np.max(legval(POINTS, row)) for row in rows]
    assert [element(row).largest(0) for row in rows] == pytest.approx(largest, abs=1e-6)
    assert largest_of(map(element, rows), 0) == pytest.approx(max(largest), abs=1e-6)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_no_zeros_are_sought_of_a_slope_that_has_none(
    sign: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    row = sign * np.array(RISING)
    monkeypatch.delattr(collocation, "legroots")
    assert element(row).largest(0) == pytest.approx(max(legval(np.array([-1.0, 1.0]), row)))


def test_largest_force_of_a_contact_is_sought_once(monkeypatch: pytest.MonkeyPatch) -> None:
    moved = result_of(EXAMPLES / "membrane.toml").dynamics
    assert moved is not None
    sought = []

    def recorded(elements: Any, row: int) -> float:
        sought.append(row)
        return largest_of(elements, row)

    monkeypatch.setattr(results, "largest_of", recorded)
    again = results.dynamic_impact_of(moved.law, moved.impact_history)
    contacts = moved.impact_history.contacts
    assert sought.count(P) == len(contacts) > 1
    forces = [interval.peak_force for interval in again.inertia.contacts]
    assert forces == [interval.peak_force for interval in moved.inertia.contacts]
