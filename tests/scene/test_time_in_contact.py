"""The least time in contact, known before a simulation, and rejections that follow from it."""

import math
import re
from typing import Any

import pytest

from derivation.scene import SceneError, read, simulate
from derivation.scene.dynamic import contact_sequence, time_in_contact
from derivation.scene.dynamic.modal import plate_of
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.impact import selected_effects

pytestmark = pytest.mark.one_version

GLASS: dict[str, Any] = {"material": "cover glass", "edge": "clamped"}
LINEAR: dict[str, dict[str, Any]] = {"effects": {"stretching": False}}
"""Otherwise the automatic decision on stretching takes seconds in each scene."""


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
    law = selected_effects(read(tables | LINEAR))[1].law
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


@pytest.mark.parametrize(
    ("radius", "plate"),
    [
        (0.008, GLASS | {"radius": 0.03, "thickness": 0.5e-3}),
        (0.01, {"material": "PMMA", "edge": "simply-supported", "radius": 0.06, "thickness": 1e-3}),
        (0.02, {"material": "steel", "edge": "paper", "radius": 0.06, "thickness": 1e-3}),
    ],
)
def test_heavy_sphere_deflects_the_plate_as_far_as_is_estimated(
    radius: float, plate: dict[str, Any]
) -> None:
    tables = scene(radius, plate, 0.02)
    del tables["accuracy"]
    effects = LINEAR["effects"] | {"inertia": True}
    modal = {"effects": effects, "inertia": {"modes": 24, "branches": "A0"}}
    result = simulate(read(tables | modal))
    assert result.complete
    motion, law = result.dynamics, result.effects.law
    modes = plate_of(law, 24).modes
    ratio = law.model.m * float(modes.inverse_modal_mass[0])
    assert ratio > time_in_contact.SPRING
    estimate = law.model.v0 * time_in_contact.half_period(law.model.m, modes) / math.pi
    actual = motion.deflection_before_separation(law) / estimate
    assert time_in_contact.DEFLECTED < actual < 1.0


def test_heavy_sphere_on_a_plate_that_stretches_is_rejected_before_the_first_step() -> None:
    """The proposed speed is the largest that is not rejected; any is simulated with given modes."""

    def check(speed: float, **more: Any) -> None:
        phone = scene(0.0158, GLASS | {"radius": 0.03, "thickness": 1.1e-3}, speed) | LINEAR
        time_in_contact.slow_count(selected_effects(read(phone | more))[1].law, 1e-8)

    with pytest.raises(SceneError, match="stretching") as error:
        check(4.4)
    given = re.search(r"at most ([\d.]+) m/s", str(error.value))
    assert given
    check(float(given[1]))
    check(4.4, inertia={"modes": 16})
    with pytest.raises(SceneError, match="stretching"):
        check(float(given[1]) + 0.1)


@pytest.mark.parametrize(("thickness", "usable"), [(0.8e-3, True), (0.4e-3, False)])
def test_proposed_speeds_allow_for_the_weight_of_the_sphere(thickness: float, usable: bool) -> None:
    """The plate deflects twice as far as under the weight at rest even if the sphere has no speed.

    The proposed speeds deflect it as far as they are meant to.
    """
    plate = GLASS | {"radius": 0.035, "thickness": thickness}
    phone = scene(0.0158, plate, 2.0) | LINEAR
    phone["sphere"]["mass"], phone["impact"]["gravity"] = 0.13, 9.81
    del phone["accuracy"]
    with pytest.raises(SceneError, match="stretching") as error:
        simulate(read(phone))
    text = str(error.value)
    low = re.search(r"about ([\d.]+) m/s for usable results", text)
    assert bool(low) == usable
    most = re.search(r"at most ([\d.]+) m/s", text)
    limit = re.search(r"less than ([\d.]+) m, at which", text)
    assert most
    assert limit
    part = math.sqrt(time_in_contact.USABLE / time_in_contact.FORCE)
    for named, deflection in ((most, 1.0), *([(low, part)] if low else [])):
        phone["impact"]["speed"] = float(named[1])
        effects = LINEAR["effects"] | {"inertia": True}
        modal = {"effects": effects, "inertia": {"modes": 24, "branches": "A0"}}
        result = simulate(read(phone | modal))
        actual = result.dynamics.deflection_before_separation(result.effects.law)
        assert 0.7 < actual / (deflection * float(limit[1])) < 1.1


def test_a_speed_that_needs_too_many_time_steps_is_not_proposed() -> None:
    plate = GLASS | {"radius": 0.063, "thickness": 0.53e-3, "edge": "simply-supported"}
    phone = scene(0.0158, plate, 0.7) | LINEAR
    phone["sphere"]["mass"] = 0.13
    with pytest.raises(SceneError, match="stretching") as error:
        simulate(read(phone))
    assert "m/s" not in str(error.value)
    phone["impact"]["speed"] = 0.2
    with pytest.raises(SceneError, match="time steps"):
        simulate(read(phone))


def test_a_quasi_static_plate_is_not_recommended_if_the_plate_stretches() -> None:
    """Without inertia the plate would not stretch, and no result would be usable."""
    plate = GLASS | {"radius": 0.063, "thickness": 0.53e-3, "edge": "simply-supported"}
    phone = scene(0.0158, plate, 0.7)
    phone["sphere"]["mass"] = 0.13
    with pytest.raises(SceneError, match="time steps") as error:
        simulate(read(phone))
    assert "effects.inertia = false" not in str(error.value)
    assert "thicker or smaller plate" in str(error.value)
    with pytest.raises(SceneError, match=r"time steps.* effects\.inertia = false"):
        simulate(read(phone | {"impact": {"speed": 0.2}} | LINEAR))


def test_impact_with_too_many_time_steps_is_rejected_and_runs_on_a_thicker_plate() -> None:
    plate = GLASS | {"radius": 0.4, "thickness": 0.6e-3}
    with pytest.raises(SceneError, match=r"effects\.inertia: .* time steps"):
        simulate(read(scene(0.0158, plate, 1.0) | LINEAR))
    result = simulate(read(scene(0.0158, plate | {"thickness": 6e-3}, 1.0) | LINEAR))
    assert result.accuracy.bound <= 1e-2


def test_a_speed_below_the_limit_of_the_deflection_is_not_called_sufficient() -> None:
    """At this speed the plate is still more curved than the sphere; at the usable one it is not."""
    heavy: dict[str, Any] = {
        "sphere": {
            "radius": 0.002868, "mass": 4.077e-4, "youngs_modulus": 1.131e9, "poissons_ratio": 0.3,
        },
        "plate": {
            "radius": 0.005807, "thickness": 3.507e-4, "youngs_modulus": 2.982e9,
            "poissons_ratio": 0.1671, "density": 4124.0, "edge": "clamped",
        },
        "impact": {"speed": 5.387},
        "effects": {"stretching": False},
    }  # fmt: skip
    with pytest.raises(SceneError, match="stretching") as error:
        simulate(read(heavy))
    limit = re.search(r"at most ([\d.]+) m/s for this limit alone", str(error.value))
    usable = re.search(r"about ([\d.]+) m/s for usable results\)", str(error.value))
    assert limit
    assert usable
    with pytest.raises(SceneError, match="more curved"):
        simulate(read(heavy | {"impact": {"speed": float(limit[1])}}))
    assert simulate(read(heavy | {"impact": {"speed": float(usable[1])}})).model_error < 0.2
