"""Time integration of one contact with plate inertia: a single collocation element.

With z the sphere's displacement, q_j the sum of the oscillators of shape j (see `modal`) and A_v
the retardation time of the contact,

    m z'' = m g - P,   P = P_e + A_v dP_e/dt >= 0,   z = quasi-static(a) + sum s_j q_j

On an element of x = (t/T)^(1/6), t since the contact began, da/dx is a polynomial through Radau's
nodes. The response of a shape to its force is an integral over the sines of its oscillators. At
the nodes this is a matrix, made once per element: no oscillator is stepped, and the only unknowns
are the contact radii.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene.collocation import NEWTON, ONSET, Element, converged, newton_step, radau
from derivation.scene.effects.effect import Array
from derivation.scene.modal import ContactSamples, ContactTables
from derivation.scene.oscillators import FreeMotion, Response, response_at
from derivation.scene.yielding import Yielding

A, V, Z, P, W, E, LOST, LEAK, DAMPED = range(9)
"""Rows of an element: radius, velocity, displacement, force, the plate's deflection and energy, and
per x the energy lost in the contact, by the pointwise coupling and by the plate's damping."""
PART = 2048
"""Oscillators that are computed at once, so that their values at the nodes stay in the cache."""


class ImpactState(NamedTuple):
    """Displacement and velocity of the sphere, deflection and velocity of the modes.

    `approach` is the displacement of the sphere less the deflection of the plate. It is integrated
    and not subtracted, as it may be far smaller than both.
    """

    displacement: float
    velocity: float
    q: Array
    q_dot: Array
    approach: float

    @property
    def separation_speed(self) -> float:
        """Velocity of the plate less that of the sphere: positive while they separate."""
        return float(np.sum(self.q_dot)) - self.velocity


@dataclass(frozen=True)
class DynamicProblem:
    """A scene in units of a contact: m, v0 and T; forces are m v0/T and depths v0 T.

    Attributes
    ----------
    contact
        Tables of the contact.
    a, T, m, v0
        Units of radius [m] and time [s], mass [kg] and speed [m/s].
    weight
        What presses the sphere on, in units of v0/T.
    retardation_time
        A_v over T.
    heard
        Time from which waves may return from the edge of a plate that is to have none.
    damping_ratio
        Damping ratio of every mode [1].
    yielding
        The contact that yields, on the branch on which it is; None of an elastic one.
    range_end
        Which limit of the contact law ends its tables; empty if none does.
    """

    contact: ContactTables
    a: float
    T: float
    m: float
    v0: float
    weight: float = 0.0
    retardation_time: float = 0.0
    heard: float = math.inf
    damping_ratio: float = 0.0
    yielding: Yielding | None = None
    range_end: str = ""

    @property
    def force(self) -> float:
        """Unit of forces [N]."""
        return self.m * (self.v0 / self.T)

    @property
    def depth(self) -> float:
        """Unit of depths [m]."""
        return self.v0 * self.T

    @cached_property
    def omega(self) -> Array:
        """Angular frequencies."""
        return self.contact.modes.omega * self.T

    @cached_property
    def inverse_modal_mass(self) -> Array:
        """Acceleration of a mode by a unit force."""
        return self.contact.modes.inverse_modal_mass * self.m

    @cached_property
    def parts(self) -> tuple[slice, ...]:
        """The oscillators, so many at once."""
        return tuple(slice(k, k + PART) for k in range(0, self.omega.size, PART))

    @cached_property
    def by_speed(self) -> NDArray[np.intp]:
        """Order of the oscillators, the slowest first."""
        return np.argsort(self.omega, kind="stable")

    def at(self, a: Array) -> ContactSamples:
        """The contact at radii [m], and what yielding adds to its depth."""
        found = self.contact.at(a)
        if self.yielding is None:
            return found
        depth, depth_a = self.yielding.added(found.force, found.force_a)
        return found._replace(depth=found.depth + depth, depth_a=found.depth_a + depth_a)

    def begin(self) -> ImpactState:
        """Everything at the moment of first contact."""
        none = np.zeros_like(self.omega)
        return ImpactState(0.0, 1.0, none, none, 0.0)

    def energies(self, state: ImpactState) -> Array:
        """Of each oscillator, over m v0^2."""
        return (state.q_dot**2 + (self.omega * state.q) ** 2) / (2.0 * self.inverse_modal_mass)

    def flight_loss(self, state: ImpactState, t: float) -> float:
        """Energy that damping takes in free flight, over m v0^2."""
        if not self.damping_ratio:
            return 0.0
        from generated.damping_kernels import free_loss

        swing, phase = self.omega * state.q, self.omega * t
        lost = free_loss(phase, np.asarray(self.damping_ratio), swing, state.q_dot)
        return float(np.sum(lost / self.inverse_modal_mass))

    def flown(self, state: ImpactState, t: float) -> ImpactState:
        """A state after free flight."""
        free = FreeMotion(self.omega * t, self.damping_ratio)
        bent = state.q_dot * t * free.by_rate - state.q * free.by_q
        fallen = 0.5 * self.weight * t * t
        return ImpactState(
            state.displacement + state.velocity * t + fallen,
            state.velocity + self.weight * t,
            state.q + state.q_dot * t + bent,
            state.q_dot * free.cos - state.q * self.omega * free.sin,
            state.approach - state.separation_speed * t + (fallen - float(np.sum(bent))),
        )


class Nodes(NamedTuple):
    """An element's nodes, with what does not depend on its radii.

    x, times since the contact and since the element began, dt/dx; integrals from the element's
    start to each node over x and t; what makes up the response of the oscillators, and their free
    motion; and of each shape the response to a force at the nodes, the sum of its oscillators'
    free motion, and what of it is even in time: position and velocity at the start.
    """

    x: Array
    t: Array
    since: Array
    rate: Array
    by_x: Array
    by_t: Array
    parts: Response
    free: Array
    response: Array
    moved: Array
    even: Array


class Values(NamedTuple):
    """What is at the nodes for a radius and its slope y; q and the forces of each shape."""

    a: Array
    y: Array
    v: Array
    z: Array
    q: Array
    approach: Array
    force: Array
    felt: Array
    load_a: Array
    load_y: Array | None
    depth: Array
    depth_a: Array
    share: Array


class TimeElement(NamedTuple):
    """An element with its end: state, radius, and the force that drives each shape there.

    `yielding` is the branch that a contact which yields was on.
    """

    element: Element
    end: ImpactState
    radius: float
    felt: Array
    yielding: Yielding | None


def nodes_of(problem: DynamicProblem, n: int, x: float, length: float, start: ImpactState) -> Nodes:
    """The nodes of an element."""
    rule, modes = radau(n), problem.contact.modes
    xs = x + length * rule.x
    t, rate = xs**ONSET, ONSET * xs ** (ONSET - 1)
    since = t - x**ONSET
    parts = Response.empty((n, problem.omega.size), problem.damping_ratio)
    free = np.empty((n, problem.omega.size))
    for part in problem.parts:
        by_q, by_rate = response_at(since, problem.omega[part], problem.damping_ratio, parts, part)
        free[:, part] = by_rate * start.q_dot[part] * since[:, None] - by_q * start.q[part]
    by_x = length * rule.integral
    by_t = by_x * rate
    even = modes.by_shape(start.q) + since[:, None] * modes.by_shape(start.q_dot)
    response = _response(problem, parts) * by_t
    moved = modes.by_shape(free)
    return Nodes(xs, t, since, rate, by_x, by_t, parts, free, response, moved, even)


def _response(problem: DynamicProblem, parts: Response) -> Array:
    """sum g(t_i - t_k)/M per shape, g the response to an impulse, shape (shapes, nodes, nodes)."""
    one = _products(problem, parts.moved_sin, parts.drive_cos)
    if not problem.damping_ratio:  # a sine of differences, odd
        return np.asarray(one - one.transpose(0, 2, 1), dtype=np.float64)
    other = _products(problem, parts.moved_cos, parts.drive_sin)
    return np.asarray(one - other, dtype=np.float64)


def _products(problem: DynamicProblem, moved: Array, drive: Array) -> Array:
    """Sums over the oscillators of each shape, of one node's value by another's."""
    modes = problem.contact.modes
    strong = moved * (problem.inverse_modal_mass / problem.omega)
    found = np.empty((modes.first.size, moved.shape[0], moved.shape[0]))
    for shapes, oscillators in modes.groups:
        one, other = strong.T[oscillators], drive.T[oscillators]
        found[shapes] = one.transpose(0, 2, 1) @ other
    return found


def values_at(
    problem: DynamicProblem, nodes: Nodes, start: ImpactState, radius: float, y: Array
) -> Values:
    """Forces, depths and deflections at the nodes, for a slope da/dx there."""
    a = radius + nodes.by_x @ y
    at = problem.at(problem.a * a)
    load, load_a, load_y = (
        at.forces / problem.force,
        at.forces_a * (problem.a / problem.force),
        None,
    )
    if problem.retardation_time:
        # The pressure keeps its shape: the retarded part drives each shape in the same proportion.
        share = problem.retardation_time / nodes.rate * load_a[:, 0] / load[:, 0]
        load_y = share[:, None] * load
        load = load + load_y * y[:, None]
        load_a = load_a + 2.0 * load_y * (y / a)[:, None]  # d2P/da2 is nearly (2/a) dP/da
    force, driven = load[:, 0], load[:, 1:]
    slowed = nodes.by_t @ force
    fallen = 0.5 * problem.weight * nodes.since**2 - nodes.by_t @ slowed
    # Uniform motion is taken apart: sphere and plate may part far slower than they move.
    bent = nodes.moved + (nodes.response @ driven.T[:, :, None])[:, :, 0].T
    q = nodes.even + bent
    return Values(
        a,
        y,
        start.velocity + problem.weight * nodes.since - slowed,
        start.displacement + start.velocity * nodes.since + fallen,
        q,
        start.approach - start.separation_speed * nodes.since + (fallen - np.sum(bent, axis=1)),
        force,
        driven,
        load_a,
        load_y,
        at.depth / problem.depth + np.sum(at.less * q, axis=1),
        (at.depth_a / problem.depth + np.sum(at.less_a * q, axis=1)) * problem.a,
        1.0 + at.less,
    )


def element(
    problem: DynamicProblem,
    n: int,
    x: float,
    length: float,
    start: ImpactState,
    radius: float,
    y: Array,
) -> TimeElement | None:
    """An element, by Newton's iteration from a guess of da/dx; None if it does not converge."""
    nodes, size, last = nodes_of(problem, n, x, length, start), math.inf, False
    order = 1 if problem.retardation_time else 2
    for _ in range(NEWTON):
        at = values_at(problem, nodes, start, radius, y)
        if not np.all(at.a > 0.0):
            return None
        if last:
            return _piece(problem, nodes, at, start, x, length)
        system = _system(nodes, at) / nodes.t[:, None]
        step = newton_step(system, (at.approach - at.depth) / nodes.t, nodes.by_x, at.a)
        if step is None:
            return None
        y, before, size = y + step[0], size, step[1]
        last = converged(size, before, order)
    return None


def _system(nodes: Nodes, at: Values) -> Array:
    """Slope of depth less displacement by da/dx at the nodes."""
    by_force = nodes.by_t @ nodes.by_t

    def by_load(load: Array) -> Array:
        driven = nodes.response * load[:, 1:].T[:, None, :]
        moved = at.share[:, None, :] @ driven.transpose(1, 0, 2)
        return np.asarray(by_force * load[:, 0] + moved[:, 0], dtype=np.float64)

    found = (np.diag(at.depth_a) + by_load(at.load_a)) @ nodes.by_x
    return found if at.load_y is None else found + by_load(at.load_y)


class Driven(NamedTuple):
    """The oscillators under a force: deflections and velocities at the end of an element.

    At its nodes their energy, the power that damping takes and, where they are asked for, the
    velocities of each shape; else 0.
    """

    q: Array
    q_dot: Array
    energy: Array
    damped: Array
    rates: Array


def _driven(
    problem: DynamicProblem, nodes: Nodes, start: ImpactState, felt: Array, by_shape: bool
) -> Driven:
    """The oscillators under the forces of each shape."""
    modes, (end, end_rate) = problem.contact.modes, np.empty((2, problem.omega.size))
    energy, damped = np.zeros((2, nodes.t.size))
    rates = np.empty(nodes.free.shape if by_shape else (1, 0))
    for part in problem.parts:
        inverse_mass, omega = problem.inverse_modal_mass[part], problem.omega[part]
        of, force = nodes.parts.of(part), felt[:, modes.shape[part]]
        cosine, sine = nodes.by_t @ (of.drive_cos * force), nodes.by_t @ (of.drive_sin * force)
        q = start.q[part] + nodes.since[:, None] * start.q_dot[part] + nodes.free[:, part]
        q += inverse_mass / omega * (of.moved_sin * cosine - of.moved_cos * sine)
        rate = start.q_dot[part] * of.rate_cos - start.q[part] * omega * of.moved_sin
        rate += inverse_mass * (of.rate_cos * cosine + of.rate_sin * sine)
        energy += np.sum((rate**2 + (omega * q) ** 2) / (2.0 * inverse_mass), axis=1)
        if problem.damping_ratio:
            from generated.damping_kernels import power_lost

            taken = power_lost(omega, np.asarray(problem.damping_ratio), rate)
            damped += np.sum(taken / inverse_mass, axis=1)
        end[part], end_rate[part] = q[-1], rate[-1]
        if by_shape:
            rates[:, part] = rate
    return Driven(end, end_rate, energy, damped, modes.by_shape(rates) if by_shape else rates)


def _piece(
    problem: DynamicProblem, nodes: Nodes, at: Values, start: ImpactState, x: float, length: float
) -> TimeElement:
    """The element as polynomials, and its end."""
    force, viscous, pointwise = at.force, at.load_y is not None, problem.contact.pointwise
    driven = _driven(problem, nodes, start, at.felt, viscous or pointwise)
    lost, leak = np.zeros_like(force), np.zeros_like(force)
    if at.load_y is not None:
        felt = at.load_y[:, 1:] / at.load_y[:, :1]
        closing = at.v - np.sum(felt * driven.rates, axis=1)
        lost = at.load_y[:, 0] * at.y * closing * nodes.rate
    if pointwise:
        leak = np.sum((force[:, None] - at.felt) * driven.rates, axis=1) * nodes.rate
    rule = radau(nodes.x.size)
    rows = at.a, at.v, at.z, force, np.sum(at.q, axis=1), driven.energy, lost, leak
    values = np.array([*rows, driven.damped * nodes.rate])
    made = Element(x, length, values @ rule.analysis.T, rule.analysis @ at.y)
    end = ImpactState(
        float(at.z[-1]), float(at.v[-1]), driven.q, driven.q_dot, float(at.approach[-1])
    )
    # A row of its own: a view of the last would keep all rows of the nodes in memory.
    return TimeElement(made, end, float(at.a[-1]), at.felt[-1].copy(), problem.yielding)
