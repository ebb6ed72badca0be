"""Time integration of one contact with plate inertia: a single collocation element.

With z the displacement of the sphere, q_j the sum of the modes of shape j (see `modal`) and A_v the
retardation time of the contact,

    m z'' = m g - P,   P = P_e + A_v dP_e/dt >= 0,   z = quasi-static(a) + sum s_j q_j

If the middle plane stretches, its force on each shape is added to that of the contact.

In a viscoelastic contact only bending is elastic: P drives the fraction of the compliance of each
shape that is bending, and P_e the rest. The modes keep their mass, so that A_v = 0 is the limit.

On an element in x = (t/T)^(1/6), with t the time since first contact, da/dx is a polynomial through
Radau's nodes. The response of a shape to its force is an integral over the sines of its modes. At
the nodes it is a matrix, computed once per element: no mode is integrated in time steps, and the
only unknowns are the contact radii.
"""

import math
from typing import NamedTuple

import numpy as np

from derivation.scene.contact_law.yielding import Yielding
from derivation.scene.dynamic.contact_tables import ContactSamples
from derivation.scene.dynamic.modal_response import (
    DrivenModes,
    Nodes,
    deflection_sums,
    driven_modes,
    modal_deflections,
    nodes_of,
)
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
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
CLOSE, NEARLY = 1e-13, 1e-9
"""Relative change of the forces of stretching that is due to rounding, and the same if it does not
decrease any more."""
KEPT, FALLING = 1e-2, 0.1
"""Size of a step, and its size over that of the one before it, up to which the next step has the
same derivative if the plate stretches: its forces of stretching are one step late in any case."""
DIVERGED = 1e3
"""Deflection over that of the free motion at which an iteration has diverged."""


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


class Stretched(NamedTuple):
    """Legendre coefficients of the force of stretching on each shape, and of the axis tension.

    Shapes (nodes, shapes) and (nodes,); the tension is in N/m.
    """

    pull: Array
    tension: Array


class TimeElement(NamedTuple):
    """A time element, and at its end the state, the radius and the force that drives each shape.

    `yielding` is the branch of a plastic contact in the element, and `stretched` is given if the
    plate stretches.
    """

    element: Element
    end: ImpactState
    radius: float
    modal_forces: Array
    yielding: Yielding | None
    stretched: Stretched | None = None


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
    forces = _forces_at(problem, nodes, radius, y).forces[:, 1:]
    pull = _stretched(problem, nodes, forces)
    assert pull is not None  # the longer element, of which this one is a part, has a solution
    return nodes.unloaded + modal_deflections(problem, nodes, forces + pull)


def _stretched(problem: DynamicProblem, nodes: Nodes, forces: Array) -> Array | None:
    """Return the force of stretching on each shape at the nodes, for the other forces."""
    pull, size = _free_pull(problem, nodes, forces.shape), 1.0
    if problem.middle_plane is None:
        return pull
    for _ in range(NEWTON):
        q = nodes.unloaded + modal_deflections(problem, nodes, forces + pull)
        if _diverges(nodes, q):
            return None
        last, before, pull = size, pull, problem.middle_plane.forces(q)
        largest = float(np.abs(pull).max())
        size = float(np.abs(pull - before).max()) / largest if largest else 0.0
        # The changes decrease at least as fast as the last one.
        if size * min(1.0, size / last) <= CLOSE or (size <= NEARLY and size > 0.1 * last):
            return pull
    return None


def _free_pull(problem: DynamicProblem, nodes: Nodes, shape: tuple[int, ...]) -> Array:
    """Return the forces of stretching by the free motion, from which an iteration begins."""
    if problem.middle_plane is None:
        return np.zeros(shape)
    return problem.middle_plane.forces(nodes.unloaded)


def _diverges(nodes: Nodes, q: Array) -> bool:
    """Return whether deflections exceed those of the free motion far too much, or are unknown."""
    return not np.abs(q).max() <= DIVERGED * (1.0 + np.abs(nodes.unloaded).max())


def _values(
    problem: DynamicProblem, nodes: Nodes, start: ImpactState, load: _Load, bent: Array
) -> Values:
    """Return the values at the nodes for the forces there and the deflections that they cause."""
    force = load.forces[:, 0]
    slowed, fallen = nodes.by_t @ force, nodes.fallen - nodes.twice @ force
    q, approach = _moved(nodes, fallen, bent)
    return Values(
        load.a,
        load.y,
        start.velocity + problem.weight * nodes.since - slowed,
        start.displacement + start.velocity * nodes.since + fallen,
        q,
        approach,
        force,
        load.forces[:, 1:],
        load.by_y,
    )


def _moved(nodes: Nodes, fallen: Array, bent: Array) -> tuple[Array, Array]:
    """Return the deflection of each shape and the approach at the nodes.

    Parameters
    ----------
    fallen
        Displacement of the sphere without uniform motion.
    bent
        Deflection of each shape by the forces.
    """
    # Uniform motion is separated: the separation speed may be far below both speeds.
    bent = nodes.moved + bent
    return nodes.even + bent, nodes.approach + (fallen - bent.sum(axis=1))


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
    nodes, found = nodes_of(problem, n, x, length, start), False
    size = before = math.inf
    order = 1 if problem.retardation_time or problem.middle_plane else 2
    # Corrected over the time so far: at once, it would take a larger force the shorter an element.
    excess = _excess(problem, start, radius) * (x**ONSET / nodes.t)
    pull = _free_pull(problem, nodes, nodes.even.shape)
    for _ in range(NEWTON):
        if found:
            return _polynomials(problem, nodes, start, radius, y, x, length, pull)
        a = radius + nodes.by_x @ y
        if not a.min() > 0.0:
            return None
        at = problem.at(problem.a * a)
        load = _load_at(problem, nodes, a, y, at)
        forces = load.forces[:, 1:]
        if problem.middle_plane is not None:
            q = nodes.unloaded + modal_deflections(problem, nodes, forces + pull)
            if _diverges(nodes, q):
                return None
            pull = problem.middle_plane.forces(q)
        bent = modal_deflections(problem, nodes, forces + pull)
        q, approach = _moved(nodes, nodes.fallen - nodes.twice @ load.forces[:, 0], bent)
        depth = at.depth / problem.depth + np.vecdot(at.weights_less_one, q)
        residual = (approach - depth - excess) / nodes.t
        if problem.middle_plane is None or size > min(KEPT, FALLING * before):
            system = _system(problem, nodes, at, load, q) / nodes.t[:, None]
        step = newton_step(system, residual, nodes.by_x, a)
        if step is None:
            return None
        y, before, size = y + step[0], size, step[1]
        if size > max(1.0, before):
            return None
        found = converged(size, before, order, enough)
    return None


def _excess(problem: DynamicProblem, start: ImpactState, radius: float) -> float:
    """Return approach less depth at the start of a viscoelastic element, due to rounding."""
    if not (problem.retardation_time and radius):
        return 0.0
    at, q = problem.at(np.array([problem.a * radius])), problem.contact.modes.by_shape(start.q)
    return start.approach - float(at.depth[0] / problem.depth + at.weights_less_one[0] @ q)


def _system(
    problem: DynamicProblem, nodes: Nodes, at: ContactSamples, load: _Load, q: Array
) -> Array:
    """Return the derivative of depth less approach with respect to da/dx, at the nodes."""
    modal_weights = 1.0 + at.weights_less_one

    def by_load(by: Array) -> Array:
        moved = deflection_sums(problem, nodes, modal_weights, by[:, 1:])
        return np.asarray(nodes.twice * by[:, 0] + moved, dtype=np.float64)

    by_radius = by_load(load.by_a)
    depth_a = (at.depth_a / problem.depth + np.vecdot(at.less_a, q)) * problem.a
    by_radius.flat[:: nodes.t.size + 1] += depth_a
    by_slope = by_radius @ nodes.by_x
    return by_slope if load.by_y is None else by_slope + by_load(load.by_y)


def _polynomials(
    problem: DynamicProblem,
    nodes: Nodes,
    start: ImpactState,
    radius: float,
    y: Array,
    x: float,
    length: float,
    pull: Array,
) -> TimeElement | None:
    """Return the element as polynomials, with its end; None if a radius is not positive."""
    load, pointwise = _forces_at(problem, nodes, radius, y), problem.contact.pointwise
    if not load.a.min() > 0.0:
        return None
    by_shape = load.by_y is not None or pointwise
    driven = driven_modes(problem, nodes, start, load.forces[:, 1:] + pull, by_shape)
    at = _values(problem, nodes, start, load, driven.bent)
    energy, force = driven.energy, at.force
    if problem.middle_plane:
        energy = energy + problem.middle_plane.energy(at.q)
    lost = leak = np.zeros(force.size)
    if at.load_y is not None:
        modal_forces = at.load_y[:, 1:] / at.load_y[:, :1]
        closing = at.v - np.sum(modal_forces * driven.rates, axis=1)
        lost = at.load_y[:, 0] * at.y * closing * nodes.rate
    if pointwise:
        elastic = load.forces if load.by_y is None else load.forces - load.by_y * at.y[:, None]
        leak = np.sum((elastic[:, :1] - elastic[:, 1:]) * driven.rates, axis=1) * nodes.rate
    rule = radau(nodes.x.size)
    rows = at.a, at.v, at.z, force, at.q.sum(axis=1), energy, lost, leak
    ratio = problem.contact.radius_ratio(problem.a * load.a, problem.depth * at.q)
    values = np.array([*rows, driven.damped * nodes.rate, at.a * ratio])
    made = Element(x, length, values @ rule.analysis.T, rule.analysis @ at.y)
    # A copy, because a view of the last row would keep all rows in memory.
    last, end = at.modal_forces[-1].copy(), _end(at, driven)
    stretched = _coefficients(problem, at.q, pull)
    return TimeElement(made, end, float(at.a[-1]), last, problem.yielding, stretched)


def _coefficients(problem: DynamicProblem, q: Array, pull: Array) -> Stretched | None:
    """Return the coefficients of forces and tension at the nodes, if the plate stretches."""
    plane, analysis = problem.middle_plane, radau(q.shape[0]).analysis
    if plane is None:
        return None
    shapes = plane.slopes.shape[0]
    return Stretched(analysis @ pull[:, :shapes], analysis @ plane.axis_tension(q))


def _end(at: Values, driven: DrivenModes) -> ImpactState:
    """Return the state at the end of an element."""
    z, v, approach = (float(row[-1]) for row in (at.z, at.v, at.approach))
    return ImpactState(z, v, driven.q, driven.q_dot, approach)


def free_element(
    problem: DynamicProblem, n: int, x: float, length: float, start: ImpactState
) -> tuple[TimeElement, Nodes, Values] | None:
    """Return an element without contact, with its nodes and values; None without convergence."""
    nodes, shapes = nodes_of(problem, n, x, length, start), problem.contact.modes.phi.size
    none, force = np.zeros(n), np.zeros((n, 1 + shapes))
    pull = _stretched(problem, nodes, force[:, 1:])
    if pull is None:
        return None
    driven = driven_modes(problem, nodes, start, pull, by_shape=False)
    at = _values(problem, nodes, start, _Load(none, none, force, force, None), driven.bent)
    energy = driven.energy
    if problem.middle_plane:
        energy = energy + problem.middle_plane.energy(at.q)
    rule = radau(n)
    rows = none, at.v, at.z, none, at.q.sum(axis=1), energy, none, none
    values = np.array([*rows, driven.damped * nodes.rate, none])
    made = Element(x, length, values @ rule.analysis.T, none)
    stretched = _coefficients(problem, at.q, pull)
    last = np.zeros(shapes)
    piece = TimeElement(made, _end(at, driven), 0.0, last, problem.yielding, stretched)
    return piece, nodes, at


def integral(piece: TimeElement, row: int) -> float:
    """Return the integral of a row, a rate by x, over a time element: length times mean value."""
    return piece.element.length * float(piece.element.rows[row, 0])
