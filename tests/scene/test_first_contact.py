"""Bounds on the duration of the first contact, which omitted effects or modes may split."""

import math
from dataclasses import replace

import pytest

from derivation.scene import SceneError, read, simulate
from derivation.scene.dynamic.contact_warnings import model_jump_warnings
from derivation.scene.dynamic.first_contact import jump_since
from derivation.scene.impact import selected_effects
from derivation.scene.result import Result
from derivation.scene.selection.effect_selection import SelectedEffects
from derivation.scene.selection.method_selection import dynamic_impact, solve_selected

pytestmark = pytest.mark.one_version


@pytest.fixture(scope="module")
def selected() -> SelectedEffects:
    """Return the effects of an impact with several contacts."""
    scene = read({
        "sphere": {"radius": 0.01, "mass": 0.0002},
        "plate": {"radius": 0.05, "thickness": 5e-4, "material": "aluminium", "edge": "clamped"},
        "impact": {"speed": 2.2},
        "accuracy": {"rtol": 0.5},
    })  # fmt: skip
    return selected_effects(scene)[1]


def test_decisive_change_joins_or_splits_the_first_contact(selected: SelectedEffects) -> None:
    result = dynamic_impact(selected, 0.5)
    first, second = result.inertia.contacts[:2]
    gap = (second.start - first.end) / (first.end - first.start)
    assert 0.0 < result.decisive_change <= min(gap, 1.0)


@pytest.mark.parametrize(("factor", "bounded"), [(0.3, True), (3.0, False)])
def test_no_bound_where_the_first_contact_may_jump(
    selected: SelectedEffects, factor: float, bounded: bool
) -> None:
    change = factor * dynamic_impact(selected, 0.5).decisive_change
    inaccurate = replace(selected, error=change)
    accuracy = solve_selected(inaccurate, 0.5, within=False)[1]
    assert math.isfinite(accuracy.bound) is bounded
    others = replace(inaccurate, outputs=("max_force",))
    assert math.isfinite(solve_selected(others, 0.5, within=False)[1].bound)
    if not bounded:
        with pytest.raises(SceneError, match=r"remove contact_time from accuracy\.outputs"):
            solve_selected(inaccurate, 0.5)


def test_bound_includes_a_jump_by_more_modes() -> None:
    """With more modes the first contact splits, although the results have nearly converged."""
    scene = {
        "sphere": {"radius": 0.009215, "density": 12740.0},
        "plate": {
            "radius": 0.1748, "half_thickness": 0.001518, "youngs_modulus": 4.096e6,
            "poissons_ratio": -0.1655, "density": 16203.0, "edge": "clamped",
            "retardation_time": 0.006241,
        },
        "impact": {"speed": 4.4765e-4},
        "effects": {"inertia": True, "viscosity": True, "non_hertzian_pressure": False},
    }  # fmt: skip
    result, finer = (
        simulate(read({**scene, "inertia": {"branches": "A0", "modes": modes}}))
        for modes in (96, 384)
    )
    assert result.dynamics is not None
    without_jump = math.fsum(result.dynamics.inertia.left(("contact_time",)))
    change = abs(result.contact_time / finer.contact_time - 1.0)
    assert without_jump < change < result.accuracy.law.bound


def nearly_split(speed: float, rtol: float | None = None, **inertia: object) -> Result:
    """Return an impact whose first contact nearly splits at about 0.021157 m/s."""
    scene = read({
        "sphere": {"radius": 0.005175, "mass": 0.0042216},
        "plate": {
            "radius": 0.044737, "thickness": 8.8029e-4, "youngs_modulus": 5.124e9,
            "poissons_ratio": 0.315, "density": 5800.0,
        },
        "impact": {"speed": speed},
        "effects": {"inertia": True},
        "inertia": inertia,
    })  # fmt: skip
    return simulate(scene, rtol=rtol)


def test_bound_of_an_elastic_contact_includes_a_jump_by_higher_branches() -> None:
    """Near the speed at which the first contact splits, the higher branches decide whether it does.

    The first contact is split with the lowest branch, and joined with all branches.
    """
    slow, fast = 0.02115, 0.02117
    while (
        fast / slow - 1.0 > 1e-6
    ):  # find the speed above which the lowest branch splits the contact
        middle = math.sqrt(slow * fast)
        split = nearly_split(middle, branches="A0", modes=48).contact_time < 6.5e-4
        slow, fast = (slow, middle) if split else (middle, fast)
    fast *= 1.00005  # so that there is a gap after the first contact, which the branches close
    result = nearly_split(fast, branches="A0", modes=48)
    every = nearly_split(fast, branches="all", modes=48)
    assert result.dynamics is not None
    without_jump = math.fsum(result.dynamics.inertia.left(("contact_time",)))
    change = every.contact_time / result.contact_time - 1.0
    assert without_jump < 0.01 < 0.3 < change < result.bound_of("contact_time")
    assert any("contact_time may change by" in text for text in result.warnings)
    assert any("model error of the force" in text for text in result.warnings)
    assert jump_since(result.dynamics) > 0.3  # due to the omitted branches alone
    # Two per cent from this speed the first contact does not jump, and its bound is small.
    for speed in (0.0207, 0.0216):
        assert nearly_split(speed, branches="A0", modes=48).bound_of("contact_time") < 1e-3


@pytest.mark.parametrize("speed", [0.02112, 0.02116, 0.0212])
def test_tolerance_is_met_close_to_the_jump_of_the_duration(speed: float) -> None:
    """Close to the jump, more modes or all branches are included until the duration is certain."""
    result = nearly_split(speed, rtol=1e-2)
    exact = nearly_split(speed, branches="all", modes=140)
    assert abs(exact.contact_time / result.contact_time - 1.0) < result.bound_of("contact_time")
    assert result.bound_of("contact_time") < 1e-2


@pytest.mark.parametrize("speed", [0.02112, 0.0212])
def test_bound_of_an_elastic_contact_includes_a_jump_by_more_modes_alone(speed: float) -> None:
    """A little further from the jump, the higher branches cannot cause it, but more modes can."""
    result = nearly_split(speed, branches="A0", modes=48)
    assert result.dynamics is not None
    assert jump_since(result.dynamics) == 0.0
    assert result.bound_of("contact_time") > result.dynamics.inertia.jump > 0.3


def test_oscillating_onset_of_a_viscoelastic_contact_is_no_jump() -> None:
    """Omitted modes cause oscillations of the force in the first thousandth of the contact."""
    times = {"retardation_time": 1.598e-5}
    plate = {"radius": 0.0318, "thickness": 8.97e-4, "material": "Gorilla Glass 3"}
    result = simulate(read({
        "sphere": {"radius": 0.01585, "mass": 0.13, "material": "steel"} | times,
        "plate": plate | times | {"edge": "clamped", "loss_factor": 0.02},
        "impact": {"speed": 1.02},
        "effects": {"stretching": False},  # which multiplies the run time
    }))  # fmt: skip
    assert result.bound_of("contact_time") < 0.1


@pytest.mark.parametrize(
    ("decisive_change", "error", "warned"), [(0.01, 0.02, 1), (0.02, 0.01, 0), (1.0, 2.0, 0)]
)
def test_a_model_error_may_split_a_contact_only_if_it_exceeds_the_decisive_change(
    decisive_change: float, error: float, warned: int
) -> None:
    """A decisive change of 1 means that no change splits or joins the contact."""
    assert len(model_jump_warnings(decisive_change, error)) == warned
