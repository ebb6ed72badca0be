"""Stretching is included automatically where the results of an impact require it."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from derivation.scene import Result, SceneError, explain, load, read, simulate
from derivation.scene.dynamic import stretching_error as module
from derivation.scene.dynamic import stretching_needed as decision
from derivation.scene.dynamic.stretching_error import deflections_of, stretching_error
from derivation.scene.dynamic.stretching_needed import NEEDED, needs_stretching
from derivation.scene.dynamic.time_in_contact import largest_deflection
from derivation.scene.impact import selected_effects
from derivation.scene.measured import measured as measured_constant
from derivation.scene.measured.measured import Fit
from derivation.scene.measured.specimen import measurement_of
from derivation.scene.output import map as map_
from derivation.scene.rows.rows import solve
from derivation.scene.scene import OUTPUTS
from tests.scene.test_unusable_results import SOFT
from tests.shared_scenes import EXAMPLES

pytestmark = pytest.mark.one_version
Tables = dict[str, dict[str, Any]]
PANE: Tables = {
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {"radius": 0.03, "thickness": 1.2e-3, "material": "glass", "edge": "clamped"},
    "impact": {"speed": 2.0},
    "accuracy": {"rtol": 0.1},
}
SLOW, FAST = 0.5, 3.0


def changed(scene: Tables, table: str, **keys: Any) -> Tables:
    return scene | {table: scene.get(table, {}) | keys}


def at(speed: float, **effects: bool) -> Result:
    return simulate(read(changed(PANE, "impact", speed=speed) | {"effects": effects}))


def numbers(result: Result) -> list[float]:
    return [getattr(result, name) for name in OUTPUTS]


@pytest.mark.parametrize("speed", [SLOW, 1.0, 2.0, FAST])
def test_stretching_is_included_where_a_result_would_have_a_large_error(speed: float) -> None:
    """The simulation of the decision has few modes, so that it may be wrong near the limit."""
    chosen, without = at(speed), at(speed, stretching=False)
    law, motion = without.effects.law, without.dynamics
    assert motion is not None
    error = max(stretching_error(law, motion, deflections_of(law, motion)).values())
    assert abs(error / NEEDED - 1.0) > 0.2
    needed = error > NEEDED
    assert needed == (speed > 1.0)
    assert chosen.effects.law.stretches == needed
    assert numbers(chosen) == numbers(at(speed, stretching=True) if needed else without)
    if needed:
        assert chosen.model_error < 0.5 * without.model_error


def test_only_requested_results_count() -> None:
    """The force of a later contact changes much more than the indentation."""
    scene = changed(PANE, "impact", speed=FAST)
    one = changed(scene, "accuracy", outputs=["max_indentation"])
    assert explain(read(scene)).effects.law.stretches
    assert not explain(read(one)).effects.law.stretches


def test_a_given_strength_makes_the_stress_count() -> None:
    """A slow, heavy sphere: the tension changes the stress much more than the other results."""
    weight = {
        "sphere": {"radius": 0.01, "material": "steel", "mass": 5.0},
        "plate": {"radius": 0.075, "thickness": 6e-3, "material": "PMMA", "edge": "clamped"},
        "impact": {"speed": 1.4},
        "accuracy": {"rtol": 0.1, "outputs": ["max_indentation"]},
    }
    strong = changed(weight, "plate", tensile_strength=70e6)
    without = simulate(read(strong | {"effects": {"stretching": False}}))
    assert without.model_errors["max_indentation"] < NEEDED < without.tensile_stress.error
    assert not explain(read(weight)).effects.law.stretches
    result = simulate(read(strong))
    assert result.effects.law.stretches
    assert result.tensile_stress.error < 0.5 * without.tensile_stress.error


@pytest.fixture
def undecided() -> Iterator[None]:
    """Forget former decisions before and after a test that changes how they are made."""
    needs_stretching.cache_clear()
    yield
    needs_stretching.cache_clear()


@pytest.mark.usefixtures("undecided")
def test_stretching_that_hardly_reduces_the_error_is_not_included(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene = read(changed(PANE, "impact", speed=FAST))
    assert selected_effects(scene)[1].law.stretches
    monkeypatch.setattr(module, "IN_PLANE", 1e3 * module.IN_PLANE)
    needs_stretching.cache_clear()
    assert not selected_effects(scene)[1].law.stretches


def test_steep_plate_does_not_stretch_if_rotations_cause_most_of_the_error() -> None:
    """An earlier version neglected rotations in the error that would remain, and included it."""
    scene: Tables = {
        "sphere": {"radius": 0.0139, "mass": 0.0195, "material": "steel"},
        "plate": {
            "radius": 0.0427, "thickness": 8.43e-3, "youngs_modulus": 1.32e7, "edge": "clamped",
            "poissons_ratio": 0.469, "density": 1987.0,
        },
        "impact": {"speed": 5.08},
        "accuracy": {"rtol": 0.1},
    }  # fmt: skip
    assert not explain(read(scene)).effects.law.stretches
    without, with_it = (
        simulate(read(scene | {"effects": {"stretching": on}})) for on in (False, True)
    )
    assert without.model_error > NEEDED
    for name, error in without.model_errors.items():
        assert error < NEEDED or with_it.model_errors[name] > 0.5 * error, name


@pytest.mark.usefixtures("undecided")
def test_rough_estimate_decides_if_few_modes_have_no_solution(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def fail(*_: object) -> None:
        raise SceneError("no solution")

    monkeypatch.setattr(decision, "with_few_modes", fail)
    light = changed(PANE, "sphere", radius=0.004)
    for speed, stretches in (30.0, False), (60.0, True):
        scene = read(changed(light, "impact", speed=speed))
        assert selected_effects(scene)[1].law.stretches == stretches


def test_explanation_states_the_reason() -> None:
    for speed, reason in (SLOW, "omitted; the model error"), (FAST, "about 30 % or more"):
        explanation = explain(read(changed(PANE, "impact", speed=speed)))
        [row] = [row for row in explanation.effects.rows if row.name == "stretching"]
        assert reason in row.reason
        assert row.included == (speed == FAST)
        assert "stretching" not in explanation.evaluation_times


@pytest.mark.parametrize(
    "more", [{"effects": {"inertia": False}}, {"inertia": {"extent": "infinite"}}]
)
def test_plate_that_cannot_stretch_does_not(more: Tables) -> None:
    assert not explain(read(changed(PANE, "impact", speed=FAST) | more)).effects.law.stretches


def test_no_false_remedy_is_named_for_a_plate_without_inertia() -> None:
    still = changed(PANE, "impact", speed=10.0) | {"effects": {"inertia": False}}
    note = simulate(read(still)).unusable_note
    assert "stretches, which the model without inertia of the plate neglects" in note
    assert "effects.stretching" not in note


def test_effects_of_a_plate_without_modes_can_be_selected() -> None:
    """A map selects them; only a simulation rejects the plate."""
    thick = changed(PANE, "plate", radius=0.3, thickness=0.6, edge="simply-supported")
    scene = read(changed(thick, "impact", speed=1e3) | {"effects": {"inertia": True}})
    law = selected_effects(scene)[1].law
    with pytest.raises(SceneError, match=r"plate\.edge: expected .* bending modes"):
        largest_deflection(law)
    assert not law.stretches


def test_heavy_sphere_that_stretches_the_plate_is_simulated() -> None:
    """It is rejected if the scene disables stretching."""
    heavy = changed(changed(PANE, "sphere", mass=0.06), "impact", speed=6.5)
    heavy = changed(heavy, "accuracy", rtol=0.3)
    result = simulate(read(heavy))
    assert result.effects.law.stretches
    assert result.complete
    assert result.energy_balance is not None
    assert abs(result.energy_balance.residual) < 1e-6
    with pytest.raises(SceneError, match=r"remove effects\.stretching = false"):
        simulate(read(heavy | {"effects": {"stretching": False}}))


def test_weight_alone_decides_under_a_slow_sphere() -> None:
    """Without weight, this plate would deflect by a hundredth of its thickness."""
    slow = changed(SOFT, "impact", speed=1e-3) | {"effects": {}}
    assert explain(read(slow)).effects.law.stretches
    assert not explain(read(changed(slow, "impact", gravity=0.0))).effects.law.stretches


@pytest.mark.parametrize(
    ("stretching", "words"), [(True, "simplified"), (False, "= true includes")]
)
def test_summary_states_how_stretching_causes_the_model_error(stretching: bool, words: str) -> None:
    result = simulate(load(EXAMPLES / "soft_layer.toml"))
    scene = read(result.scene.to_json() | {"effects": {"stretching": stretching}})
    text = " ".join(str(simulate(scene)).split())
    assert "mostly by" in text
    assert words in text.partition("mostly by")[2]


def test_rows_of_a_sweep_are_equal_to_single_simulations() -> None:
    speeds = np.array([SLOW, FAST])
    rows = solve(read(PANE), {"impact.speed": speeds}, None)
    for index, speed in enumerate(speeds.tolist()):
        alone = at(speed)
        assert [rows.results[name][index] for name in OUTPUTS] == numbers(alone)
        assert rows.effects[index].split() == list(alone.effects.included)
    assert [text.endswith("stretching") for text in rows.effects] == [False, True]


def test_map_draws_the_other_effects_as_without_stretching(monkeypatch: pytest.MonkeyPatch) -> None:
    """Only the scene itself needs stretching, and with it inertia, not every point of the map."""
    monkeypatch.setattr(map_, "THICKNESSES", np.array([0.02, 0.1, 2.0]))
    monkeypatch.setattr(map_, "RADII", np.array([1e-3, 0.1, 0.4]))
    one, other = (map_.grid(at(FAST, **more), 0.1).ratios for more in ({}, {"stretching": False}))
    assert one.keys() == other.keys()
    assert np.nanmin(one["inertia"]) < 1.0 < np.nanmax(one["inertia"])

    def legend(speed: float) -> str:
        [shown] = map_.figure(at(speed), 0.1).legends
        return " ".join(label.get_text() for label in shown.get_texts())

    assert "this scene, which needs stretching" in legend(FAST)
    assert "stretching" not in legend(SLOW)


@pytest.mark.parametrize(("speed", "stretches"), [(SLOW, False), (1.5, True)])
def test_measured_constant_belongs_to_a_plate_that_stretches_like_the_result(
    speed: float, stretches: bool
) -> None:
    """The plate that loses no energy decides, so that it is the same for all trial values."""
    wanted = {"restitution": 0.6, "solve_for": "retardation_time", "target": "plate"}
    measured = measurement_of(changed(PANE, "impact", speed=speed), wanted)
    for value in (None, 1e-5):
        law = selected_effects(measured.scene(value))[1].law
        assert law.stretches == stretches
        assert law.viscous == (value is not None)
    # With this value so much energy is lost that the plate alone would not stretch.
    slow = changed(measured.scene(1e-5).to_json(), "effects", stretching="auto")
    assert not selected_effects(read(slow))[1].law.stretches


def test_result_of_a_measurement_stretches_like_the_measured_plate(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    value = 1e-5
    monkeypatch.setattr(measured_constant, "_fit", lambda _: Fit(value, 0, 0, 0, 0, 2))
    scene = changed(PANE, "impact", speed=1.5)
    known = changed(scene, "plate", retardation_time=value)
    assert not selected_effects(read(known))[1].law.stretches
    wanted = {"restitution": 0.6, "solve_for": "retardation_time", "target": "plate"}
    law = selected_effects(read(scene | {"measured": wanted}))[1].law
    assert law.viscous
    assert law.stretches
