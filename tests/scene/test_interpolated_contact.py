"""Contacts interpolated between solutions of the integral equation: compared with a solution."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from test_rows import check, in_arrays

from derivation.scene import read
from derivation.scene.contact_law import solved_contact
from derivation.scene.contact_law.closed_contact import closed_up_to
from derivation.scene.contact_law.solved_contact import (
    INTERPOLATION,
    SolvedCase,
    force_at,
    shape_at,
)
from generated import non_hertzian_pressure

WIDE: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.13, "density": 7850},
    "plate": {
        "radius": 1.0, "thickness": 0.2, "youngs_modulus": 1e9, "poissons_ratio": 0.23,
        "edge": "clamped",
    },
    "impact": {"speed": 0.5},
    "effects": {"inertia": False},
}  # fmt: skip


@given(
    h=st.floats(-5.0, 0.7), R=st.floats(-3.0, 3.0), edge=st.floats(-0.4, 0.4),
    softness=st.sampled_from([0.0, 0.3, 5.0, 100.0]), sphere=st.booleans(),
)  # fmt: skip
@settings(max_examples=40)
def test_interpolation_equals_the_solution(
    h: float, R: float, edge: float, softness: float, sphere: bool
) -> None:
    """For radii from tiny ones to the widest contact; pressures relative to the mean one."""
    case = SolvedCase(10.0**h, 1.0, 10.0**R, 1e10 / (1.0 + softness), 1e10, edge, sphere)
    limit = closed_up_to(case, min(0.9, 0.95 * case.R, 6.0 * case.h))
    a = limit * np.append(np.geomspace(1e-7, 0.9, 20), [0.99, 1.0 - 1e-9])
    plate = non_hertzian_pressure.plate(case.h, case.b, case.edge)
    solution = non_hertzian_pressure.contact(
        plate, a, case.R, case.modulus, case.plate_modulus, sphere=sphere
    )
    shape = shape_at(a, case, limit)
    force = 4.0 / 3.0 * case.modulus * a**3 / case.R * shape.force
    linear = plate.first / plate.unit / (2.0 * case.plate_modulus)
    compliance = shape.compliance / (2.0 * case.modulus * a) + linear
    growth = 4.0 * case.modulus * a**2 / case.R * shape.growth
    for actual, expected in (
        (force, solution.force),
        (a**2 / case.R * shape.depth + linear * force, solution.indentation),
        (compliance, 1.0 / solution.stiffness),
        (growth, solution.stiffness * solution.slope),
    ):
        np.testing.assert_allclose(actual, expected, rtol=INTERPOLATION)
    pressure = 2.0 / math.pi * case.modulus * a / case.R * shape.centre
    difference = np.abs(pressure - solution.centre_pressure) / solution.mean_pressure
    assert np.max(difference) < INTERPOLATION


@pytest.mark.parametrize("edge", [-0.3, 0.0, 0.1])
@pytest.mark.parametrize(
    ("h", "R", "sphere"), [(0.005, 0.5, True), (0.05, 30.0, False), (1e-4, 0.01, True)]
)
def test_contact_is_lost_just_beyond_the_widest_one(
    h: float, R: float, sphere: bool, edge: float
) -> None:
    case = SolvedCase(h, 1.0, R, 1e10, 1e10, edge, sphere)
    high = min(0.9, 0.95 * R, 6.0 * h)
    widest = closed_up_to(case, high)
    lost = 0.5 * (high + widest) if widest < high else high
    for _ in range(40):  # halve the interval, down to rounding
        middle = 0.5 * (widest + lost)
        if math.isnan(force_at(middle, case)):
            lost = middle
        else:
            break
    assert math.isfinite(force_at(widest, case))
    assert widest == high or lost - widest <= 1.001e-9 * widest


def test_a_contact_without_a_polynomial_is_solved_at_each_radius(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    case = SolvedCase(0.1, 1.0, 0.13, 1e9, 1e9, 0.0, True)
    a = np.linspace(0.01, 0.09, 5)
    interpolated = shape_at(a, case, 0.1)
    monkeypatch.setattr(solved_contact, "_table", lambda *_: None)
    for actual, expected in zip(shape_at(a, case, 0.1), interpolated, strict=True):
        assert not np.array_equal(actual, expected)
        np.testing.assert_allclose(actual, expected, rtol=INTERPOLATION)


def test_radii_outside_the_contact_give_no_number() -> None:
    case = SolvedCase(0.1, 1.0, 0.13, 1e9, 1e9, 0.0, True)
    shape = shape_at(np.array([0.01, np.nan, 0.2]), case, 0.1)
    assert np.isfinite(shape.force).tolist() == [True, False, False]


def test_wide_contacts_of_many_plates_are_computed_in_arrays(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    columns = {
        "plate.thickness": np.array([0.15, 0.2, 0.2, 0.25, 0.05, 0.1]),
        "impact.speed": np.array([0.3, 0.5, 1.0, 0.2, 0.1, 1e3]),
    }
    solution = check(read(WIDE), columns)
    assert ["non_hertzian_pressure" in effects for effects in solution.effects] == 5 * [True] + [
        False
    ]
    assert solution.status[5] == "rejected"
    in_arrays(monkeypatch, read(WIDE), {key: values[:5] for key, values in columns.items()})
