"""Free flight between contacts: when sphere and plate meet again, if they do."""

import math
from collections.abc import Callable

import numpy as np

from derivation.scene.dynamic_problem import DynamicProblem, ImpactState
from derivation.scene.effects.effect import Array
from derivation.scene.oscillators import FreeMotion
from derivation.scene.scene import IncompleteError

STEP, BLOCK, BLOCKS = 0.3, 256, 4000
"""Phase of the fastest oscillator between looks in flight, looks at once, and how many times."""
AT_ONCE = 4_000_000
"""Values of oscillators that are computed at once, to bound the memory."""
FAST = 0.1
"""Share of the gap that the amplitudes of fast oscillators may add up to, to be passed over."""
RECOVERED = 20.0
"""Time over A_v after which a face counts as recovered: its depth has fallen to 2e-6."""
LOOK, LOOKS = 0.06, 200.0
"""Work of a look at an oscillator, and of a block of looks beside that."""
_HALVINGS = 80


def meeting(
    problem: DynamicProblem, after: ImpactState, radius: float, most: float = math.inf
) -> tuple[float, float, float]:
    """When sphere and plate meet again after a release, the radius of the face then, and the work.

    The time is infinite if they never do. A viscoelastic contact ends at a radius above 0; the
    face then recovers.

    Raises
    ------
    IncompleteError
        If this is not found out within `BLOCKS` blocks of looks, or with so much work at most
        beyond the first.
    """
    omega, state, begin = problem.omega, after, 0.0
    reach = float(np.sum(np.hypot(state.q, state.q_dot / omega)))
    block = max(2, min(BLOCK, AT_ONCE // omega.size))
    t = STEP / float(np.max(omega)) * np.arange(block + 1)
    free = FreeMotion(np.outer(t, omega), problem.damping_ratio)
    work, each = 0.0, LOOKS + LOOK * free.phase.size
    for _ in range(BLOCKS * (BLOCK // block)):
        if work and work + each > most:
            break
        work += each
        clear = _clear(problem, state)
        begin, state = begin + clear, problem.flown(state, clear)
        bent = free.sin * (state.q_dot / omega) - free.by_q * state.q
        into = state.approach + state.velocity * t + 0.5 * problem.weight * t * t
        into -= np.sum(bent, axis=1)
        opening = free.cos @ state.q_dot - free.sin @ (state.q * omega) - state.velocity
        opening -= problem.weight * t
        if problem.retardation_time:
            into -= _pressed(problem, np.add(begin, t), radius, np.add(state.q, bent))
        turned = (opening[:-1] < 0.0) & (opening[1:] > 0.0)  # they come closest in between
        for k in np.flatnonzero((into[1:] >= 0.0) | turned):
            low, high = begin + float(t[k]), begin + float(t[k + 1])
            if into[k + 1] < 0.0:
                high = _where(lambda t: problem.flown(after, t).separation_speed < 0.0, low, high)
            if _into(problem, after, high, radius) >= 0.0:
                met = _where(lambda t: _into(problem, after, t, radius) < 0.0, low, high)
                return met, float(_recovered(problem, np.array([met]), radius)[0]), work
        begin, state = begin + float(t[-1]), problem.flown(state, float(t[-1]))
        if -state.displacement > reach and state.velocity <= 0.0:
            return math.inf, 0.0, work
    raise IncompleteError(
        f"sphere and plate moved side by side without contact for {problem.T * begin:.6g} s, the "
        "limit",
        "use a thicker plate or a lighter sphere, or set effects.inertia = false for a "
        "quasi-static plate",
    )


def _clear(problem: DynamicProblem, state: ImpactState) -> float:
    """A time for which sphere and plate certainly stay apart, by looks at the slow oscillators.

    The fast ones, whose amplitudes add up to a part of the gap, cannot close it. What a
    viscoelastic face is still pressed in only widens the gap. Damping only reduces amplitudes.
    """
    order, gap = problem.by_speed, -state.approach
    omega, q, rate = (x[order] for x in (problem.omega, state.q, state.q_dot))
    beyond = np.cumsum(np.hypot(q, rate / omega)[::-1])[::-1]
    slow = max(1, int(np.searchsorted(-beyond, -FAST * gap)))
    if gap <= 0.0 or 2 * slow > order.size:
        return 0.0
    omega, q, rate = omega[:slow], q[:slow], rate[:slow]
    t = STEP / float(omega[-1]) * np.arange(max(2, min(BLOCK, AT_ONCE // slow)) + 1)
    free = FreeMotion(np.outer(t, omega), problem.damping_ratio)
    bent = free.sin @ (rate / omega) - free.by_q @ q
    into = state.approach + state.velocity * t + 0.5 * problem.weight * t * t - bent
    # The fast ones may go from one end of their swing to the other.
    near = np.flatnonzero(into + 2.0 * float(beyond[slow]) >= 0.0)
    return float(t[max(int(near[0]) - 1, 0)]) if near.size else float(t[-1])


def _into(problem: DynamicProblem, after: ImpactState, t: float, radius: float) -> float:
    """By how much the sphere is further than the face, a time after the release."""
    state = problem.flown(after, t)
    if not problem.retardation_time:
        return state.approach
    return state.approach - float(_pressed(problem, np.array([t]), radius, state.q[None])[0])


def _pressed(problem: DynamicProblem, t: Array, radius: float, q: Array) -> Array:
    """How deep the face of a viscoelastic contact is still pressed in."""
    at = problem.at(problem.a * _recovered(problem, t, radius))
    moved = np.sum(at.less * problem.contact.modes.by_shape(q), axis=1)
    return at.depth / problem.depth + np.asarray(moved, dtype=np.float64)


def _recovered(problem: DynamicProblem, t: Array, radius: float) -> Array:
    """Radius at which the face is after a time without force: P_e falls like exp(-t/A_v)."""
    none = np.zeros_like(t)
    if not problem.retardation_time or not np.any(t < RECOVERED * problem.retardation_time):
        return none
    grid = radius * np.linspace(0.0, 1.0, 64)
    root = np.cbrt(problem.contact.at(problem.a * grid).force)
    goal = root[-1] ** 3 * np.exp(-np.minimum(t / problem.retardation_time, RECOVERED))
    a = np.interp(np.cbrt(goal), root, grid)
    for _ in range(3):
        at = problem.contact.at(problem.a * a)
        a = a * np.cbrt(goal / at.force)
    return np.where(t < RECOVERED * problem.retardation_time, a, none)


def _where(before: Callable[[float], bool], low: float, high: float) -> float:
    """Where a condition that holds at `low` ceases to."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        if not low < middle < high:  # no number lies between them
            break
        low, high = (middle, high) if before(middle) else (low, middle)
    return high
