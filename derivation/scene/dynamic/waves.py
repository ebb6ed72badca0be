"""Simulates an impact on a plate with inertia, with a sufficient number of modes and branches.

The modes up to some frequency are dynamic (see `modal`); the others respond quasi-statically. The
impact is computed again with twice as many modes, and the second run is the result. The difference
is the estimated error of the omitted modes. If the higher branches may change the results by more
than the tolerance, all branches are dynamic. An infinite plate is one so large that no wave returns
from its edge during the contacts.
"""

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np

from derivation.engine.threads import one_thread
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_sequence
from derivation.scene.dynamic.contact_errors import check_whole_width
from derivation.scene.dynamic.contact_sequence import ContactRun, ImpactHistory, expected_work
from derivation.scene.dynamic.infinite_plate import edge_heard, widened, wider
from derivation.scene.dynamic.integration_error import error_after, integration_error
from derivation.scene.dynamic.mode_convergence import (
    echoes_matter,
    judged,
    largest_change,
    nearly_meets,
    unjudged,
    unreachable,
)
from derivation.scene.dynamic.mode_count import (
    LAST,
    affordable,
    beyond_limits,
    branching,
    check_followed,
    check_resolving,
    coarser,
    count_of,
    fast,
    finer,
    followed,
)
from derivation.scene.dynamic.reach import OutOfReachError, Reach
from derivation.scene.dynamic.results import dynamic_impact_of
from derivation.scene.dynamic.runs import LOOSE, WORK, Budget, run_with, time_tolerance
from derivation.scene.dynamic.stretching_error import exceeds_modes
from derivation.scene.dynamic.time_in_contact import FEWER, check_deflected, check_long, nodes_for
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.errors import SceneError
from derivation.scene.scene import OUTPUTS

TOLERANCE_FRACTION, KEPT = 1.0 / 3.0, 0.75
"""Largest accepted error by omitted modes over the tolerance; the part of it that omitted modes and
branches together may take."""
ROUGHER, ROUGHEST = 5.0, 10.0
"""Factors by which the error by omitted modes may be larger without a tolerance, if the next run
takes more work than `LONG`, and at least four times as much: then it is at most 0.2 and 0.4 %."""
FINAL = 7e7
"""Largest work of one more run beyond the limits, which is made if the tolerance is nearly met."""
LONG = 1.5e6
"""Expected work of the second run above which coarser runs first check the first one."""
FOURTH = 8
"""Number of modes from which a run with a quarter of them is meaningful."""


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

    If a contact after the first cannot be computed to its end, the impact is incomplete.

    Parameters
    ----------
    goal
        Largest accepted relative change of the results with the number of modes [1]. The number is
        doubled while the change is larger, unless the scene gives the number. If the scene gives
        no branches, all are included if the higher ones may change the results by more than the
        goal leaves of the tolerance.
    outputs
        The results that the goal applies to.
    need
        Largest error by omitted modes and branches with which the results are of use [1].

    Raises
    ------
    OutOfReachError
        If an early estimate of this error exceeds `need`.
    SceneError
        If an impact on a plate that does not deflect exceeds the range of the law, the modes of the
        plate are too slow or too many, or the first contact cannot be computed to its end.
    """
    if math.isfinite(need):
        check_resolving(law)
    check_long(law, time_tolerance(goal))
    budget, reach, first = Budget(WORK), Reach(law, outputs, need), law.model.b
    rough: DynamicImpact | None = None
    coarse: ImpactHistory | None = None
    if law.model.inertia.infinite_plate and not law.model.inertia.modes:
        law, coarse = widened(law, budget)
    if law.model.inertia.branches == "auto" and not law.viscous:
        law, rough = _branched(law, goal, outputs, budget)
    run = _converged(law, goal, reach, budget, rough, coarse)
    while law.model.inertia.infinite_plate and edge_heard(run):
        law = wider(law, first, run)
        run = _converged(law, goal, reach, budget)
    return run


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
    law: ContactLaw, goal: float, outputs: tuple[str, ...], budget: Budget
) -> tuple[ContactLaw, DynamicImpact | None]:
    """Return the law with all branches if the higher ones matter, else with the lowest branch.

    They matter if their estimated change exceeds what the goal for the modes leaves of the
    tolerance. The estimate follows from a rough run with the lowest branch; those from its first
    contacts or from a radius alone are lower bounds, at which the run may end. The rough run is
    also returned if the lowest branch is sufficient. If the contact is so short that there would be
    too many modes, the lowest branch is used.
    """
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
    beyond_room = rough.inertia.complete and rough.inertia.left(outputs)[1] > room
    if history.reason == contact_sequence.ENOUGH or beyond_room:
        return every, None
    return lowest, rough


def _converged(
    law: ContactLaw,
    goal: float,
    reach: Reach,
    budget: Budget,
    known: DynamicImpact | None = None,
    coarse: ImpactHistory | None = None,
) -> DynamicImpact:
    """Return the impact with as many modes as the goal requires, or as the limits allow.

    Parameters
    ----------
    known
        The run with the fewest modes, if it has been computed.
    coarse
        A run with still fewer modes, if there is one.
    """
    count, close = affordable(law), time_tolerance(goal)
    more = finer(law, count)
    check_followed(law, more)
    rough = known or run_with(law, count, budget, close, FEWER, coarse, reach)
    if not rough.inertia.complete:  # a finer run would not be complete either
        return rough
    if law.model.inertia.infinite_plate and edge_heard(rough):
        return rough
    check_whole_width(rough.impact_history.problem, rough.max_contact_radius)
    estimated: DynamicImpact | None = None
    halved: DynamicImpact | None = None
    work = _next_work(law, more, rough)
    dear = work > min(LONG, contact_sequence.WORK, budget.left)
    if dear and not law.model.inertia.pointwise:
        compared = _by_coarser(rough, law, count, budget, goal, reach, work)
        if compared:
            estimated, halved = compared
        if estimated and halved:
            if _enough_modes(estimated, law, goal, reach, work):
                return estimated
            if unreachable([halved], law, count, work, reach):
                return halved
            if not halved.inertia.recounted:
                inertia = replace(rough.inertia, ripple=halved.inertia.ripple)
                rough = replace(rough, inertia=inertia)
    if estimated is None:
        rough = _with_earlier(rough, law, count, reach, budget, halved)
    best: DynamicImpact | None = None
    runs: list[DynamicImpact] = []
    most: float | None = None
    while True:
        try:
            run = run_with(law, more, budget, close, coarse=rough.impact_history, most=most)
        except SceneError:
            if best is None:
                raise
            return best  # the last run that was complete
        if not run.inertia.complete:
            unstarted = run.impact_history.problem is rough.impact_history.problem
            return best or (estimated if unstarted else None) or run
        best = rough = judged(rough, run)
        runs.append(best)
        if law.model.inertia.pointwise:  # short waves gain energy: the results do not converge
            return unjudged(best)
        count, more = more, finer(law, more)
        if law.model.inertia.modes:
            return _of_chosen_modes(best, law, count, budget)
        change, enough = best.inertia.left(reach.outputs)[0], _accepted_change(best, goal, reach)
        used, almost = contact_sequence.work_of(best.impact_history), change <= LAST * enough
        if change <= enough and not echoes_matter(best, reach):
            return best
        if math.isinf(reach.need) and exceeds_modes(law, best, reach.outputs):
            return best
        beyond = beyond_limits(law, count, used, almost)
        if beyond and (most or not nearly_meets(best, reach)):
            return best
        work = _next_work(law, more, best)
        if math.isinf(reach.need) and change <= _accepted_change(best, goal, reach, work):
            return best
        if beyond:
            if work > FINAL:
                return best
            most = FINAL
        if unreachable(runs, law, count, work, reach):
            return best


def _enough_modes(
    run: DynamicImpact, law: ContactLaw, goal: float, reach: Reach, work: float
) -> bool:
    """Return whether a run with more modes, of this work, is not needed.

    Without a tolerance, modes that matter little beside stretching are not.
    """
    if run.inertia.left(reach.outputs)[0] <= _accepted_change(run, goal, reach, work):
        return True
    return math.isinf(reach.need) and exceeds_modes(law, run, reach.outputs)


def _accepted_change(run: DynamicImpact, goal: float, reach: Reach, work: float = 0.0) -> float:
    """Return the largest accepted error by omitted modes [1], for the work of the next run."""
    if work > LONG and math.isinf(reach.need):
        return min(ROUGHER * math.sqrt(work / LONG), ROUGHEST) * goal
    beyond = run.inertia.left(reach.outputs)[1]
    # Where omitted branches matter more than additional modes, a tenth of them is small enough.
    enough = goal if beyond <= goal / TOLERANCE_FRACTION else max(goal, 0.1 * beyond)
    allowed = KEPT * reach.need
    if not run.inertia.jump <= allowed < math.inf:
        return enough
    return max(enough, allowed - beyond - integration_error(run.impact_history))


def _with_earlier(
    run: DynamicImpact,
    law: ContactLaw,
    count: int,
    reach: Reach,
    budget: Budget,
    halved: DynamicImpact | None,
) -> DynamicImpact:
    """Return the first run with its change since half as many: the next may agree by chance.

    Parameters
    ----------
    halved
        The run with this change, if it is known.
    """
    if "contact_time" in reach.outputs or law.model.inertia.modes or count < FOURTH:
        return run
    if halved:
        return halved
    try:
        coarse = run_with(law, coarser(count), budget, time_tolerance(LOOSE), FEWER)
    except SceneError:  # so few modes may bend the plate more than the sphere is curved
        return run
    return judged(coarse, run) if coarse.inertia.complete else run


def _next_work(law: ContactLaw, count: int, rough: DynamicImpact) -> float:
    """Return the expected work of a run with a number of bending modes."""
    problem = problem_of(law, count, rough.impact_history.tolerance)
    return expected_work(problem, nodes_for(problem), rough.impact_history)


def _of_chosen_modes(
    run: DynamicImpact, law: ContactLaw, count: int, budget: Budget
) -> DynamicImpact:
    """Return a run with the number of modes of the scene, and a reliable error estimate.

    If half as many modes are slower than the contact, their run may agree by chance: the larger
    change since half and since a quarter as many modes then counts. If all modes are slower than
    the contact, there is no estimate.
    """
    if fast(law, coarser(count)):
        return run
    if not fast(law, count):
        return unjudged(run)
    coarse = run_with(law, coarser(coarser(count)), budget, time_tolerance(LOOSE), FEWER)
    if not coarse.inertia.complete:
        return unjudged(run)
    return largest_change(run, judged(coarse, run))


def _by_coarser(
    run: DynamicImpact,
    law: ContactLaw,
    count: int,
    budget: Budget,
    goal: float,
    reach: Reach,
    work: float,
) -> tuple[DynamicImpact | None, DynamicImpact] | None:
    """Return the first run with an error estimate by coarser ones, less work than a finer one.

    As in `_of_chosen_modes`, the larger change since half and since a quarter as many modes counts.
    The second result has the change since half as many modes alone.
    The first result is None if the coarser runs have entirely different results; both are if the
    scene gives a number of modes, the modes of the first run are slower than the contact, or a
    coarser run fails, is incomplete, or shows that the first one cannot be accurate enough.

    Parameters
    ----------
    budget
        That of all runs; these runs are not charged to it.
    work
        Expected work of the finer run.
    """
    if law.model.inertia.modes or count < FOURTH or not fast(law, count):
        return None
    compared, spare = list[DynamicImpact](), Budget(budget.left)
    for fewer in (coarser(coarser(count)), coarser(count)):
        try:
            coarse = run_with(law, fewer, spare, time_tolerance(LOOSE), FEWER)
        except SceneError:  # so few modes may bend the plate more than the sphere is curved
            return None
        if not coarse.inertia.complete:
            return None
        compared.append(judged(coarse, run))
        # The change since a quarter as many modes counts. One more only tells what is in reach.
        follows = math.isinf(reach.need) and work <= min(contact_sequence.WORK, budget.left)
        if follows and not _enough_modes(compared[0], law, goal, reach, work):
            return None
    quartered, halved = compared
    found = largest_change(quartered, halved)
    if max(found.inertia.mode_convergence) >= 1.0:
        return None, halved
    time, force, radius = map(max, quartered.inertia.ripple_error, halved.inertia.ripple_error)
    jump = max(quartered.inertia.jump, halved.inertia.jump)
    inertia = replace(found.inertia, jump=jump, ripple_error=(time, force, radius))
    return replace(run, inertia=inertia), halved
