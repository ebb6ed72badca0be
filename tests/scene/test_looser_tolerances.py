"""Run time of a simulation: a looser tolerance needs no slower functions and no more steps."""

from collections import Counter
from typing import Any

import numpy as np
import platecontact as pc
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from derivation.engine.files import ROOT
from derivation.scene import explain, kernels, read, simulate
from derivation.scene.effects import BY_NAME, WHOLE_PLATE
from derivation.scene.effects.effect import PlateEffect
from derivation.scene.impact import selected_effects
from derivation.scene.quasi_static import motion
from derivation.scene.rows.rows import solve
from derivation.scene.scene import Scene
from derivation.scene.selection import omission_bounds

TOLERANCES = [10.0**-n for n in range(1, 14)]
EXAMPLE = ROOT / "derivation" / "scene" / "examples" / "paper.toml"
NEWTON_STEPS = 12
"""Most steps of Newton's iteration for one largest radius; the limit of the loop is 60."""


@st.composite
def scenes(draw: st.DrawFn, disabled: tuple[str, ...] = ()) -> Scene:
    """Return impacts on quasi-static plates, with or without each effect that has a condition."""
    effects: dict[str, Any] = {"inertia": False, "non_hertzian_pressure": False}
    for name in (*disabled, "sphere_elasticity", "spherical_profile"):
        effects[name] = draw(st.sampled_from(["auto", False]))
    return read({
        "sphere": {"radius": 10.0 ** draw(st.floats(-2.5, -1.5)), "material": "steel"},
        "plate": {
            "radius": 0.3,
            "thickness": 10.0 ** draw(st.floats(-2.2, -0.3)),
            "material": "glass",
            "edge": draw(st.sampled_from(["paper", "simply-supported", "clamped"])),
        },
        "impact": {
            "speed": 10.0 ** draw(st.floats(-2.0, -0.3)),
            "gravity": draw(st.sampled_from([0.0, 9.81])),
        },
        "effects": effects,
    })  # fmt: skip


@pytest.mark.one_version
@given(scenes(), st.sampled_from(TOLERANCES))
@settings(max_examples=40)
def test_law_is_not_a_difference_of_the_whole_plate_and_a_part(scene: Scene, shown: float) -> None:
    """A part of the plate is not subtracted from the whole plate, which would be slower."""
    included = [frozenset[str]()]
    for rtol in TOLERANCES:
        actual = selected_effects(scene, rtol)[1]
        differs = any(isinstance(e, PlateEffect) and e.difference for e in actual.law.chosen)
        assert not differs or actual.law.effects >= WHOLE_PLATE
        assert actual.law.effects >= included[-1]
        included.append(actual.law.effects)
        if rtol == shown:  # `repr` also compares values that are NaN
            assert repr(explain(scene, rtol).effects) == repr(actual)
        for row in actual.rows:
            if row.reason.startswith("required by"):
                other = row.reason.removeprefix("required by ")
                assert row.included
                assert other in actual.included
                assert row.name in BY_NAME[other].contains
            assert row.included == (row.name in actual.law.effects)


@pytest.mark.parametrize("rtol", TOLERANCES)
def test_paper_s_law_is_not_selected_in_parts(rtol: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its function takes no longer than the selection, which needs the largest contact radius."""
    scene = pc.load(EXAMPLE)
    selected, alone = selected_effects(scene, rtol)[1], simulate(scene, rtol=rtol)
    assert selected.law.of_paper
    needed = not any(row.reason.startswith("not needed") for row in selected.rows)
    assert needed == (rtol <= 1e-2)

    def too_slow(*_: Any, **__: Any) -> Any:
        raise AssertionError("the largest radius is not needed")

    monkeypatch.setattr(omission_bounds, "largest_radii", too_slow)
    speeds = scene.impact.speed * np.geomspace(0.1, 1.0, 5)
    actual = solve(scene, {"impact.speed": speeds}, rtol)
    assert (actual.status == "finished").all()
    assert (actual.bound <= rtol).all()
    assert actual.results["contact_time"][-1] == alone.contact_time


def test_disabled_part_of_the_plate_stays_disabled() -> None:
    tables: dict[str, Any] = {
        "sphere": {"radius": 0.01, "material": "steel"},
        "plate": {"radius": 0.3, "thickness": 0.05, "material": "glass"},
        "impact": {"speed": 0.5},
        "effects": {"inertia": False, "non_hertzian_pressure": False, "finite_radius": False},
    }
    actual = selected_effects(read(tables), None)[1]
    assert "finite_thickness" in actual.included
    assert "finite_radius" not in actual.included
    assert "finite_radius" in actual.forced_out


@given(scenes())
@settings(max_examples=25)
def test_looser_tolerance_calls_no_additional_functions(scene: Scene) -> None:
    """The contact law calls no more functions of plate and sphere at a looser tolerance."""
    before = Counter[str]()
    for rtol in TOLERANCES[::3]:
        law = selected_effects(scene, rtol)[1].law
        with pytest.MonkeyPatch.context() as patch:
            calls = _counted(
                patch, "plate_contribution", "finite_radius", "bending", "sphere_contact"
            )
            law.at(np.array([1e-4, 2e-4]))
        assert sum(before.values()) <= sum(calls.values())
        before = calls


def _counted(patch: pytest.MonkeyPatch, *names: str) -> Counter[str]:
    """Count the calls of functions of `kernels`."""
    calls = Counter[str]()

    def counting(name: str, function: Any) -> Any:
        def counted(*arguments: Any) -> Any:
            calls[name] += 1
            return function(*arguments)

        return counted

    for name in names:
        patch.setattr(kernels, name, counting(name, getattr(kernels, name)))
    return calls


@given(scenes(), st.sampled_from([1e-2, 1e-3, 1e-6]))
@settings(max_examples=40)
def test_largest_radius_needs_few_newton_steps(scene: Scene, rtol: float) -> None:
    """Newton's iteration ends where rounding stops it, also with the weight of the sphere."""
    runs = [0]
    steps, radii = motion._step, motion.largest_radii

    def step(*arguments: Any) -> Any:
        runs[-1] += 1
        return steps(*arguments)

    def largest(*arguments: Any, **more: Any) -> Any:
        runs.append(0)
        return radii(*arguments, **more)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(motion, "_step", step)
        patch.setattr(motion, "largest_radii", largest)
        patch.setattr(omission_bounds, "largest_radii", largest)
        simulate(scene, rtol=rtol)
    assert max(runs) <= NEWTON_STEPS
