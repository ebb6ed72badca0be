"""Test that a prepared plate agrees with the reference for numbers and arrays of any layout."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import forces as contact_forces
from generated import contact_law, plate_points
from generated.prepared_plate import PreparedPlate, prepare

LAM, MU = 0.36e9, 0.43e9
CLOSE = 4e-15
"""Twice the error limit of the contact-law check for a well-conditioned result."""
CONTACTS = [
    (0.002, 0.01, 1.0), (0.02, 0.01, 1.0), (0.0301, 0.01, 1.0), (0.041, 0.01, 1.0),
    (0.0599, 0.01, 1.0), (0.0395, 0.01, 0.04), (0.05, 0.05, 0.3), (0.1, 9.0, 1.0),
]  # fmt: skip
"""Values of a, h and b that use every polynomial of thin, medium and thick plates."""


def number(value: Any) -> float:
    assert isinstance(value, np.float64)
    return float(value)


@pytest.mark.parametrize(("a", "h", "b"), CONTACTS)
def test_plain_numbers_agree_with_the_reference(a: float, h: float, b: float) -> None:
    plate, R = prepare(h, b), 0.9
    assert plate.points is not None
    for actual in (plate_points.indentation(plate.points, a, R), plate.indentation(a, R)):
        assert actual == pytest.approx(float(contact_balls.indentation(a, R, h, b, 20)), rel=CLOSE)
    delta = number(plate.indentation(a, R))
    radius = float(contact_balls.contact_radius(delta, R, h, b, digits=20))
    force = float(contact_forces.force(delta, R, h, b, LAM, MU, digits=20))
    stiff = float(contact_balls.stiffness(a, R, h, b, LAM, MU, digits=20))
    assert plate_points.force(plate.points, delta, R, LAM, MU) is not None
    assert number(plate.contact_radius(delta, R)) == pytest.approx(radius, rel=CLOSE)
    assert number(plate.force(delta, R, LAM, MU)) == pytest.approx(force, rel=CLOSE)
    assert number(plate.stiffness(a, R, LAM, MU)) == pytest.approx(stiff, rel=CLOSE)


def calls(plate: PreparedPlate) -> dict[str, Callable[..., np.ndarray]]:
    return {
        "indentation": plate.indentation,
        "contact_radius": plate.contact_radius,
        "force": lambda x, R: plate.force(x, R, LAM, MU),
        "stiffness": lambda x, R: plate.stiffness(x, R, LAM, MU),
    }


def as_called(name: str, x: Any, R: Any, h: Any, b: Any) -> np.ndarray:
    solid = (LAM, MU) if name in ("force", "stiffness") else ()
    values: np.ndarray = getattr(contact_law, name)(x, R, h, b, *solid)
    return values


@pytest.mark.parametrize("name", ["indentation", "contact_radius", "force", "stiffness"])
def test_arrays_of_any_layout_equal_single_points(name: str) -> None:
    """Each array element equals the scalar result, for one, few, many and repeated plates."""
    generator = np.random.default_rng(5)
    few, many = np.array([0.05, 0.02, 0.2]), generator.uniform(0.01, 0.5, 1200)
    grid = generator.uniform(1e-3, 0.02, (700, 3))
    layouts = [
        (grid[:, 0], 0.05, 1.0), (grid, few, 1.0), (grid.T, few[:, None], np.array([[1.0]])),
        (grid.reshape(1, 700, 3), few, np.array([1.0, 2.0, 1.0])),
        (grid[:, 0], many[:700], 1.0), (grid[:, :1], few, 1.0),
        (np.resize(grid, 1200), np.resize(few, 1200), 1.0),
    ]  # fmt: skip
    R = 0.7
    for x, h, b in layouts:
        if name in ("contact_radius", "force"):
            x = contact_law.indentation(x, R, h, b)
        plate = prepare(h, b)
        actual = calls(plate)[name](x, R)
        np.testing.assert_array_equal(actual, as_called(name, x, R, h, b))
        assert actual.shape == np.broadcast_shapes(*(np.shape(y) for y in (x, h, b)))
        every = np.broadcast_arrays(x, h, b)
        for index in generator.integers(0, actual.size, 25):
            one, half, radius = (float(y.flat[index]) for y in every)
            alone = calls(prepare(half, radius))[name](one, R)
            assert actual.flat[index] == pytest.approx(number(alone), rel=CLOSE)


def test_points_outside_the_domain_are_nan_without_warning() -> None:
    plate = prepare(0.1, 1.0)
    with np.errstate(all="raise"):
        for x, R in ((-1e-3, 0.9), (math.nan, 0.9), (math.inf, 0.9), (0.004, 0.0), (0.004, -1.0)):
            assert all(math.isnan(call(x, R)) for call in calls(plate).values())
        for a, R in ((1.5, 9.0), (0.95, 0.9), (0.004, math.nan)):
            assert math.isnan(plate.indentation(a, R))
        assert math.isnan(plate.force(1e-4, 0.9, -1.0, 1.0))
        assert math.isnan(plate.stiffness(0.004, 0.9, 1.0, -1.0))
        for h, b in ((0.0, 1.0), (-0.1, 1.0), (0.1, 0.0), (0.1, math.inf), (1e-95, 1.0)):
            assert math.isnan(prepare(h, b).indentation(0.004, 0.9))


def test_very_large_numbers_keep_their_digits() -> None:
    """A contact with all lengths times 2^900 has the same relative accuracy."""
    unit, a, R, h, b = 2.0**900, 0.004, 0.13, 0.1, 1.0
    small = number(prepare(h, b).indentation(a, R))
    large = number(prepare(h * unit, b * unit).indentation(a * unit, R * unit))
    assert large / unit == pytest.approx(small, rel=CLOSE)
    assert prepare(h * unit, b * unit).points is None


def test_types_follow_from_all_arguments() -> None:
    single = prepare(np.float32(0.1), np.float32(1.0))
    assert single.indentation(np.float32(0.004), np.float32(0.13)).dtype == np.float32
    assert single.indentation(0.004, 0.13).dtype == np.float32
    assert prepare(0.1, 1.0).indentation(np.array([0.004]), 0.13).dtype == np.float64
    assert prepare(1, 9).indentation(1, 8) == prepare(1.0, 9.0).indentation(1.0, 8.0)
    with pytest.raises(TypeError, match="without a mask"):
        prepare(np.ma.masked_array([0.1, 0.2], mask=[False, True]), 1.0)


def test_prepared_plate_is_immutable() -> None:
    h = np.array([0.1, 0.2])
    plate = prepare(h, 1.0)
    before = plate.indentation(0.004, 0.13)
    h[:] = 0.01
    np.testing.assert_array_equal(plate.indentation(0.004, 0.13), before)
    with pytest.raises(AttributeError):
        plate.h = 1.0  # type: ignore[misc]
