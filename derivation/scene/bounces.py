"""A sphere on a plate that moves: contact after contact, and free flight between them."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from derivation.scene.collocation import ONSET, radau
from derivation.scene.dynamics import LOST, A, P, Piece, Problem, State, V, element, onset
from derivation.scene.effects.effect import Array
from derivation.scene.scene import SceneError

FIRST, LONGEST, SHORTEST, MOST = 0.05, 0.25, 1e-13, 20000
"""First, largest and least length of an element in x, and how many are tried."""
TOLERANCE = 1e-11
"""An element's last coefficients over the largest there are."""
PHASE = 0.45
"""Largest phase of an oscillator over an element, for each of its nodes."""
CLOSED = 1e-5
"""What is left of a contact when its end is taken in one step, over the time it took."""
TOWARDS = 0.75
"""How much of what is left of a contact an element may take."""
OWN = 1e3
"""How much less exact the radius may be beside the largest of its element."""
ROUGH = 1e2
"""How much less exact the force of a contact that lags may be."""
STEP, BLOCK, BLOCKS = 0.3, 256, 4000
"""Phase of the fastest oscillator between looks in flight, looks at once, and how many times."""
CONTACTS = 100
"""How many contacts are followed."""
RECOVERED = 60.0
"""Time over A_v after which a face is held to have recovered."""
STAYS = 20.0
"""Contact time over half a swing on the resting plate from which a sphere is held to stay."""
_HALVINGS = 80
LEFT = "the sphere has left the plate's reach"
"""Why a course ends."""


class Touching(NamedTuple):
    """A contact: when it began and ended, in units of the problem, its elements and states.

    `radius` is that at its beginning, not 0 where the face has not recovered from the last one.
    """

    start: float
    end: float
    radius: float
    pieces: tuple[Piece, ...]
    before: State
    after: State


@dataclass(frozen=True)
class Course:
    """All contacts of an impact, and why it ended."""

    problem: Problem
    contacts: tuple[Touching, ...]
    reason: str


def course(problem: Problem, n: int, tolerance: float = TOLERANCE) -> Course:
    """An impact from the first contact on, by elements of n nodes.

    Parameters
    ----------
    tolerance
        Of an element's last coefficients over the largest there are [1].

    Raises
    ------
    SceneError
        If a contact cannot be followed, or the sphere's weight keeps it on the plate.
    """
    t, radius, state, found = 0.0, 0.0, problem.begin(), list[Touching]()
    # Who would not come back but by the weight has left: what follows is another impact.
    weightless = replace(problem, weight=0.0)
    while True:
        touching = contact(problem, n, state, t, radius, tolerance)
        found.append(touching)
        wait, radius = meeting(weightless, touching.after, touching.pieces[-1].radius)
        if problem.weight and wait < math.inf:
            wait, radius = meeting(problem, touching.after, touching.pieces[-1].radius)
        if wait == math.inf:
            return Course(problem, tuple(found), LEFT)
        if math.isnan(wait) or len(found) == CONTACTS:
            raise SceneError(
                f"effects.inertia: expected a sphere that leaves the plate, got one that still "
                f"{'hovers above' if math.isnan(wait) else 'touches'} it after {len(found)} "
                "contacts; give a thicker plate or a lighter sphere, or false for a plate at rest"
            )
        t, state = touching.end + wait, problem.flown(touching.after, wait)
        if not radius:
            state = state._replace(into=0.0)


def contact(
    problem: Problem,
    n: int,
    begin: State,
    start: float,
    radius: float,
    tolerance: float = TOLERANCE,
) -> Touching:
    """A contact, element by element, until the force is gone.

    Parameters
    ----------
    radius
        At its beginning: above 0 where the face has not recovered from the contact before.
    tolerance
        As `course` takes it.
    """
    found: list[Piece] = []
    # A contact that goes on has no onset; counted from an earlier x its times are regular.
    x, length, state, first = (1.0 if radius else 0.0), FIRST, begin, radius
    origin = start - x**ONSET
    # Before a quantity has grown, what counts is how large it will be.
    scale = np.full((LOST, 1), 0.1)
    for _ in range(MOST):
        length = min(length, _longest(problem, n, x, state if found else None))
        if length < SHORTEST * max(x, 1.0):
            break
        if found:
            guess = found[-1].element.slope_at(x + length * radau(n).x)
        else:
            guess = np.zeros(n) if first else onset(problem, n, length, -begin.opening)
        made = element(problem, n, x, length, state, radius, guess)
        if made is None:
            length *= 0.5
            continue
        rows = made.element.rows[:LOST]
        largest = np.maximum(scale, np.max(np.abs(rows), axis=1, keepdims=True))
        # Where the contact closes its radius matters beside itself: it says when.
        unit = np.vstack((OWN * np.max(np.abs(rows[A])), largest[V:]))
        if problem.lag:  # a force by the radius' rate is as rough as that, and only integrated
            unit[P] *= ROUGH
        error = float(np.max(np.abs(rows[:, -2:]) / unit))
        change = 0.9 * (tolerance / max(error, 1e-300)) ** (1.0 / n)
        if error > tolerance:
            length *= min(0.8, max(0.1, change))
            continue
        if float(np.sum(rows[P])) <= 0.0:  # a contact that lags lets go before it is flat
            last = _let_go(problem, n, made, state, radius)
            ended = origin + (last.element.x + last.element.length) ** ONSET
            return Touching(start, ended, first, (*found, last), begin, last.end)
        found.append(made)
        _check_weight(problem, x + length)
        x, state, radius, scale = x + length, made.end, made.radius, largest
        length = min(LONGEST, length * min(2.0, change))
        left = _left(state)
        if left < CLOSED * x**ONSET and not problem.lag:
            more, after = _released(problem, made, left)
            return Touching(start, start + x**ONSET + more, first, tuple(found), begin, after)
    raise _lost(problem, state, radius, problem.T * (origin + x**ONSET))


def _lost(problem: Problem, state: State, radius: float, time: float) -> SceneError:
    """Why a contact cannot be followed any further."""
    why = "that cannot; give less extreme numbers"
    beyond = np.nextafter(problem.contact.top, 0.0) / problem.a
    if radius > 0.99 * beyond:
        why = f"that grows wider than {problem.a * beyond:.4g} m, which is more than a blow on a "
        why += "stiff plate does; give a lower speed, a lighter sphere or less weight"
    for a in (radius, 1.2 * radius):  # where it is, and where it would go
        at = problem.contact.at(problem.a * np.array([min(a, beyond)]))
        if not at.depth_a[0] / problem.depth + at.less_a[0] @ state.q > 0.0:
            why = "under which the plate bends more sharply than the sphere is round; give a "
            why += "smaller sphere or a thicker plate"
    return SceneError(
        f"effects.inertia: expected a contact that can be followed to its end, got one at "
        f"{time:.6g} s {why}"
    )


def _left(state: State) -> float:
    """How long a contact lasts if sphere and plate part as fast as now."""
    return state.into / state.opening if state.opening > 0.0 else math.inf


def _longest(problem: Problem, n: int, x: float, state: State | None) -> float:
    """Length an element may have: by the fastest oscillator, and not beyond the release."""
    most = float(np.max(problem.omega, initial=0.0))
    ahead = PHASE * n / most if most else math.inf
    if state is not None:
        ahead = min(ahead, TOWARDS * _left(state))
    return float((x**ONSET + ahead) ** (1.0 / ONSET) - x)


def _check_weight(problem: Problem, x: float) -> None:
    """Refuse a sphere that its weight keeps on the plate: it stays far longer than it swings."""
    swing = math.pi * math.sqrt(float(np.sum(problem.drive / problem.omega**2)))
    if problem.weight and x**ONSET > STAYS * max(1.0, swing):
        raise SceneError(
            "impact.gravity: expected a sphere that comes off again, but its weight keeps it on "
            "the plate; give a higher impact.speed"
        )


def _let_go(problem: Problem, n: int, made: Piece, state: State, radius: float) -> Piece:
    """The element that ends where its force does."""
    for _ in range(3):
        x, end = made.element.x, made.element.end(P)
        guess = made.element.slope_at(x + (end - x) * radau(n).x)
        shorter = element(problem, n, x, end - x, state, radius, guess)
        if shorter is None:
            break
        made = shorter
    return made


def _released(problem: Problem, last: Piece, left: float) -> tuple[float, State]:
    """The last of a contact, as a half-space's: the force falls by the power 3/2 of the time."""
    state, force = last.end, float(np.sum(last.element.rows[P]))
    after = state
    for _ in range(3):
        flown = problem.flown(state, left)
        push, shift = 0.4 * left, 2.0 / 7.0 * left * left
        moved, far = problem.drive * last.felt * shift, problem.admittance * force * push
        after = State(
            flown.way - force * shift,
            flown.velocity - force * push,
            flown.q + moved,
            flown.rate + problem.drive * last.felt * push,
            flown.far + far,
            flown.into - force * shift - float(np.sum(moved)) - far,
        )
        left += after.into / after.opening
    return left, after._replace(into=0.0)


def meeting(problem: Problem, after: State, radius: float) -> tuple[float, float]:
    """When sphere and plate meet again after a release, and the radius of the face then.

    The time is infinite if they never do, and NaN if that is not found out. A contact that lags
    lets go at a radius above 0; the face then recovers by itself.
    """
    omega, state = problem.omega, after
    if not omega.size:
        return math.inf, 0.0
    reach = float(np.sum(np.hypot(state.q, state.rate / omega)))
    step, begin = STEP / float(np.max(omega)), 0.0
    t = step * np.arange(BLOCK + 1)
    turn = np.outer(t, omega)
    sin, cos, versed = np.sin(turn), np.cos(turn), 2.0 * np.sin(turn / 2.0) ** 2
    for _ in range(BLOCKS):
        bent = sin * (state.rate / omega) - versed * state.q
        into = state.into + state.velocity * t + 0.5 * problem.weight * t * t
        into -= np.sum(bent, axis=1)
        opening = cos @ state.rate - sin @ (state.q * omega) - state.velocity - problem.weight * t
        if problem.lag:
            into -= _pressed(problem, np.add(begin, t), radius, np.add(state.q, bent))
        turned = (opening[:-1] < 0.0) & (opening[1:] > 0.0)  # they come closest in between
        for k in np.flatnonzero((into[1:] >= 0.0) | turned):
            low, high = begin + float(t[k]), begin + float(t[k + 1])
            if into[k + 1] < 0.0:
                high = _where(lambda t: problem.flown(after, t).opening < 0.0, low, high)
            if _into(problem, after, high, radius) >= 0.0:
                met = _where(lambda t: _into(problem, after, t, radius) < 0.0, low, high)
                return met, float(_recovered(problem, np.array([met]), radius)[0])
        begin, state = begin + float(t[-1]), problem.flown(state, float(t[-1]))
        if state.far - state.way > reach and state.velocity <= 0.0:
            return math.inf, 0.0
    return math.nan, 0.0


def _into(problem: Problem, after: State, t: float, radius: float) -> float:
    """By how much the sphere is further than the face, a time after the release."""
    state = problem.flown(after, t)
    if not problem.lag:
        return state.into
    return state.into - float(_pressed(problem, np.array([t]), radius, state.q[None])[0])


def _pressed(problem: Problem, t: Array, radius: float, q: Array) -> Array:
    """How deep the face of a contact that lags is still pressed in."""
    at = problem.contact.at(problem.a * _recovered(problem, t, radius))
    return at.depth / problem.depth + np.asarray(np.sum(at.less * q, axis=1), dtype=np.float64)


def _recovered(problem: Problem, t: Array, radius: float) -> Array:
    """Radius at which the face is after a time without force: P_e falls like exp(-t/A_v)."""
    none = np.zeros_like(t)
    if not problem.lag or not np.any(t < RECOVERED * problem.lag):
        return none
    grid = radius * np.linspace(0.0, 1.0, 64)
    root = np.cbrt(problem.contact.at(problem.a * grid).force)
    goal = root[-1] ** 3 * np.exp(-np.minimum(t / problem.lag, RECOVERED))
    a = np.interp(np.cbrt(goal), root, grid)
    for _ in range(3):
        at = problem.contact.at(problem.a * a)
        a = a * np.cbrt(goal / at.force)
    return np.where(t < RECOVERED * problem.lag, a, none)


def _where(before: Callable[[float], bool], low: float, high: float) -> float:
    """Where a condition that holds at `low` ceases to."""
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if before(middle) else (low, middle)
    return high
