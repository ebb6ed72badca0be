"""Chooses the width of a plate that represents an infinite one.

No wave may return from its edge during the contacts.
"""

import math
from dataclasses import replace

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.contact_sequence import ImpactHistory
from derivation.scene.dynamic.infinite_plate_impact import infinite_plate_impact
from derivation.scene.dynamic.mode_count import (
    affordable,
    branching,
    check_followed,
    coarser,
    count_of,
    finer,
    unit_time,
)
from derivation.scene.dynamic.runs import LOOSE, WORK, Budget, run_with, time_tolerance
from derivation.scene.dynamic.time_in_contact import FEWER
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.dynamic.wave_problem import echo_time
from derivation.scene.errors import EndlessError, SceneError
from derivation.scene.scales import zener_number

WIDEST = 30.0
"""Largest radius that represents an infinite plate, over the first guess of `model_of`."""
RADIATING, CERTAIN = 1.0, 0.8
"""Zener parameter from which contacts are so long that Zener's equation gives the first width; the
contact time over that of this equation is larger: 0.9 to 0.98 in random scenes."""
PART, FEWEST = 0.1, 8
"""Part of the allowed work of all runs that a run with a quarter of the modes may take (it takes
about a twentieth of the work of the first run); least number of its modes."""


def widened(law: ContactLaw, budget: Budget) -> tuple[ContactLaw, ImpactHistory | None]:
    """Return the law with a plate that is wide enough in a run with few modes, and this run.

    Raises
    ------
    SceneError
        If the contact lasts too long, or this run shows that one with enough modes exceeds the
        limits.
    """
    first = law.model.b
    law = _wide_enough(law)
    while True:
        lowest = branching(law, "A0")
        check_followed(lowest, finer(lowest, affordable(lowest)))
        count = coarser(coarser(count_of(lowest)))
        if count < FEWEST:
            return law, None
        try:
            run = run_with(lowest, count, budget, time_tolerance(LOOSE), FEWER, most=PART * WORK)
        except EndlessError:
            raise
        except SceneError:  # with so few modes the plate may be more curved than the sphere
            return law, None
        if not wave_returned(run):
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
        raise _too_long(run.inertia.total_time)
    return replace(law, model=replace(law.model, b=2.0 * law.model.b))


def _wide_enough(law: ContactLaw) -> ContactLaw:
    """Return the law with a plate wide enough for the contact time by Zener's equation."""
    model, number, unit = law.model, zener_number(law.model), unit_time(law)
    if number < RADIATING:
        return law
    longest = echo_time(replace(model, b=2.0 * WIDEST * model.b))
    weight = law.gravity * unit / model.v0
    time = CERTAIN * unit * infinite_plate_impact(number, weight, longest / unit)[0]
    while echo_time(model) < time:
        if model.b > WIDEST * law.model.b:
            raise _too_long(time if math.isfinite(time) else longest)
        model = replace(model, b=2.0 * model.b)
    return replace(law, model=model)


def _too_long(time: float) -> SceneError:
    """Return the error of a contact that lasts longer than a time [s]."""
    return SceneError(
        f"inertia.extent: expected a contact that ends, got one of more than {time:.2g} s on an "
        'infinite plate; use a thicker plate or a lighter sphere, or remove extent = "infinite"'
    )


def wave_returned(run: DynamicImpact) -> bool:
    """Return whether a wave may have returned from the edge before the last contact ended."""
    model, problem = run.law.model, run.impact_history.problem
    return problem.T * run.impact_history.contacts[-1].end > echo_time(model)
