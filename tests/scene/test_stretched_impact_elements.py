"""Impacts on plates that stretch, against finite elements with finite strains and inertia."""

import math
from functools import cache
from typing import Any

import numpy as np
import pytest

from derivation.checks.finite_elements import impact as linear
from derivation.checks.finite_elements.plate import Plate
from derivation.scene import Result, read, simulate
from tests.scene.finite_strain_impact import Impact, simulate_impact
from tests.scene.finite_strains import Fineness, PressedPlate

pytestmark = pytest.mark.one_version
RADIUS, YOUNG, DENSITY = 0.05, 2.4e9, 1200.0
COARSE = Fineness(4, 1, 3.0, 2)
STEP, SHORT = 0.3, 0.02
"""Length of a time step: over the time in which a pressure wave crosses the thickness, and, times
the impact speed, over the largest contact radius."""
SCENES: dict[str, dict[str, Any]] = {
    "one contact with a clamped plate": {
        "sphere": {"radius": 0.015, "mass": 0.0754},
        "plate": {"thickness": 0.004, "edge": "clamped", "poissons_ratio": 0.3},
        "impact": {"speed": 5.42},
    },
    "several contacts with a supported plate": {
        "sphere": {"radius": 0.025, "mass": 0.0189},
        "plate": {"thickness": 0.005, "edge": "simply-supported", "poissons_ratio": 0.45},
        "impact": {"speed": 5.82},
    },
}
CLOSE = {"contact_time": 5e-3, "max_indentation": 3e-3, "max_force": 3e-2, "restitution": 4e-3}
"""Differences of program and elements, by mesh, time steps and finite strains under the contact."""
FITTED = 0.01
"""The same of radius and pressure, without that by finite strains."""
STRAIN_OF_RADIUS, STRAIN_OF_PRESSURE = (0.1, 0.33), (0.6, 1.1)
"""Changes of radius and pressure by finite strains under the contact, over a/R: between these for
Poisson's ratios of 0.3 to 0.45, on a half-space of this material."""


def scene_of(name: str, stretching: bool = True) -> dict[str, Any]:
    plate = {"radius": RADIUS, "youngs_modulus": YOUNG, "density": DENSITY}
    effects = {"inertia": True, "stretching": stretching}
    return SCENES[name] | {"plate": plate | SCENES[name]["plate"], "effects": effects}


@cache
def program(name: str, stretching: bool = True) -> Result:
    """Return the result of the program."""
    return simulate(read(scene_of(name, stretching)), rtol=0.1)


def pressed(scene: dict[str, Any], radius: float, turns: bool = True) -> PressedPlate:
    """Return plate and sphere of a scene on a mesh for a contact radius [m]."""
    keys = ("radius", "thickness", "youngs_modulus", "poissons_ratio", "density", "edge")
    plate = Plate(*(scene["plate"][key] for key in keys))
    return PressedPlate.of(plate, scene["sphere"]["radius"], 1.03 * radius, COARSE, turns)


@cache
def elements(name: str) -> Impact:
    """Return the result of the finite elements."""
    scene, result = scene_of(name), program(name)
    plate = pressed(scene, result.max_contact_radius)
    crossing = scene["plate"]["thickness"] / math.sqrt(plate.system.plate.modulus / DENSITY)
    speed = scene["impact"]["speed"]
    step = min(STEP * crossing, SHORT * result.max_contact_radius / speed)
    return simulate_impact(plate, scene["sphere"]["mass"], speed, step, 5.0 * result.total_time)


@pytest.mark.parametrize("name", SCENES)
def test_impacts_are_those_of_finite_strains(name: str) -> None:
    """The differences are small and within the stated errors."""
    result, found = program(name), elements(name)
    assert result.dynamics is not None
    assert len(found.contacts) == len(result.dynamics.inertia.contacts)
    for key, close in CLOSE.items():
        value, expected = getattr(result, key), getattr(found, key)
        assert value == pytest.approx(expected, rel=close), key
        assert abs(value / expected - 1.0) <= result.error_of(key), key
        assert close < result.error_of(key)
    flat = result.max_contact_radius / SCENES[name]["sphere"]["radius"]
    wider = 1.0 - result.max_contact_radius / found.max_contact_radius
    higher = result.max_pressure / found.max_pressure - 1.0
    for change, over, key in (
        (wider, STRAIN_OF_RADIUS, "max_contact_radius"),
        (higher, STRAIN_OF_PRESSURE, "max_pressure"),
    ):
        low, high = (x * flat for x in over)
        assert low - FITTED <= change <= high + FITTED
        assert abs(change) <= result.error_of(key)


def test_stretching_changes_the_impact_much_more_than_the_differences() -> None:
    name = "one contact with a clamped plate"
    plain, found = program(name, stretching=False), elements(name)
    for key in ("contact_time", "max_indentation", "restitution"):
        assert abs(getattr(plain, key) / getattr(found, key) - 1.0) > 3.0 * CLOSE[key], key


@pytest.mark.parametrize("name", SCENES)
def test_elements_conserve_energy_and_momentum(name: str) -> None:
    found, scene = elements(name), SCENES[name]
    mass, speed = scene["sphere"]["mass"], scene["impact"]["speed"]
    times, force = found.history
    step = float(np.min(np.diff(times)))
    assert found.energy == pytest.approx(1.0, abs=1e-3)
    impulse = mass * speed * (1.0 + found.restitution)
    assert float(np.sum(force)) * step == pytest.approx(impulse, rel=2e-3)


def test_elements_are_linear_in_slow_impacts() -> None:
    """Elements without finite strains, with another contact condition, give the same impact."""
    scene = scene_of("several contacts with a supported plate")
    mass, speed, radius = 0.0024, 5e-4, 1.2e-4
    scene["sphere"] = {"radius": 1.0}
    plate = pressed(scene, radius, turns=False)
    step = 1.2e-6
    found = simulate_impact(plate, mass, speed, step, 0.02)
    sphere = linear.Sphere(1.0, mass, speed, exact=True)
    history = linear.simulate_impact(plate.system, sphere, step, 0.02)
    expected = linear.results(history, plate.system)
    assert found.restitution == pytest.approx(expected.restitution, abs=1e-3)
    assert found.max_indentation == pytest.approx(expected.max_indentation, rel=1e-3)
    assert found.max_force == pytest.approx(expected.max_force, rel=5e-3)
    assert found.contact_time == pytest.approx(expected.contact_time, rel=2e-3)


def test_heavy_sphere_presses_the_plate_as_in_a_static_contact() -> None:
    """The static contact has its kinetic energy, and the force of the middle of its contact."""
    scene = scene_of("one contact with a clamped plate")
    mass, speed, radius = 5.0, 0.3, 1.6e-3
    plate = pressed(scene, radius)
    found = simulate_impact(plate, mass, speed, 5e-5, 0.1)
    [static] = plate.press([found.max_indentation])
    assert static.energy == pytest.approx(0.5 * mass * speed**2, rel=2e-3)
    times, force = found.history
    middle = np.abs(times / found.contact_time - 0.5) < 0.1
    assert float(np.mean(force[middle])) == pytest.approx(static.force, rel=3e-2)
