"""Simulates an impact on a plate with inertia, with a sufficient number of modes and branches.

The modes up to some frequency are dynamic (see `modal`); the others respond quasi-statically. The
impact is computed again with twice as many modes, and the second run is the result. The difference
is the estimated error of the omitted modes. If the higher branches may change the results by more
than the tolerance, all branches are dynamic. An infinite plate is one so large that no wave returns
from its edge during the contacts.
"""

import math
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_sequence
from derivation.scene.dynamic.contact_errors import check_whole_width
from derivation.scene.dynamic.contact_sequence import ContactRun, ImpactHistory, expected_work
from derivation.scene.dynamic.integration_error import error_after, integration_error
from derivation.scene.dynamic.mode_convergence import (
    echoes_matter,
    judged,
    largest_change,
    nearly_meets,
    unchecked,
    unjudged,
    unreachable,
)
from derivation.scene.dynamic.mode_count import (
    LAST,
    affordable,
    beyond_limits,
    branching,
    check_followed,
    coarser,
    count_of,
    fast,
    finer,
    followed,
)
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.reach import OutOfReachError, Reach
from derivation.scene.dynamic.results import dynamic_impact_of
from derivation.scene.dynamic.time_in_contact import FEWER, check_long, nodes_for
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.dynamic.wave_problem import echo_time, problem_of
from derivation.scene.errors import SceneError
from derivation.scene.scene import OUTPUTS

WIDEST = 30.0
"""Largest radius that represents an infinite plate, over the first guess of `model_of`."""
LOOSE, TOLERANCE_FRACTION, KEPT = 4e-4, 1.0 / 3.0, 0.75
"""Largest accepted error by omitted modes: without a tolerance [1], and as a part of one; the part
that omitted modes and branches together may take."""
ROUGHER = 5.0
"""Factor by which the error by omitted modes may be larger without a tolerance, if the next run
takes more work than `LONG`: then it is at most 0.2 %."""
FINAL = 7e7
"""Largest work of one more run beyond the limits, which is made if the tolerance is nearly met."""
LONG = 1.5e6
"""Expected work of the second run above which coarser runs first check the first one."""
FOURTH = 8
"""Number of modes from which a run with a quarter of them is meaningful."""
WHOLE = 1.5e6
"""Largest work of a run that only determines which tolerance a message names."""
WORK = 4.5e7
"""Largest work of all runs of an impact, in the units of `contact_sequence.WORK`."""


def goal(rtol: float | None) -> float:
    """Return the largest accepted change with the number of modes [1] for a tolerance."""
    return LOOSE if rtol is None else TOLERANCE_FRACTION * rtol


def time_tolerance(goal: float) -> float:
    """Return the tolerance of the time elements, small against the goal for more modes [1]."""
    return min(1e-8, max(contact_sequence.TOLERANCE, 1e-3 * goal))


@dataclass
class Budget:
    """Remaining work of all runs of an impact together, in the units of `WORK`."""

    left: float


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
    check_long(law, time_tolerance(goal))
    budget, reach = Budget(WORK), Reach(law, outputs, need)
    rough: DynamicImpact | None = None
    if law.model.inertia.branches == "auto" and not law.viscous:
        law, rough = _branched(law, goal, outputs, budget)
    run, first = _converged(law, goal, reach, budget, rough), law.model.b
    while law.model.inertia.infinite_plate and _edge_heard(run):
        if law.model.b > WIDEST * first:
            raise SceneError(
                f"inertia.extent: the contact on an infinite plate had not ended after "
                f"{run.inertia.total_time:.6g} s; use a thicker plate or a lighter sphere"
            )
        law = replace(law, model=replace(law.model, b=2.0 * law.model.b))
        run = _converged(law, goal, reach, budget)
    return run


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


def _edge_heard(run: DynamicImpact) -> bool:
    """Return whether a wave may have returned from the edge before the last contact ended."""
    model, problem = run.law.model, run.impact_history.problem
    return problem.T * run.impact_history.contacts[-1].end > echo_time(model)


def _converged(
    law: ContactLaw,
    goal: float,
    reach: Reach,
    budget: Budget,
    known: DynamicImpact | None = None,
) -> DynamicImpact:
    """Return the impact with as many modes as the goal requires, or as the limits allow.

    Parameters
    ----------
    known
        The run with the fewest modes, if it has been computed.
    """
    count, close = affordable(law), time_tolerance(goal)
    more = finer(law, count)
    check_followed(law, more)
    rough = known or _run(law, count, budget, close, FEWER, reach=reach)
    if not rough.inertia.complete:  # a finer run would not be complete either
        return rough
    check_whole_width(rough.impact_history.problem, rough.max_contact_radius)
    estimated = None
    work = _next_work(law, more, rough)
    dear = work > min(LONG, contact_sequence.WORK, budget.left)
    if dear and not law.model.inertia.pointwise:
        compared = _by_coarser(rough, law, count, Budget(budget.left))
        if compared:
            estimated, halved = compared
            change = estimated.inertia.left(reach.outputs)[0]
            if change <= _accepted_change(estimated, goal, reach, work):
                return estimated
            if unreachable(halved, law, count, work, reach):
                return halved
            if not halved.inertia.recounted:
                inertia = replace(rough.inertia, ripple=halved.inertia.ripple)
                rough = replace(rough, inertia=inertia)
    if estimated is None:
        rough = _with_earlier(rough, law, count, reach, budget)
    best: DynamicImpact | None = None
    most: float | None = None
    while True:
        try:
            run = _run(law, more, budget, close, coarse=rough.impact_history, most=most)
        except SceneError:
            if best is None:
                raise
            return best  # the last run that was complete
        if not run.inertia.complete:
            unstarted = run.impact_history.problem is rough.impact_history.problem
            return best or (estimated if unstarted else None) or run
        best = rough = judged(rough, run)
        if law.model.inertia.pointwise:  # short waves gain energy: the results do not converge
            return unjudged(best)
        count, more = more, finer(law, more)
        if law.model.inertia.modes:
            return _of_chosen_modes(best, law, count, budget)
        change, enough = best.inertia.left(reach.outputs)[0], _accepted_change(best, goal, reach)
        used, almost = contact_sequence.work_of(best.impact_history), change <= LAST * enough
        if change <= enough and not echoes_matter(best, reach):
            return best
        beyond = beyond_limits(law, count, used, almost)
        if beyond and (most or not nearly_meets(best, reach)):
            return best
        work = _next_work(law, more, best)
        if change <= _accepted_change(best, goal, reach, work):
            return best
        if beyond:
            if work > FINAL:
                return best
            most = FINAL
        if unreachable(best, law, count, work, reach):
            return best


def _accepted_change(run: DynamicImpact, goal: float, reach: Reach, work: float = 0.0) -> float:
    """Return the largest accepted error by omitted modes [1], for the work of the next run."""
    if work > LONG and math.isinf(reach.need):
        return ROUGHER * goal
    beyond = run.inertia.left(reach.outputs)[1]
    # Where omitted branches matter more than additional modes, a tenth of them is small enough.
    enough = goal if beyond <= goal / TOLERANCE_FRACTION else max(goal, 0.1 * beyond)
    allowed = KEPT * reach.need
    if not run.inertia.jump <= allowed < math.inf:
        return enough
    return max(enough, allowed - beyond - integration_error(run.impact_history))


def _with_earlier(
    run: DynamicImpact, law: ContactLaw, count: int, reach: Reach, budget: Budget
) -> DynamicImpact:
    """Return the first run with its change since half as many: the next may agree by chance."""
    if "contact_time" in reach.outputs or law.model.inertia.modes or count < FOURTH:
        return run
    try:
        coarse = _run(law, coarser(count), budget, time_tolerance(LOOSE), FEWER)
    except SceneError:  # so few modes may bend the plate more than the sphere is curved
        return run
    return judged(coarse, run) if coarse.inertia.complete else run


def _next_work(law: ContactLaw, count: int, rough: DynamicImpact) -> float:
    """Return the expected work of a run with a number of bending modes."""
    problem = problem_of(law, count, rough.impact_history.tolerance)
    return expected_work(problem, nodes_for(problem), rough.impact_history)


def _run(
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
    except OutOfReachError:
        # The change by omitted branches grows until the end, and the message names a tolerance.
        if reach and (whole := _within(law, problem, n, tolerance, WHOLE)):
            reach.check(whole.inertia.omitted_branch_error)
        raise
    budget.left -= history.work
    return dynamic_impact_of(law, history)


def _within(
    law: ContactLaw, problem: DynamicProblem, n: int, tolerance: float, work: float
) -> DynamicImpact | None:
    """Return a complete impact if it needs no more than some work, else None."""
    with suppress(SceneError):
        history = contact_sequence.impact_history(problem, n, tolerance, work)
        return dynamic_impact_of(law, history) if history.complete else None
    return None


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
    coarse = _run(law, coarser(coarser(count)), budget, time_tolerance(LOOSE), FEWER)
    if not coarse.inertia.complete:
        return unjudged(run)
    return largest_change(run, judged(coarse, run))


def _by_coarser(
    run: DynamicImpact, law: ContactLaw, count: int, budget: Budget
) -> tuple[DynamicImpact, DynamicImpact] | None:
    """Return the first run with an error estimate by coarser ones, less work than a finer one.

    As in `_of_chosen_modes`, the larger change since half and since a quarter as many modes counts.
    The second result has the change since half as many modes alone.
    None if the scene gives a number of modes, the modes of the first run are slower than the
    contact, or a coarser run fails, is incomplete or has entirely different results.
    """
    if law.model.inertia.modes or count < FOURTH or not fast(law, count):
        return None
    compared: list[DynamicImpact] = []
    for fewer in (coarser(coarser(count)), coarser(count)):
        try:
            coarse = _run(law, fewer, budget, time_tolerance(LOOSE), FEWER)
        except SceneError:  # so few modes may bend the plate more than the sphere is curved
            return None
        if not coarse.inertia.complete:
            return None
        compared.append(judged(coarse, run))
    quartered, halved = compared
    found = largest_change(quartered, halved)
    if max(found.inertia.mode_convergence) >= 1.0:
        return None
    force, radius = map(max, quartered.inertia.ripple_error, halved.inertia.ripple_error)
    jump = max(quartered.inertia.jump, halved.inertia.jump)
    inertia = replace(found.inertia, jump=jump, ripple_error=(force, radius))
    return replace(run, inertia=inertia), halved
