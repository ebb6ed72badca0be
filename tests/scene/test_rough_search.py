"""Searches with few modes reject a measured restitution only if no constant gives it."""

import json
import re
from dataclasses import replace
from functools import cache
from typing import Any

import pytest

from derivation.scene import SceneError, read, simulate
from derivation.scene.dynamic import contact_sequence, waves
from derivation.scene.measured.measurement import Measurement
from derivation.scene.measured.rough_search import FAR, HALF, PART, rough_value
from derivation.scene.measured.trial import Trial, UnreachedError

pytestmark = pytest.mark.one_version

THIN: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.008, "material": "bearing steel"},
    "plate": {"radius": 0.123, "thickness": 0.002, "material": "steel"},
    "impact": {"speed": 3.7},
    "effects": {"stretching": False},  # which multiplies the run time
}


MARBLE: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.008, "material": "glass"},
    "plate": {
        "radius": 0.2, "thickness": 0.005, "youngs_modulus": 60e9, "poissons_ratio": 0.22,
        "density": 2300.0,
    },
    "impact": {"speed": 1.0},
}  # fmt: skip


@cache
def restitution_without_loss(scene: str) -> float:
    """Return the restitution of a scene, given as JSON, with a tolerance of 3e-3."""
    return simulate(read(json.loads(scene)), rtol=3e-3).restitution


def with_restitution(scene: Any, factor: float) -> tuple[Any, float]:
    """Return a scene with a multiple of the restitution without loss, and this restitution."""
    most = restitution_without_loss(json.dumps(scene))
    measured = {"restitution": factor * most, "solve_for": "yield_stress", "target": "plate"}
    return read(scene | {"measured": measured}), most


@pytest.mark.parametrize(("tables", "factor"), [(MARBLE, 1.06), (MARBLE, 1.5), (THIN, 6.0)])
def test_a_restitution_above_that_without_loss_is_rejected_with_few_modes(
    tables: Any, factor: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The message names the restitution that an accurate simulation has."""
    scene, most = with_restitution(tables, factor)
    parts = set[float]()
    simulated = Measurement.simulated

    def recorded(self: Measurement, value: float | None, within: bool = False) -> Trial:
        parts.add(self.part)
        return simulated(self, value, within)

    monkeypatch.setattr(Measurement, "simulated", recorded)
    with pytest.raises(SceneError, match="estimated with few modes") as error:
        simulate(scene)
    assert parts == {PART, HALF}
    named = re.search(r"less than about (\S+),", str(error.value))
    assert named
    assert float(named[1]) == pytest.approx(most, rel=0.03)


@pytest.mark.parametrize("factor", [0.97, 0.6])
def test_a_restitution_below_that_without_loss_is_found(factor: float) -> None:
    """With few modes the restitution without loss is a third larger."""
    scene, most = with_restitution(MARBLE, factor)
    few = Measurement(MARBLE, "yield_stress", 0.5, PART).to(0.1).simulated(None)
    assert few.restitution > 1.3 * most
    result = simulate(scene)
    assert abs(result.restitution / (factor * most) - 1.0) <= result.accuracy.bound < 1e-2


@pytest.mark.parametrize("thickness", [1.2e-3, 2e-3, 5e-3, 12e-3])
@pytest.mark.parametrize("edge", ["clamped", "simply-supported"])
def test_few_modes_do_not_underestimate_the_restitution(thickness: float, edge: str) -> None:
    plate = THIN["plate"] | {"thickness": thickness, "edge": edge}
    whole = simulate(read(THIN | {"plate": plate}), rtol=1e-2).restitution
    measurement = Measurement(THIN | {"plate": plate}, "yield_stress", 0.5).to(0.1)
    few, half = (replace(measurement, part=part).simulated(None) for part in (PART, HALF))
    assert whole < 0.7 * FAR * few.restitution
    assert half.restitution == pytest.approx(whole, rel=0.02)


def test_an_incomplete_measurement_is_an_error_of_the_scene(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Its restitution is unknown; an earlier version stopped with an error about NaN."""
    measurement = Measurement(THIN, "yield_stress", 0.05).to(0.1)
    assert measurement.simulated(None).restitution < 0.1
    monkeypatch.setattr(contact_sequence, "CONTACTS", 1)
    waves.impact.cache_clear()
    for part in (0.0, HALF):
        with pytest.raises(SceneError, match=r"^measured\.target: .*last separation"):
            replace(measurement, part=part).simulated(None)
    waves.impact.cache_clear()


def test_an_error_of_the_measurement_names_the_speed_of_the_measurement() -> None:
    """An earlier message recommended a lower impact.speed, which did not change the measurement."""
    wide = {
        "sphere": {"radius": 0.0213, "youngs_modulus": 1e8, "poissons_ratio": 0.45, "mass": 0.0459},
        "plate": {"radius": 0.04, "thickness": 0.0025, "material": "steel"},
        "impact": {"speed": 2.0},
    }
    measured = {"restitution": 0.5, "solve_for": "yield_stress", "target": "plate"}
    with pytest.raises(SceneError, match=r"^measured: .*reduce measured\.tested_at") as error:
        simulate(read(wide | {"measured": measured | {"tested_at": 30.0}}))
    assert "impact.speed" not in str(error.value)
    enough = re.search(r"\((\S+) m/s is low enough for this limit\)", str(error.value))
    assert enough
    slower = wide | {"impact": {"speed": float(enough[1])}}
    assert Measurement(slower, "yield_stress", 0.5).to(0.1).simulated(None).restitution > 0.0


GOLF: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.0213, "youngs_modulus": 1e8, "poissons_ratio": 0.45, "mass": 0.0459},
    "plate": {"radius": 0.04, "thickness": 0.0025, "material": "titanium"},
    "impact": {"speed": 20.0},
}


@pytest.mark.parametrize("part", [0.9, 0.6, 0.35, 0.2])
def test_a_plastic_contact_is_at_most_as_wide_as_an_elastic_one_at_speed_over_restitution(
    part: float,
) -> None:
    block = {"radius": 1.0, "thickness": 2.0, "material": "steel"}
    effects = {"effects": {"inertia": False, "spherical_profile": False, "bending": False}}
    scene = {"sphere": {"radius": 0.01, "material": "steel"}, "plate": block} | effects
    at_rest = {"restitution": part, "solve_for": "yield_stress"}
    yielding = simulate(read(scene | {"impact": {"speed": 1.0}, "measured": at_rest}))
    assert yielding.restitution == pytest.approx(part, rel=1e-3)
    elastic = simulate(read(scene | {"impact": {"speed": 1.0 / part}}))
    assert 0.9 < yielding.max_contact_radius / elastic.max_contact_radius < 1.0


def test_recommended_speed_of_the_measurement_is_low_enough_for_its_restitution() -> None:
    """An earlier version recommended a speed at which the contact was too wide after yield.

    The search then makes shorter steps where the contact would be too wide.
    """
    on_plate = {"restitution": 0.69, "solve_for": "yield_stress", "target": "plate"}
    scene = GOLF | {"impact": {"speed": 1.0}, "measured": on_plate | {"tested_at": 30.0}}
    with pytest.raises(SceneError, match=r"measured\.tested_at") as error:
        simulate(read(scene))
    enough = re.search(r"\((\S+) m/s is low enough for this limit\)", str(error.value))
    assert enough
    speed = float(enough[1])
    scene["measured"]["tested_at"] = speed
    assert simulate(read(scene)).measured_note
    scene["measured"]["tested_at"] = speed / 0.69
    with pytest.raises(SceneError, match=r"radius below .* reduce .*, or correct"):
        simulate(read(scene))


def test_a_restitution_just_below_that_without_loss_determines_the_constant() -> None:
    """An earlier rough search found a plate that does not yield, with an infinite error."""
    most = simulate(read(MARBLE), rtol=1e-3).restitution
    near = {"restitution": 0.991 * most, "solve_for": "yield_stress", "target": "plate"}
    result = simulate(read(MARBLE | {"measured": near}), rtol=1e-2)
    assert abs(result.restitution / near["restitution"] - 1.0) <= result.accuracy.bound <= 1e-2


def test_few_modes_find_a_constant_that_hardly_reduces_the_restitution() -> None:
    """An earlier version found it too large by a factor of 5, which required a second search."""
    most = simulate(read(MARBLE), rtol=1e-3).restitution
    near = Measurement(MARBLE, "yield_stress", 0.99 * most)
    found = rough_value(near.to(0.1))
    assert found == pytest.approx(near.to(1e-3).value(1e-4), rel=0.2)


def test_a_retardation_time_that_never_reduces_the_restitution_is_no_solution() -> None:
    """An earlier message stated a smallest restitution above that without a retardation time."""
    phone = {
        "sphere": {"radius": 0.01585, "mass": 0.13, "material": "steel"},
        "plate": {"radius": 0.03538, "thickness": 0.00106, "material": "phone glass"},
        "impact": {"speed": 0.18138, "gravity": 9.81},
    }
    few = Measurement(phone, "retardation_time", 0.96, PART).to(0.1)
    elastic = few.simulated(None)
    with pytest.raises(UnreachedError, match="which none of the tried values reduces") as error:
        few.rough_value(elastic)
    assert f"{elastic.restitution:.3g}" in str(error.value)
    assert elastic.restitution < few.simulated(error.value.value).restitution
