"""Tolerances that the number of modes cannot meet: how many runs show it, and the remedy."""

import pickle
import re
import tomllib
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from shared_scenes import EXAMPLES

from derivation.scene import Result, SceneError, read, simulate
from derivation.scene.dynamic import contact_sequence, refinement, stretched_shapes, waves
from derivation.scene.dynamic.contact_errors import too_many_steps
from derivation.scene.dynamic.contact_sequence import ImpactHistory
from derivation.scene.dynamic.integration_error import integration_error
from derivation.scene.dynamic.mode_convergence import nearly_meets, unchecked
from derivation.scene.dynamic.reach import Reach
from derivation.scene.dynamic.runs import Budget, time_tolerance
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.errors import ToleranceError
from derivation.scene.scene import OUTPUTS

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


THIN: dict[str, Any] = {
    "sphere": {"radius": 0.0024972, "material": "aluminium"},
    "plate": {
        "radius": 0.0049154, "thickness": 3.8893e-4, "youngs_modulus": 6.288e9,
        "poissons_ratio": 0.37465, "density": 1265.9, "edge": "clamped", "yield_stress": 2.4744e6,
    },
    "impact": {"speed": 0.24505},
    "accuracy": {"rtol": 7.87e-4, "outputs": ["max_force", "max_indentation"]},
}  # fmt: skip


def test_a_named_tolerance_is_met_with_all_branches_if_the_lowest_one_misses_it() -> None:
    """The tolerance is named for all branches; with it the lowest one seems to be sufficient."""
    with pytest.raises(SceneError, match="expected a tolerance that can be met") as error:
        simulate(read(THIN))
    named = float(str(error.value).partition("such as ")[2].split()[0])
    for rtol in (named, 1.1 * named):
        assert simulate(read(THIN), rtol=rtol).accuracy.bound <= rtol


def test_a_tolerance_is_met_that_the_errors_of_modes_and_time_elements_exceed_together(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """More modes are tried also if only the error of the time elements exceeds the tolerance."""
    scene: dict[str, Any] = {
        "sphere": {
            "radius": 0.001857, "mass": 2.35e-4, "youngs_modulus": 1.157e9, "poissons_ratio": 0.3,
        },
        "plate": {
            "radius": 0.006944, "thickness": 0.0013278, "youngs_modulus": 2.794e9,
            "poissons_ratio": 0.2625, "density": 7604.5, "edge": "simply-supported",
            "retardation_time": 1.0582e-5,
        },
        "impact": {"speed": 0.0689},
    }  # fmt: skip
    runs: list[DynamicImpact] = []
    once = refinement.compare

    def recorded(*args: Any) -> DynamicImpact:
        runs.append(once(*args))
        return runs[-1]

    monkeypatch.setattr(refinement, "compare", recorded)
    with pytest.raises(SceneError, match="expected a tolerance that can be met") as error:
        simulate(read(scene), rtol=3.2e-4)
    named = float(str(error.value).partition("such as ")[2].split()[0])
    errors = [run.inertia.error(OUTPUTS) for run in runs]
    just_above = [1.0001 * error for error in errors if error > named]
    assert just_above
    for rtol in just_above:
        assert simulate(read(scene), rtol=rtol).accuracy.bound <= rtol


@pytest.mark.parametrize("branches", [0.1, 0.5, 0.7, 0.9, 0.999])
def test_accepted_error_by_modes_meets_the_tolerance_with_all_other_errors(branches: float) -> None:
    need = 1e-3
    run = simulate(read(LEAD), rtol=0.01).dynamics
    assert run is not None
    inertia = replace(run.inertia, omitted_branch_error=(branches * need,) * 5)
    run, reach = replace(run, inertia=inertia), Reach(run.law, OUTPUTS, need)
    accepted = refinement.Refinement(run.law, need / 3.0, reach, Budget(0.0))._accepted_change(run)
    others = branches * need + integration_error(run.impact_history)
    assert accepted > 0.0
    assert accepted + others <= need * (1.0 + 1e-12)
    modes = inertia.left(OUTPUTS)[0]
    for part in (0.5, 1.5):  # of the error of the time elements
        room = modes + branches * need + part * integration_error(run.impact_history)
        assert nearly_meets(run, replace(reach, need=room)) == (part < 1.0)


JUMPING: dict[str, Any] = {
    "sphere": {
        "radius": 0.0017922, "mass": 4.4593e-6, "youngs_modulus": 157.59e9, "poissons_ratio": 0.3,
    },
    "plate": {
        "radius": 0.0069985, "thickness": 2.2664e-4, "youngs_modulus": 18.428e9,
        "poissons_ratio": 0.37909, "density": 6316.1, "edge": "clamped", "yield_stress": 10.643e6,
    },
    "impact": {"speed": 1.5611},
    "effects": {"stretching": False},
    "accuracy": {"rtol": 0.0206},
}  # fmt: skip


def test_a_contact_time_that_may_jump_is_rejected_with_the_error_of_the_other_results() -> None:
    """An earlier message recommended to remove it, which led to the rejection of the others."""
    with pytest.raises(SceneError, match="may split this contact") as error:
        simulate(read(JUMPING))
    stated = re.search(r"the error of the other results is up to (\S+)\)", str(error.value))
    assert stated
    others = {"accuracy": {"rtol": 0.0206, "outputs": list(OUTPUTS[1:])}}
    with pytest.raises(ToleranceError) as missed:
        simulate(read(JUMPING | others))
    assert 0.9 * float(stated[1]) < missed.value.error <= float(stated[1])
    alone = {"accuracy": {"rtol": 0.0206, "outputs": ["contact_time"]}}
    with pytest.raises(SceneError, match=r"or request other results in accuracy\.outputs$"):
        simulate(read(JUMPING | alone))


def test_a_tolerance_for_the_omitted_branches_alone_is_called_a_lower_limit() -> None:
    """This tolerance is rejected, because the waves from the edge require a larger one."""
    scene: dict[str, Any] = {
        "sphere": {
            "radius": 0.00242, "mass": 1.126, "youngs_modulus": 74.9e9, "poissons_ratio": 0.3,
        },
        "plate": {
            "radius": 0.0725, "thickness": 0.0092, "youngs_modulus": 1.646e9,
            "poissons_ratio": 0.276, "density": 5752.0, "edge": "clamped",
            "retardation_time": 1.363e-5,
        },
        "impact": {"speed": 0.802},
    }  # fmt: skip
    with pytest.raises(SceneError, match="this is a lower limit") as error:
        simulate(read(scene), rtol=2e-4)
    limit = float(str(error.value).partition("at least about ")[2].partition(",")[0])
    with pytest.raises(SceneError, match="a tolerance that can be met, such as"):
        simulate(read(scene), rtol=limit)


def computed_once(function: Callable[..., ImpactHistory]) -> Callable[..., ImpactHistory]:
    """Return a function that computes the result for equal arguments once.

    An impact is simulated with the same numbers of modes for several tolerances. Simulations that a
    function of the program may end early are not kept.
    """
    known: dict[bytes, ImpactHistory] = {}

    def result(*arguments: Any, **named: Any) -> ImpactHistory:
        if any(map(callable, (*arguments, *named.values()))):
            return function(*arguments, **named)
        key = pickle.dumps((arguments, named))
        if key not in known:
            known[key] = function(*arguments, **named)
        return known[key]

    return result


@pytest.mark.parametrize("outputs", [OUTPUTS, ("max_force",)])
def test_a_stretched_plate_meets_all_tolerances_above_a_named_one(
    outputs: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The error of the shapes that do not stretch is known after the last run only."""
    monkeypatch.setattr(stretched_shapes, "MORE", 16)
    monkeypatch.setattr(stretched_shapes, "MOST", 16)
    once = computed_once(contact_sequence.impact_history)
    monkeypatch.setattr(contact_sequence, "impact_history", once)
    tables = tomllib.loads((EXAMPLES / "glass_pane.toml").read_text())
    tables |= {"effects": {"stretching": True}, "impact": {"speed": 8.0}}
    waves.impact.cache_clear()

    def simulated(rtol: float) -> Result:
        return simulate(read(tables | {"accuracy": {"rtol": rtol, "outputs": list(outputs)}}))

    runs: list[DynamicImpact] = []
    compare = refinement.compare

    def recorded(*args: Any) -> DynamicImpact:
        runs.append(compare(*args))
        return runs[-1]

    monkeypatch.setattr(refinement, "compare", recorded)
    with pytest.raises(SceneError, match="expected a tolerance that can be met") as error:
        simulated(1e-4)
    named = float(str(error.value).partition("such as ")[2].split()[0])
    errors = [run.inertia.error(outputs) for run in runs]
    met = simulated(named)
    assert met.dynamics is not None
    by_shapes = max(met.dynamics.inertia.shape_error[OUTPUTS.index(name)] for name in outputs)
    assert 0.0 < by_shapes < met.accuracy.bound <= named
    for rtol in (1.6 * named, *(0.995 * (error + by_shapes) for error in errors)):
        assert rtol < named or simulated(rtol).accuracy.bound <= rtol
    waves.impact.cache_clear()


@pytest.mark.parametrize("factor", [1.0, 1.5, 2.0])
def test_omitted_effects_leave_a_part_of_the_tolerance_for_rounding(factor: float) -> None:
    """A tolerance above the named one was rejected, because effects were omitted with it."""
    scene = read(
        {
            "sphere": {"radius": 0.00181, "material": "steel"},
            "plate": {
                "radius": 6.04, "thickness": 0.1184, "youngs_modulus": 170.5e9,
                "poissons_ratio": 0.346, "density": 3917.0, "edge": "simply-supported",
                "retardation_time": 4.034e-6,
            },
            "impact": {"speed": 0.00332},
            "effects": {"inertia": False},
        }
    )  # fmt: skip
    with pytest.raises(SceneError, match="rtol: expected at least") as error:
        simulate(scene, rtol=7.6e-12)
    rtol = factor * float(str(error.value).partition("at least ")[2].split()[0])
    assert simulate(scene, rtol=rtol).accuracy.bound <= rtol


@pytest.mark.parametrize("stretching", [True, False])
def test_a_plate_that_stretches_is_not_recommended_to_have_no_inertia(stretching: bool) -> None:
    tables = tomllib.loads((EXAMPLES / "glass_pane.toml").read_text())
    run = simulate(read(tables | {"effects": {"stretching": stretching}})).dynamics
    assert run is not None
    history = run.impact_history
    remedies = (
        unchecked(history, history.problem, 4).remedy,
        too_many_steps(history.problem, 1.0, 10, 1e-9).remedy,
    )
    for remedy in remedies:
        assert ("effects.inertia = false" in str(remedy)) != stretching


@pytest.mark.parametrize(("rtol", "named"), [(None, False), (1e-2, False), (1e-6, True)])
def test_a_larger_tolerance_is_recommended_only_if_it_allows_longer_time_steps(
    rtol: float | None, named: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An earlier message recommended it for scenes without a tolerance."""
    run = simulate(read(tomllib.loads((EXAMPLES / "glass_pane.toml").read_text()))).dynamics
    assert run is not None
    monkeypatch.setattr(contact_sequence, "ELEMENTS", 4)
    with pytest.raises(SceneError, match="limit of 4 time steps") as error:
        contact_sequence.impact_history(
            run.impact_history.problem, 10, time_tolerance(waves.goal(rtol))
        )
    assert ("accuracy.rtol" in str(error.value)) == named
