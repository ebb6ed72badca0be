"""Errors, warnings and output of `simulate` at the limits of its range."""

import json
import math
import re
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shared_scenes

from derivation.cli import main
from derivation.scene import SceneError, explain, read, scales, simulate, sweep
from derivation.scene.code import code
from derivation.scene.contact_law import edge_remainder
from derivation.scene.contact_law.law import THICK, ContactLaw
from derivation.scene.contact_law.stress_limits import pressure_warnings
from derivation.scene.dynamic import (
    contact_errors,
    contact_sequence,
    mode_count,
    separation,
    waves,
)
from derivation.scene.dynamic.contact_warnings import GRAZING, grazing_warnings
from derivation.scene.dynamic.infinite_plate_impact import infinite_plate_impact
from derivation.scene.dynamic.time_element import P
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.effects import WHOLE_PLATE
from derivation.scene.model import InertiaSettings, Model, model_of
from derivation.scene.numerics.collocation import radau
from derivation.scene.output import animation
from derivation.scene.quasi_static import motion, viscous, viscous_elements
from derivation.scene.scene import IncompleteError
from derivation.scene.selection.achieved_accuracy import AchievedAccuracy, Part
from generated.back_face import back_face_stress

BALL = Model(
    R=0.02, m=0.25, v0=1.0, h=0.005, b=0.15, lam=40e9, mu=27e9, density=2700.0,
    inertia=InertiaSettings(modes=8),
)  # fmt: skip
HERTZ = frozenset({"hertz"})
MOVING = WHOLE_PLATE | {"hertz", "inertia"}
SCENE: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.02, "material": "steel"},
    "plate": {"radius": 0.2, "thickness": 0.01, "material": "aluminium", "tensile_strength": 200e6},
    "impact": {"speed": 1.0},
    "effects": {"inertia": True},
    "inertia": {"modes": 8},
}
Captured = pytest.CaptureFixture[str]


def moving(**tables: Mapping[str, Any]) -> Any:
    return read({name: {**SCENE[name], **tables.get(name, {})} for name in SCENE})


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return shared_scenes.written(tmp_path, SCENE)


# --- text output


def test_simulate_states_contacts_and_back_face_stress(file: Path, capsys: Captured) -> None:
    assert main(["simulate", str(file), "--details"]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    result = simulate(moving())
    assert result.dynamics is not None
    assert "Contacts" in shown
    assert all(note in shown for note in result.dynamics.notes())
    assert (
        f"strength / largest tensile stress = {200e6 / result.max_tensile_stress:.3g}"
        in result.strength_note
    )
    assert "quasi-static" not in result.strength_note
    assert result.strength_note in shown


def test_sweep_is_printed_as_table_or_json(file: Path, capsys: Captured) -> None:
    file.write_text(file.read_text().replace("inertia = true", "inertia = false"))
    wanted = ["simulate", str(file), "--sweep", "impact.speed=0.5:1:2"]
    assert main(wanted) == 0
    shown = capsys.readouterr().out
    rows = [line.split() for line in shown.splitlines() if re.match(r" *(0\.5|1) ", line)]
    assert "P [N]" in shown
    assert main([*wanted, "--json", "-"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert [row["value"] for row in data] == [0.5, 1.0]
    assert len(rows) == 2
    for row, cells in zip(data, rows, strict=True):
        digits = min(row["digits"]["max_force"], sweep.MOST_DIGITS)
        error = abs(float(cells[3]) / row["results"]["max_force"] - 1.0)
        assert error <= 0.5 * 10.0 ** (1 - digits)


def test_explain_is_printed_as_table_or_json(file: Path, capsys: Captured) -> None:
    assert main(["explain", str(file)]) == 0
    table = capsys.readouterr()
    assert "Effects in" in table.out
    assert "inertia is included" in " ".join(table.err.split())
    assert main(["explain", str(file), "--json", "-"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert "inertia" in data["included"]
    assert "inertia is included" in data["notes"][0]
    assert "Effects in" not in str(data)


def test_html_animation_contains_its_frames(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(animation, "FRAMES", 3)
    page = animation.render(simulate(moving()), ".html").decode()
    assert page.count("data:image/png;base64") == 3


def test_infinite_plate_is_stated() -> None:
    explanation = explain(moving(inertia={"extent": "infinite", "modes": "auto"}))
    assert any("no wave returns" in note for note in explanation.notes)


def test_bound_names_its_outputs() -> None:
    part = Part(1e-6, "proved")
    whole = AchievedAccuracy("full", None, law=part, quadrature=part, rounding=part)
    some = replace(whole, outputs=("contact_time", "max_force"))
    assert "contact time, max force" not in str(whole)
    assert "contact time, max force" in str(some)


def test_back_face_of_a_block_uses_the_edge_of_the_paper() -> None:
    """The block is thicker than the range of the supports' model, so the paper's edge is used."""
    assert max(key[1] for key in edge_remainder._table()) == THICK
    block, soft = (
        simulate(
            shared_scenes.scene(plate={"half_thickness": 0.9, "edge": edge}, impact={"speed": 0.01})
        )
        for edge in ("clamped", "paper")
    )
    m, a, force = block.model, block.max_contact_radius, block.max_force
    assert (
        block.max_tensile_stress == float(back_face_stress(force, a, m.h, m.b, m.lam, m.mu)) > 0.0
    )
    assert block.max_tensile_stress == pytest.approx(soft.max_tensile_stress, rel=1e-3)


def test_compressive_stress_predicts_no_failure() -> None:
    plate = {"half_thickness": 400.0, "tensile_strength": 1e6}
    result = simulate(shared_scenes.scene(plate=plate, impact={"speed": 0.01}))
    assert result.max_tensile_stress == 0.0
    assert result.strength_note.endswith("no tensile stress on the axis")


# --- warnings


@pytest.mark.parametrize(
    ("speeds", "least", "message"),
    [
        (
            [1.0, GRAZING / 2],
            1.0,
            f"{GRAZING / 2:.2g}",
        ),
        (
            [1.0],
            GRAZING / 4,
            f"{GRAZING / 4:.2g}",
        ),
        ([1.0], 1.0, ""),
    ],
)
def test_grazing_recontact_gives_a_warning(speeds: list[float], least: float, message: str) -> None:
    assert message in "".join(grazing_warnings(speeds, least))
    assert bool(grazing_warnings(speeds, least)) == bool(message)


def test_pressure_warning_of_a_viscoelastic_contact() -> None:
    (text,) = pressure_warnings(1e6, 2e8, viscous=True)
    assert "plate" in text
    assert pressure_warnings(1e6, None, viscous=True) == ()
    assert pressure_warnings(1e6, 2e8) == ()


# --- rejected scenes and errors


def test_material_without_density_gives_no_mass() -> None:
    with pytest.raises(SceneError, match=r"sphere\.material: .*paper"):
        moving(sphere={"material": "paper"})
    assert moving(sphere={"material": "paper", "mass": 0.2}).sphere.mass == 0.2


@pytest.mark.parametrize(
    ("scene", "rtol", "message"),
    [
        (
            moving(inertia={"modes": 60}),
            1e-9,
            ".*1e-09.*inertia.modes",
        ),
        (shared_scenes.scene(), 1e-13, r".*radius of 0\.\d+ sphere radii.*1e-13"),
    ],
)
def test_unattainable_tolerance_is_rejected_with_the_smallest_one(
    scene: Any, rtol: float, message: str
) -> None:
    with pytest.raises(SceneError, match=r"rtol: expected at least \S+ " + message) as error:
        simulate(scene, rtol=rtol)
    (least,) = re.findall(r"at least (\S+)", str(error.value))
    assert simulate(scene, rtol=1.01 * float(least)).accuracy.bound <= 1.01 * float(least)


def test_impact_with_inertia_beyond_the_law_is_rejected() -> None:
    fast = ContactLaw(replace(BALL, v0=1e6), MOVING)
    scene = moving(impact={"speed": 1e6})
    for run in (lambda: waves.impact(fast), lambda: problem_of(fast, 8)):
        with pytest.raises(SceneError, match=r"impact\.speed"):
            run()
    with pytest.raises(SceneError, match=r"impact\.speed"):
        simulate(scene)


@pytest.mark.one_version
def test_number_of_modes_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    """The last run within the limit is returned, with its change as the estimated error."""
    every = law(inertia=InertiaSettings(branches="all"))
    fine = waves.impact(every, 1e-7)
    monkeypatch.setattr(mode_count, "MANY", fine.inertia.modes // 2)
    waves.impact.cache_clear()
    rough = waves.impact(every, 1e-7)
    assert rough.inertia.modes < fine.inertia.modes
    error = abs(rough.restitution / fine.restitution - 1.0)
    assert error <= sum(rough.inertia.left(("restitution",)))


def test_inaccurate_code_is_not_returned() -> None:
    recipe = code.recipe(shared_scenes.scene())
    law, limit = recipe.law, float(recipe.numbers["LIMIT"])
    a = np.linspace(0.0, limit, 4001)[1:]
    table = law.indentation(a, law.at(a))

    def inverse(delta: Any) -> Any:
        return np.interp(delta, table, a)

    made = {
        "LIMIT": limit,
        "MAX_INDENTATION": math.inf,
        "contact_radius": inverse,
        "force": lambda delta: law.force(inverse(delta), law.at(inverse(delta))),
        "stiffness": lambda delta: law.stiffness(inverse(delta), law.at(inverse(delta))),
    }
    with pytest.raises(SceneError, match=r"^scene: "):
        code.errors(recipe, made)


# --- contacts that cannot be simulated


def law(effects: frozenset[str] = MOVING, **changes: Any) -> ContactLaw:
    return ContactLaw(replace(BALL, **changes), effects)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("SHORTEST", 10.0, "the contact at 0 s has no solution"),
        ("ELEMENTS", 4, "still in contact .* limit of 4 time steps"),
    ],
)
def test_first_contact_without_end_is_rejected(
    name: str, value: float, message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = problem_of(law(), 8)
    monkeypatch.setattr(contact_sequence, name, value)
    with pytest.raises(SceneError, match=rf"effects\.inertia: .*{message}"):
        contact_sequence.impact_history(problem, 10)


def test_reasons_for_a_failed_contact() -> None:
    problem = problem_of(law(), 8)
    widest = problem.contact.top / problem.a
    failure = contact_errors.no_solution(problem, problem.begin(), widest, 0.0)
    assert f"grows wider than {problem.contact.top:.4g} m" in failure.why
    assert "impact.speed" in str(failure.remedy)


def test_sphere_too_heavy_to_rebound_is_rejected() -> None:
    """A very long contact is rejected if the sphere has weight, and allowed if it has none."""
    heavy = problem_of(law(MOVING | {"gravity"}, gravity=9.81), 8)
    light = problem_of(law(), 8)
    contact_sequence._check_weight(heavy, 1.0)
    contact_sequence._check_weight(light, 1e6)
    with pytest.raises(IncompleteError, match="weight"):
        contact_sequence._check_weight(heavy, 1e6)


@pytest.mark.parametrize(("name", "value"), [("MOST", 1), ("SHORTEST", 1e9)])
def test_unfinished_viscoelastic_contact_is_rejected(
    name: str, value: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    rest = ContactLaw(replace(BALL, retardation_time=1e-5), frozenset({"hertz", "viscosity"}))
    result = viscous.impact(rest)
    assert 0.0 < result.restitution < 1.0
    monkeypatch.setattr(viscous, name, value)
    with pytest.raises(SceneError, match=r"^plate\.retardation_time: .* \S+ s;"):
        viscous.impact(rest)


def test_element_that_cannot_be_shortened_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    """A viscoelastic contact ends within its last element, whose own end may lie later."""
    result = waves.impact(law(MOVING | {"viscosity"}, retardation_time=1e-4))
    problem, touching = result.impact_history.problem, result.impact_history.contacts[0]
    last, before = touching.pieces[-1], touching.pieces[-2]
    end, n = last.element.x + last.element.length, last.element.slope.size
    again = separation.last_element(problem, n, last, end, before.end, before.radius)
    assert again.element.end(P) == pytest.approx(last.element.end(P), rel=1e-6)
    monkeypatch.setattr(separation, "element", lambda *_: None)
    assert separation.last_element(problem, n, last, end, before.end, before.radius) is last


def test_initial_guess_with_nan_does_not_converge() -> None:
    result = viscous.impact(ContactLaw(replace(BALL, retardation_time=1e-5), HERTZ | {"viscosity"}))
    assert result.problem is not None
    n, none = 8, np.zeros(1)
    start = viscous_elements.Times(none, np.full(1, 1e-3), none, np.ones(1), none)
    guess = viscous_elements.onset(result.problem, radau(n), start.length)
    assert viscous_elements.elements(result.problem, n, start, guess).found.item()
    with np.errstate(all="ignore"):
        made = viscous_elements.elements(result.problem, n, start, guess * 1e200)
    assert not made.found.item()


# --- physics


def test_first_accepted_rule_gives_the_history_of_the_finest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first rule that reproduces the contact time gives the history of the finest rule."""
    result = simulate(shared_scenes.scene())
    first = result.history(41)
    monkeypatch.setattr(motion, "HISTORY_TOLERANCE", -1.0)
    for ours, finest in zip(first, result.history(41), strict=True):
        off = np.abs(finest - ours) / np.max(np.abs(ours))
        assert np.max(off[1:-1]) < 1e-12
        assert np.max(off) < 1e-7


@pytest.mark.parametrize("number", [0.02, 0.3, 1.5])
def test_restitution_of_a_thin_infinite_plate_agrees_with_zener(number: float) -> None:
    """Zener's equation is the limit of a contact small compared with the thickness."""
    plate = {"radius": 0.1, "thickness": 0.01, "youngs_modulus": 7e10, "poissons_ratio": 0.2,
             "density": 2500.0}  # fmt: skip
    data = {"sphere": {"radius": 1e-3, "mass": 1e-3}, "plate": plate, "impact": {"speed": 1e-6},
            "inertia": {"extent": "infinite"}}  # fmt: skip
    unit = scales.zener_number(model_of(read(data)))
    # Zener's number is proportional to m^(3/5); a low speed makes the contact small.
    data["sphere"]["mass"] = 1e-3 * (number / unit) ** (5.0 / 3.0)  # type: ignore[index]
    result = simulate(read(data))
    assert scales.zener_number(result.model) == pytest.approx(number, rel=1e-6)
    assert result.restitution == pytest.approx(infinite_plate_impact(number)[1], abs=2e-2)


def test_viscoelastic_surface_recovers_between_contacts() -> None:
    """Without force the elastic part, like a^3, decays as exp(-t/retardation time)."""
    lagging = law(MOVING | {"viscosity"}, retardation_time=1e-4)
    result = waves.impact(lagging)
    contacts, problem = result.impact_history.contacts, result.impact_history.problem
    again = [(one, two) for one, two in pairwise(contacts) if two.radius]
    assert len(again) >= 2
    for one, two in again:
        gap = problem.T * (two.start - one.end)
        fallen = (two.radius / one.pieces[-1].radius) ** 3
        assert fallen == pytest.approx(math.exp(-gap / 1e-4), rel=1e-3)
    assert abs(result.energy_balance.residual) < 1e-7


def test_too_few_modes_have_no_bound() -> None:
    """Too few modes give wrong results although they agree with fewer, so no bound is stated."""
    few, many = (simulate(moving(inertia={"modes": count})) for count in (4, 60))
    assert math.isinf(few.accuracy.bound)
    assert few.dynamics is not None
    assert "error estimate requires" in few.dynamics.notes()[-1]
    assert abs(few.restitution / many.restitution - 1.0) > 10.0 * many.accuracy.bound
    with pytest.raises(SceneError, match=r"^inertia\.modes: .*4"):
        simulate(moving(inertia={"modes": 4}), rtol=0.5)
