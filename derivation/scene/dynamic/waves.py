"""Simulates an impact on a plate with inertia, with a sufficient number of modes and branches.

The modes up to some frequency are dynamic (see `modal`); the others respond quasi-statically. The
impact is computed again with twice as many modes, and the second run is the result. The difference
is the estimated error of the omitted modes. If the higher branches may change the results by more
than the tolerance, all branches are dynamic. An infinite plate is one so large that no wave returns
from its edge during the contacts. Without a tolerance, an impact whose results are all useless
because the plate stretches is computed with few modes only.
"""

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache

import numpy as np

from derivation.engine.threads import one_thread
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_sequence
from derivation.scene.dynamic.contact_sequence import ContactRun, ImpactHistory
from derivation.scene.dynamic.first_contact import jump_since
from derivation.scene.dynamic.infinite_plate import wave_returned, widened, wider
from derivation.scene.dynamic.integration_error import error_after, integration_error
from derivation.scene.dynamic.mode_count import (
    FEWEST,
    affordable,
    branching,
    check_resolving,
    coarser,
    count_of,
    finer,
    followed,
)
from derivation.scene.dynamic.not_usable import not_usable
from derivation.scene.dynamic.reach import OutOfReachError, Reach
from derivation.scene.dynamic.refinement import TOLERANCE_FRACTION, Refinement
from derivation.scene.dynamic.results import dynamic_impact_of
from derivation.scene.dynamic.runs import LOOSE, WORK, Budget, time_tolerance
from derivation.scene.dynamic.slow_modes import slow_impact
from derivation.scene.dynamic.stiff_unloading import number_with_solution
from derivation.scene.dynamic.stretched_shapes import (
    EnoughShapes,
    enough_shapes,
    more_shapes,
    with_many_shapes,
    with_shape_error,
)
from derivation.scene.dynamic.time_in_contact import FEWER, check_deflected, nodes_for, slow_count
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.errors import EndlessError, SceneError, StiffUnloadingError
from derivation.scene.scene import OUTPUTS


def goal(rtol: float | None) -> float:
    """Return the largest accepted change with the number of modes [1] for a tolerance."""
    return LOOSE if rtol is None else TOLERANCE_FRACTION * rtol


@lru_cache(maxsize=4)
def impact(
    law: ContactLaw,
    goal: float = LOOSE,
    outputs: tuple[str, ...] = OUTPUTS,
    need: float = math.inf,
) -> DynamicImpact:
    """Return the impact by a law with inertia.

    If a contact after the first cannot be computed to its end, the impact is incomplete. An impact
    with too many time steps is computed with slower modes.

    Parameters
    ----------
    goal
        Largest accepted relative change of the results with the number of modes [1]. The number is
        doubled while the change is larger, unless the scene gives the number. If the scene gives
        no branches, all are included if the higher ones may change the results by more than the
        part of the tolerance that the goal leaves.
    outputs
        The results that the goal applies to.
    need
        Largest error by omitted modes and branches with which the results are useful [1].

    Raises
    ------
    OutOfReachError
        If an early estimate of this error exceeds `need`.
    SceneError
        If an impact on a plate that does not deflect exceeds the range of the law, the modes of the
        plate are too slow or too many, or the first contact cannot be computed to its end.
    """
    try:
        return _impact(law, goal, outputs, need, Budget(WORK))
    except StiffUnloadingError as error:
        chosen = bool(law.model.inertia.modes)
        raise error.named(number_with_solution(law, error), chosen) from None


def _impact(
    law: ContactLaw, goal: float, outputs: tuple[str, ...], need: float, budget: Budget
) -> DynamicImpact:
    """Return the impact of `impact` within a budget of work."""
    if math.isfinite(need):
        check_resolving(law)
    timed = need if "contact_time" in outputs else math.inf
    count, used = slow_count(law, time_tolerance(goal), timed), with_many_shapes(law, need)
    if not count:
        free = not (law.model.inertia.modes or law.model.inertia.infinite_plate)
        try:
            run = _with_fast_modes(used, goal, Reach(law, outputs, need), budget)
            if not (free and run.impact_history.endless):
                return run
        except EndlessError:
            if not free:
                raise
        count = max(FEWEST, coarser(affordable(branching(law, "A0"))))
    return with_shape_error(used, slow_impact(used, count, goal, Budget(WORK)), goal)


def _with_fast_modes(law: ContactLaw, goal: float, reach: Reach, budget: Budget) -> DynamicImpact:
    """Return the impact with modes as fast as the contact, or with those of the scene."""
    first, outputs, need = law.model.b, reach.outputs, reach.need
    branches = law.model.inertia.branches
    rough: DynamicImpact | None = None
    coarse: ImpactHistory | None = None
    if law.model.inertia.infinite_plate and not law.model.inertia.modes:
        law, coarse = widened(law, budget)
    if math.isinf(need) and (few := not_usable(law, outputs)):
        return few
    if law.model.inertia.branches == "auto" and not law.viscous:
        law, rough = _branched(law, goal, reach, budget)
    run = _refined(law, first, goal, reach, budget, rough, coarse)
    every = branching(run.law, "all")
    if branches != "auto" or run.law == every or not _missed_by_branches(run, every, reach):
        return run
    return _better(run, lambda: _refined(every, first, goal, reach, budget), outputs)


def _better(
    run: DynamicImpact, other: Callable[[], DynamicImpact], outputs: tuple[str, ...]
) -> DynamicImpact:
    """Return the run with the smaller error of two, or the first one if the other one fails."""
    with suppress(SceneError):
        return min(run, other(), key=lambda one: one.inertia.error(outputs))
    return run


def _refined(
    law: ContactLaw,
    first: float,
    goal: float,
    reach: Reach,
    budget: Budget,
    rough: DynamicImpact | None = None,
    coarse: ImpactHistory | None = None,
) -> DynamicImpact:
    """Return the impact with enough modes, on an infinite plate with a sufficient width.

    Parameters
    ----------
    first
        The first radius of an infinite plate [m].
    rough, coarse
        The runs with the fewest modes, and with still fewer, if there are any.
    """
    enough = enough_shapes(law, goal, reach, rough)
    if enough.law != law:
        law, rough, coarse = enough.law, None, None
    run = Refinement(law, goal, reach, budget).impact(rough, coarse)
    while law.model.inertia.infinite_plate and wave_returned(run):
        law = wider(law, first, run)
        run, enough = Refinement(law, goal, reach, budget).impact(), EnoughShapes(law)
    found = with_shape_error(law, run, goal, rough, enough.error)
    if _misses(run, reach) or not _misses(found, reach):
        return found
    if more := more_shapes(law):
        return _better(found, lambda: _refined(more, first, goal, reach, budget), reach.outputs)
    by_shapes = max(found.inertia.shape_error[OUTPUTS.index(name)] for name in reach.outputs)
    if by_shapes >= reach.need:
        return found
    less = Refinement(law, goal, replace(reach, need=reach.need - by_shapes), budget)
    return _better(
        found,
        lambda: with_shape_error(law, less.impact(rough), goal, rough, enough.error),
        reach.outputs,
    )


def _misses(run: DynamicImpact, reach: Reach) -> bool:
    """Return whether a run does not meet a tolerance."""
    return run.inertia.error(reach.outputs) + integration_error(run.impact_history) > reach.need


def _missed_by_branches(run: DynamicImpact, every: ContactLaw, reach: Reach) -> bool:
    """Return whether a tolerance is missed because of the omitted branches.

    Parameters
    ----------
    every
        The law with all branches.
    """
    by_modes = run.inertia.left(reach.outputs)[0] > reach.need
    if every.viscous or by_modes or not run.inertia.complete or not _misses(run, reach):
        return False
    return followed(every, finer(every, affordable(every)))


def check_simulable(law: ContactLaw, rtol: float | None) -> None:
    """Reject an impact that cannot be simulated for any yield stress or retardation time.

    Parameters
    ----------
    rtol
        Tolerance of the results [1], if they have one.

    Raises
    ------
    SceneError
        As `impact` does before its first run.
    """
    with one_thread(), np.errstate(all="ignore"):
        if rtol is not None:
            check_resolving(law)
        check_deflected(law, time_tolerance(goal(rtol)))


def _branched(
    law: ContactLaw, goal: float, reach: Reach, budget: Budget
) -> tuple[ContactLaw, DynamicImpact | None]:
    """Return the law with all branches if the higher ones matter, else with the lowest branch.

    They matter if their estimated change exceeds the part of the tolerance that the goal for the
    modes leaves. The estimate follows from a rough run with the lowest branch. The run may end
    early, because estimates from its first contacts or from a radius alone are lower bounds. The
    rough run is also returned if the lowest branch is sufficient. If the contact is so short that
    there would be too many modes, the lowest branch is used. The higher ones also matter if, by
    this change, the first contact may split or join the next one, and its duration then exceeds the
    tolerance.
    """
    outputs = reach.outputs
    every, lowest, close = branching(law, "all"), branching(law, "A0"), time_tolerance(goal)
    if not followed(every, finer(every, affordable(every))):
        return lowest, None
    problem = problem_of(lowest, count_of(law), close)
    room = goal / TOLERANCE_FRACTION - goal - error_after(problem, close)

    def beyond(contacts: tuple[ContactRun, ...]) -> bool:
        """Return whether the higher branches matter because of some contacts alone."""
        begun = dynamic_impact_of(lowest, ImpactHistory(problem, contacts, contact_sequence.ENOUGH))
        return begun.inertia.left(outputs)[1] > room

    n = nodes_for(problem) - FEWER
    watch = Reach(lowest, outputs, room).watch(lowest, problem.a)
    try:
        history = contact_sequence.impact_history(problem, n, close, enough=beyond, watch=watch)
    except OutOfReachError:
        return every, None
    budget.left -= history.work
    rough = dynamic_impact_of(lowest, history)
    beyond_room = rough.inertia.complete and (
        rough.inertia.left(outputs)[1] > room
        or ("contact_time" in outputs and jump_since(rough) > reach.need)
    )
    if history.reason == contact_sequence.ENOUGH or beyond_room:
        return every, None
    return lowest, rough
