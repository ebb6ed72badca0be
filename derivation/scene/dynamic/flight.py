"""Free flight between contacts: the time of the next contact, if there is one."""

import math

import numpy as np
from numpy.typing import NDArray

from derivation.scene.dynamic.contact_errors import or_quasi_static
from derivation.scene.dynamic.modal import Indices
from derivation.scene.dynamic.oscillators import FreeMotion
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.errors import EndlessError
from derivation.scene.numerics.crossing import rise
from generated.arrays import Double as Array

STEP, BLOCK, BLOCKS = 0.3, 256, 4000
"""Phase of the fastest mode between evaluations, evaluations per block, and number of blocks."""
AT_ONCE = 2**18
"""Number of values of modes that are computed at once: most flights with many modes are decided
after a few evaluations."""
FAST = 0.1
"""Sum of the amplitudes of modes over the gap below which they cannot close it, and over that of
all modes below which their motion need not be known to exclude a contact at most times."""
RECOVERED = 20.0
"""Time over A_v after which a face counts as recovered: its depth has decayed to 2e-6 of the
initial one."""
MODE_WORK, BLOCK_WORK = 0.06, 200.0
"""Work of an evaluation of a mode, and additional work of a block of evaluations."""
SINCE = 1e-5
"""Part of the flight, or of A_v, in which the speed of a face that recovers is measured."""


def next_contact(
    problem: DynamicProblem, after: ImpactState, radius: float, most: float = math.inf
) -> tuple[float, float, float]:
    """Return the time from separation to the next contact, its radius at the start, and the work.

    The time is infinite if no further contact is possible. A viscoelastic contact ends at a radius
    above 0, and the face then recovers.

    Parameters
    ----------
    after, radius
        State and radius at separation.
    most
        Largest work; the first block may exceed it.

    Raises
    ------
    EndlessError
        If the next contact is not found, nor excluded, within `BLOCKS` blocks or the largest work.
    """
    omega, state, begin = problem.omega, after, 0.0
    reach = float(np.sum(np.hypot(state.q, state.q_dot / omega)))
    block = max(2, min(BLOCK, AT_ONCE // omega.size))
    t = STEP / float(np.max(omega)) * np.arange(block + 1)
    free = FreeMotion(np.outer(t, omega), problem.damping_ratio)
    work, each = 0.0, BLOCK_WORK + MODE_WORK * free.phase.size
    for _ in range(BLOCKS * (BLOCK // block)):
        if work and work + each > most:
            break
        work += each
        clear = _time_apart(problem, state)
        begin, state = begin + clear, problem.flown(state, clear)
        bent = free.sin * (state.q_dot / omega) - free.by_q * state.q
        into = state.approach + state.velocity * t + 0.5 * problem.weight * t * t
        into -= np.sum(bent, axis=1)
        opening = free.cos @ state.q_dot - free.sin @ (state.q * omega) - state.velocity
        opening -= problem.weight * t
        if problem.retardation_time:
            into -= remaining_depth(problem, np.add(begin, t), radius, np.add(state.q, bent))
        turned = (opening[:-1] < 0.0) & (opening[1:] > 0.0)  # the gap is smallest in between
        for k in np.flatnonzero((into[1:] >= 0.0) | turned):
            low, high = begin + float(t[k]), begin + float(t[k + 1])
            if into[k + 1] < 0.0:
                high = rise(lambda t: problem.flown(after, t).separation_speed, low, high)

            def overlap(t: float) -> float:
                return _overlap(problem, problem.flown(after, t), t, radius)

            if overlap(high) >= 0.0:
                met = rise(overlap, low, high)
                return met, float(recovering_radius(problem, np.array([met]), radius)[0]), work
        begin, state = begin + float(t[-1]), problem.flown(state, float(t[-1]))
        if -state.displacement > reach and state.velocity <= 0.0:
            return math.inf, 0.0, work
    raise side_by_side(problem, begin)


def side_by_side(problem: DynamicProblem, t: float) -> EndlessError:
    """Return the error of a flight that has not ended after a time."""
    return EndlessError(
        f"sphere and plate moved side by side without contact for {problem.T * t:.6g} s, the limit",
        f"use a thicker plate or a lighter sphere{or_quasi_static(problem)}",
    )


def meeting_speed(
    problem: DynamicProblem,
    after: ImpactState,
    radius: float,
    t: float,
    met: ImpactState | None = None,
) -> float:
    """Return the speed at which sphere and face meet at a time after separation.

    While a viscoelastic surface recovers from a contact, it may touch a sphere that moves away from
    the plate.

    Parameters
    ----------
    after, radius
        State and radius at separation.
    met
        State at the time, if the plate stretches: free vibration then leads to it only for a short
        time before.
    """
    if not problem.retardation_time:
        return -(met or problem.flown(after, t)).separation_speed
    # They may also touch again immediately.
    step = SINCE * (min(t, problem.retardation_time) or problem.retardation_time)
    t = max(t, step)
    now, before = problem.flown(after, t), problem.flown(after, t - step)
    if met is not None:
        now, before = met, problem.flown(met, -step)
    return (_overlap(problem, now, t, radius) - _overlap(problem, before, t - step, radius)) / step


def _time_apart(problem: DynamicProblem, state: ImpactState) -> float:
    """Return a time during which sphere and plate cannot touch, from the slow modes.

    The amplitudes of the fast modes add up to a fraction of the gap. The remaining depth of a
    viscoelastic face only increases the gap, and damping only reduces amplitudes.
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
    # The fast modes may change by twice their amplitudes.
    near = np.flatnonzero(into + 2.0 * float(beyond[slow]) >= 0.0)
    return float(t[max(int(near[0]) - 1, 0)]) if near.size else float(t[-1])


def slow_modes(problem: DynamicProblem, state: ImpactState) -> tuple[Indices, float]:
    """Return the slowest modes, and a bound on the change of the deflection by all others."""
    order = problem.by_speed
    amplitudes = np.hypot(state.q[order], state.q_dot[order] / problem.omega[order])
    beyond = np.append(np.cumsum(amplitudes[::-1])[::-1], 0.0)
    count = int(np.argmax(beyond <= FAST * beyond[0]))
    return order[:count], 2.0 * float(beyond[count])


def may_touch(
    problem: DynamicProblem, state: ImpactState, overlap: Array, since: Array, modes: Indices
) -> NDArray[np.bool_]:
    """Return whether an overlap may be positive at times, less the deflection of some free modes.

    Their amplitudes decide at most times.
    """
    most = 2.0 * float(np.sum(np.hypot(state.q[modes], state.q_dot[modes] / problem.omega[modes])))
    near = np.flatnonzero(overlap + most >= 0.0)
    block = max(1, AT_ONCE // max(1, modes.size))
    for some in (near[k : k + block] for k in range(0, near.size, block)):
        vibrating = problem.deflections(state, since[some], modes)
        overlap[some] -= np.sum(vibrating, axis=1) - np.sum(state.q[modes])
    found = np.zeros(overlap.size, dtype=np.bool_)
    found[near] = overlap[near] >= 0.0
    return found


def _overlap(problem: DynamicProblem, state: ImpactState, t: float, radius: float) -> float:
    """Return the overlap of sphere and face in a state, a time after separation."""
    if not problem.retardation_time:
        return state.approach
    return state.approach - float(remaining_depth(problem, np.array([t]), radius, state.q[None])[0])


def remaining_depth(problem: DynamicProblem, t: Array, radius: float, q: Array) -> Array:
    """Return the remaining depth of the face after a viscoelastic contact."""
    at = problem.at(problem.a * recovering_radius(problem, t, radius))
    by_shape = problem.contact.modes.by_shape
    lagging = by_shape(problem.lagging(radius, t)[0])
    moved = np.sum(lagging + at.weights_less_one * (by_shape(q) + lagging), axis=1)
    return at.depth / problem.depth + np.asarray(moved, dtype=np.float64)


def recovering_radius(problem: DynamicProblem, t: Array, radius: float) -> Array:
    """Return the radius of the face after a time without force: P_e decays as exp(-t/A_v)."""
    none = np.zeros_like(t)
    if not problem.retardation_time or not np.any(t < RECOVERED * problem.retardation_time):
        return none
    a = problem.recovering(radius, np.minimum(t / problem.retardation_time, RECOVERED))
    return np.where(t < RECOVERED * problem.retardation_time, a, none)
