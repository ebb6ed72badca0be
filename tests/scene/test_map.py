"""The map of a scene agrees with the effect selection, and so with `explain`."""

import math
from functools import cache
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shared_scenes
from shared_scenes import EXAMPLES

from derivation.cli import main
from derivation.scene import Scene, SceneError, read, simulate
from derivation.scene.impact import selected_effects
from derivation.scene.output import map as map_
from derivation.scene.result import Result
from derivation.scene.selection.effect_selection import SelectedEffects
from derivation.scene.selection.selection import select


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reduce the map to few points and that of the scene."""
    monkeypatch.setattr(map_, "THICKNESSES", np.geomspace(1e-3, 10.0, 5))
    monkeypatch.setattr(map_, "RADII", np.geomspace(1e-3, 6.0, 5))


@cache
def mapped(name: str) -> tuple[Result, map_.Grid]:
    """Return an example's result and its coarse map."""
    result = shared_scenes.result_of(EXAMPLES / f"{name}.toml")
    return result, map_.grid(result, result.effects.rtol)


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("name", sorted(path.stem for path in EXAMPLES.glob("*.toml")))
def test_marker_agrees_with_explain(name: str) -> None:
    result, actual = mapped(name)
    column = np.flatnonzero(actual.thicknesses == result.model.eta)
    row = np.flatnonzero(actual.radii == result.max_contact_radius / result.model.h)
    for effect in result.effects.rows:
        if effect.name not in actual.ratios:
            continue
        ratio = actual.ratios[effect.name][row, column].item()
        if effect.disabled:
            assert ratio == pytest.approx(min(effect.bound / result.effects.rtol, map_.MOST))
        else:
            assert (ratio > 1.0) == (effect.name in _needed(result.effects)), effect.name
        if not effect.included and effect.bound < result.effects.rtol:
            assert ratio == pytest.approx(effect.bound / result.effects.rtol, rel=2e-3)


@pytest.mark.one_version
@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("name", ["glass_pane", "pad", "ball_drop"])
def test_selection_at_each_point_agrees_with_the_map(name: str) -> None:
    """The effects at all points are selected together; the ratios are those of single selections.

    The points are simulated singly only if rounding could decide.
    """
    result, actual = mapped(name)
    wanted, rtol = result.scene.effects.model_dump(), result.effects.rtol
    _, _, known, points = map_._points(result)
    places = np.argwhere(known)
    assert len(places) > 12
    for row, place in enumerate(map(tuple, places.tolist())):
        selection = select(points.take(row), wanted, rtol, result.effects.outputs)
        for effect, ratio in actual.ratios.items():
            needed, size = effect in selection.needed, selection.sizes.get(effect, math.inf)
            assert ratio[place] == map_._ratio(size, rtol, selection.choice[effect], needed)
            assert (ratio[place] > 1.0) == needed or selection.choice[effect] is False


def test_points_have_the_speeds_of_their_contact_radii() -> None:
    result = simulate(shared_scenes.scene())
    for width, eta in ((0.01, 0.02), (0.3, 0.1)):
        model = map_.replace(result.model, h=eta * result.model.b)
        speed = float(map_._speed(model, np.array([width * model.h])).item())
        law = map_._law(map_.replace(model, v0=speed))
        assert map_.largest_radius(law) == pytest.approx(width * model.h, rel=1e-9)
    assert np.isnan(map_._speed(result.model, np.array([2.0 * result.model.b]))).all()


def test_unknown_change_by_an_effect_is_large() -> None:
    """An effect whose bound is not a number left a hole in the map."""
    unknown = np.array([math.nan, math.inf])
    assert map_._ratio(unknown, 1e-3, "auto", needed=True).tolist() == [map_.MOST] * 2


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("name", ["glass_pane", "block", "paper", "impact_echo"])
def test_explain_agrees_on_both_sides_of_each_line(name: str) -> None:
    """For the points next to each line, the selection of `explain` agrees with the map."""
    result, actual = mapped(name)
    names = [row.name for row in result.effects.rows if row.name in actual.ratios]
    auto = [x for x in names if getattr(result.scene.effects, x) == "auto"]
    included = np.array([actual.ratios[x] > 1.0 for x in auto])
    known = np.isfinite(actual.ratios[auto[0]])
    compared = 0
    for row, column in np.argwhere(known[:-1] & known[1:]):
        if (included[:, row, column] != included[:, row + 1, column]).any():
            for index in ((row, column), (row + 1, column)):
                point_scene = _scene_at(result, actual, *index)
                _, selection = selected_effects(point_scene, result.accuracy.rtol)
                shown = [x for k, x in enumerate(auto) if included[(k, *index)]]
                assert [x for x in _needed(selection) if x in auto] == shown, index
                compared += 1
    assert compared >= 2


def _needed(selection: SelectedEffects) -> list[str]:
    """Return the effects that are included for the tolerance, not because this takes no longer."""
    rows = (row for row in selection.rows if row.included)
    return [row.name for row in rows if not row.reason.startswith("not needed")]


def _scene_at(result: Result, actual: map_.Grid, row: int, column: int) -> Scene:
    """Return the scene of a point of the map, with its thickness and speed."""
    data, model = result.scene.to_json(), result.model
    eta, width = float(actual.thicknesses[column]), float(actual.radii[row])
    speed, plate = model.v0, map_.replace(model, h=eta * model.b)
    if (eta, width) != (model.eta, result.max_contact_radius / model.h):
        stretch = map_.largest_radius(map_._law(model)) / result.max_contact_radius
        speed = map_._speed(plate, np.array([stretch * width * plate.h])).item()
    thin = {k: x for k, x in data["plate"].items() if k not in {"thickness", "half_thickness"}}
    return read(
        data
        | {"plate": thin | {"half_thickness": plate.h}}
        | {"impact": data["impact"] | {"speed": speed}}
    )


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("name", ["glass_pane", "block"])
def test_ticks_point_to_the_side_where_the_effect_matters(name: str) -> None:
    """Ticks are on the left of a line, where the ratio of the effect is above 1."""
    result, actual = mapped(name)
    made = map_.figure(result, result.effects.rtol)
    ticked = [x for x in made.axes[0].collections if x.get_path_effects()]
    assert ticked
    drawn = [r for r in map_.lines(actual).values() if np.nanmin(r) < 1.0 < np.nanmax(r)]
    to_screen = made.axes[0].transData
    for line, ratio in zip(ticked, drawn, strict=True):
        points = np.stack(np.meshgrid(actual.thicknesses, actual.radii), axis=-1)[ratio > 1.0]
        side = to_screen.transform(points)
        votes = 0.0
        for path in line.get_paths():
            for begin, end in pairwise(to_screen.transform(path.vertices)):
                left = np.array([begin[1] - end[1], end[0] - begin[0]])
                middle = 0.5 * (begin + end)
                nearest = side[np.argmin(np.hypot(*(side - middle).T))] - middle
                votes += np.sign(left @ nearest)
        assert votes > 0.0


@pytest.mark.usefixtures("coarse")
def test_map_marks_the_scene(tmp_path: Path) -> None:
    example = EXAMPLES / "ball_drop.toml"
    assert main(["map", str(example), "--plot", f"{tmp_path}/m.svg"]) == 0
    drawn = (tmp_path / "m.svg").read_text()
    for name in ("spherical_profile", "bending", "edge", "non_hertzian_pressure", "this scene"):
        assert name in drawn
    assert main(["map", str(example), "--plot", f"{tmp_path}/m.txt"]) == 2


@pytest.mark.usefixtures("coarse")
def test_marker_is_at_the_contact_of_the_scene() -> None:
    result = simulate(shared_scenes.scene())
    [star] = [x for x in map_.figure(result, 1e-3).axes[0].lines if x.get_marker() == "*"]
    point = 0.02 / 0.5, result.max_contact_radius / 0.02
    assert np.ravel(star.get_data()) == pytest.approx(point, rel=1e-12)


@pytest.mark.usefixtures("coarse")
def test_map_lists_effects_that_matter_everywhere_or_nowhere() -> None:
    result = simulate(shared_scenes.scene())
    (legend,) = map_.figure(result, 1e-300).legends
    legend_texts = [text.get_text() for text in legend.get_texts()]
    assert any(text.startswith("everywhere: ") for text in legend_texts), legend_texts
    assert not any(text.startswith("nowhere: ") for text in legend_texts), legend_texts


def test_legend_of_a_map_has_one_line_for_effects_that_matter_everywhere(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Those that are unknown at other points had another line."""
    result, unknown = simulate(shared_scenes.scene()), np.array([[np.nan, 2.0], [2.0, 2.0]])
    ratios = {"edge": unknown, "bending": np.full((2, 2), 2.0)}
    axis, nowhere = np.array([0.01, 1.0]), np.zeros((2, 2), dtype=bool)
    monkeypatch.setattr(map_, "grid", lambda *_: map_.Grid(axis, axis, ratios, nowhere))
    (legend,) = map_.figure(result, 1e-3).legends
    texts = [text.get_text() for text in legend.get_texts()]
    assert [text for text in texts if "everywhere" in text] == ["everywhere: edge, bending"]


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("name", ["pad", "ball_drop"])
def test_legend_is_within_the_picture(name: str) -> None:
    """In the map of the pad all nine effects matter everywhere."""
    result, _ = mapped(name)
    made = map_.figure(result, result.effects.rtol)
    made.draw_without_rendering()
    (legend,) = made.legends
    extent = legend.get_window_extent()
    assert made.bbox.xmin <= extent.xmin
    assert extent.xmax <= made.bbox.xmax


@pytest.mark.usefixtures("coarse")
def test_map_shows_where_a_scene_without_density_is_rejected() -> None:
    """The map was rejected although the scene is not, because inertia matters at other points."""
    tables = {
        "sphere": {"radius": 1e-3, "material": "steel"},
        "plate": {"radius": 20, "thickness": 20, "youngs_modulus": 7e10, "poissons_ratio": 0.3},
        "impact": {"speed": 0.01},
    }
    result = simulate(read(tables), rtol=0.1)
    actual = map_.grid(result, 0.1)
    place = np.argwhere(actual.rejected)[0]
    with pytest.raises(SceneError, match=r"plate\.density: expected a density") as raised:
        selected_effects(_scene_at(result, actual, *place.tolist()), 0.1)
    assert str(raised.value) == actual.reason
    assert all(np.isnan(ratio[actual.rejected]).all() for ratio in actual.ratios.values())
    (legend,) = map_.figure(result, 0.1).legends
    texts = [text.get_text() for text in legend.get_texts()]
    assert any(text.startswith("rejected, for example because plate.density") for text in texts)
    assert not mapped("block")[1].rejected.any()


@pytest.mark.usefixtures("coarse")
def test_points_outside_the_range_have_lines_unlike_any_shading() -> None:
    """Their grey was almost that of the shading of two effects."""
    made = map_.figure(mapped("block")[0], 1e-3)
    (legend,) = made.legends
    [outside] = [x for x in legend.get_patches() if x.get_hatch()]
    assert made.axes[0].patch.get_hatch() == outside.get_hatch()
