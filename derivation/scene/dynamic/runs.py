"""Simulates an impact on a plate with a given number of modes, within limits of the work."""

from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from derivation.engine.threads import one_thread
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_sequence
from derivation.scene.dynamic.contact_errors import LOOSEST
from derivation.scene.dynamic.contact_sequence import ImpactHistory, expected_work
from derivation.scene.dynamic.mode_convergence import unchecked
from derivation.scene.dynamic.mode_count import MODES, branching, count_of
from derivation.scene.dynamic.reach import OutOfReachError, Reach
from derivation.scene.dynamic.results import dynamic_impact_of
from derivation.scene.dynamic.time_in_contact import FEWER, nodes_for, slow_count
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.errors import IncompleteError

LOOSE = 4e-4
"""Largest accepted error by omitted modes without a tolerance [1]."""
WHOLE, FEWER_MODES = 2.5e5, 4
"""Largest work (a quarter of a second) of a run that only determines which tolerance a message
names; factor by which it has fewer modes."""
FEWEST = 5
"""Least number of modes of a simulation without an error bound."""
WORK = 4.5e7
"""Largest work of all runs of an impact, in the units of `contact_sequence.WORK`."""


def time_tolerance(goal: float) -> float:
    """Return the tolerance of the time elements, small against the goal for more modes [1]."""
    return min(LOOSEST, max(contact_sequence.TOLERANCE, 1e-3 * goal))


@dataclass
class Budget:
    """Remaining work of all runs of an impact together, in the units of `WORK`."""

    left: float


def run_with(
    law: ContactLaw,
    count: int,
    budget: Budget,
    tolerance: float,
    fewer_nodes: int = 0,
    coarse: ImpactHistory | None = None,
    reach: Reach | None = None,
    most: float | None = None,
) -> DynamicImpact:
    """Return the impact with a number of bending modes.

    If the work estimated from a coarser run is too large, that run is returned as incomplete.

    Parameters
    ----------
    tolerance
        Tolerance of the time elements [1].
    fewer_nodes
        Number of nodes by which the elements are reduced.
    coarse
        A run with fewer modes, if there is one.
    reach
        The tolerance, if the run ends when omitted wave branches exceed it.
    most
        Largest work, if it differs from that of every run.
    """
    problem = problem_of(law, count, tolerance)
    n = nodes_for(problem) - fewer_nodes
    work = most or min(contact_sequence.WORK, budget.left)
    if coarse and expected_work(problem, n, coarse) > work:
        fewer = count // 2
        while fewer > 1 and expected_work(problem_of(law, fewer, tolerance), n, coarse) > work:
            fewer //= 2
        return dynamic_impact_of(law, unchecked(coarse, problem, fewer))
    enough = reach.enough(law, problem) if reach else None
    watch = reach.watch(law, problem.a) if reach else None
    try:
        history = contact_sequence.impact_history(problem, n, tolerance, work, enough, watch)
    except OutOfReachError as early:
        if reach:
            _check_later(law, max(1, count // FEWER_MODES), reach, early.change)
        raise
    budget.left -= history.work
    return dynamic_impact_of(law, history)


def with_few_modes(law: ContactLaw, part: float, work: float = WORK) -> DynamicImpact:
    """Return an impact with few bending modes and the lowest branch, without an error bound.

    Parameters
    ----------
    part
        Their number over that of the first run [1].
    work
        Largest work, in the units of `WORK`.
    """
    lowest = branching(law, "A0")
    count = count_of(lowest)
    count = min(max(min(count, FEWEST), round(part * count)), MODES)
    with one_thread(), np.errstate(all="ignore"):
        count = min(count, slow_count(lowest, time_tolerance(LOOSE)) or count)
        return run_with(lowest, count, Budget(min(work, WORK)), time_tolerance(LOOSE), FEWER)


def _check_later(law: ContactLaw, count: int, reach: Reach, early: float) -> None:
    """Raise an error if the final change by omitted branches exceeds an early estimate.

    The message then names a tolerance for the final change.

    Parameters
    ----------
    count
        Number of bending modes.
    early
        The early estimate [1].
    """
    tolerance = time_tolerance(LOOSE)
    problem = problem_of(law, count, tolerance)
    with suppress(IncompleteError):
        n = nodes_for(problem) - FEWER
        history = contact_sequence.impact_history(problem, n, tolerance, WHOLE)
        reach.check(dynamic_impact_of(law, history).inertia.omitted_branch_error, early)
