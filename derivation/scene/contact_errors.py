"""Errors of contacts that do not end, or that have no solution."""

import numpy as np

from derivation.scene.dynamic_problem import DynamicProblem, ImpactState
from derivation.scene.effects.inertia import WIDER
from derivation.scene.errors import IncompleteError
from derivation.scene.yield_events import turned

SHARP = 0.05
"""Slope of the gap over that without vibration below which the contact is no longer circular."""


def endless(problem: DynamicProblem, t: float, most: int) -> IncompleteError:
    """Return the error of a simulation with too many time steps."""
    return IncompleteError(
        f"the sphere was still in contact {problem.T * t:.6g} s after the first contact, when the "
        f"limit of {most} time steps was reached",
        "reduce inertia.modes, increase accuracy.rtol, or set effects.inertia = false",
    )


def lost(
    problem: DynamicProblem, state: ImpactState, radius: float, time: float
) -> IncompleteError:
    """Return the error of a contact without a solution: too wide, not circular, or extreme."""
    why, remedy = "has no solution that can be found", "use less extreme values"
    beyond = np.nextafter(problem.contact.top, 0.0) / problem.a
    if radius > 0.99 * beyond:
        why = f"grows wider than {problem.a * beyond:.4g} m, " + (
            f"the largest radius of the contact law: {problem.range_end}"
            if problem.range_end
            else f"{WIDER:g} times what the impact on a plate that does not deflect reaches"
        )
        remedy = "reduce impact.speed or impact.gravity, or use a lighter sphere or a thicker plate"
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
