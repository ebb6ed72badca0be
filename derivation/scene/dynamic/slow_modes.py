"""Impacts that last too long for modes as fast as the contact: simulated with slower ones.

A heavy sphere stays on a thin plate for long, and the fastest mode limits the time step. Slower
modes hardly change how deep the sphere deflects the plate and how fast it rebounds, but each single
contact, and with it the duration of the first one.
"""

from dataclasses import replace

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.mode_convergence import compare, largest_error, without_estimate
from derivation.scene.dynamic.mode_count import FEWEST, branching, coarser
from derivation.scene.dynamic.runs import LOOSE, WORK, Budget, run_with, time_tolerance
from derivation.scene.dynamic.time_in_contact import FEWER, QUICK
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.errors import EndlessError, SceneError

LONGEST = 2.0 * QUICK
"""Largest work of a run, if fewer modes are possible."""


def slow_impact(law: ContactLaw, count: int, goal: float, budget: Budget) -> DynamicImpact:
    """Return the impact with a number of modes, or with fewer if it lasts longer than expected.

    Parameters
    ----------
    goal
        As for `waves.impact`.
    """
    lowest, fewest = branching(law, "A0"), count <= FEWEST
    most = None if fewest else LONGEST
    try:
        run = run_with(lowest, count, budget, time_tolerance(goal), FEWER, most=most)
        longer = run.impact_history.endless
    except EndlessError:
        if fewest:
            raise
        longer = True
    if longer and not fewest:
        return slow_impact(law, max(FEWEST, coarser(count)), goal, budget)
    return _with_error(lowest, run, count) if run.inertia.complete else run


def _with_error(law: ContactLaw, run: DynamicImpact, count: int) -> DynamicImpact:
    """Return a run with the error of its omitted modes.

    Two runs with slow modes may agree by chance: the larger one of the changes since half and since
    a quarter as many modes is used.
    """
    half, compared = coarser(count), list[DynamicImpact]()
    for fewer in (coarser(half), half):
        try:
            rough = run_with(law, fewer, Budget(WORK), time_tolerance(LOOSE), FEWER)
        except SceneError:  # so few modes may make the plate more curved than the sphere
            return without_estimate(run)
        if not rough.inertia.complete:
            return without_estimate(run)
        compared.append(compare(rough, run))
    found = largest_error(*compared)
    of_time = found.inertia.ripple_error[0], 0.0, 0.0
    return replace(found, inertia=replace(found.inertia, slow=True, ripple_error=of_time))
