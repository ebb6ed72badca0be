"""Time integration of one contact with plate inertia: a single collocation element.

With z the displacement of the sphere, q_j the sum of the modes of shape j (see `modal`) and A_v the
retardation time of the contact,

    m z'' = m g - P,   P = P_e + A_v dP_e/dt >= 0,   z = quasi-static(a) + sum s_j q_j

In a viscoelastic contact only bending is elastic: P drives the fraction of the compliance of each
shape that is bending, and P_e the rest. The modes keep their mass, so that A_v = 0 is the limit.

On an element in x = (t/T)^(1/6), with t the time since first contact, da/dx is a polynomial through
Radau's nodes. The response of a shape to its force is an integral over the sines of its modes. At
the nodes it is a matrix, computed once per element: no mode is integrated in time steps, and the
only unknowns are the contact radii.
"""

import itertools
import math
from typing import NamedTuple

import numpy as np

from derivation.scene.contact_law.yielding import Yielding
from derivation.scene.dynamic.contact_tables import ContactSamples
from derivation.scene.dynamic.oscillators import Response, response_at
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState, Part
from derivation.scene.numerics.collocation import (
    NEWTON,
    NEXT,
    ONSET,
    Element,
    converged,
    newton_step,
    radau,
)
from generated.arrays import Double as Array

A, V, Z, P, W, E, LOST, LEAK, DAMPED, C = range(10)
"""Rows of an element: radius of the law, velocity, displacement, force, deflection and energy of
the plate; per x the energies lost in the contact, by the pointwise coupling and by damping of the
plate; and the contact radius, which differs from that of the law by the curvature of the plate."""

CLOSE = 1e-13
SEVERAL = 4
"""Number of modes per shape from which a matrix for each shape saves time."""


class Nodes(NamedTuple):
    """The nodes of an element, with all quantities that do not depend on its radii.

    The fields are x; times since the start of the contact and of the element; dt/dx; matrices of
    the integrals from the start of the element over x, over t and twice over t; the modes in parts,
    their response, and their free motion minus uniform motion; for each shape the sum of this
    difference over its modes; the uniform motion from position and velocity at the start; and, if
    the shapes have many modes, the matrix of each from forces to deflections at the nodes.
    """

    x: Array
    t: Array
    since: Array
    rate: Array
    by_x: Array
    by_t: Array
    twice: Array
    parts: tuple[Part, ...]
    response: Response
    free: Array
    moved: Array
    even: Array
    by_force: Array | None


class Values(NamedTuple):
    """Quantities at the nodes for radii a with slopes y; q and modal forces of each shape."""

    a: Array
    y: Array
    v: Array
    z: Array
    q: Array
    approach: Array
    force: Array
    modal_forces: Array
    load_y: Array | None


class TimeElement(NamedTuple):
    """A time element, and at its end the state, the radius and the force that drives each shape.

    `yielding` is the branch of a plastic contact in the element.
    """

    element: Element
    end: ImpactState
    radius: float
    modal_forces: Array
    yielding: Yielding | None
    pull: Array | float = 0.0


def nodes_of(problem: DynamicProblem, n: int, x: float, length: float, start: ImpactState) -> Nodes:
    """Return the nodes of an element, with the response of the modes."""
    rule, modes = radau(n), problem.contact.modes
    xs = x + length * rule.x
    t, rate = xs**ONSET, ONSET * xs ** (ONSET - 1)
    since = t - x**ONSET
    response = Response.empty((n, problem.omega.size), problem.damping_ratio)
    free, parts = np.empty((n, problem.omega.size)), problem.parts(n)
    for part in (part.modes for part in parts):
        by_q, by_rate = response_at(
            since, problem.omega[part], problem.damping_ratio, response, part
        )
        by_rate *= since[:, None] * start.q_dot[part]
        by_q *= start.q[part]
        np.subtract(by_rate, by_q, out=free[:, part])
    by_x = length * rule.integral
    by_t = by_x * rate
    even = modes.by_shape(start.q) + since[:, None] * modes.by_shape(start.q_dot)
    moved, twice = modes.by_shape(free), by_t @ by_t
    many = problem.omega.size >= SEVERAL * modes.phi.size
    by_force = _matrices(problem, parts, response, by_t) if many else None
    return Nodes(
        xs, t, since, rate, by_x, by_t, twice, parts, response, free, moved, even, by_force
    )  # fmt: skip


def _matrices(
    problem: DynamicProblem, parts: tuple[Part, ...], response: Response, by_t: Array
) -> Array:
    """Return `Nodes.by_force`, shape (shapes, nodes, nodes).

    With them, an iteration takes the same time for any number of modes per shape.
    """
    n = by_t.shape[0]
    matrices = np.empty((problem.contact.modes.phi.size, n, n))
    for part in parts:
        drive = response.drive[..., part.modes] * problem.strength[part.modes]
        moved = response.moved[..., part.modes]
        ends = itertools.pairwise([*part.first, part.shape.size])
        for shape, (begin, end) in enumerate(ends, part.shapes.start):
            left, right = (of[..., begin:end].reshape(n, -1) for of in (moved, drive))
            np.matmul(left, right.T, out=matrices[shape])
    matrices *= by_t
    return matrices


def _driven_waves(problem: DynamicProblem, nodes: Nodes, part: Part, driven: Array) -> Array:
    """Return cosine and sine of modes under forces of their shapes, shape (nodes, 2, modes).

    The deflection is the sum of both, each multiplied by `moved`.
    """
    n, indices = nodes.t.size, part.modes
    force = part.by_mode(driven[:, part.shapes]) * problem.strength[indices]
    forces = nodes.response.drive[..., indices] * force[:, None]
    return np.asarray((nodes.by_t @ forces.reshape(n, -1)).reshape(forces.shape))


def _modal_deflections(problem: DynamicProblem, nodes: Nodes, driven: Array) -> Array:
    """Return the deflection of each shape at the nodes by forces at the nodes."""
    if nodes.by_force is not None:
        return np.asarray((nodes.by_force @ driven.T[..., None])[..., 0].T)
    bent = np.empty_like(driven)
    for part in nodes.parts:
        waves = _driven_waves(problem, nodes, part, driven)
        waves *= nodes.response.moved[..., part.modes]
        bent[:, part.shapes] = part.by_shape(waves[:, 0] + waves[:, 1])
    return bent


def _deflection_sums(
    problem: DynamicProblem, nodes: Nodes, modal_weights: Array, driven: Array
) -> Array:
    """Return the sum of weighted deflections at each node, per contact force at each node."""
    if nodes.by_force is not None:
        return np.asarray(np.einsum("is,sik,ks->ik", modal_weights, nodes.by_force, driven))
    n = nodes.t.size
    bent = np.zeros((n, n))
    for part in nodes.parts:
        indices = part.modes
        load = part.by_mode(driven[:, part.shapes]) * problem.strength[indices]
        moved = nodes.response.moved[..., indices] * part.by_mode(
            modal_weights[:, None, part.shapes]
        )
        drive = nodes.response.drive[..., indices] * load[:, None]
        bent += moved.reshape(n, -1) @ drive.reshape(n, -1).T
    return bent * nodes.by_t


class _Load(NamedTuple):
    """Contact force and forces of each shape, in columns, at radii a with slopes y = da/dx.

    `by_a` has the derivatives with respect to a; `by_y` those with respect to y, of a viscoelastic
    contact.
    """

    a: Array
    y: Array
    forces: Array
    by_a: Array
    by_y: Array | None


def _load_at(
    problem: DynamicProblem, nodes: Nodes, a: Array, y: Array, at: ContactSamples
) -> _Load:
    """Return the forces at the nodes for contact radii and their slopes."""
    load = at.forces / problem.force
    load_a = at.forces_a * (problem.a / problem.force)
    if not problem.retardation_time:
        return _Load(a, y, load, load_a, None)
    # The pressure keeps its shape. The viscous part of the force therefore drives each shape in the
    # same proportion, but only its bending: all other deflection lags the force.
    viscous_ratio = problem.retardation_time / nodes.rate * load_a[:, 0] / load[:, 0]
    load_y = viscous_ratio[:, None] * load
    load_y[:, 1:] *= problem.bending_fraction
    load = load + load_y * y[:, None]
    load_a = load_a + 2.0 * load_y * (y / a)[:, None]  # d^2P/da^2 is nearly (2/a) dP/da
    return _Load(a, y, load, load_a, load_y)


def _forces_at(problem: DynamicProblem, nodes: Nodes, radius: float, y: Array) -> _Load:
    """Return the forces at the nodes without their derivatives, for a slope da/dx."""
    a = radius + nodes.by_x @ y
    if problem.retardation_time:
        return _load_at(problem, nodes, a, y, problem.contact.at(problem.a * a))
    forces = problem.contact.forces(problem.a * a) / problem.force
    return _Load(a, y, forces, np.empty((0, 0)), None)


def deflections_at(problem: DynamicProblem, nodes: Nodes, radius: float, y: Array) -> Array:
    """Return the deflection of each shape at the nodes for a slope da/dx there."""
    load = _forces_at(problem, nodes, radius, y)
    return nodes.even + nodes.moved + _modal_deflections(problem, nodes, load.forces[:, 1:])


def free_pull(problem: DynamicProblem, nodes: Nodes) -> Array | float:
    """Return the forces of stretching by the free motion, from which an iteration begins."""
    if problem.middle_plane is None:
        return 0.0
    return problem.middle_plane.forces(nodes.even + nodes.moved)


def _values(
    problem: DynamicProblem, nodes: Nodes, start: ImpactState, load: _Load, bent: Array
) -> Values:
    """Return the values at the nodes for the forces there and the deflections that they cause."""
    force = load.forces[:, 0]
    slowed = nodes.by_t @ force
    fallen = 0.5 * problem.weight * nodes.since**2 - nodes.twice @ force
    # Uniform motion is separated: the separation speed may be far below both speeds.
    bent = nodes.moved + bent
    return Values(
        load.a,
        load.y,
        start.velocity + problem.weight * nodes.since - slowed,
        start.displacement + start.velocity * nodes.since + fallen,
        nodes.even + bent,
        start.approach - start.separation_speed * nodes.since + (fallen - bent.sum(axis=1)),
        force,
        load.forces[:, 1:],
        load.by_y,
    )


def element(
    problem: DynamicProblem,
    n: int,
    x: float,
    length: float,
    start: ImpactState,
    radius: float,
    y: Array,
    enough: float = NEXT,
) -> TimeElement | None:
    """Return an element by Newton's iteration from a guess of da/dx; None without convergence.

    The iteration ends when a step would change the radii by at most `enough`, relative to the
    largest of them.
    """
    nodes, size, found = nodes_of(problem, n, x, length, start), math.inf, False
    order = 1 if problem.retardation_time or problem.middle_plane else 2
    pull = free_pull(problem, nodes)
    for _ in range(NEWTON):
        if found:
            return _polynomials(problem, nodes, start, radius, y, x, length, pull)
        a = radius + nodes.by_x @ y
        if not a.min() > 0.0:
            return None
        at = problem.at(problem.a * a)
        load = _load_at(problem, nodes, a, y, at)
        bent = _modal_deflections(problem, nodes, load.forces[:, 1:] + pull)
        values = _values(problem, nodes, start, load, bent)
        if problem.middle_plane:
            if not np.max(np.abs(values.q)) < 1e3:
                return None
            pull = problem.middle_plane.forces(values.q)
        depth = at.depth / problem.depth + np.vecdot(at.weights_less_one, values.q)
        system = _system(problem, nodes, at, load, values.q) / nodes.t[:, None]
        step = newton_step(system, (values.approach - depth) / nodes.t, nodes.by_x, a)
        if step is None:
            return None
        y, before, size = y + step[0], size, step[1]
        if size > max(1.0, before):
            return None
        found = converged(size, before, order, enough)
    return None


def _system(
    problem: DynamicProblem, nodes: Nodes, at: ContactSamples, load: _Load, q: Array
) -> Array:
    """Return the derivative of depth less approach with respect to da/dx, at the nodes."""
    modal_weights = 1.0 + at.weights_less_one

    def by_load(by: Array) -> Array:
        moved = _deflection_sums(problem, nodes, modal_weights, by[:, 1:])
        return np.asarray(nodes.twice * by[:, 0] + moved, dtype=np.float64)

    by_radius = by_load(load.by_a)
    depth_a = (at.depth_a / problem.depth + np.vecdot(at.less_a, q)) * problem.a
    by_radius.flat[:: nodes.t.size + 1] += depth_a
    by_slope = by_radius @ nodes.by_x
    return by_slope if load.by_y is None else by_slope + by_load(load.by_y)


class DrivenModes(NamedTuple):
    """The modes under a force: deflections and velocities at the end of an element.

    At the nodes: deflection of each shape by the forces, energy of the modes, power dissipated by
    damping and, if requested, the velocity of each shape.
    """

    q: Array
    q_dot: Array
    bent: Array
    energy: Array
    damped: Array
    rates: Array


def _driven_modes(
    problem: DynamicProblem, nodes: Nodes, start: ImpactState, modal_forces: Array, by_shape: bool
) -> DrivenModes:
    """Return the motion of the modes under the forces of each shape."""
    modes, (end, end_rate) = problem.contact.modes, np.empty((2, problem.omega.size))
    energy, damped = np.zeros((2, nodes.t.size))
    bent = np.empty_like(modal_forces)
    rates = np.empty(nodes.free.shape if by_shape else (1, 0))
    for part in nodes.parts:
        indices = part.modes
        inverse_mass, omega = problem.inverse_modal_mass[indices], problem.omega[indices]
        of, waves = nodes.response, _driven_waves(problem, nodes, part, modal_forces)
        q_0, q_dot = start.q[indices], start.q_dot[indices]
        swing = waves * of.rate[..., indices]
        rate = (swing[:, 0] + swing[:, 1]) * omega
        rate += q_dot * of.rate[:, 0, indices] - q_0 * omega * of.moved[:, 0, indices]
        waves *= of.moved[..., indices]
        q = waves[:, 0] + waves[:, 1]
        bent[:, part.shapes] = part.by_shape(q)
        q += q_0 + nodes.since[:, None] * q_dot
        q += nodes.free[:, indices]
        end[indices], end_rate[indices] = q[-1], rate[-1]
        if by_shape:
            rates[:, indices] = rate
        if problem.damping_ratio:
            from generated.damping_kernels import power_lost

            taken = power_lost(omega, np.asarray(problem.damping_ratio), rate)
            damped += np.sum(taken / inverse_mass, axis=1)
        rate *= rate
        q *= omega
        q *= q
        energy += (rate + q) @ (0.5 / inverse_mass)
    rates = modes.by_shape(rates) if by_shape else rates
    return DrivenModes(end, end_rate, bent, energy, damped, rates)


def _polynomials(
    problem: DynamicProblem,
    nodes: Nodes,
    start: ImpactState,
    radius: float,
    y: Array,
    x: float,
    length: float,
    pull: Array | float,
) -> TimeElement | None:
    """Return the element as polynomials, with its end; None if a radius is not positive."""
    load, pointwise = _forces_at(problem, nodes, radius, y), problem.contact.pointwise
    if not load.a.min() > 0.0:
        return None
    by_shape = load.by_y is not None or pointwise
    driven = _driven_modes(problem, nodes, start, load.forces[:, 1:] + pull, by_shape)
    at = _values(problem, nodes, start, load, driven.bent)
    if problem.middle_plane:
        driven.energy[:] += problem.middle_plane.energy(at.q)
    force = at.force
    lost, leak = np.zeros_like(force), np.zeros_like(force)
    if at.load_y is not None:
        modal_forces = at.load_y[:, 1:] / at.load_y[:, :1]
        closing = at.v - np.sum(modal_forces * driven.rates, axis=1)
        lost = at.load_y[:, 0] * at.y * closing * nodes.rate
    if pointwise:
        elastic = load.forces if load.by_y is None else load.forces - load.by_y * at.y[:, None]
        leak = np.sum((elastic[:, :1] - elastic[:, 1:]) * driven.rates, axis=1) * nodes.rate
    rule = radau(nodes.x.size)
    rows = at.a, at.v, at.z, force, np.sum(at.q, axis=1), driven.energy, lost, leak
    ratio = problem.contact.radius_ratio(problem.a * load.a, problem.depth * at.q)
    values = np.array([*rows, driven.damped * nodes.rate, at.a * ratio])
    made = Element(x, length, values @ rule.analysis.T, rule.analysis @ at.y)
    end = ImpactState(
        float(at.z[-1]), float(at.v[-1]), driven.q, driven.q_dot, float(at.approach[-1])
    )
    # A copy, because a view of the last row would keep all rows in memory.
    last = pull if isinstance(pull, float) else pull[-1].copy()
    return TimeElement(made, end, float(at.a[-1]), at.modal_forces[-1].copy(), problem.yielding, last)


def free_element(
    problem: DynamicProblem, n: int, x: float, length: float, start: ImpactState
) -> tuple[TimeElement, Nodes, Values] | None:
    """Return an element without contact, in which the plate stretches, and its values."""
    assert problem.middle_plane is not None
    nodes, plane = nodes_of(problem, n, x, length, start), problem.middle_plane
    pull = free_pull(problem, nodes)
    none, shapes = np.zeros(n), problem.contact.modes.phi.size
    load = _Load(none, none, np.zeros((n, 1 + shapes)), np.empty((0, 0)), None)
    for _ in range(NEWTON):
        values = _values(problem, nodes, start, load, _modal_deflections(problem, nodes, pull))
        if not np.max(np.abs(values.q)) < 1e3:
            return None
        before, pull = pull, plane.forces(values.q)
        if np.max(np.abs(pull - before)) <= CLOSE * np.max(np.abs(pull)):
            break
    else:
        return None
    driven = _driven_modes(problem, nodes, start, pull, False)
    at = _values(problem, nodes, start, load, driven.bent)
    energy = driven.energy + plane.energy(at.q)
    rows = none, at.v, at.z, none, np.sum(at.q, axis=1), energy, none, none
    rule = radau(n)
    values = np.array([*rows, driven.damped * nodes.rate, none])
    made = Element(x, length, values @ rule.analysis.T, none)
    end = ImpactState(
        float(at.z[-1]), float(at.v[-1]), driven.q, driven.q_dot, float(at.approach[-1])
    )
    return TimeElement(made, end, 0.0, np.zeros(shapes), problem.yielding), nodes, at
