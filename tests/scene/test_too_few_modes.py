"""Too few modes for any error bound are rejected before a simulation, with a sufficient number."""

import re
from dataclasses import replace
from typing import Any

import pytest

from derivation.scene import SceneError, read, simulate
from derivation.scene.dynamic import contact_sequence
from derivation.scene.dynamic.unmet_tolerances import out_of_reach
from derivation.scene.selection.achieved_accuracy import ESTIMATED, Part

PANE: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {"radius": 0.3, "thickness": 0.008, "material": "glass"},
    "impact": {"speed": 2.0},
}


def scene(modes: int | str, rtol: float | None = 0.3) -> Any:
    accuracy = {} if rtol is None else {"accuracy": {"rtol": rtol}}
    return read(PANE | {"inertia": {"modes": modes}} | accuracy)


def recommended() -> tuple[int, int]:
    with pytest.raises(SceneError, match=r"^inertia\.modes: ") as error:
        simulate(scene(3))
    found = re.search(r"at least (\d+) modes .* inertia\.modes to (\d+)", str(error.value))
    assert found
    return int(found[1]), int(found[2])


def test_too_few_modes_are_rejected_without_a_simulation(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contact_sequence, "impact_history", None)
    assert recommended()[0] > 3


def test_recommended_numbers_have_a_bound_and_only_smaller_ones_are_rejected() -> None:
    """Without a tolerance, no number below the least has a bound."""
    least, enough = recommended()
    result = simulate(scene(enough, 0.1))
    assert result.accuracy.bound <= 0.1
    assert result.accuracy.bound < simulate(scene(least, None)).accuracy.bound < float("inf")
    assert simulate(scene(least - 1, None)).accuracy.bound == float("inf")
    with pytest.raises(SceneError, match=r"^inertia\.modes: expected at least"):
        simulate(scene(least - 1))


def test_recommended_number_is_not_said_to_meet_the_tolerance() -> None:
    """It only resolves the contact; an earlier message did not say that more may be necessary."""
    with pytest.raises(SceneError) as error:
        simulate(scene(3, 1e-5))
    said = r"to resolve it, increase inertia\.modes to (\d+) \(the tolerance may require more\)"
    found = re.search(said, str(error.value))
    assert found
    with pytest.raises(SceneError, match=r"^rtol: .*; increase the tolerance or inertia\.modes"):
        simulate(scene(int(found[1]), 1e-5))


def test_no_tolerance_above_one_is_recommended() -> None:
    """An earlier message recommended a tolerance of 290 %, which a scene may not have."""
    result = simulate(scene(40, None))
    accuracy, law = replace(result.accuracy, law=Part(2.2, ESTIMATED)), result.effects.law
    large, small = (str(out_of_reach(0.5, accuracy, law, 1e-4, 1.0, (), x)) for x in (2.9, 0.9))
    assert large.startswith("rtol: expected no tolerance, ")
    assert "remove the tolerance or " in large
    assert small.startswith("rtol: expected at least 9.0e-01 ")
