"""The end of a contact with plate inertia: the time at which its force vanishes."""

import numpy as np

from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.time_element import P, TimeElement, element
from derivation.scene.numerics.collocation import NEXT, radau

STEADY, CLOSE = 0.1, 1e-9
"""Largest change of the separation speed in the last step, and of its duration by an iteration that
has converged [1]."""


def last_element(
    problem: DynamicProblem,
    n: int,
    made: TimeElement,
    end: float,
    state: ImpactState,
    radius: float,
    enough: float = NEXT,
) -> TimeElement:
    """Return the element, shortened so that it ends where its force vanishes."""
    for _ in range(3):
        x = made.element.x
        guess = made.element.slope_at(x + (end - x) * radau(n).x)
        shorter = element(problem, n, x, end - x, state, radius, guess, enough)
        if shorter is None:
            break
        made, end = shorter, shorter.element.zero_near_end(P)
    return made


def released(
    problem: DynamicProblem, last: TimeElement, left: float
) -> tuple[float, ImpactState] | None:
    """Return duration and state at the end of the last step, in which P falls as t^(3/2).

    None if the separation speed changes so much, by fast modes, that P falls differently.
    """
    state, force = last.end, float(np.sum(last.element.rows[P]))
    shape = problem.contact.modes.shape
    pressed = problem.inverse_modal_mass * last.modal_forces[shape]
    stretched = np.zeros_like(pressed)
    if last.stretched is not None:
        pull = np.zeros(problem.contact.modes.phi.size)
        pull[: last.stretched.pull.shape[1]] = np.sum(last.stretched.pull, axis=0)
        stretched = problem.inverse_modal_mass * pull[shape]
    for _ in range(3):
        flown = problem.flown(state, left)
        push, shift = 0.4 * left, 2.0 / 7.0 * left * left
        moved = pressed * shift + stretched * (0.5 * left * left)
        after = ImpactState(
            flown.displacement - force * shift,
            flown.velocity - force * push,
            flown.q + moved,
            flown.q_dot + pressed * push + stretched * left,
            flown.approach - force * shift - float(np.sum(moved)),
        )
        speed = after.separation_speed
        if not abs(speed / state.separation_speed - 1.0) <= STEADY:
            return None
        more = after.approach / speed
        left += more
    return (left, after._replace(approach=0.0)) if abs(more) <= CLOSE * left else None
