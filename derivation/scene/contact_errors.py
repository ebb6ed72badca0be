"""Errors of contacts that do not end, or that have no solution."""

import numpy as np

from derivation.scene.dynamic_problem import DynamicProblem, ImpactState
from derivation.scene.effects.inertia import WIDER
from derivation.scene.errors import IncompleteError, wide_contact
from derivation.scene.yield_events import turned

STUCK = 1e-7
"""Length of an element in x, over max(x, 1), at which one without a solution ends the simulation.
In 75 impacts, shorter elements had a solution only after failures of elements longer than 6e-5."""
TOO_WIDE = 1.05
"""Contact radius over the limit of the law at which a simulation ends: so much wider that with more
modes it would not be within the limit."""
SHARP = 0.05
"""Slope of the gap over that without vibration below which the contact is no longer circular."""


def endless(problem: DynamicProblem, t: float, most: int) -> IncompleteError:
    """Return the error of a simulation with too many time steps."""
    return IncompleteError(
        f"the sphere was still in contact {problem.T * t:.6g} s after the first contact, when the "
        f"limit of {most} time steps was reached",
        "reduce inertia.modes, increase accuracy.rtol, or set effects.inertia = false",
    )


def check_width(problem: DynamicProblem, radius: float) -> None:
    """Raise an error if a plastic contact is far wider than the law allows.

    Yielding widens a contact beyond the radius of the elastic law, at which its tables end. A
    contact that is not so wide is checked with the results.

    Parameters
    ----------
    radius
        Radius of the elastic law, in units of the problem.

    Raises
    ------
    SceneError
        If the contact radius exceeds `TOO_WIDE` times the limit.
    """
    branch, a = problem.yielding, problem.a * np.array([radius])
    if branch is None or not branch.loading:
        return
    widest = float(branch.widened(a, problem.contact.at(a).force)[0])
    if widest > TOO_WIDE * problem.limit:
        got = f"at least {widest:.6g}"
        raise wide_contact("impact.speed", problem.range_end, got, _narrower(problem))


def _narrower(problem: DynamicProblem) -> str:
    """Return what makes a contact narrower."""
    weight = " or impact.gravity" if problem.weight else ""
    return f"reduce impact.speed{weight}, or use a lighter sphere or a thicker plate"


def lost(
    problem: DynamicProblem, state: ImpactState, radius: float, time: float
) -> IncompleteError:
    """Return the error of a contact without a solution: too wide, not circular, or extreme."""
    why, remedy = "has no solution that can be found", "use less extreme values"
    beyond = np.nextafter(problem.contact.top, 0.0) / problem.a
    if radius > 0.99 * beyond:
        why = (
            f"grows wider than {problem.contact.top:.4g} m, {WIDER:g} times what the impact on a "
            "plate that does not deflect reaches"
        )
        if problem.contact.top >= problem.limit:
            why = f"grows wider than the contact law allows, {problem.range_end}"
        remedy = _narrower(problem)
    bent = problem.contact.modes.by_shape(state.q)
    # The present radius and a larger one, of a plastic contact also where unloading begins.
    for branch in (problem, turned(problem, radius)):
        for a in (radius, 1.2 * radius):
            at = branch.at(problem.a * np.array([min(a, beyond)]))
            own = at.depth_a[0] / problem.depth
            if a > 0.0 and not own + at.less_a[0] @ bent > SHARP * own:
                why = "is not circular, because the plate is more curved than the sphere"
                remedy = "use a smaller sphere or a thicker plate"
    return IncompleteError(f"the contact at {time:.6g} s {why}", remedy)
