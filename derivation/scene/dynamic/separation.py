"""The end of a contact with plate inertia: the time at which its force vanishes."""

import numpy as np

from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.time_element import P, TimeElement, element
from derivation.scene.numerics.collocation import NEXT, radau


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


def released(problem: DynamicProblem, last: TimeElement, left: float) -> tuple[float, ImpactState]:
    """Return duration and state at the end of the last step, in which P falls as t^(3/2)."""
    state, force = last.end, float(np.sum(last.element.rows[P]))
    after, shape = state, problem.contact.modes.shape
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
        left += after.approach / after.separation_speed
    return left, after._replace(approach=0.0)
