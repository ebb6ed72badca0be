"""Simulations with few modes refuse a measured restitution only if no constant gives it."""

import re
from dataclasses import replace
from typing import Any

import pytest

from derivation.scene import SceneError, read, simulate
from derivation.scene.dynamic import contact_sequence, waves
from derivation.scene.measured.measurement import Measurement
from derivation.scene.measured.rough_search import FAR, HALF, PART
from derivation.scene.measured.trial import Trial

THIN: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.008, "material": "bearing steel"},
    "plate": {"radius": 0.123, "thickness": 0.002, "material": "steel"},
    "impact": {"speed": 3.7},
}


MARBLE: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.008, "material": "glass"},
    "plate": {
        "radius": 0.2, "thickness": 0.005, "youngs_modulus": 60e9, "poissons_ratio": 0.22,
        "density": 2300.0,
    },
    "impact": {"speed": 1.0},
}  # fmt: skip


def wanted(scene: Any, factor: float) -> tuple[Any, float]:
    """Return a scene with a multiple of the restitution without loss, and this restitution."""
    most = simulate(read(scene), rtol=3e-3).restitution
    measured = {"restitution": factor * most, "solve_for": "yield_stress", "target": "plate"}
    return read(scene | {"measured": measured}), most


@pytest.mark.parametrize("factor", [1.06, 1.5, 6.0])
def test_a_restitution_above_that_without_loss_is_refused_by_few_modes(
    factor: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The message names the restitution that an accurate simulation has."""
    scene, most = wanted(THIN, factor)
    parts = set[float]()
    simulated = Measurement.simulated

    def noted(self: Measurement, value: float | None, within: bool = False) -> Trial:
        parts.add(self.part)
        return simulated(self, value, within)

    monkeypatch.setattr(Measurement, "simulated", noted)
    with pytest.raises(SceneError, match="estimated with few modes") as error:
        simulate(scene)
    assert parts == {PART, HALF}
    named = re.search(r"less than about (\S+),", str(error.value))
    assert named
    assert float(named[1]) == pytest.approx(most, rel=0.03)


@pytest.mark.parametrize("factor", [0.97, 0.6])
def test_a_restitution_below_that_without_loss_is_found(factor: float) -> None:
    """With few modes the restitution without loss is a third larger."""
    scene, most = wanted(MARBLE, factor)
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
    """Its restitution is unknown: the search stopped with an error about NaN."""
    measurement = Measurement(THIN, "yield_stress", 0.05).to(0.1)
    assert measurement.simulated(None).restitution < 0.1
    monkeypatch.setattr(contact_sequence, "CONTACTS", 1)
    waves.impact.cache_clear()
    for part in (0.0, HALF):
        with pytest.raises(SceneError, match=r"^measured\.target: .*last separation"):
            replace(measurement, part=part).simulated(None)
    waves.impact.cache_clear()


def test_an_error_of_the_measurement_names_the_speed_of_the_measurement() -> None:
    """The message named a lower impact.speed, which did not change the measurement."""
    wide = {
        "sphere": {"radius": 0.0213, "youngs_modulus": 1e8, "poissons_ratio": 0.45, "mass": 0.0459},
        "plate": {"radius": 0.04, "thickness": 0.0025, "material": "steel"},
        "impact": {"speed": 2.0},
    }
    measured = {"restitution": 0.5, "solve_for": "yield_stress", "target": "plate"}
    with pytest.raises(SceneError, match=r"^measured: .*reduce measured\.tested_at") as error:
        simulate(read(wide | {"measured": measured | {"tested_at": 30.0}}))
    assert "impact.speed" not in str(error.value)
    enough = re.search(r"\((\S+) m/s is low enough\)", str(error.value))
    assert enough
    slower = wide | {"impact": {"speed": float(enough[1])}}
    assert Measurement(slower, "yield_stress", 0.5).to(0.1).simulated(None).restitution > 0.0
