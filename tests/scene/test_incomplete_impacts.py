"""Impacts simulated in part: the results so far are kept and shown as incomplete."""

import json
import math
import pickle
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from derivation.cli import main
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_sequence, flight, refinement, waves
from derivation.scene.dynamic.contact_sequence import ImpactHistory
from derivation.scene.dynamic.first_contact import IRREGULAR
from derivation.scene.dynamic.mode_count import affordable
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.reach import Reach
from derivation.scene.dynamic.runs import Budget, run_with
from derivation.scene.dynamic.stretching_needed import stretched
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.effects import WHOLE_PLATE
from derivation.scene.model import InertiaSettings, Model
from derivation.scene.scene import OUTPUTS, IncompleteError

BALL = Model(
    R=0.02, m=0.25, v0=1.0, h=0.005, b=0.15, lam=40e9, mu=27e9, density=2700.0,
    inertia=InertiaSettings(modes=8),
)  # fmt: skip
EFFECTS = WHOLE_PLATE | {"hertz", "inertia"}
PHONE = """
[sphere]
radius = 0.0158
mass = 0.13
[plate]
radius = 0.05
thickness = 0.00055
material = "glass"
edge = "clamped"
[impact]
speed = 6.0
[effects]
inertia = true
stretching = false
[inertia]
modes = 24
"""


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("CONTACTS", 1, "after 1 contacts"),
        ("BLOCKS", 0, "without contact"),
        ("ELEMENTS", 0, "limit of .* time steps"),
    ],
)
def test_contacts_before_an_endless_one_are_kept(
    name: str, value: int, message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = problem_of(ContactLaw(BALL, EFFECTS), 8)
    whole = contact_sequence.impact_history(problem, 10)
    assert whole.complete
    assert len(whole.contacts) == 2
    limit = value or whole.contacts[0].tried + (1 if name == "ELEMENTS" else 0)
    module = flight if name == "BLOCKS" else contact_sequence
    monkeypatch.setattr(module, name, limit if name == "ELEMENTS" else value)
    part = contact_sequence.impact_history(problem, 10)
    assert not part.complete
    assert len(part.contacts) == 1
    assert part.contacts[0].end == whole.contacts[0].end
    assert re.search(message, part.reason)


@pytest.mark.parametrize("steps", [0.5, 1e9])
def test_only_a_plate_that_does_not_stretch_may_have_no_inertia(
    steps: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Stretching needs inertia. Few steps end the impact in the first flight, many after it."""
    linear = ContactLaw(BALL, EFFECTS)
    for law in (linear, stretched(linear)):
        problem = problem_of(law, 8)
        whole = contact_sequence.impact_history(problem, 10)
        assert len(whole.contacts) > 1
        work = (whole.contacts[0].tried + steps) * contact_sequence.weight_of(problem, 10)
        with monkeypatch.context() as limited:
            limited.setattr(contact_sequence, "CONTACTS", 1)
            part = contact_sequence.impact_history(problem, 10, work=work)
        assert not part.complete
        assert ("effects.inertia = false" in part.remedy) == (law is linear)


def test_contacts_before_a_later_error_are_kept(capsys: Any, tmp_path: Path) -> None:
    """Contacts before an error are kept: here phone glass bends too much in a later contact."""
    file = tmp_path / "phone.toml"
    file.write_text(PHONE)
    assert main(["simulate", str(file), "--json", "-"]) == 1
    data = json.loads(capsys.readouterr().out)
    dynamics, contacts = data["dynamics"], data["dynamics"]["contacts"]
    assert not dynamics["complete"]
    assert "curved" in dynamics["end_reason"]
    assert data["restitution"] is None
    assert data["accuracy"]["bound"] is None
    assert len(contacts) > 1
    assert data["max_force"] == max(touch["peak_force"] for touch in contacts)
    assert data["contact_time"] == contacts[0]["end"]
    # The simulated part conserves energy and momentum.
    balance = dynamics["energy_balance"]
    assert abs(balance["residual"]) <= 1e-10
    speed = math.sqrt(2.0 * balance["rebound_kinetic"] / 0.13)
    impulse = sum(touch["impulse"] for touch in contacts)
    assert impulse == pytest.approx(0.13 * (6.0 - speed), rel=1e-8)
    assert main(["simulate", str(file)]) == 1
    shown = " ".join(capsys.readouterr().out.split())
    assert "INCOMPLETE" in shown
    # The sphere is much heavier than the plate; the quasi-static plate that is named has a result.
    assert "try effects.inertia = false" in shown
    file.write_text(PHONE.replace("inertia = true", "inertia = false").replace("6.0", "4.0"))
    assert main(["simulate", str(file)]) == 0


def test_a_quasi_static_plate_is_not_recommended_for_a_plate_that_stretches(
    capsys: Any, tmp_path: Path
) -> None:
    file = tmp_path / "phone.toml"
    file.write_text(PHONE.replace("stretching = false", "stretching = true"))
    assert main(["simulate", str(file)]) == 2
    shown = " ".join(capsys.readouterr().err.split())
    assert "more curved than the sphere; use a smaller sphere or a thicker plate" in shown
    assert "inertia = false" not in shown


def test_error_with_partial_results_can_be_pickled() -> None:
    restored = pickle.loads(pickle.dumps(IncompleteError("it ends", "correct it")))
    assert str(restored) == "effects.inertia: it ends; correct it"


def test_search_in_a_long_flight_respects_the_work_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = problem_of(ContactLaw(BALL, EFFECTS), 8)
    above = problem.begin()._replace(velocity=0.0, approach=-1.0)
    leaving = above._replace(velocity=-1.0, displacement=-1.0)
    _, _, one = flight.next_contact(problem, leaving, 0.0)
    assert one > 0.0
    blocks, apart = list[ImpactState](), flight._time_apart

    def counted(problem: DynamicProblem, state: ImpactState) -> float:
        blocks.append(state)
        return apart(problem, state)

    monkeypatch.setattr(flight, "_time_apart", counted)
    with pytest.raises(IncompleteError, match="without contact"):
        flight.next_contact(problem, above, 0.0, 3.0 * one)
    assert len(blocks) == 3


def test_run_above_the_work_limit_is_not_started(monkeypatch: pytest.MonkeyPatch) -> None:
    """Coarser runs give the error of the first run; without them it is returned as incomplete."""
    wide = replace(BALL, b=1.5, inertia=InertiaSettings(branches="A0"))
    law = ContactLaw(wide, EFFECTS)
    waves.impact.cache_clear()
    begun: list[ImpactHistory] = []
    follow = contact_sequence.impact_history

    def recorded(*args: Any, **options: Any) -> ImpactHistory:
        begun.append(follow(*args, **options))
        return begun[-1]

    monkeypatch.setattr(contact_sequence, "impact_history", recorded)
    whole = waves.impact(law)
    assert whole.inertia.complete
    assert len(begun) > 1
    first, second = begun[:2]
    assert first.work < second.work
    begun.clear()
    waves.impact.cache_clear()
    monkeypatch.setattr(contact_sequence, "WORK", 0.5 * (first.work + second.work))
    limited = waves.impact(law)
    assert max(history.problem.omega.size for history in begun) == first.problem.omega.size
    assert limited.inertia.complete
    # The estimated error covers the difference from the run with more modes.
    for index, (coarse, fine) in enumerate(zip(limited.numbers, whole.numbers, strict=True)):
        error = IRREGULAR * limited.inertia.mode_convergence[index]
        assert coarse == pytest.approx(fine, rel=error)
    begun.clear()
    waves.impact.cache_clear()
    monkeypatch.setattr(refinement, "FOURTH", math.inf)
    part = waves.impact(law)
    waves.impact.cache_clear()
    assert [history.work for history in begun] == [first.work]
    assert not part.inertia.complete
    assert math.isnan(part.restitution)
    assert part.contact_time == pytest.approx(whole.contact_time, rel=0.05)
    assert "limit of time steps and modes" in part.inertia.end_reason
    # The impact is complete with the setting that the remedy proposes.
    given = re.search(r"inertia.modes = (\d+)", part.inertia.remedy)
    assert given
    fewer = replace(wide, inertia=InertiaSettings(modes=int(given[1]), branches="A0"))
    assert waves.impact(replace(law, model=fewer)).inertia.complete
    waves.impact.cache_clear()


def test_all_runs_of_an_impact_count_towards_one_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    law = ContactLaw(replace(BALL, inertia=InertiaSettings()), EFFECTS)
    used: list[float] = []
    follow = contact_sequence.impact_history

    def recorded(*args: Any, **options: Any) -> ImpactHistory:
        history = follow(*args, **options)
        used.append(history.work)
        return history

    monkeypatch.setattr(contact_sequence, "impact_history", recorded)
    waves.impact.cache_clear()
    best = waves.impact(law, 1e-4)
    whole = sum(used)
    assert len(used) > 3
    used.clear()
    waves.impact.cache_clear()
    monkeypatch.setattr(waves, "WORK", 0.9 * whole)
    result = waves.impact(law, 1e-4)
    waves.impact.cache_clear()
    assert sum(used) <= 0.9 * whole * (1.0 + 1e-12)  # sums are rounded
    assert result.inertia.complete
    assert result.inertia.modes < best.inertia.modes


def test_coarser_runs_give_an_error_if_a_finer_one_exceeds_the_limit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """An earlier version had too little work left for them, and called the impact incomplete."""
    law = ContactLaw(replace(BALL, inertia=InertiaSettings(branches="A0")), EFFECTS)
    reach = Reach(law, OUTPUTS, math.inf)
    first = run_with(law, affordable(law), Budget(math.inf), 1e-8).impact_history.work
    monkeypatch.setattr(refinement, "LONG", 1.0)
    run = refinement.Refinement(law, 1e-9, reach, Budget(1.5 * first)).impact()
    assert run.inertia.complete
    finer = refinement.Refinement(law, 1e-9, reach, Budget(math.inf)).impact()
    assert finer.inertia.modes > run.inertia.modes
    for name in OUTPUTS:
        change = abs(getattr(run, name) / getattr(finer, name) - 1.0)
        assert change <= run.inertia.error((name,))
    assert run.inertia.error(("max_indentation",)) < 0.5
