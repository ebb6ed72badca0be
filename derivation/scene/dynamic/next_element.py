"""The next time element of a contact with plate inertia: start, solution, accuracy, length."""

import math

import numpy as np

from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.time_element import LOST, A, P, TimeElement, element
from derivation.scene.numerics.collocation import NEWTON, ONSET, change_of_length, radau
from generated.arrays import Double as Array

LONGEST = 0.3
"""Largest length of an element in x."""
EARLY = 0.5
"""Coefficient of the additional growth of elements near the onset."""
PHASE = 0.75
"""Largest phase of a mode over an element, divided by the number of nodes [rad]."""
TURN = 2.0
"""Largest phase over an element of a shape whose only stiffness is the tension [rad]."""
SAFE = 0.1
"""Part of the tolerance for which elements that approach the end of a contact are chosen."""
WITHIN = 0.5
"""Remaining time from the approach over that from the radius, below which the latter is used."""
OWN = 1e3
"""Factor of the tolerance for the radius, relative to the largest value in its own element."""
ROUGH, ENDING = 1e2, 1e1
"""Factors of the tolerance for the force of a viscoelastic contact: in general, and in the element
in which it ends."""


def solved(
    problem: DynamicProblem,
    n: int,
    x: float,
    length: float,
    start: ImpactState,
    radius: float,
    before: list[TimeElement],
    enough: float,
) -> TimeElement | None:
    """Return the next element, from the slope of the one before it, if there is one, or a guess."""
    if before:
        guess = before[-1].element.slope_beyond(A, x + length * radau(n).x)
    else:
        guess = np.zeros(n) if radius else _onset(problem, n, length, -start.separation_speed)
    made = element(problem, n, x, length, start, radius, guess, enough)
    if made is None and before:  # an oscillating slope cannot be extrapolated
        made = element(problem, n, x, length, start, radius, np.zeros(n), enough)
    return made


def error_and_scales(
    problem: DynamicProblem, made: TimeElement, scale: Array, tolerance: float
) -> tuple[float, float, Array]:
    """Return the error of an element, the factor for the next length, and scales.

    The scales are the largest values of each quantity so far, shape (LOST, 1).
    """
    sizes = np.abs(made.element.rows[:LOST])
    largest = np.maximum(scale, sizes.max(axis=1, keepdims=True))
    unit = largest.copy()
    # At the end the radius determines the time of separation: it needs a relative accuracy.
    unit[A] = OWN * sizes[A].max()
    # A viscoelastic force is as rough as the rate of the radius. It is only integrated, but at the
    # end it determines the contact time.
    if problem.retardation_time:
        unit[P] *= ROUGH if made.element.rows[P].sum() > 0.0 else ENDING
    return *change_of_length((sizes / unit).max(axis=0), tolerance), largest


def next_length(last: TimeElement, x: float, change: float) -> float:
    """Return the length of the element after `last`, which ends at x.

    Except near the onset, the allowed length is uniform in time, not in x.
    """
    more = x**ONSET - last.element.x**ONSET
    more *= change * (1.0 + EARLY * more / x**ONSET)
    return min(LONGEST, float((x**ONSET + more) ** (1.0 / ONSET)) - x)


def begun(begin: ImpactState, radius: float) -> float:
    """Return the start of a contact in x: above 0 if the face has not recovered.

    Such a contact has no onset. Its time is counted from the moment at which the sphere, at its
    present speed, would have first touched a face that had recovered. With a later origin of time,
    the elements would be too coarse for the forces at a small radius. A plate that is more curved
    than the sphere touches it before, at a negative approach.
    """
    if not radius or begin.separation_speed >= 0.0:
        return 1.0 if radius else 0.0
    return min(1.0, float(abs(begin.approach / begin.separation_speed) ** (1.0 / ONSET)))


def _onset(problem: DynamicProblem, n: int, length: float, meeting: float) -> Array:
    """Return da/dx at the nodes after first contact: the depth grows at the approach speed."""
    rule = radau(n)
    goal = meeting * (length * rule.x) ** ONSET
    a = np.sqrt(goal * problem.depth * problem.contact.R) / problem.a
    for _ in range(NEWTON):  # from above, because depth grows faster than a^2
        at = problem.at(problem.a * a)
        move = (at.depth / problem.depth - goal) / (at.depth_a * (problem.a / problem.depth))
        a = np.maximum(a - move, 0.5 * a)
        if np.max(np.abs(move) / a) < 1e-3:
            break
    return np.asarray(np.linalg.solve(length * rule.integral, a), dtype=np.float64)


def left_after(last: TimeElement) -> float:
    """Return the remaining time of a contact at the present separation speed.

    At its end the square of the radius vanishes linearly in time. If fast modes bend the plate more
    than the sphere is curved, the approach vanishes long before; the remaining time then follows
    from the radius.
    """
    state, x = last.end, last.element.x + last.element.length
    if state.separation_speed <= 0.0:
        return math.inf
    narrowing = -2.0 * float(np.sum(last.element.slope)) / (ONSET * x ** (ONSET - 1))
    if narrowing <= 0.0:
        return math.inf
    left = state.approach / state.separation_speed
    return left if left * narrowing > WITHIN * last.radius else last.radius / narrowing


def longest(
    problem: DynamicProblem, n: int, x: float, state: ImpactState, left: float, tolerance: float
) -> float:
    """Return the largest length of an element by its fastest mode and the remaining time."""
    most = problem.fastest
    ahead = PHASE * n / most if most else math.inf
    ahead = min(ahead, _towards(n, tolerance) * left, stretched_step(problem, state))
    return float((x**ONSET + ahead) ** (1.0 / ONSET) - x)


def stretched_step(problem: DynamicProblem, state: ImpactState) -> float:
    """Return the largest duration of an element in which the plate stretches."""
    plane, modes = problem.middle_plane, problem.contact.modes
    if plane is None:
        return math.inf
    stiffness = plane.stiffness(modes.by_shape(state.q))
    square = float(np.max(problem.inverse_modal_mass[modes.first[: stiffness.size]] * stiffness))
    return TURN / math.sqrt(square) if square > 0.0 else math.inf


def _towards(n: int, tolerance: float) -> float:
    """Return the largest length of an element over the remaining time of a contact.

    At the end the square of the radius vanishes linearly. The Legendre coefficients of the radius
    decrease as z^-n, with z + 1/z = 2 (2/p - 1) for an element that takes a part p of the time.
    """
    z = math.pow(SAFE * tolerance, -1.0 / n)
    return 4.0 / (2.0 + z + 1.0 / z)
