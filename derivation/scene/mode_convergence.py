"""Convergence of the results of an impact with the number of plate modes."""

from dataclasses import replace

import numpy as np

from derivation.scene.contact_sequence import ImpactHistory
from derivation.scene.dynamic_problem import DynamicProblem
from derivation.scene.dynamic_results import NONE, UNKNOWN
from derivation.scene.law import ContactLaw
from derivation.scene.mode_count import beyond_limits, fast
from derivation.scene.reach import Reach
from derivation.scene.wave_motion import DynamicImpact

REGULAR, QUICK = 2.2, 16.0
"""Largest expected factors by which twice as many modes reduce an error: of the contact time, which
decreases regularly (see `wave_motion.LATE`) with modes shorter than the thickness; of others."""
FIRST = 4000.0
"""Largest expected factor if half as many modes were slower than the contact: in 84 random impacts
the error then decreased by factors of up to 2300, in single contacts up to 170."""
SHORT = 4.0
"""Largest wave number times half the thickness from which the contact time converges regularly."""
DEARER = {"A0": 2.0, "all": 4.0}
"""Least factor of the work of a run with twice as many bending modes."""


def judged(rough: DynamicImpact, found: DynamicImpact) -> DynamicImpact:
    """Return the finer run with the relative change of each result since the coarser run."""
    pairs = zip(found.numbers, rough.numbers, strict=True)
    time, depth, force, radius, speed = (abs(new - old) / abs(new) for new, old in pairs)
    change, jump = (time, depth, force, radius, speed), found.jump_since(rough)
    before = rough.inertia.mode_convergence
    recounted = len(found.inertia.contacts) != len(rough.inertia.contacts)
    inertia = replace(
        found.inertia,
        mode_convergence=change, jump=jump, earlier_change=before, recounted=recounted,
    )  # fmt: skip
    return replace(found, inertia=inertia)


def unjudged(found: DynamicImpact) -> DynamicImpact:
    """Return a run without an error estimate for its omitted modes."""
    unknown = replace(found.inertia, mode_convergence=UNKNOWN, earlier_change=NONE)
    return replace(found, inertia=unknown)


def unreachable(
    found: DynamicImpact, law: ContactLaw, count: int, work: float, reach: Reach
) -> bool:
    """Return whether no number of modes within the limits can be expected to meet the tolerance.

    If the runs differ in the number of contacts, nothing can be expected.

    Parameters
    ----------
    found
        A run with an error estimate.
    count
        Its number of bending modes.
    work
        Expected work of the run with twice as many.
    """
    if found.inertia.recounted:  # the next run may have the same contacts, and agree
        return False
    dearer = DEARER["all" if law.model.inertia.branches == "all" else "A0"]
    shortest = float(np.max(found.impact_history.problem.contact.modes.phi)) * law.model.h
    timed = REGULAR if shortest > SHORT else QUICK
    resolved = fast(law, count // 2)
    doublings, count = 1, 2 * count
    while not beyond_limits(law, count, work, near=True):
        count, work, doublings = 2 * count, dearer * work, doublings + 1
    factors = {name: timed if name == "contact_time" else QUICK for name in reach.outputs}
    errors = (
        found.inertia.left((name,))[0]
        / ((factor if resolved or factor == REGULAR else FIRST) * factor ** (doublings - 1))
        for name, factor in factors.items()
    )
    return max(errors) > reach.need


def unchecked(coarse: ImpactHistory, problem: DynamicProblem, fewer: int) -> ImpactHistory:
    """Return a run as incomplete, because a finer one for its error estimate is too much work."""
    return replace(
        coarse,
        reason=f"the error of {coarse.problem.omega.size} modes is unknown, because the "
        f"{problem.omega.size} modes for its estimate exceed the limit of work",
        remedy=f"set inertia.modes = {fewer} and remove the tolerance, or set "
        "effects.inertia = false",
    )
