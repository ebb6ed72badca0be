"""Strongly damped plates need thousands of modes; the work must be estimated before a run."""

from typing import Any

import pytest

from derivation.scene import read, simulate
from derivation.scene.dynamic import contact_sequence, runs, waves
from derivation.scene.dynamic.contact_sequence import ImpactHistory, expected_work
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.scene import OUTPUTS

SLAB: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.0095, "material": "steel"},
    "plate": {
        "radius": 1.05, "thickness": 0.142, "material": "concrete", "edge": "clamped",
        "loss_factor": 0.2,
    },
    "impact": {"speed": 2.88, "gravity": 9.81},
}  # fmt: skip
PANE: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {
        "radius": 0.3, "thickness": 0.008, "material": "glass", "edge": "simply-supported",
        "loss_factor": 1.0,
    },
    "impact": {"speed": 2.0},
}  # fmt: skip
FINE = (9.097725e-05, 0.4090555)
"""Contact time [s] and restitution of the pane with 15,645 modes (a run of twelve seconds)."""


def test_expected_work_of_many_damped_modes_is_not_too_small(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """In an earlier version, 9540 modes took twice the expected work, 15,645 modes five times."""
    finished: list[ImpactHistory] = []
    ratios = []

    def recorded(problem: DynamicProblem, n: int, *args: Any) -> ImpactHistory:
        found = contact_sequence.impact_history(problem, n, *args)
        if finished and problem.omega.size > 5000:
            ratios.append(found.work / expected_work(problem, n, finished[-1]))
        finished.append(found)
        return found

    monkeypatch.setattr(runs, "contact_sequence", _With(recorded))
    waves.impact.cache_clear()
    simulate(read(SLAB))
    waves.impact.cache_clear()
    assert ratios
    assert max(ratios) < 1.3


class _With:
    """The module `contact_sequence` with another `impact_history`."""

    def __init__(self, impact_history: Any) -> None:
        self.impact_history = impact_history

    def __getattr__(self, name: str) -> Any:
        return getattr(contact_sequence, name)


@pytest.mark.one_version
def test_a_strongly_damped_plate_without_a_tolerance_is_within_its_bound() -> None:
    """Four times as many modes would halve the error and take five times as long."""
    result = simulate(read(PANE))
    assert result.dynamics is not None
    assert result.dynamics.inertia.modes < 5000
    assert max(result.dynamics.inertia.left(OUTPUTS)) <= 4e-3
    for name, fine in zip(("contact_time", "restitution"), FINE, strict=True):
        assert abs(getattr(result, name) / fine - 1.0) <= result.accuracy.bound < 4e-3, name
