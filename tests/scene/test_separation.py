"""The last step of a contact, which assumes that sphere and plate separate at a constant speed."""

import math
from functools import lru_cache
from typing import Any

import numpy as np

from derivation.scene import explain, read
from derivation.scene.dynamic.contact_sequence import ImpactHistory, impact_history
from derivation.scene.dynamic.next_element import left_after
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.separation import released
from derivation.scene.dynamic.time_element import P
from derivation.scene.dynamic.wave_problem import problem_of

HEAVY: dict[str, Any] = {
    "sphere": {"radius": 0.0158, "mass": 0.13, "material": "steel"},
    "plate": {"radius": 0.06, "thickness": 1e-3, "material": "cover glass", "edge": "clamped"},
    "impact": {"speed": 1.0},
    "effects": {"stretching": False},
}
"""A heavy sphere on a thin plate: contacts last for many periods of the fastest mode."""


@lru_cache
def history(nodes: int) -> ImpactHistory:
    """Return the impact with a loose tolerance, so that the last step is long."""
    problem = problem_of(explain(read(HEAVY)).effects.law, 46)
    return impact_history(problem, nodes, 1e-6, math.inf)


def energy(problem: DynamicProblem, state: ImpactState) -> float:
    """Return the energy of sphere and plate."""
    return state.velocity**2 / 2.0 + float(np.sum(problem.energies(state)))


def test_last_step_does_the_work_of_a_force_that_falls_as_the_power_three_halves() -> None:
    """The step is tried after each element. Most elements end too early for it."""
    steps = 0
    for touching in history(12).contacts:
        for piece in touching.pieces:
            before, left = piece.end, left_after(piece)
            parted = released(history(12).problem, piece, left) if left < math.inf else None
            if parted is None:
                continue
            duration, after = parted
            force = float(np.sum(piece.element.rows[P]))
            work = 0.4 * force * before.separation_speed * duration
            gained = energy(history(12).problem, after) - energy(history(12).problem, before)
            assert after.separation_speed > 0.0
            assert abs(gained - work) < 0.2 * work + 1e-12
            steps += 1
    assert steps >= len(history(12).contacts)


def test_contacts_do_not_depend_on_the_elements() -> None:
    """An earlier version took the last step while modes vibrated; the first end varied by 2e-3."""
    coarse, medium, fine = (history(nodes) for nodes in (12, 16, 24))
    assert len(coarse.contacts) == len(medium.contacts) == len(fine.contacts)
    for other in (coarse, medium):
        for one, exact in zip(other.contacts, fine.contacts, strict=True):
            assert abs(one.end - exact.end) < 1e-5
            assert abs(one.after.velocity - exact.after.velocity) < 1e-6
