"""Tolerances that the number of modes cannot meet: how many runs show it, and the remedy."""

import tomllib
from typing import Any

import pytest
from shared_scenes import EXAMPLES

from derivation.scene import SceneError, read, simulate
from derivation.scene.dynamic import refinement, waves
from derivation.scene.dynamic.wave_motion import DynamicImpact

pytestmark = pytest.mark.one_version

COMPOSITE: dict[str, Any] = {
    "sphere": {"radius": 0.0026, "material": "glass"},
    "plate": {
        "radius": 0.15, "thickness": 0.0084, "youngs_modulus": 50e9, "poissons_ratio": 0.3,
        "density": 1600.0, "loss_factor": 0.11, "yield_stress": 320e6,
    },
    "impact": {"speed": 0.9},
    "inertia": {"extent": "infinite"},
}  # fmt: skip
LEAD: dict[str, Any] = {
    "sphere": {"radius": 0.0057, "material": "steel"},
    "plate": {
        "radius": 0.038, "thickness": 0.003, "youngs_modulus": 16e9, "poissons_ratio": 0.44,
        "density": 11340.0,
    },
    "impact": {"speed": 0.24, "gravity": 9.81},
}  # fmt: skip


@pytest.mark.parametrize("scene", [COMPOSITE, LEAD])
def test_a_tolerance_that_cannot_be_met_is_rejected_with_one_that_can(
    scene: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The runs end before the limits of modes; another tolerance changes the omitted effects."""
    works: list[float] = []
    once = refinement.run_with

    def counted(*args: Any, **kwargs: Any) -> DynamicImpact:
        found = once(*args, **kwargs)
        works.append(found.impact_history.work)
        return found

    monkeypatch.setattr(refinement, "run_with", counted)
    with pytest.raises(SceneError, match="expected a tolerance that can be met, such as") as error:
        simulate(read(scene), rtol=1e-4)
    spent = sum(works)
    assert spent < 0.1 * waves.WORK
    works.clear()
    named = float(str(error.value).partition("such as ")[2].split()[0])
    assert simulate(read(scene), rtol=named).accuracy.bound <= named < 1e-3
    assert sum(works) <= spent


@pytest.mark.parametrize(("rtol", "runs"), [(3e-4, 3), (1e-4, 3), (5e-5, 2)])
def test_one_run_beyond_the_limits_is_made_if_the_tolerance_is_near(
    rtol: float, runs: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """If the error is below 5 times the tolerance, one more run meets it, or it is rejected."""
    scene = read(tomllib.loads((EXAMPLES / "glass_pane.toml").read_text()))
    monkeypatch.setattr("derivation.scene.dynamic.mode_count.WORK", 0.0)
    waves.impact.cache_clear()
    counts: list[int] = []
    once = refinement.run_with

    def counted(law: Any, count: int, *args: Any, **kwargs: Any) -> Any:
        counts.append(count)
        return once(law, count, *args, **kwargs)

    monkeypatch.setattr(refinement, "run_with", counted)
    if rtol == 3e-4:
        assert simulate(scene, rtol=rtol).accuracy.bound <= rtol
    else:
        with pytest.raises(SceneError, match="expected a tolerance that can be met, such as"):
            simulate(scene, rtol=rtol)
    assert len(counts) == runs
    waves.impact.cache_clear()


def test_more_modes_are_tried_if_the_first_contact_may_split() -> None:
    """An earlier message recommended a smaller tolerance, which was rejected with the first one."""
    scene: dict[str, Any] = {
        "sphere": {
            "radius": 0.0199, "density": 991.0, "youngs_modulus": 9.81e9, "poissons_ratio": 0.45,
            "retardation_time": 6.644e-4,
        },
        "plate": {
            "radius": 0.1747, "thickness": 0.0378, "youngs_modulus": 8.65e10,
            "poissons_ratio": 0.0, "density": 3160.0, "retardation_time": 7.897e-6,
        },
        "impact": {"speed": 0.24},
        "accuracy": {"rtol": 0.036},
    }  # fmt: skip
    few = {"inertia": {"modes": 13}}
    with pytest.raises(SceneError, match=r"may split .*; try more inertia\.modes, or remove"):
        simulate(read(scene | few))
    with pytest.raises(SceneError, match="rtol: expected at least about"):
        simulate(read(scene | few | {"accuracy": {"rtol": 0.018}}))
    assert simulate(read(scene | {"inertia": {"modes": 100}})).accuracy.bound < 0.036
    assert simulate(read(scene)).accuracy.bound < 0.036
