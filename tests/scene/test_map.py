"""The map of a scene draws what the effect selection decides, and so what `explain` says."""

import math
from pathlib import Path

import given
import numpy as np
import pytest
from given import EXAMPLES

from derivation.cli import main
from derivation.scene import load, simulate
from derivation.scene import map as map_
from derivation.scene.effect_selection import select


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """A map of few points beside the scene's own."""
    monkeypatch.setattr(map_, "THICKNESSES", np.geomspace(1e-3, 10.0, 5))
    monkeypatch.setattr(map_, "RADII", np.geomspace(1e-3, 6.0, 5))


@pytest.mark.usefixtures("coarse")
@pytest.mark.parametrize("example", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_the_star_is_on_the_side_that_explain_says(example: Path) -> None:
    result = simulate(load(example))
    found = map_.grid(result, result.effects.rtol)
    column = np.flatnonzero(found.thicknesses == result.model.eta)
    row = np.flatnonzero(found.radii == result.max_contact_radius / result.model.h)
    for effect in result.effects.rows:
        if effect.name not in found.ratios:
            continue
        ratio = found.ratios[effect.name][row, column].item()
        if effect.disabled:
            assert ratio == pytest.approx(min(effect.bound / result.effects.rtol, map_.MOST))
        else:
            assert (ratio > 1.0) == effect.included, effect.name
        if not effect.included and effect.bound < result.effects.rtol:
            assert ratio == pytest.approx(effect.bound / result.effects.rtol, rel=2e-3)


def test_every_point_of_the_map_is_a_scene_of_its_own() -> None:
    """At the speed that a point stands for the selection decides as the map shows."""
    result = simulate(given.scene())
    wanted, outputs = result.scene.effects.model_dump(), result.effects.outputs
    for width, eta in ((0.01, 0.02), (0.3, 0.1)):
        model = map_.replace(result.model, h=eta * result.model.b)
        speed = map_._speed(model, width * model.h)
        law = map_._law(map_.replace(model, v0=speed))
        assert map_.largest_radius(law) == pytest.approx(width * model.h, rel=1e-9)
        found = select(map_.replace(model, v0=speed), wanted, 1e-3, outputs)
        for name in map_.drawn(result):
            included = name in found.included
            assert (map_._ratio(found, name, 1e-3) > 1.0) == included
    assert math.isnan(map_._speed(result.model, 2.0 * result.model.b))


@pytest.mark.usefixtures("coarse")
def test_the_map_marks_the_scene(tmp_path: Path) -> None:
    example = EXAMPLES / "ball_drop.toml"
    assert main(["map", str(example), "--plot", f"{tmp_path}/m.svg"]) == 0
    drawn = (tmp_path / "m.svg").read_text()
    for name in ("spherical_profile", "bending", "edge", "non_hertzian_pressure", "the scene"):
        assert name in drawn
    assert main(["map", str(example), "--plot", f"{tmp_path}/m.txt"]) == 2


@pytest.mark.usefixtures("coarse")
def test_the_star_on_the_map_is_the_scenes_contact() -> None:
    result = simulate(given.scene())
    [star] = [x for x in map_.figure(result, 1e-3).axes[0].lines if x.get_marker() == "*"]
    place = 0.02 / 0.5, result.max_contact_radius / 0.02
    assert np.ravel(star.get_data()) == pytest.approx(place, rel=1e-12)


@pytest.mark.usefixtures("coarse")
def test_a_map_says_what_counts_everywhere_or_nowhere() -> None:
    result = simulate(given.scene())
    (legend,) = map_.figure(result, 1e-300).legends
    told = [text.get_text() for text in legend.get_texts()]
    assert any(text.endswith(": everywhere") for text in told), told
    assert not any(text.endswith(": nowhere") for text in told), told
