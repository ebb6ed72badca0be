"""The model error by stretching of the plate, against a simulation of a von Karman plate."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from derivation.scene import read, simulate
from derivation.scene.contact_law.corrections import stretching
from derivation.scene.dynamic.stretching_error import (
    DIP,
    END,
    MARGIN,
    SMALLEST,
    deflections_of,
    earlier_end,
    stretching_error,
)
from derivation.scene.model import Model
from tests.scene.stretching_scenes import SCENES, moving, simulated, simulations
from tests.scene.von_karman import Motion, Plastic


@pytest.mark.one_version
@pytest.mark.parametrize("name", SCENES)
def test_error_covers_the_difference_between_a_linear_and_a_stretched_plate(name: str) -> None:
    """The damped plate requires the error terms `TIME` and `PEAK`, the light one `END`."""
    result, (linear, stretched) = moving(name), simulations(name)
    assert result.dynamics is not None
    law = result.effects.law
    error = stretching_error(law, result.dynamics, deflections_of(law, result.dynamics))
    for key, size in error.items():
        assert abs(stretched[key] / linear[key] - 1.0) <= size + 1e-3, key
    change = stretched["max_tensile_stress"] / linear["max_tensile_stress"] - 1.0
    assert abs(change) <= result.tensile_stress.error - result.dynamics.back_face.error
    # The deflection is large enough to matter, and the errors are part of the model error.
    assert abs(stretched["max_indentation"] / linear["max_indentation"] - 1.0) > 5e-3
    assert result.model_error >= max(error.values())


@pytest.mark.parametrize(("size", "expected"), [(0.1, 0.625), (1e-3, 0.0)])
def test_first_contact_may_end_at_a_low_minimum_of_its_force(size: float, expected: float) -> None:
    """The force rises again after a minimum of 0.2 of the largest one, at 3/8 of the contact."""
    force = np.array([0.0, 1.0, 0.6, 0.2, 0.3, 0.4, 0.3, 0.1, 0.0])
    assert END * size < 0.2
    assert (DIP * size > 0.2) == (expected > 0.0)
    assert earlier_end(force, np.full(9, size)) == expected


@pytest.mark.parametrize("speed", [0.5, 1.5])
def test_error_of_a_quasi_static_plate_covers_that_of_a_spring(speed: float) -> None:
    """The reference is a Hertz contact and a stiffening spring, solved by the energy balance."""
    scene = SCENES["heavy sphere on a supported plate"] | {"impact": {"speed": speed}}
    result = simulated(scene, inertia=False, non_hertzian_pressure=False)
    model = result.model
    K = 4.0 / 3.0 * model.modulus / (1.0 + model.softness) * math.sqrt(model.R)
    local = (result.max_force / K) ** (2.0 / 3.0)
    w, thickness = result.max_indentation - local, 2.0 * model.h
    stiffness = result.max_force / w
    A = 0.286 / thickness**2  # supported edge, nu = 0.25

    def force(w: float, A: float) -> float:
        return stiffness * w * (1.0 + A * w**2)

    def energy(w: float, A: float) -> float:
        stored = stiffness * w**2 / 2.0 * (1.0 + A * w**2 / 2.0)
        return 0.4 * K * (force(w, A) / K) ** (5.0 / 3.0) + stored

    stiff = brentq(lambda x: energy(x, A) - energy(w, 0.0), 0.0, w)
    harder = force(stiff, A)
    depth = stiff + (harder / K) ** (2.0 / 3.0)
    changes = harder / result.max_force - 1.0, depth / result.max_indentation - 1.0
    for change in changes:
        assert abs(change) <= result.model_error
    assert max(changes) > 0.3 * result.model_error


def rebound(contact: Plastic, model: Model, stiffness: float, A: float, dt: float) -> float:
    """Return the rebound speed of a plastic contact and a spring that stiffens, in series."""
    y, v, force, still = 0.0, model.v0, 0.0, Motion(0.0, 0.0, dt)
    while True:
        v += dt / 2.0 * (model.gravity - force / model.m)
        y += v * dt
        if y <= contact.dent:
            return -v

        def excess(depth: float, y: float = y) -> float:
            w = y - depth
            return replace(contact).press(depth, still)[0] - stiffness * w * (1.0 + A * w**2)

        force, _ = contact.press(brentq(excess, contact.dent, y, xtol=1e-16), still)
        v += dt / 2.0 * (model.gravity - force / model.m)


def test_error_of_the_restitution_covers_a_heavy_plastic_contact_on_a_quasi_static_plate() -> None:
    """An earlier version stated the stiffening itself, nine tenths of the change."""
    plate = {
        "radius": 0.0121, "thickness": 1e-3, "youngs_modulus": 1.14e9, "poissons_ratio": 0.3,
        "edge": "clamped", "yield_stress": 1.93e6,
    }  # fmt: skip
    scene = {
        "sphere": {"radius": 2.17e-3, "mass": 0.0236, "material": "steel"},
        "plate": plate,
        "impact": {"speed": 0.103, "gravity": 67.3},
        "effects": {"inertia": False, "plasticity": True, "non_hertzian_pressure": False},
    }
    result = simulate(read(scene), rtol=0.5)
    model = result.model
    modulus = model.modulus / (1.0 + model.softness)
    K = 4.0 / 3.0 * modulus * math.sqrt(model.R)
    w = result.max_indentation - result.max_contact_radius**2 / model.R
    onset = 0.5 * math.pi * model.R * 1.6 * plate["yield_stress"] / modulus
    linear, stretched = (
        rebound(
            Plastic(K, model.R, onset), model, result.max_force / w, A,
            result.contact_time / 6000,
        )
        for A in (0.0, float(stretching(model, w)) / w**2)
    )  # fmt: skip
    assert linear / model.v0 == pytest.approx(result.restitution, rel=0.02)
    change = abs(stretched / linear - 1.0)
    assert float(stretching(model, w)) < change < result.model_errors["restitution"]


def test_warning_where_stretching_may_split_the_first_contact() -> None:
    """It appears if the stiffening exceeds the change that splits or joins the contact."""
    warned = set()
    for result in map(moving, SCENES):
        assert result.dynamics is not None
        first = result.dynamics.deflection_during(result.effects.law, 0)
        stiffening = float(stretching(result.model, first))
        expected = stiffening >= max(result.dynamics.decisive_change / MARGIN, SMALLEST)
        assert any("stiffer by" in text for text in result.warnings) == expected
        warned.add(expected)
    assert warned == {True, False}
