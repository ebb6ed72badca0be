"""The number of shapes that stretch the plate, and the error of the others.

All shapes vibrate, but only the first ones stretch the middle plane: its forces decrease fast with
the wave number. The error is estimated with few modes, because fast ones hardly change it. With a
tolerance that the error exceeds, more shapes stretch the plate.
"""

import math
from dataclasses import replace
from typing import NamedTuple

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.first_contact import IRREGULAR
from derivation.scene.dynamic.mode_convergence import compare
from derivation.scene.dynamic.mode_count import affordable, branching, finer
from derivation.scene.dynamic.reach import Reach
from derivation.scene.dynamic.results import UNKNOWN
from derivation.scene.dynamic.runs import WORK, Budget, run_with, time_tolerance
from derivation.scene.dynamic.time_in_contact import FEWER
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.effects.effect import Results
from derivation.scene.errors import SceneError
from derivation.scene.scene import OUTPUTS

MORE, MOST, ACCURATE = 96, 192, 0.05
"""Number of shapes with a tolerance, the largest number, and the largest tolerance for them [1]."""
FEW = 128
"""Number of modes of the second run up to which the largest number of shapes stretch the plate."""
PART = 0.75
"""Error of the omitted shapes over the tolerance above which more shapes stretch the plate."""
LEFT = 0.4
"""Estimated error of the omitted shapes over the change since half as many. At least a third would
be left if it decreased as the square of their number."""
SHORT, SHORT_OF_RADIUS = 0.05, 0.5
"""Additional error by short waves, which bend the plate under the contact, over the contact radius
divided by the radius of the sphere and by the number of shapes; the same of the contact radius.

In 23 random impacts with contact radii of 0.02 to 0.94 sphere radii, results with 48 and 96 shapes
differed from those with 192 by at most 0.8 of both errors. An earlier version stated a quarter of
the change alone, which was too small in 22 of them. Up to 0.32 of changes of the force above 0.1 %
were left; small changes, above all of the contact radius, may be followed by larger ones: up to 40
times the change was left, 0.04 % of the radius.
"""


def with_shapes(law: ContactLaw, shapes: int) -> ContactLaw:
    """Return a law in which a number of shapes stretch the plate."""
    model = law.model
    return replace(law, model=replace(model, inertia=replace(model.inertia, shapes=shapes)))


def with_many_shapes(law: ContactLaw, need: float) -> ContactLaw:
    """Return a law in which many shapes stretch the plate if the results have a tolerance.

    If the second run of the impact has few modes, usually all shapes do, so that no error of others
    is to be estimated.

    Parameters
    ----------
    need
        Largest error with which the results are useful [1].
    """
    if not law.stretches or need > ACCURATE:
        return law
    return with_shapes(law, MOST if finer(law, affordable(law)) <= FEW else MORE)


class EnoughShapes(NamedTuple):
    """A law in which enough shapes stretch the plate.

    Attributes
    ----------
    law
        The law.
    error
        Estimated error of the other shapes, for each result [1]; None if it is not known yet.
    """

    law: ContactLaw
    error: Results | None = None


def enough_shapes(
    law: ContactLaw, goal: float, reach: Reach, rough: DynamicImpact | None
) -> EnoughShapes:
    """Return a law in which so many shapes stretch the plate that the others hardly matter.

    Parameters
    ----------
    goal, rough
        As in `shape_error`.
    reach
        The tolerance of the impact.
    """
    more = more_shapes(law)
    if more is None or math.isinf(reach.need):
        return EnoughShapes(law)
    error = shape_error(law, goal, rough)
    if max(error[OUTPUTS.index(name)] for name in reach.outputs) <= PART * reach.need:
        return EnoughShapes(law, error)
    return enough_shapes(more, goal, reach, None)


def more_shapes(law: ContactLaw) -> ContactLaw | None:
    """Return a law in which twice as many shapes stretch the plate; None if there are no more."""
    shapes = 2 * law.model.inertia.shapes
    return with_shapes(law, shapes) if law.stretches and shapes <= MOST else None


def with_shape_error(
    law: ContactLaw,
    run: DynamicImpact,
    goal: float,
    rough: DynamicImpact | None = None,
    error: Results | None = None,
) -> DynamicImpact:
    """Return a run with the estimated error of the shapes that do not stretch the plate.

    Parameters
    ----------
    goal, rough
        As in `shape_error`.
    error
        This error, if it is known.
    """
    if not law.stretches or not run.inertia.complete:
        return run
    if run.impact_history.problem.contact.modes.phi.size <= law.model.inertia.shapes:
        return run  # the change with the number of modes includes it
    error = error or shape_error(law, goal, rough)
    return replace(run, inertia=replace(run.inertia, shape_error=error))


def shape_error(law: ContactLaw, goal: float, rough: DynamicImpact | None = None) -> Results:
    """Return the estimated error of the shapes that do not stretch the plate, for each result [1].

    The simulations with few modes are not charged to the budget of the impact.

    Parameters
    ----------
    goal
        Largest accepted relative change of the results with the number of modes [1].
    rough
        The run of the impact with the fewest modes, if it has been computed. It is one of those
        with few modes if it has no more than twice as many as shapes stretch the plate.
    """
    lowest, count = branching(law, "A0"), law.model.inertia.shapes
    if rough:
        few = rough.impact_history.problem.contact.modes.phi.size
        if rough.law == lowest and count <= few <= 2 * count:
            return _error(lowest, few, goal, rough)
    return _error(lowest, count, goal)


def _error(law: ContactLaw, count: int, goal: float, rough: DynamicImpact | None = None) -> Results:
    """Return the estimated relative error of each result [1].

    Parameters
    ----------
    count, rough
        Number of modes from which it is estimated, and the run with them, if there is one.
    """
    shapes, close, budget = law.model.inertia.shapes, time_tolerance(goal), Budget(WORK)
    try:
        fewer = run_with(with_shapes(law, shapes // 2), count, budget, close, FEWER)
        all_of_them = rough or run_with(law, count, budget, close, FEWER)
    except SceneError:  # so few modes may make the plate more curved than the sphere
        return UNKNOWN
    if not (fewer.inertia.complete and all_of_them.inertia.complete):
        return UNKNOWN
    changed = compare(fewer, all_of_them).inertia
    short = all_of_them.max_contact_radius / law.model.R / shapes
    time, depth, force, radius, speed = (
        LEFT / IRREGULAR * changed.error_of_modes(name)
        + short * (SHORT_OF_RADIUS if name == "max_contact_radius" else SHORT)
        for name in OUTPUTS
    )
    return time, depth, force, radius, speed
