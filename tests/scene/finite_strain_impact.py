"""Impacts of a rigid sphere on a plate of three-dimensional finite elements with finite strains.

Plate, sphere and contact are those of `finite_strains`, here with inertia: the law between Green's
strain and the second Piola-Kirchhoff stress is linear, and nodes of the deformed contact face touch
the sphere without friction. The time steps are those of `derivation.checks.finite_elements.impact`;
the displacements of a step follow from iterations with the stiffness of an earlier state.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from scipy import sparse

from derivation.checks.finite_elements.impact import SPECTRAL_RADIUS, Nodes, contact_forces
from derivation.checks.finite_elements.mesh import Double
from derivation.checks.finite_elements.plate import _Reference, factorised
from tests.scene.finite_strains import PressedPlate

CLOSE, ITERATIONS, GROWTH = 1e-4, 12, 2.0
"""Change of displacements over that of a step at the impact speed which ends the iteration; largest
number of iterations from one guess; growth of the change that ends them without a result."""
FLIGHT_STEP, FLYING, APART = 4.0, 20, 5
"""Length of the steps between contacts over that in a contact; number of steps without contact
after which they are longer; the same that separate two contacts."""
LEAVING = 1.2
"""Height of the sphere over the largest deflection of the plate from which no contact follows."""
CANDIDATES = 60
"""Largest number of steps from which the largest contact radius follows."""
LAST = 5
"""Number of last steps of a contact from which its end is extrapolated."""


class Moving(NamedTuple):
    """Displacements, velocities, accelerations of the scheme and of the equations of motion.

    The last unknown is the displacement of the sphere.
    """

    q: Double
    v: Double
    a: Double
    real: Double


class Step(NamedTuple):
    """A time step with contact: time [s], and at each node of the face u [m] and the force [N].

    The force is the vertical one.
    """

    time: float
    u: Double
    force: Double


class Impact(NamedTuple):
    """Results of an impact.

    Attributes
    ----------
    contact_time
        Duration of the first contact [s].
    max_indentation, max_force, max_contact_radius, max_pressure, restitution
        As in the program [m, N, m, Pa, 1]; radius and pressure are fitted in the widest contact.
    deflection
        Largest deflection of the contact face [m].
    energy
        Energy of plate and sphere after the last contact over the initial one [1].
    misfit
        Deviations of the forces on nodes from those of the fitted pressure, over the force [1].
    contacts
        Start and end of each contact [s].
    history
        Times of steps with contact [s], and contact forces [N].
    """

    contact_time: float
    max_indentation: float
    max_force: float
    max_contact_radius: float
    max_pressure: float
    restitution: float
    deflection: float
    energy: float
    misfit: float
    contacts: tuple[tuple[float, float], ...]
    history: Double


@dataclass(frozen=True)
class MovingPlate:
    """A plate with inertia, and the forces of its displacements.

    Attributes
    ----------
    pressed
        The plate on a mesh, and the sphere.
    """

    pressed: PressedPlate

    @cached_property
    def _lengths(self) -> tuple[Double, Double, Double, Double]:
        """Return derivatives of the places in an element by r and z, 1/r, and weights."""
        mesh = self.pressed.system.mesh
        width, height = np.diff(mesh.r_ends), np.diff(mesh.z_ends)
        weights = self.pressed._gradients[3]
        one, middle = _Reference(mesh.degree), (mesh.r_ends[1:] + mesh.r_ends[:-1]) / 2
        r = np.repeat(middle[:, None] + width[:, None] / 2 * one.points, one.points.size, axis=1)
        by_r = np.repeat(2 / width, height.size)[:, None]
        by_z = np.tile(2 / height, width.size)[:, None]
        return by_r, by_z, np.repeat(1 / r, height.size, axis=0), weights

    @cached_property
    def _one(self) -> _Reference:
        return _Reference(self.pressed.system.mesh.degree)

    @cached_property
    def unknowns(self) -> Any:
        """Matrix from the free unknowns to all displacements.

        A condition on the mean deflection of the edge eliminates one of its nodes.
        """
        pressed = self.pressed
        free, held = pressed._free, pressed._held
        size = held.shape[0]
        whole = sparse.csr_matrix(
            (np.ones(free.size), (free, np.arange(free.size))), (size, free.size)
        )
        if not held.shape[1]:
            return whole
        line = (whole.T @ held).toarray()[:, 0]
        last = int(np.argmax(line))
        others = np.delete(np.arange(free.size), last)
        kept = sparse.csr_matrix(
            (np.ones(others.size), (others, np.arange(others.size))), (free.size, others.size)
        )
        row = sparse.csr_matrix(
            (-line[others] / line[last], (np.full(others.size, last), np.arange(others.size))),
            (free.size, others.size),
        )
        row.eliminate_zeros()
        return (whole @ (kept + row)).tocsr()

    @cached_property
    def mass(self) -> Any:
        """Consistent mass matrix of the free unknowns."""
        index, weights = self.pressed._numbers, self._lengths[3]
        n, values = weights.shape[1], self._one.values
        one = np.einsum(
            "eg,gi,gj->eij", self.pressed.system.plate.density * weights, values, values
        )
        blocks, places = [], []
        for part in (index[:, :n], index[:, n:]):
            blocks.append(one.ravel())
            places.append((np.repeat(part, n, axis=1).ravel(), np.tile(part, (1, n)).ravel()))
        rows, columns = (np.concatenate(x) for x in zip(*places, strict=True))
        size, T = self.unknowns.shape[0], self.unknowns
        whole = sparse.csr_matrix((np.concatenate(blocks), (rows, columns)), shape=(size, size))
        return (T.T @ whole @ T).tocsc()

    @cached_property
    def face(self) -> Any:
        """Matrix from the free unknowns to radial, then vertical displacements of the face."""
        face = self.pressed._face
        return self.unknowns[np.concatenate((face, face + 1))]

    def forces(self, q: Double) -> tuple[Double, float]:
        """Return the derivative of the elastic energy by each free unknown, and the energy [J]."""
        plate, one = self.pressed.system.plate, self._one
        (by_r, by_z, over_r, weights), index = self._lengths, self.pressed._numbers
        n, all_q = weights.shape[1], self.unknowns @ q
        u, w = all_q[index[:, :n]], all_q[index[:, n:]]
        u_r, w_r = by_r * (u @ one.by_r.T), by_r * (w @ one.by_r.T)
        u_z, w_z = by_z * (u @ one.by_z.T), by_z * (w @ one.by_z.T)
        hoop = over_r * (u @ one.values.T)
        rr = u_r + 0.5 * (u_r * u_r + w_r * w_r)
        zz = w_z + 0.5 * (u_z * u_z + w_z * w_z)
        tt = hoop + 0.5 * hoop * hoop
        rz = u_z + w_r + u_r * u_z + w_r * w_z
        trace = plate.lam * (rr + zz + tt)
        s_rr, s_zz, s_tt = (weights * (trace + 2.0 * plate.mu * e) for e in (rr, zz, tt))
        s_rz = weights * (plate.mu * rz)
        energy = 0.5 * float(np.sum(s_rr * rr + s_zz * zz + s_tt * tt + s_rz * rz))
        of_u = (by_r * (s_rr * (1.0 + u_r) + s_rz * u_z)) @ one.by_r
        of_u += (by_z * (s_zz * u_z + s_rz * (1.0 + u_r))) @ one.by_z
        of_u += (over_r * s_tt * (1.0 + hoop)) @ one.values
        of_w = (by_r * (s_rr * w_r + s_rz * (1.0 + w_z))) @ one.by_r
        of_w += (by_z * (s_zz * (1.0 + w_z) + s_rz * w_r)) @ one.by_z
        spring = self.pressed._spring @ all_q
        both = np.concatenate((of_u, of_w), axis=1)
        whole = np.bincount(index.ravel(), both.ravel(), all_q.size) + spring
        return self.unknowns.T @ whole, energy + 0.5 * float(all_q @ spring)

    def stiffness(self, q: Double) -> Any:
        """Return the stiffness matrix of the free unknowns."""
        T = self.unknowns
        return (T.T @ self.pressed.elastic(T @ q)[2] @ T).tocsc()


class Solver:
    """Solves the equations of a step with the stiffness of some state."""

    def __init__(self, plate: MovingPlate, s: float, q: Double) -> None:
        self.factors = factorised((plate.mass + s * plate.stiffness(q)).tocsc())
        self.columns: Double = self.factors.solve(plate.face.T.toarray())
        self.of_face: Double = plate.face @ self.columns


@dataclass
class Stepper:
    """Generalised-alpha time steps of a length h [s]."""

    plate: MovingPlate
    mass: float
    speed: float
    h: float
    damping: float = SPECTRAL_RADIUS
    solver: Solver = field(init=False)

    def __post_init__(self) -> None:
        """Compute the constants of the scheme, and the factors of the undeformed state."""
        rho = self.damping
        alpha_m, alpha_f = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
        self.gamma = 0.5 + alpha_f - alpha_m
        self.beta = 0.25 * (1.0 + alpha_f - alpha_m) ** 2
        self.keep = alpha_f / (1.0 - alpha_m), alpha_m / (1.0 - alpha_m)
        self.c = (1.0 - alpha_f) / (1.0 - alpha_m)
        self.s = self.beta * self.h**2 * self.c
        self.solver = Solver(self.plate, self.s, np.zeros(self.plate.mass.shape[0]))

    def advance(self, old: Moving, active: Nodes) -> tuple[Moving, Double, Nodes]:
        """Return the state after a step, normal forces on the face, and which nodes touch."""
        h = self.h
        rest = self.keep[0] * old.real - self.keep[1] * old.a
        start = old.q + h * old.v + h**2 * ((0.5 - self.beta) * old.a + self.beta * rest)
        q, normal, active = self._displacements(start, old, active)
        real = (q - start) / self.s
        a = self.c * real + rest
        v = old.v + h * ((1.0 - self.gamma) * old.a + self.gamma * a)
        return Moving(q, v, a, real), normal, active

    def _displacements(
        self, start: Double, old: Moving, active: Nodes
    ) -> tuple[Double, Double, Nodes]:
        """Return displacements, normal forces and touching nodes at the end of a step.

        Raises
        ------
        ArithmeticError
            If the iteration does not converge with a renewed stiffness.
        """
        close = CLOSE * self.speed * self.h
        # Forces may change fast, and the iteration then needs another guess.
        for first, renewed in ((start + self.s * old.real, False), (old.q, False), (old.q, True)):
            q, touches, largest = first, active, math.inf
            for _ in range(ITERATIONS):
                if renewed:
                    self.solver = Solver(self.plate, self.s, q[:-1])
                try:
                    change, normal, touches = self._change(start, q, touches)
                except ArithmeticError:  # no set of touching nodes stays
                    break
                size = float(np.max(np.abs(change)))
                if not size < GROWTH * largest:
                    break
                q, largest = q + change, min(size, largest)
                if size < close:
                    return q, normal, touches
        raise ArithmeticError("impact: expected a solution of a time step, found none")

    def _change(self, start: Double, q: Double, active: Nodes) -> tuple[Double, Double, Nodes]:
        """Return the change in an iteration, normal forces, and touching nodes."""
        plate, s, solver, sphere = self.plate, self.s, self.solver, start[-1] - q[-1]
        n, A = plate.pressed._face.size, solver.of_face
        free = -solver.factors.solve(
            plate.mass @ (q[:-1] - start[:-1]) + s * plate.forces(q[:-1])[0]
        )
        gap, n_r, n_z = plate.pressed._gap(plate.unknowns @ q[:-1], float(q[-1]))
        moved = plate.face @ free
        gap = gap + n_r * moved[:n] + n_z * (moved[n:] + sphere)
        compliance = s * (
            np.outer(n_r, n_r) * A[:n, :n]
            + np.outer(n_r, n_z) * A[:n, n:]
            + np.outer(n_z, n_r) * A[n:, :n]
            + np.outer(n_z, n_z) * (A[n:, n:] + 1.0 / self.mass)
        )
        normal, active = contact_forces(compliance, gap, active)
        pushed = solver.columns @ np.concatenate((n_r * normal, n_z * normal))
        change = np.append(free + s * pushed, sphere + s / self.mass * float(n_z @ normal))
        return change, normal, active

    def energy(self, state: Moving) -> float:
        """Return the energy of plate and sphere [J]."""
        kinetic = state.v[:-1] @ (self.plate.mass @ state.v[:-1]) + self.mass * state.v[-1] ** 2
        return 0.5 * float(kinetic) + self.plate.forces(state.q[:-1])[1]


def simulate_impact(
    pressed: PressedPlate, mass: float, speed: float, step: float, longest: float
) -> Impact:
    """Return the results of an impact of a sphere with a mass [kg] and a speed [m/s].

    Parameters
    ----------
    step
        Length of the time steps in a contact [s].
    longest
        Largest duration [s].

    Raises
    ------
    ArithmeticError
        If it lasts longer, or a contact is wider than the fine part of the mesh.
    """
    plate = MovingPlate(pressed)
    fine, coarse = Stepper(plate, mass, speed, step), None
    size = plate.mass.shape[0] + 1
    state = Moving(*(np.zeros(size) for _ in range(4)))
    state.v[-1] = speed
    brought, n = fine.energy(state), pressed._face.size
    active = np.zeros(n, dtype=bool)
    time, apart, deepest, depth = 0.0, 0, 0.0, 0.0
    touching, spans = list[Step](), list[list[float]]()
    while True:
        used, before = fine, state
        if apart >= FLYING:
            coarse = coarse or Stepper(plate, mass, speed, FLIGHT_STEP * step)
            used = coarse
        state, normal, active = used.advance(before, active)
        if used is coarse and normal.any():  # the contact begins with short steps
            used, apart = fine, -int(FLIGHT_STEP)
            state, normal, active = fine.advance(before, np.zeros(n, dtype=bool))
        time += used.h
        if time > longest:
            raise ArithmeticError(f"impact: expected its end within {longest:g} s, got none")
        if normal[-1] > 0.0:
            raise ArithmeticError(
                "impact: expected a contact within the fine mesh, got a wider one"
            )
        nodes = plate.unknowns @ state.q[:-1]
        depth = max(depth, float(state.q[-1]))
        deepest = max(deepest, -float(np.min(nodes[pressed._face + 1])))
        if normal.any():
            if not spans or time - spans[-1][1] > (APART + 0.5) * step:
                spans.append([time - used.h, time])
            apart, spans[-1][1] = 0, time
            vertical = -normal * pressed._gap(nodes, float(state.q[-1]))[2]
            touching.append(Step(time, nodes[pressed._face], vertical))
            continue
        apart += 1
        left = state.v[-1] < 0.0 and -state.q[-1] > LEAVING * deepest
        if apart >= FLYING and left:
            restitution = -float(state.v[-1]) / speed
            energy = fine.energy(state) / brought
            return _results(pressed, touching, spans, (depth, restitution, deepest, energy))


def _results(
    pressed: PressedPlate,
    touching: Sequence[Step],
    spans: Sequence[Sequence[float]],
    numbers: tuple[float, float, float, float],
) -> Impact:
    """Return the results from the steps with contact."""
    times = np.array([one.time for one in touching])
    vertical = np.array([one.force for one in touching])
    total = np.sum(vertical, axis=1)
    first = times <= spans[0][1] * (1.0 + 1e-12)
    last = np.flatnonzero(first)[-LAST:]
    line = np.polynomial.Polynomial.fit(total[last] ** (2.0 / 3.0), times[last], 1)
    outer = np.array([np.flatnonzero(one)[-1] for one in vertical])
    wide = np.flatnonzero(outer == np.max(outer))
    wide = np.sort(wide[np.argsort(-total[wide])[:CANDIDATES]])
    q, fits = np.zeros(2 * pressed.system.mesh.columns * pressed.system.mesh.rows), []
    for step in (touching[k] for k in wide.tolist()):
        q[pressed._face] = step.u
        fits.append(pressed._pressure(q, step.force))
    radius, pressure, misfit = max(fits)
    depth, restitution, deflection, energy = numbers
    return Impact(
        contact_time=float(line(0.0)),
        max_indentation=depth,
        max_force=float(np.max(total)),
        max_contact_radius=radius,
        max_pressure=pressure,
        restitution=restitution,
        deflection=deflection,
        energy=energy,
        misfit=misfit,
        contacts=tuple((a, b) for a, b in spans),
        history=np.array([times, total]),
    )
