"""Effect selection: bounds, decisions, omitted effects that are not computed, and output."""

import json
import math
import re
from itertools import pairwise
from pathlib import Path

import pytest
from shared_scenes import ALL, AT_REST, EXAMPLES, model, random_models, scene

from derivation.checks import effects as measure
from derivation.checks import paper_law
from derivation.cli import main
from derivation.scene import SceneError, explain, load, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects import EFFECTS, WHOLE_PLATE
from derivation.scene.model import model_of
from derivation.scene.quasi_static import motion
from derivation.scene.selection import effect_selection
from derivation.scene.selection.effect_selection import OUTPUTS, decide

Captured = pytest.CaptureFixture[str]


@pytest.mark.one_version
def test_bounds_hold_in_random_scenes() -> None:
    rows = measure.judge(25)
    assert [row for row in rows if not row.passed] == []
    assert max(row.error_over_bound for row in rows) > 0.5  # at least one bound is tight
    included = [row.included for row in rows]
    assert included == sorted(included)


def test_violated_bound_is_detected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        measure, "selected_impact", lambda *_: ([1.0, 1.0, 1.02, 1.0], ["hertz"], 1e-3)
    )
    monkeypatch.setattr(measure, "all_effects_impact", lambda _: ([1.0] * 4, ["hertz"]))
    rows = measure.judge(3)
    assert not any(row.passed for row in rows)
    assert rows[0].quantity == "max_force"


def test_looser_tolerance_includes_no_more_effects() -> None:
    for m in random_models(10):
        taken = [decide(m, AT_REST, rtol).law.effects for rtol in (1e-9, 1e-6, 1e-4, 1e-2, 1e-1)]
        for tight, loose in pairwise(taken):
            assert loose <= tight


def test_selection_changes_at_the_bound() -> None:
    """The same effects are selected at the bound, and at least one more just below it."""
    for m in random_models(4):
        for rtol in (1e-2, 1e-4):
            selection = decide(m, AT_REST, rtol)
            if not 0 < selection.error < math.inf:
                continue
            assert decide(m, AT_REST, selection.error).law.effects == selection.law.effects
            tighter = decide(m, AT_REST, selection.error * (1 - 1e-9))
            assert len(tighter.law.effects) > len(selection.law.effects)
            whole = motion.impact(ContactLaw(m, decide(m, AT_REST, 0.0).law.effects))
            parts = motion.impact(selection.law)
            for one, other in zip(whole.numbers, parts.numbers, strict=True):
                assert abs(other / one - 1) <= selection.error * (1 + 1e-9)


def test_weight_changes_the_radius_within_its_bound() -> None:
    """With non-Hertzian pressure the radius grows up to 3.5 times as fast as Hertz's."""
    data = measure.scene(226)
    whole = measure.all_effects_impact(data)
    values, effects, bound = measure.selected_impact(data, 1e-2)
    assert whole is not None
    assert "gravity" not in effects
    assert "non_hertzian_pressure" in effects
    assert 0.5 * bound < abs(values[3] / whole[0][3] - 1) <= bound


def test_choices_of_the_user_are_applied_and_have_bounds() -> None:
    m = model()
    out = decide(m, AT_REST | {"bending": False, "gravity": True}, 1e-1)
    assert "bending" not in out.law.effects
    assert "gravity" in out.law.effects
    rows = {row.name: row for row in out.rows}
    assert rows["bending"].disabled
    assert "in the scene" in rows["gravity"].reason
    small = {row.name: row for row in decide(m, AT_REST | {"finite_radius": False}, 1e-9).rows}[
        "finite_radius"
    ]
    assert f"at most {100 * small.bound:.2g} %" in small.reason
    hertz = ALL - {"non_hertzian_pressure"}
    whole, without = (motion.impact(ContactLaw(m, e)) for e in (hertz, hertz - {"finite_radius"}))
    changes = [abs(b / a - 1) for a, b in zip(whole.numbers, without.numbers, strict=True)]
    assert 0.3 * small.bound < max(changes) <= small.bound


def test_pressure_and_inertia_require_all_parts_of_the_plate() -> None:
    off = decide(model(), {"bending": False, "inertia": False}, 1e-6)
    assert "non_hertzian_pressure" not in off.law.effects
    # An effect that cannot be included adds to the bound like any omitted effect.
    assert off.error >= {row.name: row.bound for row in off.rows}["non_hertzian_pressure"] > 1e-6
    for name in ("non_hertzian_pressure", "inertia"):
        with pytest.raises(SceneError, match=r"effects\.bending = false"):
            decide(model(), {"bending": False, name: True}, 1e-6)


def test_required_parts_of_the_pressure_are_included() -> None:
    law = decide(model(), AT_REST | {"non_hertzian_pressure": True}, 10.0).law
    assert (
        law.effects
        >= {"non_hertzian_pressure", "spherical_profile", "sphere_elasticity"} | WHOLE_PLATE
    )
    law = decide(
        model(), AT_REST | {"non_hertzian_pressure": True, "spherical_profile": False}, 10.0
    ).law
    assert "spherical_profile" not in law.effects


def test_parameters_are_those_of_the_largest_contact() -> None:
    m = model()
    result = motion.impact(ContactLaw(m, ALL))
    a, rows = result.max_contact_radius, {row.name: row for row in decide(m, AT_REST, 0.0).rows}
    depth = a * a / m.R
    exact = {
        "hertz": a / m.R, "spherical_profile": a / m.R, "non_hertzian_pressure": a / (2 * m.h),
        "sphere_elasticity": m.modulus / m.sphere_modulus,
        "gravity": m.m * m.gravity * depth / (m.m * m.v0**2 / 2),
        "bending": 2 / math.pi * a * m.b**2 / (2 * m.h) ** 3,
    }  # fmt: skip
    for name, value in exact.items():
        assert rows[name].parameter_value == pytest.approx(value, rel=0.02)
    assert rows["finite_radius"].parameter_value == pytest.approx(0.37 * a / m.b, rel=0.01)
    # Static deflection, simply supported over the paper's edge: (3 + nu)/(2 (1 + nu)).
    nu = m.lam / (2 * (m.lam + m.mu))
    extra = rows["bending"].parameter_value * ((3 + nu) / (2 * (1 + nu)) - 1)
    assert rows["edge"].parameter_value == pytest.approx(extra, rel=0.15)


def test_unneeded_outputs_include_no_effects() -> None:
    """The spherical profile is omitted for the force and included for the contact radius."""
    m = model(sphere_modulus=math.inf, gravity=0.0, h=1e3, b=1e4, v0=0.1, edge="paper")
    worst = decide(m, AT_REST, 0.0, OUTPUTS)
    assert "spherical_profile" in worst.law.effects
    errors = {
        name: decide(m, AT_REST | {"spherical_profile": "auto"}, 1.0, (name,)).error
        for name in OUTPUTS
    }
    assert errors["max_contact_radius"] > 1.4 * errors["max_force"]
    rtol = math.sqrt(errors["max_contact_radius"] * errors["max_force"])
    assert "spherical_profile" in decide(m, AT_REST, rtol, ("max_contact_radius",)).law.effects
    assert "spherical_profile" not in decide(m, AT_REST, rtol, ("max_force",)).law.effects


def test_tolerance_applies_to_the_outputs_of_the_scene() -> None:
    block = {"half_thickness": 1e3, "radius": 1e4, "edge": "paper"}
    given = scene(plate=block, sphere={"material": None}, impact={"gravity": None}).to_json()
    m = model_of(read(given))
    errors = [
        decide(m, AT_REST, 1.0, (name,)).error for name in ("max_contact_radius", "max_force")
    ]
    rtol = math.sqrt(errors[0] * errors[1])
    for name, wanted in (("max_contact_radius", True), ("max_force", False)):
        result = simulate(read(given | {"accuracy": {"rtol": rtol, "outputs": [name]}}))
        assert ("spherical_profile" in result.effects.law.effects) is wanted
    assert (
        result.accuracy.bound >= result.accuracy.parts["effects"].bound == result.effects.error > 0
    )


def test_paper_scene_with_automatic_selection() -> None:
    """On a very thick plate only Hertz's contact is included."""
    thick = scene(plate={"half_thickness": 1e3, "radius": 1e4}, sphere={"material": None})
    result = simulate(thick, rtol=1e-2)
    assert result.accuracy.method == "hertz"
    assert result.effects.law.effects == {"hertz"}
    assert result.accuracy.bound <= 1e-2


def test_explain_does_not_simulate_and_gives_reasons(capsys: Captured, tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(
        "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[plate]\nradius = 0.5\nthickness = 0.01\n"
        "material = 'glass'\n[impact]\nspeed = 1\n[effects]\nfinite_radius = false\n"
    )
    assert main(["explain", str(path), "--rtol", "1e-1", "--json", f"{tmp_path}/e.json"]) == 0
    shown = capsys.readouterr().out
    data = json.loads((tmp_path / "e.json").read_text())
    assert [row["name"] for row in data["effects"]] == [effect.name for effect in EFFECTS]
    assert set(data["evaluation_times"]) == set(data["included"])
    assert re.search(
        r"disabled in the scene: changes [a-z_]+ by at most \S+ %\"", json.dumps(data["effects"])
    )
    assert "impact.gravity is not given" in json.dumps(data["effects"])
    assert data["bound"] <= data["rtol"]
    for row in data["effects"]:
        assert row["name"] in shown
    assert "Zener" in data["notes"][0]
    assert "The scene disables finite_radius" in " ".join(shown.split())
    explanation = explain(scene())
    assert "plate.density" in explanation.notes[0]
    block = scene(plate={"half_thickness": 1e3, "radius": 1e4}, effects={"inertia": "auto"})
    assert "any density" in explain(block, 0.02).notes[0]
    assert "<table>" in explanation._repr_html_()


def test_reference_supports_only_the_law_of_the_paper(tmp_path: Path) -> None:
    """The message on a rejected scene lists keys with which the scene is accepted."""
    example = EXAMPLES / "glass_pane.toml"
    called = sorted(explain(load(example)).effects.law.effects - WHOLE_PLATE - {"hertz"})
    assert {"edge", "gravity", "inertia", "sphere_elasticity"} <= set(called)
    with pytest.raises(SceneError, match=", ".join(called)) as caught:
        paper_law.in_doubles(load(example))
    assert main(["reference", str(example), "--digits", "15"]) == 2
    lines = str(caught.value).rpartition("[effects] ")[2].split(", ")
    path = tmp_path / "scene.toml"
    path.write_text(example.read_text() + "\n[effects]\n" + "\n".join(lines) + "\n")
    actual = paper_law.in_doubles(load(path))
    assert actual.effects.law.effects == WHOLE_PLATE | {"hertz"}
    paper = (EXAMPLES / "paper.toml").read_text()
    for key in ("bending = false", "finite_radius = false"):
        path.write_text(f"{paper}{key}\n")
        with pytest.raises(SceneError, match=key.partition(" ")[0]):
            paper_law.in_doubles(load(path))


def test_reference_of_a_quasi_static_plate_needs_no_density(tmp_path: Path) -> None:
    text, path = (EXAMPLES / "paper.toml").read_text(), tmp_path / "scene.toml"
    path.write_text(text.replace("inertia = false", "inertia = true"))
    with pytest.raises(SceneError, match=r"plate\.density"):
        paper_law.in_doubles(load(path))
    known = paper_law.in_doubles(load(EXAMPLES / "paper.toml"))
    path.write_text(text.replace("inertia = false", 'inertia = "auto"'))
    assert paper_law.in_doubles(load(path)).contact_time == known.contact_time


def test_rows_are_shown_in_every_output() -> None:
    result = simulate(scene())
    made = result.to_json()["effects"]
    assert json.loads(json.dumps(made)) == made
    assert [row["name"] for row in made] == [effect.name for effect in EFFECTS]
    assert effect_selection.HEADS[0] in result._repr_html_()
    assert result.model == model_of(scene())


def test_not_applicable_differs_from_omitted_without_a_bound() -> None:
    """An effect that does not apply is "n/a"; an omitted one without a bound is "no bound"."""
    selection = decide(model(gravity=0.0), {"inertia": False}, 1e-3)
    cells = {
        line[0]: dict(zip(effect_selection.HEADS, line, strict=True)) for line in selection.lines()
    }
    away = cells["gravity"]
    assert [away[h] for h in ("parameter value", "max. change if omitted", "status")] == ["n/a"] * 3
    disabled = cells["inertia"]
    assert disabled["parameter value"] == "n/a"
    assert (disabled["max. change if omitted"], disabled["status"]) == ("no bound", "omitted")
    assert cells["hertz"]["status"] == "included"
