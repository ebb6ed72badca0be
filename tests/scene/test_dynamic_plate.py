"""Scenes with plate inertia: rejected scenes, results, figures and supported edges."""

import csv
import io
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from shared_scenes import written

from derivation.cli import main
from derivation.scene import SceneError, explain, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.infinite_plate_impact import infinite_plate_impact
from derivation.scene.dynamic.modal import plate_of
from derivation.scene.effects import WHOLE_PLATE
from derivation.scene.model import model_of
from derivation.scene.output.history import DynamicHistory
from derivation.scene.output.wave_plot import figure

SCENE: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.02, "material": "steel"},
    "plate": {"radius": 0.2, "thickness": 0.01, "material": "aluminium"},
    "impact": {"speed": 1.0},
    "effects": {"inertia": "auto"},
}


def scene(**tables: dict[str, Any]) -> Any:
    return read({name: SCENE.get(name, {}) | tables.get(name, {}) for name in SCENE | tables})


@pytest.fixture(scope="module")
def result() -> Any:
    return simulate(scene())


def test_inertia_is_included_if_required(result: Any) -> None:
    assert {"inertia", "bending", "finite_thickness", "finite_radius"} <= result.effects.law.effects
    still = simulate(scene(effects={"inertia": False}))
    assert "inertia" not in still.effects.law.effects
    assert still.inertia_neglected
    assert any("inertia is neglected" in text for text in still.warnings)
    assert not result.inertia_neglected
    assert not any("inertia" in text for text in result.warnings)
    assert result.restitution < 0.9 < still.restitution == 1.0
    row = next(row for row in still.effects.rows if row.name == "inertia")
    assert row.disabled


def test_inertia_requires_the_density() -> None:
    own = {"youngs_modulus": 70e9, "poissons_ratio": 0.3, "radius": 0.2, "thickness": 0.01}
    bare = {**SCENE, "plate": own}
    for wanted in ("auto", True):
        with pytest.raises(SceneError, match=r"^plate\.density: .*effects\.inertia"):
            simulate(read(bare | {"effects": {"inertia": wanted}}))
    assert simulate(read(bare | {"effects": {"inertia": False}})).restitution == 1.0
    # Inertia of a thick block is negligible for any density.
    block = own | {"radius": 1.0, "thickness": 1.0}
    known = read({**bare, "plate": block, "impact": {"speed": 1e-3}})
    assert known.effects.inertia == "auto"
    assert "inertia" not in simulate(known, rtol=1e-1).effects.law.effects


def test_inertia_requires_all_parts_of_the_plate() -> None:
    with pytest.raises(SceneError, match=r"^effects\.inertia .*effects\.bending"):
        simulate(scene(effects={"inertia": True, "bending": False}))
    with pytest.raises(SceneError, match=r"^effects\.bending: "):
        simulate(scene(effects={"bending": False}))


@pytest.mark.parametrize("part", ["finite_radius", "finite_thickness"])
def test_disabled_small_static_part_keeps_inertia(part: str) -> None:
    """Disabling a small static part keeps inertia, and its bound covers the change."""
    whole, without = (simulate(scene(effects=e)) for e in ({}, {part: False}))
    assert "inertia" in without.effects.law.effects
    size = next(row.bound for row in without.effects.rows if row.name == part)
    for one, other in zip(whole.dynamics.numbers, without.dynamics.numbers, strict=True):  # type: ignore[union-attr]
        assert abs(other / one - 1.0) <= size + whole.accuracy.bound + without.accuracy.bound


def test_json_and_history_are_consistent(result: Any) -> None:
    data = json.loads(json.dumps(result.to_json()))["dynamics"]
    balance = data["energy_balance"]
    assert abs(balance["residual"]) <= 1e-11
    assert sum(data["mode_energies"]) == pytest.approx(balance["plate"], rel=1e-12)
    assert data["contacts"][0]["end"] == result.contact_time
    assert data["contacts"][-1]["end"] == data["total_time"] >= result.contact_time
    impulse = sum(touch["impulse"] for touch in data["contacts"])
    m, v0 = result.model.m, result.model.v0
    assert impulse == pytest.approx(m * v0 * (1.0 + result.restitution), rel=1e-10)
    history = result.history(301)
    assert isinstance(history, DynamicHistory)
    rows = list(csv.reader(io.StringIO(history.to_csv())))
    assert rows[0][-2:] == ["deflection", "plate_energy"]
    assert len(rows) == 302
    assert np.max(history.force) == pytest.approx(result.max_force, rel=1e-3)
    assert np.all(history.force >= 0.0)
    assert 0.5 * m * history.velocity[-1] ** 2 == pytest.approx(
        balance["rebound_kinetic"], rel=1e-9
    )
    assert history.plate_energy[-1] == pytest.approx(balance["plate"], rel=1e-9)
    page = result._repr_html_()
    assert "energy balance closes" in page
    assert "approach speed / impact speed" in page


def test_times_end_at_the_last_separation(result: Any) -> None:
    whole = result.at([0.0, result.total_time])
    assert whole.history().velocity[-1] == pytest.approx(-result.restitution, rel=1e-9)
    with pytest.raises(SceneError, match=r"^times: "):
        result.at([1.01 * result.total_time])


def test_figure_shades_every_contact(result: Any) -> None:
    drawn = figure(result)
    contacts = len(result.dynamics.inertia.contacts)
    shaded = [len(axes.patches) for axes in drawn.axes]
    assert sorted(shaded) == [0, *[contacts] * 4]
    stacked = next(axes for axes in drawn.axes if "initial kinetic energy" in axes.get_ylabel())
    assert len(stacked.collections) == 3
    # In contact the sphere is below this deflection.
    assert any("without local indentation" in text for text in _labels(drawn))


def _labels(drawn: Any) -> list[str]:
    return [text for axes in drawn.axes for text in axes.get_legend_handles_labels()[1]]


def test_animation_shows_the_motion_of_the_plate(tmp_path: Path, monkeypatch: Any) -> None:
    from PIL import Image

    from derivation.scene.output import animation

    monkeypatch.setattr(animation, "FRAMES", 6)
    toml = written(tmp_path, SCENE)
    path = tmp_path / "plate.gif"
    assert main(["simulate", str(toml), "--animate", str(path), "--json", "-"]) == 0
    with Image.open(path) as movie:
        assert movie.n_frames == 6
    assert main(["simulate", str(toml), "--animate", str(tmp_path / "plate.mp4")]) == 2
    toml.write_text(toml.read_text().replace('inertia = "auto"', "inertia = false"))
    assert main(["simulate", str(toml), "--animate", str(tmp_path / "still.gif")]) == 2
    assert not (tmp_path / "still.gif").exists()


def test_animation_for_a_browser_needs_no_network(result: Any, monkeypatch: Any) -> None:
    from derivation.scene.output import animation

    monkeypatch.setattr(animation, "FRAMES", 2)
    page = animation.render(result, ".html").decode()
    assert "http" not in page.replace("http://www.w3.org", "")
    assert "fa-" not in page
    assert page.count("<button") == len(animation.BUTTONS)
    assert all(f"{text}</button>" in page for text in animation.BUTTONS.values())


def test_titles_of_an_animation_do_not_overlap(result: Any, monkeypatch: Any) -> None:
    """An earlier layout had no room for the time, which was written across the other title."""
    from matplotlib.animation import FuncAnimation

    from derivation.scene.output import animation

    def page(movie: Any, **_: Any) -> str:
        drawn = movie._fig
        drawn.draw_without_rendering()
        time, other = (text.get_window_extent() for text in (drawn.axes[0].title, *drawn.texts))
        assert time.y1 < other.y0 or time.x1 < other.x0
        assert other.y1 < drawn.bbox.y1
        assert "without local indentation" in drawn.axes[0].get_legend_handles_labels()[1][0]
        return ""

    monkeypatch.setattr(FuncAnimation, "to_jshtml", page)
    animation.render(result, ".html")


def test_profiles_are_zero_at_the_edge_and_correct_at_the_axis(result: Any) -> None:
    times = np.linspace(0.1, 0.9, 5) * result.total_time
    profiles = result.dynamics.profiles(times, np.array([0.0, result.model.b]))
    history = result.at(times).history()
    np.testing.assert_allclose(profiles[:, 0], history.deflection, rtol=1e-9)
    assert np.max(np.abs(profiles[:, 1])) <= 1e-9 * np.max(np.abs(profiles[:, 0]))


def test_curve_of_zener_agrees_with_its_series() -> None:
    for number in (1e-3, 2e-3):
        series = 1.0 - 1.7302 * number + 1.796 * number**2
        assert infinite_plate_impact(number)[1] == pytest.approx(series, abs=2.0 * number**3 + 1e-7)
    assert infinite_plate_impact(5.0)[1] < 1e-3


@pytest.mark.parametrize(("edge", "factor"), [("paper", 1.0), ("clamped", 0.5),
                                              ("simply-supported", 3.3 / 2.6)])  # fmt: skip
def test_modes_of_a_thin_plate_add_up_to_the_static_deflection(edge: str, factor: float) -> None:
    """The sum is P b^2/(8 pi D) times 1, 1/2 (clamped) or (3 + nu)/(2 (1 + nu)) (supported)."""
    thin = scene(plate={"thickness": 2e-4, "edge": edge})
    model = replace(model_of(thin), h=1e-4)
    law = ContactLaw(model, WHOLE_PLATE | {"hertz", "edge"} if edge != "paper" else WHOLE_PLATE)
    actual = float(np.sum(plate_of(law, 400).modes.compliance))
    bending = model.modulus * (2.0 * model.h) ** 3 / 12.0
    assert actual == pytest.approx(factor * model.b**2 / (8.0 * np.pi * bending), rel=2e-5)


@pytest.mark.parametrize("edge", ["simply-supported", "clamped"])
def test_supported_plate_uses_the_modes_of_its_edge(edge: str) -> None:
    held = simulate(scene(plate={"edge": edge}))
    assert {"edge", "inertia"} <= held.effects.law.effects
    assert abs(held.dynamics.energy_balance.residual) <= 1e-11  # type: ignore[union-attr]
    assert 0.0 < held.restitution < 1.0


def test_no_code_is_generated_for_a_plate_with_inertia() -> None:
    from derivation.scene.code.code import recipe

    with pytest.raises(SceneError, match=r"effects\.inertia = false"):
        recipe(scene())


def test_explain_states_plate_inertia() -> None:
    explanation = explain(scene())
    assert any("inertia" in note for note in explanation.notes)
    assert explanation.evaluation_times["inertia"] > 0.0


def test_weight_may_increase_the_speed_but_not_the_energy() -> None:
    """The sphere separates below the height of first contact: its restitution is 1.21."""
    speed, gravity = 3.938e-5, 0.015288
    outcome = simulate(read({
        "sphere": {"radius": 0.11199, "density": 830.06, "youngs_modulus": 1.095e14,
                   "poissons_ratio": 0.3},
        "plate": {"radius": 0.31961, "half_thickness": 6.5405e-3, "youngs_modulus": 5.6393e9,
                  "poissons_ratio": 0.3709, "density": 856.6, "edge": "simply-supported"},
        "impact": {"speed": speed, "gravity": gravity},
        "effects": {"inertia": True},
        "inertia": {"branches": "A0", "modes": 8},
    }))  # fmt: skip
    balance, dynamics = outcome.energy_balance, outcome.dynamics
    assert balance is not None
    assert dynamics is not None
    # The rebound speed follows from the impulses of the contact and of the weight.
    mass = 2.0 * balance.initial_kinetic / speed**2
    impulse = sum(touch.impulse for touch in dynamics.inertia.contacts)
    rebound = impulse / mass - speed - gravity * dynamics.inertia.total_time
    assert outcome.restitution == pytest.approx(rebound / speed, rel=1e-9)
    assert outcome.restitution > 1.2
    # At the height of first contact, the rebound speed would be below the impact speed.
    depth = balance.gravity_work / mass / gravity
    assert 0.0 < depth < 0.1 * outcome.max_indentation
    assert 0.9 < math.sqrt(rebound**2 - 2.0 * gravity * depth) / speed < 1.0
    assert abs(balance.residual) < 1e-9
