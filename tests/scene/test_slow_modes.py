"""Impacts that last too long for modes as fast as the contact are simulated with slower ones."""

import math
from typing import Any

import numpy as np
import pytest

from derivation.engine.threads import one_thread
from derivation.scene import SceneError, explain, read, simulate
from derivation.scene.dynamic import slow_modes, waves
from derivation.scene.dynamic.mode_count import FEWEST, fast
from derivation.scene.dynamic.runs import WORK, Budget
from derivation.scene.dynamic.slow_modes import slow_impact
from derivation.scene.impact import selected_effects
from derivation.scene.input.materials import engineering_constants
from derivation.scene.quantity import ONE_DIGIT, rounded_up
from derivation.scene.result import Result
from derivation.scene.scene import OUTPUTS

pytestmark = pytest.mark.one_version

Tables = dict[str, Any]
SHEET: Tables = {
    "sphere": {"radius": 0.02, "material": "steel"},
    "plate": {"radius": 0.1, "thickness": 1e-3, "material": "aluminium", "edge": "clamped"},
    "impact": {"speed": 2.0},
}
"""A steel ball falls on a clamped sheet, whose first mode has a 17th of its mass."""
FASTER: dict[str, tuple[int, Tables]] = {
    "elastic": (
        13,
        {
            "sphere": {"radius": 0.0194, "material": "steel"},
            "plate": {
                "radius": 0.233, "thickness": 4.75e-3, "material": "glass", "edge": "clamped",
                "loss_factor": 0.01,
            },
            "impact": {"speed": 1.24},
        },
    ),
    "viscoelastic": (
        20,
        {
            "sphere": {"radius": 0.0253, "material": "aluminium", "retardation_time": 1.7e-7},
            "plate": {
                "radius": 0.323, "thickness": 2.56e-3, "material": "aluminium", "edge": "clamped",
                "loss_factor": 0.1,
            },
            "impact": {"speed": 0.298},
        },
    ),
    "plastic, stretched": (
        20,
        {
            "sphere": {"radius": 7.03e-3, "material": "aluminium"},
            "plate": {
                "radius": 0.0604, "thickness": 5.32e-4, "material": "steel", "yield_stress": 4.68e8
            },
            "impact": {"speed": 0.237},
            "effects": {"stretching": True},
        },
    ),
}  # fmt: skip
"""Numbers of slow modes, and impacts that can also be simulated with fast ones."""


@pytest.fixture(scope="module")
def result() -> Result:
    """Return the impact on the sheet."""
    return simulate(read(SHEET))


@pytest.mark.parametrize("case", FASTER)
def test_errors_cover_an_impact_with_fast_modes(case: str) -> None:
    """The results of few slow modes differ from those of fast ones by less than stated."""
    count, tables = FASTER[case]
    law = selected_effects(read(tables))[1].law
    assert not fast(law, count)
    with one_thread(), np.errstate(all="ignore"):
        accurate = waves.impact(law, 1e-4)
        slow = slow_impact(law, count, 1e-4, Budget(WORK))
    assert slow.inertia.slow
    assert not accurate.inertia.slow
    changes = []
    for name in OUTPUTS:
        value, other = (float(getattr(run, name)) for run in (slow, accurate))
        allowed = slow.inertia.error((name,)) + accurate.inertia.error((name,))
        changes.append(abs(value - other) / abs(value))
        assert changes[-1] <= allowed, name
    assert slow.inertia.error(("max_indentation",)) < 1.0  # it has a digit
    assert max(changes) > 1e-3  # the modes differ enough for this comparison


def test_heavy_ball_on_a_sheet_has_usable_results(result: Result) -> None:
    """All results but the contact time have a digit, and the summary says which one has none."""
    assert result.dynamics is not None
    assert result.dynamics.inertia.slow
    assert result.bound_of("contact_time") > 1.0
    assert result.bound_of("restitution") < 0.1
    assert result.bound_of("max_force") < 0.3
    text = " ".join(str(result).split())
    assert "contact time (first of 2) unknown" in text
    assert "Unknown: contact time: omitted effects or modes may change it" in text
    assert "error of max indentation, max force, max contact radius, restitution at most" in text


def test_results_with_one_digit_are_stated_apart_from_more_accurate_ones() -> None:
    """With 40 modes, contact time and force have one digit, other results have more."""
    tables = FASTER["plastic, stretched"][1] | {"inertia": {"modes": 40, "branches": "A0"}}
    result = simulate(read(tables))
    rough = ("contact_time", "max_force")
    for name in OUTPUTS:
        assert (result.bound_of(name) >= ONE_DIGIT) == (name in rough), name
        assert result.digits_of_result(name) == 1 or name not in rough, name
    assert result.accuracy.bound == max(map(result.bound_of, OUTPUTS))
    text = " ".join(str(result).split())
    assert "relative error of max indentation, max contact radius, restitution at most" in text
    for name in rough:
        assert f", of {name.replace('_', ' ')} {rounded_up(result.bound_of(name))}" in text


def test_heavy_ball_deflects_the_sheet_as_a_static_load_of_equal_work(result: Result) -> None:
    """Nearly all energy is in the stretched sheet when the ball stops.

    Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, table 82, a clamped plate with
    an immovable edge and a central load: w/H + 0.443 (w/H)^3 = 0.217 P b^2/(E H^4), one term of a
    series, for nu = 0.3.
    """
    model = result.model
    young, _ = engineering_constants(model.lam, model.mu)
    H, energy = 2.0 * model.h, 0.5 * model.m * model.v0**2
    unit = young * H**5 / (0.217 * model.b**2)
    square = (math.sqrt(1.0 + 4.0 * 0.443 * energy / unit) - 1.0) / 0.443
    assert result.max_indentation == pytest.approx(H * math.sqrt(square), rel=0.07)


def test_explanation_names_the_number_of_modes(result: Result) -> None:
    """The number of modes in `explain` is that of the simulation."""
    assert result.dynamics is not None
    modes = f"{result.dynamics.inertia.modes} bending modes, because the impact lasts too long"
    assert modes in " ".join(explain(read(SHEET)).notes)


def test_named_tolerance_is_met_without_the_contact_time() -> None:
    """The contact time cannot meet a tolerance; the message names one for the other results."""
    with pytest.raises(SceneError, match=r"contact_time, .*; remove contact_time from accuracy"):
        simulate(read(SHEET), rtol=0.2)
    outputs = {"outputs": ["max_indentation", "restitution"]}
    with pytest.raises(SceneError, match="tolerance that can be met, such as") as info:
        simulate(read(SHEET | {"accuracy": outputs | {"rtol": 1e-3}}))
    named = float(str(info.value).split("such as ")[1].split()[0])
    assert named < 0.3
    simulate(read(SHEET | {"accuracy": outputs | {"rtol": named}}))


def test_impacts_longer_than_expected_have_fewer_modes(monkeypatch: pytest.MonkeyPatch) -> None:
    """If even the expected number of modes takes too long, fewer are used."""
    count, tables = 30, FASTER["elastic"][1]
    law = selected_effects(read(tables))[1].law
    monkeypatch.setattr(slow_modes, "LONGEST", 1e5)
    with one_thread(), np.errstate(all="ignore"):
        run = slow_impact(law, count, 1e-4, Budget(WORK))
    assert run.inertia.complete
    assert FEWEST <= run.inertia.modes < count
    assert math.isfinite(run.inertia.error(("restitution",)))
