"""The check on plate inertia: error bounds compared with more modes and all branches."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from derivation.checks import inertia as inertia_check
from derivation.checks import inertia_rows as measure
from derivation.checks.inertia_rows import InertiaRow
from derivation.checks.random_scenes import Scene, largest_change
from derivation.cli import main
from derivation.engine.files import measurements
from derivation.scene.contact_law import limits
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import waves
from derivation.scene.effects.effect import weight_work_ratio
from derivation.scene.effects.inertia import higher_branch_error
from derivation.scene.model import Model, model_of
from derivation.scene.quasi_static.motion import impact
from derivation.scene.scales import zener_number
from derivation.scene.scene import OUTPUTS, read
from derivation.scene.selection.effect_selection import SelectedEffects, decide

SLOW = Model(
    R=0.05, m=0.4, v0=2e-3, h=0.05, b=0.15, lam=40e9, mu=27e9, density=2700.0, edge="clamped"
)
"""A sphere that hits a thick disc very slowly."""


def selection_of(model: Model, rtol: float) -> SelectedEffects:
    """Return the effect selection for inertia, with all other effects included."""
    others = inertia_check.selectable_effects(model) - {"inertia", "hertz"}
    return decide(model, dict.fromkeys(others, True) | {"inertia": "auto"}, rtol)


@pytest.mark.parametrize("changes", [{}, {"gravity": 9.81, "v0": 4e-3}, {"R": 0.02, "v0": 0.01}])
def test_both_sides_of_the_threshold(changes: dict[str, Any]) -> None:
    """Inertia is included just below its bound, and its change of the results is within it."""
    model = replace(SLOW, **changes)
    every = inertia_check.selectable_effects(model)
    omission_bound = selection_of(model, 1.0).error
    assert 0.0 < omission_bound < 3e-2
    above, below = (
        selection_of(model, omission_bound),
        selection_of(model, omission_bound * (1.0 - 1e-9)),
    )
    assert above.law.effects == every - {"inertia"}
    assert below.law.effects == every
    static, dynamic = impact(above.law), waves.impact(below.law, omission_bound / 100.0)
    changed = [abs(x / y - 1.0) for x, y in zip(static.numbers, dynamic.numbers, strict=True)]
    assert 1e-3 * omission_bound < max(changed) <= omission_bound


def test_weight_increases_the_effect_of_inertia() -> None:
    """A sphere that indents the plate by its weight loses a larger part of its energy."""
    heavy = replace(SLOW, v0=1e-3, gravity=9.81)
    light = replace(heavy, gravity=0.0)
    bounds = [selection_of(model, 1.0).error for model in (light, heavy)]
    every = [inertia_check.selectable_effects(model) for model in (light, heavy)]
    static = inertia_check.quasi_static(heavy)
    assert static is not None
    work_ratio = weight_work_ratio(heavy, static.max_indentation)
    assert work_ratio > 1.0
    assert bounds[1] > work_ratio * bounds[0]
    energy_losses = []
    for model, effects in zip((light, heavy), every, strict=True):
        dynamic = waves.impact(ContactLaw(model, effects), 1e-4)
        energy_losses.append(1.0 - dynamic.restitution)
    assert energy_losses[1] > 2.0 * energy_losses[0]
    assert energy_losses[1] <= bounds[1]
    # The bound on the omitted branches grows with the weight too.
    result = waves.impact(ContactLaw(heavy, every[1]), 1e-3)
    a, time = result.max_contact_radius, result.contact_time
    assert (
        result.inertia.omitted_branch_error[-1]
        > work_ratio * higher_branch_error(heavy, a, time)[-1]
    )


NUMBERS, OMITTED = (5, 9, 17, 34, 44, 90, 111, 142), (5, 17, 34)


@pytest.mark.parametrize("number", NUMBERS)
def test_bounds_hold_in_random_scenes(number: int) -> None:
    data, position = measure.scene(number)
    assert inertia_check.reason_to_skip(data) == ""
    row = inertia_check.solve(number, data, position)
    assert isinstance(row, InertiaRow)
    assert row.included is (number not in OMITTED)
    assert row.error <= min(row.bound, row.rtol)
    assert row.omission_change <= row.omission_bound


EXACT = InertiaRow(
    0, 1e-2, "none", True, 1e-3, 0.0, "max_force", 0.0, 1e-3, 0.0, "max_force", 1, 4, 8
)


def test_largest_change_is_found_and_named() -> None:
    exact = [2.0] * 5
    assert largest_change([2.0, 2.0, 2.04, 1.99, 2.0], exact) == (pytest.approx(0.02), "max_force")
    assert largest_change([2.0, math.nan, 2.04, 1.99, 2.0], exact) == (math.inf, "max_indentation")


def test_violated_bound_is_detected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        inertia_check, "solve", lambda number, *_: replace(EXACT, number=number, error=0.02)
    )
    monkeypatch.setattr(inertia_check, "reason_to_skip", lambda _: "")
    evaluation = inertia_check.judge(3)
    (side,) = measure.sides(evaluation.rows)
    assert not side.passed
    assert side.quantity == "max_force"
    assert side.error_over_bound == pytest.approx(20.0)
    assert evaluation.drawn == 3


def test_rejected_and_skipped_scenes_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    turns, solved = iter(["", "too slow", "", ""]), iter(["rtol", "rtol"])
    monkeypatch.setattr(
        inertia_check, "solve", lambda number, *_: next(solved, replace(EXACT, number=number))
    )
    monkeypatch.setattr(inertia_check, "reason_to_skip", lambda _: next(turns))
    evaluation = inertia_check.judge(1)
    assert evaluation.rejected == {"rtol": 2}
    assert evaluation.skipped == {"too slow": 1}
    assert [row.number for row in evaluation.rows] == [3]
    assert measure.as_data(evaluation, 1)["drawn"] == 4


def test_number_of_modes_agrees_with_the_law_of_weyl() -> None:
    from derivation.scene.dynamic.modal import free_modes
    from derivation.scene.model import InertiaSettings

    for eta, modes in ((0.3, 24), (0.06, 80)):
        model = replace(SLOW, h=eta * SLOW.b, edge="paper",
                        inertia=InertiaSettings(modes=modes, branches="all"))  # fmt: skip
        reference = free_modes(model, modes).omega.size
        assert inertia_check.mode_count(model) == pytest.approx(reference, rel=0.15)


def test_recorded_scenes_are_within_their_bounds() -> None:
    data = json.loads((measurements() / "inertia.json").read_text())
    assert len(data["rows"]) >= 500
    for kinds, least in (({measure.ELASTIC}, 100), ({*measure.KEYS, measure.SEVERAL}, 100)):
        for included in (True, False):
            sides = [s for s in data["sides"] if s["dissipation"] in kinds]
            assert sum(s["scenes"] for s in sides if s["included"] is included) >= least
    for row in data["rows"]:
        assert row["error"] <= min(row["bound"], row["rtol"])
        assert row["omission_bound"] is None or row["omission_change"] <= row["omission_bound"]


def test_command_shows_both_sides_of_the_threshold(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def solve(number: int, data: Scene, position: float) -> InertiaRow | str:
        known = data["inertia"]["branches"] == "A0"
        return replace(
            EXACT,
            number=number,
            rtol=position,
            included=known,
            bound=position,
            omission_bound=math.inf,
        )

    monkeypatch.setattr(inertia_check, "solve", solve)
    monkeypatch.setattr(inertia_check, "reason_to_skip", lambda _: "")
    monkeypatch.setattr(inertia_check, "MEASURED", tmp_path / "inertia.json")
    assert main(["check", "inertia", "-n", "12", "--seed", "7", "--update"]) == 0
    shown = capsys.readouterr().out
    assert "12 of 12" in shown
    stored = json.loads((tmp_path / "inertia.json").read_text())
    assert stored["seed"] == 7
    assert [side["included"] for side in stored["sides"]] == [True, False]
    assert stored["rows"][0]["omission_bound"] is None
    assert set(OUTPUTS) >= {row["quantity"] for row in stored["rows"]}


def changed(**tables: dict[str, Any]) -> dict[str, Any]:
    """Return an elastic scene that is not skipped, with some keys of its tables changed."""
    data = measure.scene(1)[0]
    del data["plate"]["retardation_time"]
    return {**data, **{name: {**data[name], **keys} for name, keys in tables.items()}}


def test_scenes_are_skipped_for_stated_reasons() -> None:
    """Scenes are skipped for their weight, Zener parameter, speed or number of modes."""
    assert inertia_check.reason_to_skip(changed()) == ""
    slow = changed(impact={"speed": 1e-3, "gravity": 9.81})
    assert "weight over the initial kinetic energy above 100" in inertia_check.reason_to_skip(slow)
    static = inertia_check.quasi_static(model_of(read(slow)))
    assert static is not None
    assert 2.0 * 9.81 * static.max_indentation / 1e-6 > inertia_check.MAX_WEIGHT_WORK
    # Zener's parameter is proportional to mass^(3/5); the limit 5 is between the two values.
    heavy, light = (changed(sphere={"density": rho}) for rho in (1e7, 1e3))
    assert inertia_check.reason_to_skip(heavy) == "Zener parameter above 5"
    assert inertia_check.reason_to_skip(light) == ""
    numbers = [zener_number(model_of(read(data))) for data in (heavy, light)]
    assert numbers[0] / numbers[1] == pytest.approx(1e4**0.6, rel=1e-9)
    assert numbers[1] < 5.0 < numbers[0]
    fast = changed(impact={"speed": 1e6})
    assert inertia_check.reason_to_skip(fast) == "no impact on the quasi-static plate"
    assert inertia_check.quasi_static(model_of(read(fast))) is None
    assert inertia_check.reason_to_skip(measure.scene(2)[0]) == "too many modes"


def test_skipped_scenes_are_reported_with_the_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    """A skipped scene is reported with its reason: too many modes, or speed out of range."""
    data, position = measure.scene(9)
    solution = inertia_check.solve(9, data, position)
    assert isinstance(solution, InertiaRow)
    monkeypatch.setattr(inertia_check, "MAX_MODES", solution.modes // 2)
    assert inertia_check.solve(9, data, position) == (
        f"reference: more than {solution.modes // 2} modes"
    )

    def beyond(law: ContactLaw, *_: object) -> None:
        limits.refuse(replace(law, model=replace(law.model, v0=1e9)))

    monkeypatch.setattr(inertia_check.waves, "impact", beyond)
    assert inertia_check.solve(9, data, position) == "impact.speed"
