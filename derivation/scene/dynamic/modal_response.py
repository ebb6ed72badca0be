"""The response of the plate's modes at the nodes of a time element to forces of their shapes."""

import itertools
from typing import NamedTuple

import numpy as np

from derivation.scene.dynamic.oscillators import Response, response_at
from derivation.scene.dynamic.problem import DynamicProblem, ImpactState, Part
from derivation.scene.numerics.collocation import ONSET, radau
from generated.arrays import Double as Array

SEVERAL, SEVERAL_STRETCHED = 4, 1.5
"""Number of modes per shape from which a matrix for each shape saves time; the same if the plate
stretches, because an iteration then uses the matrices more often."""


class Nodes(NamedTuple):
    """The nodes of an element, with all quantities that do not depend on its radii.

    The fields are x; times since the start of the contact and of the element; dt/dx; matrices of
    the integrals from the start of the element over x, over t and twice over t; the modes in parts,
    their response, and their free motion minus uniform motion; for each shape the sum of this
    difference over its modes; the uniform motion from position and velocity at the start; the sum
    of both; the approach in uniform motion, and the fall by the weight; and, if the shapes have
    many modes, the matrix of each from forces to deflections at the nodes.
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
    unloaded: Array
    approach: Array
    fallen: Array
    by_force: Array | None


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
    approach = start.approach - start.separation_speed * since
    fallen = 0.5 * problem.weight * since**2
    by_force = _matrices(problem, parts, response, by_t) if _with_matrices(problem) else None
    return Nodes(
        xs, t, since, rate, by_x, by_t, twice, parts, response, free, moved, even, even + moved,
        approach, fallen, by_force,
    )  # fmt: skip


def _with_matrices(problem: DynamicProblem) -> bool:
    """Return whether a matrix for each shape saves time."""
    several = SEVERAL if problem.middle_plane is None else SEVERAL_STRETCHED
    return bool(problem.omega.size >= several * problem.contact.modes.phi.size)


def _matrices(
    problem: DynamicProblem, parts: tuple[Part, ...], response: Response, by_t: Array
) -> Array:
    """Return `Nodes.by_force`, shape (shapes, nodes, nodes).

    With them, an iteration takes the same time for any number of modes per shape.
    """
    n = by_t.shape[0]
    matrices = np.empty((problem.contact.modes.phi.size, n, n))
    for part in parts:
        of = response.of(part.modes)
        drive, moved = _by_mode(of.drive * problem.strength[part.modes]), _by_mode(of.moved)
        ends = itertools.pairwise([*part.first.tolist(), part.shape.size])
        for shape, (begin, end) in enumerate(ends, part.shapes.start):
            some = slice(2 * begin, 2 * end)
            np.matmul(moved[some].T, drive[some], out=matrices[shape])
    matrices *= by_t
    return matrices


def _by_mode(factors: Array) -> Array:
    """Return factors of the response, shape (2 modes, nodes)."""
    return factors.transpose(2, 1, 0).reshape(-1, factors.shape[0])


def _driven_waves(problem: DynamicProblem, nodes: Nodes, part: Part, driven: Array) -> Array:
    """Return cosine and sine of modes under forces of their shapes, shape (nodes, 2, modes).

    The deflection is the sum of both, each multiplied by `moved`.
    """
    n, indices = nodes.t.size, part.modes
    force = part.by_mode(driven[:, part.shapes]) * problem.strength[indices]
    forces = nodes.response.drive[..., indices] * force[:, None]
    return np.asarray((nodes.by_t @ forces.reshape(n, -1)).reshape(forces.shape))


def modal_deflections(problem: DynamicProblem, nodes: Nodes, driven: Array) -> Array:
    """Return the deflection of each shape at the nodes by forces at the nodes."""
    if nodes.by_force is not None:
        return np.asarray((nodes.by_force @ driven.T[..., None])[..., 0].T)
    bent = np.empty_like(driven)
    for part in nodes.parts:
        waves = _driven_waves(problem, nodes, part, driven)
        waves *= nodes.response.moved[..., part.modes]
        bent[:, part.shapes] = part.by_shape(waves[:, 0] + waves[:, 1])
    return bent


def deflection_sums(
    problem: DynamicProblem, nodes: Nodes, modal_weights: Array, driven: Array
) -> Array:
    """Return the sum of weighted deflections at each node, per contact force at each node."""
    if nodes.by_force is not None:
        bent = nodes.by_force * driven.T[:, None]
        return np.asarray((modal_weights[:, None] @ bent.transpose(1, 0, 2))[:, 0])
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


def driven_modes(
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
