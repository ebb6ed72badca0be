"""Impacts in which stretching would double the stiffness of the plate are refused early."""

import math
import re
from typing import Any

import pytest

from derivation.scene import SceneError, read, simulate
from derivation.scene.dynamic import contact_sequence, deflection_limit
from derivation.scene.dynamic.modal import plate_of
from derivation.scene.dynamic.time_in_contact import half_period
from derivation.scene.impact import selected_effects
from derivation.scene.scene import OUTPUTS

pytestmark = pytest.mark.one_version

GLASS: dict[str, Any] = {"material": "cover glass", "edge": "clamped"}
HAIL: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.0125, "material": "ice"},
    "plate": {"radius": 0.25, "thickness": 0.8e-3, "material": "steel", "edge": "clamped"},
    "impact": {"speed": 22.0},
}


def scene(R: float, plate: dict[str, Any], speed: float) -> dict[str, Any]:
    return {
        "sphere": {"radius": R, "material": "steel"}, "plate": plate, "impact": {"speed": speed},
        "accuracy": {"rtol": 1e-2},
    }  # fmt: skip


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
    modal = {"effects": {"inertia": True}, "inertia": {"modes": 24, "branches": "A0"}}
    result = simulate(read(tables | modal))
    assert result.complete
    motion, law = result.dynamics, result.effects.law
    modes = plate_of(law, 24).modes
    ratio = law.model.m * float(modes.inverse_modal_mass[0])
    assert ratio > deflection_limit.SPRING
    estimate = law.model.v0 * half_period(law.model.m, modes) / math.pi
    actual = motion.deflection_before_separation(law) / estimate
    assert deflection_limit.DEFLECTED < actual < 1.0


def test_heavy_sphere_on_a_plate_that_stretches_is_refused_before_the_first_step() -> None:
    """The proposed speed is the largest that is not refused; any is simulated with given modes."""

    def check(speed: float, **more: Any) -> None:
        phone = scene(0.0158, GLASS | {"radius": 0.03, "thickness": 1.1e-3}, speed)
        deflection_limit.check_deflected(selected_effects(read(phone | more))[1].law, 1e-8)

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
    phone = scene(0.0158, plate, 2.0)
    phone["sphere"]["mass"], phone["impact"]["gravity"] = 0.13, 9.81
    del phone["accuracy"]
    with pytest.raises(SceneError, match="stretching") as error:
        simulate(read(phone))
    text = str(error.value)
    low = re.search(r"\(about ([\d.]+) m/s for usable results", text)
    assert bool(low) == usable
    most = re.search(r"at most ([\d.]+) m/s", text)
    limit = re.search(r"less than ([\d.]+) m, at which", text)
    assert most
    assert limit
    part = math.sqrt(deflection_limit.USABLE / deflection_limit.FORCE)
    for named, deflection in ((most, 1.0), *([(low, part)] if low else [])):
        phone["impact"]["speed"] = float(named[1])
        modal = {"effects": {"inertia": True}, "inertia": {"modes": 24, "branches": "A0"}}
        result = simulate(read(phone | modal))
        actual = result.dynamics.deflection_before_separation(result.effects.law)
        assert 0.7 < actual / (deflection * float(limit[1])) < 1.1


def test_a_speed_that_needs_too_many_time_steps_is_not_proposed() -> None:
    plate = GLASS | {"radius": 0.063, "thickness": 0.53e-3, "edge": "simply-supported"}
    phone = scene(0.0158, plate, 0.7)
    phone["sphere"]["mass"] = 0.13
    with pytest.raises(SceneError, match="stretching") as error:
        simulate(read(phone))
    assert "m/s" not in str(error.value)
    phone["impact"]["speed"] = 0.2
    with pytest.raises(SceneError, match="time steps"):
        simulate(read(phone))


def test_light_sphere_is_refused_after_the_first_contact(monkeypatch: pytest.MonkeyPatch) -> None:
    """With given modes it is simulated, and no result is then usable."""
    count, contact = 0, contact_sequence.contact

    def counted(*given: Any) -> Any:
        nonlocal count
        count += 1
        return contact(*given)

    monkeypatch.setattr(contact_sequence, "contact", counted)
    with pytest.raises(SceneError, match="thicknesses\\) in the first contact"):
        simulate(read(HAIL))
    assert count <= 2  # the first with the lowest wave branch alone may end before
    result = simulate(read(HAIL | {"inertia": {"modes": 24, "branches": "A0"}}))
    assert count > 10
    assert min(result.model_errors[name] for name in OUTPUTS) >= 1.0


@pytest.mark.parametrize(
    "tables",
    [
        HAIL,
        HAIL | {"plate": HAIL["plate"] | {"yield_stress": 250e6, "loss_factor": 0.1}},
        HAIL | {"plate": HAIL["plate"] | {"edge": "simply-supported"}, "accuracy": {"rtol": 1e-2}},
        scene(0.01, {"material": "aluminium", "radius": 0.3, "thickness": 1e-3}, 10.0),
    ],
)
def test_light_sphere_is_simulated_at_the_proposed_speed(tables: dict[str, Any]) -> None:
    with pytest.raises(SceneError, match="in the first contact") as error:
        simulate(read(tables))
    most = re.search(r"at most ([\d.]+) m/s", str(error.value))
    limit = re.search(r"less than ([\d.]+) m, at which", str(error.value))
    assert most
    assert limit
    slower = tables | {"impact": {"speed": float(most[1])}}
    slower.pop("accuracy", None)
    result = simulate(read(slower))
    actual = result.dynamics.deflection_during(result.effects.law, 0)
    assert 0.8 < actual / float(limit[1]) < 1.0
