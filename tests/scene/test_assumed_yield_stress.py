"""The yield stress that a summary assumes for bodies without one: they do not yield above it."""

import re
from typing import Any

import pytest

from derivation.scene import read, simulate
from derivation.scene.contact_law.yield_warnings import assumed_yield_stress
from derivation.scene.output.result_errors import largest_within_error

SCALES = {"k": 1e3, "M": 1e6, "G": 1e9}
SCENE: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {"radius": 0.2, "thickness": 0.05, "material": "steel"},
    "impact": {"speed": 0.5},
    "effects": {"inertia": False},
}


def changed(**tables: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {name: keys | tables.get(name, {}) for name, keys in SCENE.items()}


def assumed(scene: dict[str, dict[str, Any]]) -> float | None:
    """Return the stress [Pa] that the summary states; None if it states none."""
    search_result = re.search(
        r"at least ([\d.]+) ([kMG])Pa", " ".join(str(simulate(read(scene))).split())
    )
    return float(search_result[1]) * SCALES[search_result[2]] if search_result else None


@pytest.mark.parametrize("body", ["sphere", "plate"])
def test_body_yields_below_the_assumed_stress_and_not_above(body: str) -> None:
    stated = assumed(SCENE)
    assert stated
    # The stated stress includes the model error of the pressure.
    stress = stated / (1.0 + simulate(read(SCENE)).model_errors["max_pressure"])
    for factor, yields in ((1.01, False), (0.99, True)):
        result = simulate(read(changed(**{body: {"yield_stress": factor * stress}})))
        assert (result.dent > 0.0) == yields


def test_nothing_is_assumed_of_rigid_bodies_and_of_known_yield_stresses() -> None:
    known = {"yield_stress": 1e12}
    assert assumed(changed(sphere=known, plate=known)) is None
    rigid = changed(plate=known) | {"sphere": {"radius": 0.01, "mass": 0.03}}
    assert assumed(rigid) is None


def test_plate_in_bending_needs_the_stress_of_its_back_face() -> None:
    text = assumed_yield_stress(read(SCENE), pressure=1.6e9, bending=2e9)
    assert "1.00 GPa (sphere) and 2.00 GPa (plate, in bending)" in text


def test_yield_stress_that_a_measured_restitution_determines_is_known() -> None:
    measured = {"restitution": 0.6, "solve_for": "yield_stress", "tested_at": 1.0}
    text = " ".join(str(simulate(read(SCENE | {"measured": measured}))).split())
    assert "no yield stress is given for the sphere; the results assume at least" in text
    known = changed(sphere={"yield_stress": 1e12}) | {"measured": measured}
    assert assumed(known) is None


def test_assumed_stress_includes_the_error_of_the_pressure() -> None:
    """A plate with the stated yield stress is not reported to yield within the error."""
    elastic = changed(effects={"plasticity": False})
    loose = elastic | {"accuracy": {"rtol": 0.2}}
    stress = assumed(loose)
    assert stress
    assert stress > 1.01 * (assumed(elastic) or 0.0)
    for factor, may_yield in ((1.01, False), (0.99, True)):
        plate = loose["plate"] | {"yield_stress": factor * stress}
        warnings = simulate(read(loose | {"plate": plate})).warnings
        assert any("may yield" in text for text in warnings) == may_yield


@pytest.mark.parametrize("speed", [0.11, 0.17, 0.23, 0.31, 0.37])
def test_stated_stress_is_rounded_up(speed: float) -> None:
    """An earlier version rounded to nearest, and half of the stated values were too small."""
    plate = {"radius": 0.5, "thickness": 0.3}
    scene = changed(sphere={"material": "steel"}, plate=plate, impact={"speed": speed})
    stated = assumed(scene)
    needed = largest_within_error(simulate(read(scene)), "max_pressure") / 1.6
    assert stated is not None
    assert needed <= stated <= 1.01 * needed
    assert simulate(read(changed(**scene | {"plate": plate | {"yield_stress": stated}}))).dent == 0
