"""The least time in contact, known before a simulation, and refusals that follow from it."""

import math
from typing import Any

import pytest

from derivation.scene import SceneError, read, simulate
from derivation.scene.dynamic import contact_sequence, time_in_contact
from derivation.scene.dynamic.modal import plate_of
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.impact import selected_effects

pytestmark = pytest.mark.one_version

GLASS: dict[str, Any] = {"material": "cover glass", "edge": "clamped"}


def scene(R: float, plate: dict[str, Any], speed: float) -> dict[str, Any]:
    return {
        "sphere": {"radius": R, "material": "steel"}, "plate": plate, "impact": {"speed": speed},
        "accuracy": {"rtol": 1e-2},
    }  # fmt: skip


@pytest.mark.parametrize(
    "tables",
    [
        scene(0.012, GLASS | {"radius": 0.1, "thickness": 1e-3}, 0.5),
        scene(0.008, GLASS | {"radius": 0.06, "thickness": 1.5e-3, "loss_factor": 0.05}, 2.0),
        scene(0.01, {"material": "PMMA", "radius": 0.1, "thickness": 0.003}, 1.0),
        scene(
            0.01,
            {"material": "steel", "radius": 0.1, "thickness": 2e-3, "yield_stress": 235e6},
            2.0,
        ),
    ],
)
def test_contacts_last_longer_than_the_least_time(tables: dict[str, Any]) -> None:
    law = selected_effects(read(tables))[1].law
    least = time_in_contact.time_in_contact(law, plate_of(law, 32).modes)
    problem = problem_of(law, 16)
    history = contact_sequence.impact_history(problem, 24, 1e-6)
    assert history.complete
    touched = problem.T * sum(one.end - one.start for one in history.contacts)
    assert 0.0 < least < touched < 6.0 * least


def test_mass_on_a_stiff_spring_stops_after_a_quarter_of_a_period() -> None:
    """The plate is one spring if its modes are much faster than the sphere on it."""
    tables = scene(0.005, GLASS | {"radius": 0.02, "thickness": 0.001}, 1e-4)
    tables["sphere"] |= {"mass": 5.0}
    law = selected_effects(read(tables | {"effects": {"inertia": True}}))[1].law
    modes = plate_of(law, 24).modes
    model = law.model
    stiffness = 4.0 / 3.0 * law.modulus * model.R**0.5
    depth = (1.25 * model.m * model.v0**2 / stiffness) ** 0.4
    compliance = sum(modes.compliance) + 1.0 / (1.25 * stiffness * depth**0.5)
    quarter = 0.5 * math.pi * (model.m * compliance) ** 0.5
    assert time_in_contact.stopping_time(law, modes) == pytest.approx(quarter, rel=0.01)


def test_impact_with_too_many_time_steps_is_refused_and_runs_on_a_thicker_plate() -> None:
    plate = GLASS | {"radius": 0.4, "thickness": 0.6e-3}
    with pytest.raises(SceneError, match=r"effects\.inertia: .* time steps"):
        simulate(read(scene(0.0158, plate, 1.0)))
    result = simulate(read(scene(0.0158, plate | {"thickness": 6e-3}, 1.0)))
    assert result.accuracy.bound <= 1e-2
