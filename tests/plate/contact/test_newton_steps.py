"""Test Newton's iterations: the stated number of steps is sufficient, and they converge."""

import math
from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from shared_scenes import scene

from derivation.scene import indent, static_contact
from generated import contact_law, impact, perturbation, plate_arrays, plate_points
from generated.prepared_plate import prepare

PLATE = (1.0, 0.36e9, 0.43e9)
"""b, lam, mu."""
HALF = np.array([0.02, 0.1, 1.0, 5.0])
DEPTHS, SPEEDS = np.geomspace(1e-12, 2e-3, 150)[:, None], np.geomspace(1e-6, 30.0, 60)[:, None]


def radius() -> Any:
    return contact_law.contact_radius(DEPTHS, 0.13, HALF, 1.0)


def radius_alone() -> Any:
    """Return contact radii from scalar calls."""
    plate = prepare(0.1, 1.0)
    return np.array([plate.contact_radius(float(depth), 0.13) for depth in DEPTHS[:, 0]])


def largest() -> Any:
    return np.array(impact.impact(0.13, 72.0, SPEEDS, HALF, *PLATE))


def wide() -> Any:
    """Return impacts with a > 2 h, some beyond the range of the first polynomial."""
    speeds = np.geomspace(6.0, 140.0, 20)
    result = impact.impact(20.0, 72.0, speeds, 0.05, *PLATE)
    assert np.all(result.max_contact_radius > 2 * 0.05)
    return np.array(result)


def history_of_impact() -> Any:
    times = np.linspace(0.0, impact.impact(0.13, 72.0, 1.0, 0.1, *PLATE).contact_time, 41)
    return np.array(impact.history(times, 0.13, 72.0, 1.0, 0.1, *PLATE))


def breaks() -> Any:
    speeds = SPEEDS[SPEEDS > 1e-3]
    motions = [perturbation.PrintedMotion(72.0, v, 2e7, xi) for v in speeds for xi in (1e5, 1e8)]
    return np.array([motion.last for motion in motions])


def indented() -> Any:
    """Return radii by the full law of an elastic sphere, which has no generated inverse."""
    contacts = indent(scene(effects={"stretching": False}), force=[1.0, 1e3, 1e5])
    return np.array([contact.contact_radius for contact in contacts])


@pytest.mark.parametrize(
    ("module", "results", "needed"),
    [
        (plate_arrays, radius, 6),
        (plate_points, radius_alone, 6),
        (impact, largest, 6),
        (impact, wide, 6),
        (impact, history_of_impact, 6),
        (perturbation, breaks, 10),
        (static_contact, indented, 10),
    ],
)
def test_stated_number_of_steps_is_sufficient(
    module: ModuleType, results: Callable[[], Any], needed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The stated number of steps gives the result to the last bit; convergence is superlinear."""
    exact = results()
    assert np.all(np.isfinite(exact))
    errors = []
    monkeypatch.setattr(static_contact, "_FOUND", math.inf)  # accepts the result of too few steps
    for steps in (1, 2, 3, needed):
        monkeypatch.setattr(module, "_STEPS", steps)
        actual = results()
        size = np.max(np.abs(exact), axis=0)
        errors.append(float(np.max(np.abs(actual - exact) / size)))
    assert errors[-1] == 0.0
    assert errors[2] / errors[1] < errors[1] / errors[0] < 0.5
