"""Comparison of two runs with different numbers of plate modes, whose contacts differ."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from derivation.scene import read, simulate
from derivation.scene.dynamic import mode_convergence


def run_of(*spans: tuple[float, float]) -> Any:
    """Return a run that has contacts at some times."""
    contacts = [SimpleNamespace(start=start, end=end) for start, end in spans]
    return SimpleNamespace(
        inertia=SimpleNamespace(contacts=contacts),
        impact_history=SimpleNamespace(problem=SimpleNamespace(T=1.0)),
    )


@pytest.mark.parametrize(
    ("rough", "found", "starts"),
    [
        (((0, 1), (2, 3)), ((0, 1.01), (2.02, 3.02)), [(0, 0), (2, 2.02)]),
        # A short contact that only one of the runs has is compared at equal times.
        (((0, 1), (1.2, 1.3), (2, 3)), ((0, 1.01), (2.02, 3)), [(0, 0), (2, 2.02), (1.2, 1.2)]),
        (((0, 1), (2, 3)), ((0, 1), (1.2, 1.3), (2.02, 3)), [(0, 0), (1.2, 1.2), (2, 2.02)]),
        # If one run splits a contact of the other, the longer part is paired with it.
        (((0, 1), (2, 4)), ((0, 1), (2.01, 2.4), (2.5, 4)), [(0, 0), (2.01, 2.01), (2, 2.5)]),
    ],
)
def test_contacts_are_paired_by_the_time_that_they_share(
    rough: tuple[tuple[float, float], ...],
    found: tuple[tuple[float, float], ...],
    starts: list[tuple[float, float]],
) -> None:
    times = mode_convergence._same_times(run_of(*rough), run_of(*found))
    assert [(old[0], new[0]) for old, new in times] == starts


def test_the_time_of_a_single_contact_may_agree_by_chance() -> None:
    """If other results change much, an almost unchanged contact time does not show convergence."""
    scene = {
        "sphere": {"radius": 0.004, "material": "steel"},
        "plate": {"radius": 0.06, "thickness": 0.03, "material": "concrete"},
        "impact": {"speed": 1.0},
        "inertia": {"modes": 64, "branches": "A0"},
    }
    dynamics = simulate(read(scene)).dynamics
    assert dynamics is not None
    assert len(dynamics.inertia.contacts) == 1
    changed = replace(dynamics.inertia, mode_convergence=(1e-9, 1e-9, 1e-2, 1e-9, 1e-9))
    assert changed.error_by_change("contact_time") > 1e-3
