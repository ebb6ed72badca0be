"""Flight between contacts while the plate stretches: time elements until the next contact.

Only the first shapes stretch the middle plane. Modes of the others vibrate freely, as in a flight
without stretching, and do not limit the length of the elements.

Most flights last until the sphere has left the reach of the plate. A rough simulation, in which
fewer shapes stretch the plate, usually shows that no contact follows.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legvander

from derivation.scene.dynamic.flight import (
    AT_ONCE,
    RECOVERED,
    STEP,
    may_touch,
    remaining_depth,
    side_by_side,
    slow_modes,
)
from derivation.scene.dynamic.middle_plane import MiddlePlane
from derivation.scene.dynamic.modal import Indices
from derivation.scene.dynamic.next_element import PHASE, stretched_step
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.time_element import E, TimeElement, W, free_element
from derivation.scene.errors import IncompleteError
from derivation.scene.numerics.collocation import ONSET, change_of_length, radau
from derivation.scene.numerics.crossing import rise
from generated.arrays import Double as Array

BEGIN = 1.0
"""Start of a flight in x; the elements are then nearly uniform in time."""
SHORTEST = 1e-6
"""Length of an element over the first one tried at which the flight has no solution."""
ACCURATE = 150.0
"""Phase of the fastest shape that stretches the plate, after which a rough simulation may show that
no contact follows [rad]. On a plate that is thinner than half its radius, the shear waves of the
last contact have then crossed the thickness, at which the history of the stress ends."""
MISSING = 2.0
"""Safety factor of the forces of stretching that a rough simulation omits, because they are
evaluated at the ends of its elements only."""
SOFTER = 0.25
"""Lower bound on the stretching energy over that of the static deflection by a point force, for
equal deflections on the axis. The least ratio of any shape is 0.48 on a clamped plate, 0.30 on a
simply supported one and 0.56 with the paper's edge, for Poisson's ratios from -0.99 to 0.49. It is
the minimum of a convex function; a lower bound by duality equals it."""


class FlightPiece(NamedTuple):
    """An element of a flight.

    Attributes
    ----------
    made
        The element of the modes that stretch the plate.
    since
        Its start after the separation, in units of the problem.
    start
        The state of all modes there.
    """

    made: TimeElement
    since: float
    start: ImpactState

    @property
    def end(self) -> float:
        """End of the element after the separation."""
        element = self.made.element
        return (element.x + element.length) ** ONSET - BEGIN


class Flight(NamedTuple):
    """A flight: its elements, the state at its end, and whether it ends with a contact."""

    pieces: tuple[FlightPiece, ...]
    end: ImpactState
    met: bool


@dataclass(frozen=True)
class FlightProblem:
    """The problem of a flight: the modes that stretch the plate, and the others.

    Attributes
    ----------
    whole
        The problem of the impact.
    """

    whole: DynamicProblem

    @cached_property
    def indices(self) -> tuple[Indices, Indices]:
        """Indices of the modes that stretch the plate, the lowest of their shapes, and others."""
        plane, modes = self.whole.middle_plane, self.whole.contact.modes
        assert plane is not None
        own = modes.first[: plane.slopes.shape[0]]
        return own, np.delete(np.arange(modes.omega.size), own)

    @cached_property
    def stretched(self) -> DynamicProblem:
        """The problem of the modes that stretch the plate."""
        return self._part(self.indices[0], self.whole.middle_plane)

    @cached_property
    def others(self) -> DynamicProblem:
        """The problem of the other modes, without stretching."""
        return self._part(self.indices[1], None)

    def _part(self, modes: Indices, plane: MiddlePlane | None) -> DynamicProblem:
        whole = self.whole
        contact = replace(whole.contact, modes=whole.contact.modes.some(modes))
        return replace(whole, contact=contact, middle_plane=plane, retardation_time=0.0)

    def split(self, state: ImpactState) -> tuple[ImpactState, ImpactState]:
        """Return the states of both parts."""
        own, others = (
            state._replace(q=state.q[part], q_dot=state.q_dot[part]) for part in self.indices
        )
        return own, others

    def joined(self, stretched: ImpactState, others: ImpactState, moved: float) -> ImpactState:
        """Return the state of all modes; the others have moved the face by a distance."""
        return stretched._replace(
            q=self.together(stretched.q, others.q),
            q_dot=self.together(stretched.q_dot, others.q_dot),
            approach=stretched.approach - moved,
        )

    def together(self, stretched: Array, others: Array) -> Array:
        """Return values of all modes, along the last axis."""
        values = np.empty((*stretched.shape[:-1], self.whole.omega.size))
        values[..., self.indices[0]], values[..., self.indices[1]] = stretched, others
        return values


def flight(
    problem: DynamicProblem,
    n: int,
    after: ImpactState,
    radius: float,
    most: int,
    tolerance: float,
) -> Flight:
    """Return the flight from a separation to the next contact, or until none is possible.

    Parameters
    ----------
    n
        Number of nodes of an element.
    after, radius
        State and radius at separation.
    most
        Largest number of elements.
    tolerance
        As for `impact_history`.

    Raises
    ------
    EndlessError
        If the flight needs more elements.
    """
    parts, x, state, pieces = FlightProblem(problem), BEGIN, after, list[FlightPiece]()
    wait = ACCURATE / parts.stretched.fastest
    accurate = max(wait, RECOVERED * problem.retardation_time)
    while len(pieces) < most:
        if _left(problem, state):
            return Flight(tuple(pieces), state, False)
        if x**ONSET - BEGIN >= accurate:
            near = next_approach(problem, n, x, state, most)
            if near is None:
                return Flight(tuple(pieces), state, False)
            accurate = near + wait
        piece, met = _piece(parts, n, x, state, radius, tolerance)
        x = piece.made.element.x + piece.made.element.length
        state = state_after(parts, piece)
        pieces.append(piece)
        if met:
            return Flight(tuple(pieces), _touching(problem, state, piece.end, radius), True)
    raise side_by_side(problem, x**ONSET - BEGIN)


def _left(problem: DynamicProblem, state: ImpactState) -> bool:
    """Return whether no further contact is possible: the sphere has left the reach of the plate."""
    return state.velocity <= 0.0 and -state.displacement > reach(problem, state)


def next_approach(
    problem: DynamicProblem, n: int, x: float, state: ImpactState, most: int
) -> float | None:
    """Return a time after the separation at which sphere and plate may be near each other.

    There is no contact up to it, and none at all if it is None. It follows from a rough simulation,
    in which few shapes stretch the plate. Forces of stretching that are missing move the face by at
    most their sum over all modes, integrated over time; a smaller gap counts as near.
    """
    rough, plane = problem.rough_plane, problem.middle_plane
    if rough is None or plane is None:
        return x**ONSET - BEGIN
    parts = FlightProblem(replace(problem, middle_plane=rough, rough_plane=None))
    longest, moved, missing = PHASE * n / parts.stretched.fastest, 0.0, 0.0
    by_shape, first = problem.contact.modes.by_shape, problem.contact.modes.first
    for _ in range(most):
        if _left(parts.whole, state):
            return None
        q, before = by_shape(state.q), missing
        missing = float(problem.strength[first] @ np.abs(plane.forces(q) - rough.forces(q)))
        rate = MISSING * max(before, missing)
        try:
            margin = moved + rate * longest
            piece, near = _piece(parts, n, x, state, 0.0, math.inf, margin)
        except IncompleteError:
            break
        if near:
            break
        x = piece.made.element.x + piece.made.element.length
        moved += rate * (piece.end - piece.since)
        state = state_after(parts, piece)
    return x**ONSET - BEGIN


def _touching(problem: DynamicProblem, state: ImpactState, t: float, radius: float) -> ImpactState:
    """Return a state in which sphere and face touch exactly, without the error of polynomials."""
    depth = 0.0
    if problem.retardation_time:
        depth = float(remaining_depth(problem, np.array([t]), radius, state.q[None])[0])
    return state._replace(approach=depth)


def _piece(
    parts: FlightProblem,
    n: int,
    x: float,
    state: ImpactState,
    radius: float,
    tolerance: float,
    margin: float | None = None,
) -> tuple[FlightPiece, bool]:
    """Return the next element, and whether it ends with a contact.

    With a margin, the element is not shortened, and the second result is whether the gap may be as
    small as the margin.
    """
    t, own, others = x**ONSET - BEGIN, *parts.split(state)
    ahead = min(PHASE * n / parts.stretched.fastest, stretched_step(parts.stretched, own))
    length = first = (x**ONSET + ahead) ** (1.0 / ONSET) - x

    def solved(length: float) -> tuple[TimeElement, Array, Array] | None:
        """Return an element, its overlap with a flat face that only its modes move, and these."""
        found = free_element(parts.stretched, n, x, length, own)
        if found is None:
            return None
        made, _, values = found
        return made, radau(n).analysis @ values.approach, radau(n).analysis @ values.q

    while (found := solved(length)) is None or (change := _shorter(found[0], tolerance)) < 1.0:
        length *= change if found else 0.5
        if length < SHORTEST * first:
            raise _unsolved(parts.whole, x)
    made, approach, q = found
    recovering = t < RECOVERED * parts.whole.retardation_time

    def since(s: Array) -> Array:
        return np.asarray((x + length * (1.0 + s) / 2.0) ** ONSET - x**ONSET)

    def at(s: Array, coefficients: Array) -> Array:
        return np.asarray(legvander(s, n - 1) @ coefficients, dtype=np.float64)

    def overlap_at(s: Array) -> Array:
        overlap = at(s, approach)
        block = max(1, AT_ONCE // parts.whole.omega.size)
        for some in (slice(k, k + block) for k in range(0, s.size, block)):
            vibrating = parts.others.deflections(others, since(s[some]), slice(None))
            overlap[some] -= np.sum(vibrating, axis=1) - np.sum(others.q)
            if recovering:
                face = parts.together(at(s[some], q), vibrating)
                overlap[some] -= remaining_depth(parts.whole, t + since(s[some]), radius, face)
        return overlap

    s = np.linspace(-1.0, 1.0, max(4 * n, math.ceil(ahead * parts.whole.fastest / STEP)) + 1)
    near = np.arange(1, s.size)
    if not recovering:
        slow, change = slow_modes(parts.others, others)
        change += margin or 0.0
        steps = ahead * float(np.max(parts.others.omega[slow], initial=0.0)) / STEP
        rough, basis = _grid(max(4 * n, math.ceil(steps)) + 1, n)
        may = may_touch(parts.others, others, basis @ approach + change, since(rough), slow)
        if margin is not None:
            return FlightPiece(made, t, state), bool(np.any(may))
        near = near[(may[:-1] | may[1:])[np.searchsorted(rough, s[1:]).clip(1) - 1]]
    near = near[overlap_at(s[near]) >= 0.0] if near.size else near
    if not near.size:
        return FlightPiece(made, t, state), False
    high = float(s[near[0]])
    low = float(s[near[0] - 1])
    met = rise(lambda s: float(overlap_at(np.array([s]))[0]), low, high)
    shorter = solved(length * (1.0 + met) / 2.0)
    if shorter is None:
        raise _unsolved(parts.whole, x)
    return FlightPiece(shorter[0], t, state), True


def _shorter(made: TimeElement, tolerance: float) -> float:
    """Return the factor for the length of an element that is not accurate enough; else 1.

    Free vibration is exact for any length, but the forces of stretching are polynomials. They are
    as smooth as the energy of the plate.
    """
    sizes = np.abs(made.element.rows[[W, E]])
    error, change = change_of_length((sizes / sizes.max(axis=1, keepdims=True)).max(0), tolerance)
    return change if error > tolerance else 1.0


@lru_cache(maxsize=4)
def _grid(count: int, n: int) -> tuple[Array, Array]:
    """Return evenly spaced points on [-1, 1], and the values of n Legendre polynomials there."""
    s = np.linspace(-1.0, 1.0, count)
    return s, np.asarray(legvander(s, n - 1), dtype=np.float64)


def _unsolved(problem: DynamicProblem, x: float) -> IncompleteError:
    """Return the error of a flight without a solution."""
    time = problem.T * (x**ONSET - BEGIN)
    return IncompleteError(
        f"the vibration of the stretched plate has no solution {time:.3g} s after a contact",
        "reduce impact.speed, or set effects.stretching = false",
    )


def state_after(parts: FlightProblem, piece: FlightPiece) -> ImpactState:
    """Return the state of all modes at the end of an element."""
    others = parts.split(piece.start)[1]
    flown = parts.others.flown(others, piece.end - piece.since)
    return parts.joined(piece.made.end, flown, float(np.sum(flown.q) - np.sum(others.q)))


def reach(problem: DynamicProblem, state: ImpactState) -> float:
    """Return a bound on the deflection of the plate in free vibration, by its energy.

    Shapes that do not stretch the plate deflect by at most as much as with all energy.
    """
    plane, modes = problem.middle_plane, problem.contact.modes
    assert plane is not None
    energy = float(np.sum(problem.energies(state)))
    energy += float(plane.energy(modes.by_shape(state.q)))
    static = modes.by_shape(problem.inverse_modal_mass / problem.omega**2)
    soft, others = (float(np.sum(part)) for part in np.split(static, [plane.slopes.shape[0]]))
    quartic = SOFTER * float(plane.energy(static / soft))
    half = 0.25 / soft  # energy = square/(2 soft) + quartic square^2
    square = energy / (half + math.sqrt(half * half + quartic * energy))
    stretched = math.sqrt(square) + math.sqrt(2.0 * others * energy)
    return min(stretched, math.sqrt(2.0 * (soft + others) * energy))
