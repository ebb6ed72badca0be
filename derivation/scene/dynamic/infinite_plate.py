"""Chooses the width of a plate that represents an infinite one.

No wave may return from its edge during the contacts.
"""

from dataclasses import replace

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.contact_sequence import ImpactHistory
from derivation.scene.dynamic.mode_count import branching, coarser, count_of
from derivation.scene.dynamic.runs import LOOSE, WORK, Budget, run_with, time_tolerance
from derivation.scene.dynamic.time_in_contact import FEWER
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.dynamic.wave_problem import echo_time
from derivation.scene.errors import EndlessError, SceneError

WIDEST = 30.0
"""Largest radius that represents an infinite plate, over the first guess of `model_of`."""
PART, FEWEST = 0.1, 8
"""Part of the work of all runs that a run with a quarter of the modes may take, which takes about a
twentieth of the work of the first run; least number of its modes."""


def widened(law: ContactLaw, budget: Budget) -> tuple[ContactLaw, ImpactHistory | None]:
    """Return the law with a plate so wide that it is infinite in a run with few modes; this run.

    Raises
    ------
    SceneError
        If this run shows that one with enough modes exceeds the limits.
    """
    first = law.model.b
    while True:
        lowest = branching(law, "A0")
        count = coarser(coarser(count_of(lowest)))
        if count < FEWEST:
            return law, None
        try:
            run = run_with(lowest, count, budget, time_tolerance(LOOSE), FEWER, most=PART * WORK)
        except EndlessError:
            raise
        except SceneError:  # so few modes may bend the plate more than the sphere is curved
            return law, None
        if not edge_heard(run):
            return law, run.impact_history if run.inertia.complete else None
        law = wider(law, first, run)


def wider(law: ContactLaw, first: float, run: DynamicImpact) -> ContactLaw:
    """Return the law of an infinite plate with twice the radius.

    Parameters
    ----------
    first
        The first radius [m].
    run
        A run in which a wave returned from the edge.
    """
    if law.model.b > WIDEST * first:
        raise SceneError(
            f"inertia.extent: the contact on an infinite plate had not ended after "
            f"{run.inertia.total_time:.6g} s; use a thicker plate or a lighter sphere"
        )
    return replace(law, model=replace(law.model, b=2.0 * law.model.b))


def edge_heard(run: DynamicImpact) -> bool:
    """Return whether a wave may have returned from the edge before the last contact ended."""
    model, problem = run.law.model, run.impact_history.problem
    return problem.T * run.impact_history.contacts[-1].end > echo_time(model)
