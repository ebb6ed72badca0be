"""The duration of the first contact has no bound where omitted effects may change it by a jump."""

import math
from dataclasses import replace

import pytest

from derivation.scene import SceneError, read
from derivation.scene.effect_selection import SelectedEffects
from derivation.scene.impact import selected_effects
from derivation.scene.method_selection import dynamic_impact, solve_selected


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


def test_change_that_joins_or_splits_the_first_contact(selected: SelectedEffects) -> None:
    found = dynamic_impact(selected, 0.5)
    first, second = found.inertia.contacts[:2]
    gap = (second.start - first.end) / (first.end - first.start)
    assert 0.0 < found.decisive_change <= min(gap, 1.0)


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
        with pytest.raises(SceneError, match="contact_time out of accuracy"):
            solve_selected(inaccurate, 0.5)
