"""Doubles the number of modes of an impact on a plate with inertia until it is accurate enough.

The difference from a run with half as many modes is the estimated error of the omitted modes.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_sequence
from derivation.scene.dynamic.contact_errors import check_whole_width
from derivation.scene.dynamic.contact_sequence import ImpactHistory, expected_work
from derivation.scene.dynamic.infinite_plate import wave_returned
from derivation.scene.dynamic.mode_convergence import (
    compare,
    echoes_matter,
    jump_matters,
    largest_change,
    largest_error,
    nearly_meets,
    room_for_modes,
    unreachable,
    without_estimate,
)
from derivation.scene.dynamic.mode_count import (
    LAST,
    affordable,
    beyond_limits,
    check_followed,
    coarser,
    fast,
    finer,
)
from derivation.scene.dynamic.reach import Reach
from derivation.scene.dynamic.runs import LOOSE, Budget, run_with, time_tolerance
from derivation.scene.dynamic.stretching_error import exceeds_modes
from derivation.scene.dynamic.time_in_contact import FEWER, nodes_for
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.errors import SceneError, StiffUnloadingError

TOLERANCE_FRACTION, KEPT = 1.0 / 3.0, 0.75
"""Largest accepted error by omitted modes over the tolerance; largest one by omitted modes and
branches together."""
ROUGHER, ROUGHEST = 5.0, 10.0
"""Factors by which the error by omitted modes may be larger without a tolerance, if the next run
takes more work than `LONG`, and at least four times as much: then it is at most 0.2 and 0.4 %."""
FINAL = 7e7
"""Largest work of one more run beyond the limits, which is made if the tolerance is nearly met."""
LONG = 1.5e6
"""Expected work of the second run above which coarser runs first check the first one."""
FOURTH = 8
"""Number of modes from which a run with a quarter of them is meaningful."""


class FirstRun(NamedTuple):
    """The first run, after coarser runs have shown its error if a finer one takes much work.

    Attributes
    ----------
    run
        The run.
    estimated
        The same with an error estimate by these runs, if they give one.
    final
        Whether no finer run is needed, or none is useful.
    """

    run: DynamicImpact
    estimated: DynamicImpact | None = None
    final: bool = False


@dataclass(frozen=True)
class Refinement:
    """The runs of an impact with increasing numbers of modes.

    Attributes
    ----------
    law
        The law, with the wave branches of the runs.
    goal
        Largest accepted relative change of the results with the number of modes [1].
    reach
        The tolerance of the impact.
    budget
        Remaining work of all runs.
    """

    law: ContactLaw
    goal: float
    reach: Reach
    budget: Budget

    def impact(
        self, known: DynamicImpact | None = None, coarse: ImpactHistory | None = None
    ) -> DynamicImpact:
        """Return the impact with as many modes as the goal requires, or as the limits allow.

        Parameters
        ----------
        known
            The run with the fewest modes, if it has been computed.
        coarse
            A run with still fewer modes, if there is one.
        """
        count, close = affordable(self.law), time_tolerance(self.goal)
        check_followed(self.law, finer(self.law, count))
        rough = known or run_with(self.law, count, self.budget, close, FEWER, coarse, self.reach)
        if not rough.inertia.complete:  # a finer run would not be complete either
            return rough
        if self.law.model.inertia.infinite_plate and wave_returned(rough):
            return rough
        check_whole_width(rough.impact_history.problem, rough.max_contact_radius)
        first = self._first_with_error(rough, count)
        return first.run if first.final else self._refined(first, count)

    def _first_with_error(self, rough: DynamicImpact, count: int) -> FirstRun:
        """Return the first run, with an error estimate by coarser ones."""
        work = self._next_work(rough, finer(self.law, count))
        compared: tuple[DynamicImpact | None, DynamicImpact] | None = None
        halved: DynamicImpact | None = None
        much = work > min(LONG, contact_sequence.WORK, self.budget.left)
        if much and not self.law.model.inertia.pointwise:
            compared = self._by_coarser(rough, count, work)
        if compared:
            estimated, halved = compared
            if estimated:
                if self._enough_modes(estimated, work):
                    return FirstRun(estimated, final=True)
                if unreachable([halved], self.law, count, work, self.reach):
                    return FirstRun(halved, final=True)
                if not halved.inertia.recounted:
                    inertia = replace(rough.inertia, ripple=halved.inertia.ripple)
                    rough = replace(rough, inertia=inertia)
                return FirstRun(rough, estimated)
        return FirstRun(self._with_earlier(rough, count, halved))

    def _refined(self, first: FirstRun, count: int) -> DynamicImpact:
        """Return the last of the runs, each with twice as many modes as the one before it."""
        law, rough, close, fewest = self.law, first.run, time_tolerance(self.goal), count
        runs: list[DynamicImpact] = []
        most: float | None = None
        while most != 0.0:
            count = finer(law, count)
            try:
                coarse = rough.impact_history
                run = run_with(law, count, self.budget, close, coarse=coarse, most=most)
            except SceneError as error:
                if runs:  # the last run was complete
                    break
                stiff = isinstance(error, StiffUnloadingError)
                if stiff and (estimated := self._unrefined(first, fewest)):
                    return estimated
                raise
            if not run.inertia.complete:
                unstarted = run.impact_history.problem is rough.impact_history.problem
                return runs[-1] if runs else (first.estimated if unstarted else None) or run
            rough = compare(rough, run)
            runs.append(rough)
            if law.model.inertia.pointwise:  # short waves gain energy: results do not converge
                return without_estimate(rough)
            if law.model.inertia.modes:
                return self._of_chosen_modes(rough, count)
            most = self._limit_of_next(runs, count, most)
        return runs[-1]

    def _unrefined(self, first: FirstRun, count: int) -> DynamicImpact | None:
        """Return the first run with an error estimate by coarser ones; None if they give none."""
        if first.estimated or self.law.model.inertia.pointwise:  # which does not converge
            return first.estimated
        compared = self._by_coarser(first.run, count)
        return compared[0] if compared else None

    def _limit_of_next(
        self, runs: list[DynamicImpact], count: int, most: float | None
    ) -> float | None:
        """Return the largest work of a finer run, None for the usual limit; 0 if there is none.

        Parameters
        ----------
        most
            The same of the last run.
        """
        best, reach = runs[-1], self.reach
        free = math.isinf(reach.need)  # there is no tolerance
        change, enough = best.inertia.left(reach.outputs)[0], self._accepted_change(best)
        if change <= enough and not echoes_matter(best, reach):
            # More modes also show whether the first contact splits, if they take little work. The
            # restitution of a yielded contact may change more by the second doubling than by the
            # first.
            unsure = jump_matters(best, reach) or (best.dent > 0.0 and len(runs) == 1)
            quick = self._next_work(best, finer(self.law, count)) <= LONG
            return most if quick and unsure else 0.0
        if free and exceeds_modes(self.law, best, reach.outputs):
            return 0.0
        used = contact_sequence.work_of(best.impact_history)
        beyond = beyond_limits(self.law, count, used, change <= LAST * enough)
        if beyond and (most or not nearly_meets(best, reach)):
            return 0.0
        work = self._next_work(best, finer(self.law, count))
        if free and change <= self._accepted_change(best, work):
            return 0.0
        if (beyond and work > FINAL) or unreachable(runs, self.law, count, work, reach):
            return 0.0
        return FINAL if beyond else most

    def _enough_modes(self, run: DynamicImpact, work: float) -> bool:
        """Return whether a run with more modes, which takes this work, is not needed.

        Without a tolerance, it is not if the error by omitted modes is small compared with
        stretching.
        """
        if run.inertia.left(self.reach.outputs)[0] <= self._accepted_change(run, work):
            return True
        return math.isinf(self.reach.need) and exceeds_modes(self.law, run, self.reach.outputs)

    def _accepted_change(self, run: DynamicImpact, work: float = 0.0) -> float:
        """Return the largest accepted error by omitted modes [1], for the work of the next run."""
        goal, reach = self.goal, self.reach
        if work > LONG and math.isinf(reach.need):
            return min(ROUGHER * math.sqrt(work / LONG), ROUGHEST) * goal
        beyond = run.inertia.left(reach.outputs)[1]
        room = room_for_modes(run, reach)
        # If omitted branches matter more than omitted modes, a tenth of their change is small
        # enough.
        enough = goal if beyond <= goal / TOLERANCE_FRACTION else max(goal, 0.1 * beyond)
        if room > 0.0:  # otherwise no number of modes meets the tolerance
            enough = min(enough, room)
        allowed = KEPT * reach.need
        if not run.inertia.jump <= allowed < math.inf:
            return enough
        return max(enough, room - (reach.need - allowed))

    def _with_earlier(
        self, run: DynamicImpact, count: int, halved: DynamicImpact | None
    ) -> DynamicImpact:
        """Return the first run with its change since half as many: the next may agree by chance.

        Parameters
        ----------
        halved
            The run with this change, if it is known.
        """
        law = self.law
        if "contact_time" in self.reach.outputs or law.model.inertia.modes or count < FOURTH:
            return run
        if halved:
            return halved
        try:
            coarse = run_with(law, coarser(count), self.budget, time_tolerance(LOOSE), FEWER)
        except SceneError:  # so few modes may make the plate more curved than the sphere
            return run
        return compare(coarse, run) if coarse.inertia.complete else run

    def _next_work(self, rough: DynamicImpact, count: int) -> float:
        """Return the expected work of a run with a number of bending modes."""
        problem = problem_of(self.law, count, rough.impact_history.tolerance)
        return expected_work(problem, nodes_for(problem), rough.impact_history)

    def _of_chosen_modes(self, run: DynamicImpact, count: int) -> DynamicImpact:
        """Return a run with the number of modes of the scene, and a reliable error estimate.

        If half as many modes are slower than the contact, their run may agree by chance: the larger
        one of the changes since half and since a quarter as many modes is used. If all modes are
        slower than the contact, there is no estimate.
        """
        law, fewest = self.law, coarser(coarser(count))
        if fast(law, coarser(count)):
            return run
        if not fast(law, count):
            return without_estimate(run)
        coarse = run_with(law, fewest, self.budget, time_tolerance(LOOSE), FEWER)
        if not coarse.inertia.complete:
            return without_estimate(run)
        return largest_change(run, compare(coarse, run))

    def _by_coarser(
        self, run: DynamicImpact, count: int, work: float = math.inf
    ) -> tuple[DynamicImpact | None, DynamicImpact] | None:
        """Return the first run with an error estimate by coarser ones, less work than a finer one.

        As in `_of_chosen_modes`, the larger one of the changes since half and since a quarter as
        many modes is used. The second result has the change since half as many modes alone. The
        first result is None if the results of the coarser runs differ by 100 % or more; both are if
        the scene gives a number of modes, the modes of the first run are slower than the contact,
        or a coarser run fails, is incomplete, or shows that the first one cannot be accurate
        enough. The coarser runs are not charged to the budget.

        Parameters
        ----------
        work
            Expected work of the finer run; infinite if it fails.
        """
        law, left = self.law, self.budget.left
        if law.model.inertia.modes or count < FOURTH or not fast(law, count):
            return None
        compared = list[DynamicImpact]()
        spare = Budget(max(left, run.impact_history.work))  # coarser runs together take less
        for fewer in (coarser(coarser(count)), coarser(count)):
            try:
                coarse = run_with(law, fewer, spare, time_tolerance(LOOSE), FEWER)
            except SceneError:  # so few modes may make the plate more curved than the sphere
                return None
            if not coarse.inertia.complete:
                return None
            compared.append(compare(coarse, run))
            # The larger change is used. The next coarser run is useless if the finer run follows
            # anyway.
            follows = math.isinf(self.reach.need) and work <= min(contact_sequence.WORK, left)
            if follows and not self._enough_modes(compared[0], work):
                return None
        quartered, halved = compared
        found = largest_error(quartered, halved)
        return (None if max(found.inertia.mode_convergence) >= 1.0 else found), halved
