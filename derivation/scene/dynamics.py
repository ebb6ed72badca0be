"""A sphere on a plate that moves: an element of a contact.

With z the sphere's way, q_j the plate's oscillators (see `modal`), A_v the contact's lag,

    m z'' = m g - P,   P = P_e + A_v dP_e/dt >= 0,   z = rest(a) + sum s_j q_j

On an element of x = (t/T)^(1/6), t since the contact began, da/dx is a polynomial through
Radau's nodes. What an oscillator remembers is an integral over its sines, which at the nodes
is a matrix: no oscillator is stepped, and the only unknowns are the radii.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import legvander

from derivation.scene.collocation import NEWTON, ONSET, Element, newton_step, radau, settled
from derivation.scene.effects.effect import Array
from derivation.scene.modal import Contact, sinc_less_one

A, V, Z, P, W, E, LOST, LEAK = range(8)
"""Rows of an element: radius, velocity, way, force, the plate's deflection and energy, and per x
the energy lost and that which a closure at the axis leaks."""


class State(NamedTuple):
    """The sphere's way and velocity, the oscillators' and the endless plate's deflection.

    `into` is by how much the sphere has got further than the plate's face: the difference of
    way and deflections, which are not subtracted, as it may be far smaller.
    """

    way: float
    velocity: float
    q: Array
    rate: Array
    far: float
    into: float

    @property
    def opening(self) -> float:
        """How fast they part."""
        return float(np.sum(self.rate)) - self.velocity


@dataclass(frozen=True)
class Problem:
    """A scene in units of a contact: m, v0 and T; forces are m v0/T and depths v0 T.

    Attributes
    ----------
    contact
        Tables of the contact.
    a, T, m, v0
        Units of radius [m] and time [s], mass [kg] and speed [m/s].
    weight
        What presses the sphere on, in units of v0/T.
    lag
        A_v over T.
    """

    contact: Contact
    a: float
    T: float
    m: float
    v0: float
    weight: float = 0.0
    lag: float = 0.0

    @property
    def force(self) -> float:
        """Unit of forces [N]."""
        return self.m * (self.v0 / self.T)

    @property
    def depth(self) -> float:
        """Unit of depths [m]."""
        return self.v0 * self.T

    @property
    def omega(self) -> Array:
        """Angular frequencies."""
        return self.contact.modes.omega * self.T

    @property
    def drive(self) -> Array:
        """Acceleration of an oscillator by a unit force."""
        return self.contact.modes.drive * self.m

    @property
    def admittance(self) -> float:
        """Velocity of an endless plate by a unit force."""
        return self.contact.modes.admittance * (self.m / self.T)

    def begin(self) -> State:
        """Everything at the moment of first contact."""
        none = np.zeros_like(self.omega)
        return State(0.0, 1.0, none, none, 0.0, 0.0)

    def energies(self, state: State) -> Array:
        """Of each oscillator, over m v0^2."""
        return (state.rate**2 + (self.omega * state.q) ** 2) / (2.0 * self.drive)

    def flown(self, state: State, t: float) -> State:
        """A state after free flight."""
        turn = self.omega * t
        bent = state.rate * t * sinc_less_one(turn) - 2.0 * state.q * np.sin(turn / 2.0) ** 2
        fallen = 0.5 * self.weight * t * t
        return State(
            state.way + state.velocity * t + fallen,
            state.velocity + self.weight * t,
            state.q + state.rate * t + bent,
            state.rate * np.cos(turn) - state.q * self.omega * np.sin(turn),
            state.far,
            state.into - state.opening * t + (fallen - float(np.sum(bent))),
        )


class Nodes(NamedTuple):
    """An element's nodes: x, times, dt/dx, integrals from its start to each, over x and t."""

    x: Array
    t: Array
    since: Array
    rate: Array
    by_x: Array
    by_t: Array
    cos: Array
    sin: Array
    free: Array


class Values(NamedTuple):
    """What is at the nodes for a radius and its slope y."""

    a: Array
    y: Array
    v: Array
    z: Array
    q: Array
    far: Array
    into: Array
    force: Array
    felt: Array
    load_a: Array
    load_y: Array
    depth: Array
    depth_a: Array
    share: Array


class Piece(NamedTuple):
    """An element with what is at its end: state, radius, and the force each oscillator feels."""

    element: Element
    end: State
    radius: float
    felt: Array


def nodes_of(problem: Problem, n: int, x: float, length: float, start: State) -> Nodes:
    """The nodes of an element."""
    rule = radau(n)
    xs = x + length * rule.x
    t, rate = xs**ONSET, ONSET * xs ** (ONSET - 1)
    since = t - x**ONSET
    turn = np.outer(since, problem.omega)
    cos, sin = np.cos(turn), np.sin(turn)
    free = start.rate * since[:, None] * sinc_less_one(turn)
    free -= 2.0 * start.q * np.sin(turn / 2.0) ** 2
    by_x = length * rule.integral
    return Nodes(xs, t, since, rate, by_x, by_x * rate, cos, sin, free)


def values_at(problem: Problem, nodes: Nodes, start: State, radius: float, y: Array) -> Values:
    """Forces, depths and oscillators at the nodes, for a slope da/dx there."""
    a = radius + nodes.by_x @ y
    at = problem.contact.at(problem.a * a)
    felt = np.column_stack((at.force, at.felt)) / problem.force
    felt_a = np.column_stack((at.force_a, at.felt_a)) * (problem.a / problem.force)
    # The pressure keeps its shape: what lags is felt like the rest, and is gone when P is.
    load_y = (problem.lag / nodes.rate * felt_a[:, 0] / felt[:, 0])[:, None] * felt
    load = felt + load_y * y[:, None]
    force, driven = load[:, 0], load[:, 1:]
    slowed = nodes.by_t @ force
    fallen = 0.5 * problem.weight * nodes.since**2 - nodes.by_t @ slowed
    swing = nodes.sin * (nodes.by_t @ (nodes.cos * driven))
    swing -= nodes.cos * (nodes.by_t @ (nodes.sin * driven))
    # What goes evenly is taken apart: sphere and plate may part far slower than they move.
    bent = nodes.free + problem.drive / problem.omega * swing
    even, far = nodes.since[:, None] * start.rate, problem.admittance * slowed
    q = start.q + even + bent
    return Values(
        a,
        y,
        start.velocity + problem.weight * nodes.since - slowed,
        start.way + start.velocity * nodes.since + fallen,
        q,
        start.far + far,
        start.into - start.opening * nodes.since + (fallen - np.sum(bent, axis=1) - far),
        force,
        driven,
        felt_a + 2.0 * load_y * (y / a)[:, None],  # d2P/da2 is nearly (2/a) dP/da
        load_y,
        at.depth / problem.depth + np.sum(at.less * q, axis=1),
        (at.depth_a / problem.depth + np.sum(at.less_a * q, axis=1)) * problem.a,
        1.0 + at.less,
    )


def element(
    problem: Problem, n: int, x: float, length: float, start: State, radius: float, y: Array
) -> Piece | None:
    """An element, by Newton's iteration from a guess of da/dx; None if it does not converge."""
    nodes, size = nodes_of(problem, n, x, length, start), math.inf
    for _ in range(NEWTON):
        at = values_at(problem, nodes, start, radius, y)
        if not np.all(at.a > 0.0):
            return None
        system = _system(problem, nodes, at) / nodes.t[:, None]
        step = newton_step(system, (at.into - at.depth) / nodes.t, nodes.by_x, at.a)
        if step is None:
            return None
        y, before, size = y + step[0], size, step[1]
        if settled(size, before):
            return _piece(problem, nodes, at, start, x, length)
    return None


def _system(problem: Problem, nodes: Nodes, at: Values) -> Array:
    """Slope of depth less way by da/dx at the nodes."""
    weighted = at.share * (problem.drive / problem.omega)
    sines, cosines = weighted * nodes.sin, weighted * nodes.cos
    by_force = nodes.by_t @ nodes.by_t + problem.admittance * nodes.by_t

    def by_load(load: Array) -> Array:
        swing = sines @ (nodes.cos * load[:, 1:]).T - cosines @ (nodes.sin * load[:, 1:]).T
        return np.asarray(by_force * load[:, 0] + nodes.by_t * swing, dtype=np.float64)

    found = (np.diag(at.depth_a) + by_load(at.load_a)) @ nodes.by_x
    return found + by_load(at.load_y) if problem.lag else found


def _piece(
    problem: Problem, nodes: Nodes, at: Values, start: State, x: float, length: float
) -> Piece:
    """The element as polynomials, and its end."""
    driven, force, rate = at.felt, at.force, nodes.rate
    swing = nodes.cos * (nodes.by_t @ (nodes.cos * driven))
    swing += nodes.sin * (nodes.by_t @ (nodes.sin * driven))
    moving = start.rate * nodes.cos - start.q * problem.omega * nodes.sin + problem.drive * swing
    plate = np.sum((moving**2 + (problem.omega * at.q) ** 2) / (2.0 * problem.drive), axis=1)
    lost = problem.admittance * force**2 * rate
    if problem.lag:
        felt = at.load_y[:, 1:] / at.load_y[:, :1]
        lost += at.load_y[:, 0] * at.y * (at.v - np.sum(felt * moving, axis=1)) * rate
    leak = np.zeros_like(force)
    if problem.contact.pointwise:
        leak = np.sum((force[:, None] - driven) * moving, axis=1) * rate
    deflection = np.sum(at.q, axis=1) + at.far
    rule = radau(nodes.x.size)
    rows = np.array([at.a, at.v, at.z, force, deflection, plate, lost, leak]) @ rule.analysis.T
    made = Element(x, length, rows, rule.analysis @ at.y)
    z, v, far, into = (float(row[-1]) for row in (at.z, at.v, at.far, at.into))
    return Piece(made, State(z, v, at.q[-1], moving[-1], far, into), float(at.a[-1]), driven[-1])


def oscillating(problem: Problem, found: Element, start: State, radius: float, x: float) -> Array:
    """The oscillators' deflections at a place of an element."""
    n = found.slope.size
    nodes = nodes_of(problem, n, found.x, found.length, start)
    q = values_at(problem, nodes, start, radius, found.slope_at(nodes.x)).q
    s = 2.0 * (x - found.x) / found.length - 1.0
    return np.asarray(legvander([s], n - 1)[0] @ (radau(n).analysis @ q), dtype=np.float64)


def onset(problem: Problem, n: int, length: float, meeting: float) -> Array:
    """da/dx where a contact begins: the depth grows at the speed at which they meet."""
    rule = radau(n)
    goal = meeting * (length * rule.x) ** ONSET
    a = np.sqrt(goal * problem.depth * problem.contact.R) / problem.a
    for _ in range(NEWTON):  # depth grows faster than a^2: the iteration comes down
        at = problem.contact.at(problem.a * a)
        move = (at.depth / problem.depth - goal) / (at.depth_a * (problem.a / problem.depth))
        a = np.maximum(a - move, 0.5 * a)
        if np.max(np.abs(move) / a) < 1e-3:
            break
    return np.asarray(np.linalg.solve(length * rule.integral, a), dtype=np.float64)
