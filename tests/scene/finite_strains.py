"""A rigid sphere pressed into a plate of three-dimensional finite elements with finite strains.

The elements are those of `derivation.checks.finite_elements`, over r and z. Unless another solid is
given, the law between Green's strain and the second Piola-Kirchhoff stress is linear. Nodes of the
contact face touch the sphere without friction, along its normal, in the deformed state. Neither a
thin plate nor a half-space nor a contact law is assumed.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.optimize import minimize_scalar
from scipy.sparse.linalg import splu

from derivation.checks.finite_elements.mesh import Double, Mesh, _growing_intervals
from derivation.checks.finite_elements.plate import Plate, System, _lagrange, _Reference
from derivation.plate.edge.remainder import lobatto
from tests.scene.hyperelastic import Solid, linear

ITERATIONS, CLOSE, SHORTEST = 40, 1e-9, 1e-3
"""Largest number of Newton's iterations; step over the indentation that ends them; shortest step of
the indentation over the indentation."""
REACH = 1.6
"""Radius of the nodes that may touch the sphere, over the expected contact radius."""
TERMS, POINTS, TRIES = 4, 24, 25
"""Terms of the pressure over the radius; Gauss points per element of the contact face; number of
contact radii that are tried."""
Numbers = NDArray[np.intp]


class Fineness(NamedTuple):
    """Mesh density.

    Attributes
    ----------
    contact, halved
        Number of elements over the contact radius, and how often they are halved towards its end.
    far
        Largest radial element size over the thickness.
    edge
        How often the element at the plate's edge is halved.
    degree
        Polynomial degree.
    """

    contact: int = 6
    halved: int = 2
    far: float = 3.0
    edge: int = 3
    degree: int = 4


class Pressed(NamedTuple):
    """A static contact.

    Attributes
    ----------
    indentation, force, stiffness
        Displacement of the sphere [m], contact force [N], and its derivative [N/m].
    radius, pressure
        Contact radius in the deformed state [m], and pressure at the centre [Pa].
    energy
        Elastic energy [J].
    misfit
        Deviations of the forces on nodes from those of the fitted pressure, over the force [1].
    """

    indentation: float
    force: float
    stiffness: float
    radius: float
    pressure: float
    energy: float
    misfit: float


class _State(NamedTuple):
    """Displacements of all nodes, and normal forces on those of the contact face."""

    q: Double
    normal: Double


class _Touching(NamedTuple):
    """Touching nodes: their u, the directions of normal forces, and forces over lengths."""

    face: Numbers
    n_r: Double
    n_z: Double
    turn: Double


@dataclass(frozen=True)
class PressedPlate:
    """A plate and a rigid sphere.

    Attributes
    ----------
    system
        Unknowns and edge conditions of the plate.
    R
        Radius of the sphere [m].
    turns
        Whether the edge may turn by any angle: only its mean deflection is zero, unless it is
        clamped. Otherwise it cannot deflect at any height.
    solid
        The response of the plate's material.
    """

    system: System
    R: float
    turns: bool = True
    solid: Solid = linear

    @classmethod
    def of(
        cls, plate: Plate, R: float, radius: float, fine: Fineness, turns: bool = True
    ) -> "PressedPlate":
        """Return a plate whose mesh is fine up to the end of a contact of a radius [m]."""
        size = radius / fine.contact
        inner = np.linspace(0.0, radius, fine.contact + 1)
        smallest = size * 0.5**fine.halved
        more = radius - size * 0.5 ** np.arange(1, fine.halved + 1)
        b, H = plate.radius, plate.thickness
        outer = _growing_intervals(smallest, b - radius, 2.0, fine.far * H, fine.edge)
        depth = _growing_intervals(2.0 * smallest, H, 2.0, 0.5 * H, 0)
        r_ends, z_ends = np.concatenate((inner[:-1], more, radius + outer)), H / 2 - depth[::-1]
        r_ends[-1], z_ends[0], z_ends[-1] = b, -H / 2, H / 2
        reach = float(r_ends[r_ends <= REACH * radius][-1])
        system = System(plate, Mesh(r_ends, z_ends, fine.degree, reach))
        return cls(system, R, turns and plate.edge != "clamped")

    @cached_property
    def _numbers(self) -> Numbers:
        """Numbers of the unknowns of each element: all u, then all w."""
        one, mesh = _Reference(self.system.mesh.degree), self.system.mesh
        layers = mesh.z_ends.size - 1
        i, k = np.divmod(np.arange((mesh.r_ends.size - 1) * layers), layers)
        column, row = i[:, None] * mesh.degree + one.column, k[:, None] * mesh.degree + one.row
        first = 2 * (column * mesh.rows + row)
        return np.concatenate((first, first + 1), axis=1)

    @cached_property
    def _gradients(self) -> tuple[Double, Double, Double, Double]:
        """Return d/dr, d/dz and 1/r of the shapes at each element's points, and their weights."""
        mesh = self.system.mesh
        one, width, height = _Reference(mesh.degree), np.diff(mesh.r_ends), np.diff(mesh.z_ends)
        middle = (mesh.r_ends[1:] + mesh.r_ends[:-1]) / 2
        by_r = np.repeat(one.by_r[None] * (2 / width)[:, None, None], height.size, axis=0)
        by_z = np.tile(one.by_z[None] * (2 / height)[:, None, None], (width.size, 1, 1))
        r = np.repeat(middle[:, None] + width[:, None] / 2 * one.points, one.points.size, axis=1)
        area = np.pi / 2 * np.kron(one.weights, one.weights) * r * width[:, None]
        weights = area[:, None] * height[:, None]
        over_r = np.repeat(one.values / r[..., None], height.size, axis=0)
        return by_r, by_z, over_r, weights.reshape(-1, r.shape[1])

    @cached_property
    def _edge(self) -> Numbers:
        """Radial displacements of the edge."""
        mesh = self.system.mesh
        return 2 * ((mesh.columns - 1) * mesh.rows + np.arange(mesh.rows))

    @cached_property
    def _spring(self) -> Any:
        """Stiffness of the edge for all unknowns."""
        size = 2 * self.system.mesh.columns * self.system.mesh.rows
        elastic = self.system.plate.edge == "paper"
        return self.system._spring(size, self._edge) if elastic else sparse.csr_matrix((size, size))

    @cached_property
    def _free(self) -> Numbers:
        """Unknowns that are not zero."""
        free = self.system.free
        return np.union1d(free, self._edge + 1) if self.turns else free

    @cached_property
    def _held(self) -> Any:
        """Weights of the unknowns in the mean deflection of the edge, if only that is zero."""
        mesh, size = self.system.mesh, 2 * self.system.mesh.columns * self.system.mesh.rows
        if not self.turns:
            return sparse.csc_matrix((size, 0))
        line = np.zeros(mesh.rows)
        for k, height in enumerate(np.diff(mesh.z_ends)):
            part = slice(k * mesh.degree, (k + 1) * mesh.degree + 1)
            line[part] += height * lobatto(mesh.degree)[1]
        places = self._edge + 1, 0 * self._edge
        return sparse.csc_matrix((line / np.sum(line), places), shape=(size, 1))

    @cached_property
    def _face(self) -> Numbers:
        """Radial displacements of the nodes that may touch the sphere."""
        rows = self.system.mesh.rows
        return 2 * (np.arange(self.system.contact_radii.size) * rows + rows - 1)

    def elastic(self, q: Double) -> tuple[float, Double, Any]:
        """Return the elastic energy, its derivative by each unknown, and the stiffness matrix."""
        plate, (by_r, by_z, over_r, weights) = self.system.plate, self._gradients
        n, index = by_r.shape[2], self._numbers
        u, w = q[index[:, :n, None]], q[index[:, n:, None]]
        u_r, u_z, w_r, w_z = ((by @ x)[..., 0] for x in (u, w) for by in (by_r, by_z))
        hoop = (over_r @ u)[..., 0]
        # Green's strain; the last one is twice the shear strain.
        strains = (
            u_r + 0.5 * (u_r**2 + w_r**2),
            w_z + 0.5 * (u_z**2 + w_z**2),
            hoop + 0.5 * hoop**2,
            u_z + w_r + u_r * u_z + w_r * w_z,
        )

        def change(by: Double, of_u: Double, of_w: Double) -> Double:
            return np.concatenate((of_u[..., None] * by, of_w[..., None] * by), axis=2)

        changes = (
            change(by_r, 1.0 + u_r, w_r),
            change(by_z, u_z, 1.0 + w_z),
            change(over_r, 1.0 + hoop, 0.0 * hoop),
            change(by_z, 1.0 + u_r, w_r) + change(by_r, u_z, 1.0 + w_z),
        )
        energy, parts, moduli = self.solid(strains, plate.lam, plate.mu)
        stresses = [weights * s for s in parts]
        forces, stiffness = np.zeros(index.shape), np.zeros((*index.shape, 2 * n))
        for by, stress, row in zip(changes, stresses, moduli, strict=True):
            forces += np.einsum("eg,egi->ei", stress, by)
            grown = sum((weights * x)[..., None] * changes[j] for j, x in row.items())
            stiffness += np.swapaxes(by, 1, 2) @ grown
        rr, zz, tt, rz = (s[..., None] for s in stresses)
        across = np.swapaxes(by_r, 1, 2) @ (rz * by_z)
        turning = np.swapaxes(by_r, 1, 2) @ (rr * by_r) + np.swapaxes(by_z, 1, 2) @ (zz * by_z)
        turning += across + np.swapaxes(across, 1, 2)
        stiffness[:, n:, n:] += turning
        stiffness[:, :n, :n] += turning + np.swapaxes(over_r, 1, 2) @ (tt * over_r)
        places = np.repeat(index, 2 * n, axis=1).ravel(), np.tile(index, (1, 2 * n)).ravel()
        matrix = sparse.csr_matrix((stiffness.ravel(), places), shape=2 * (q.size,)) + self._spring
        pull = self._spring @ q
        whole = np.bincount(index.ravel(), forces.ravel(), q.size) + pull
        return float(np.sum(weights * energy) + 0.5 * q @ pull), whole, matrix

    def press(self, indentations: Sequence[float]) -> list[Pressed]:
        """Return the contacts at increasing indentations [m].

        Raises
        ------
        ArithmeticError
            If Newton's iteration does not converge after a short step.
        """
        size = 2 * self.system.mesh.columns * self.system.mesh.rows
        state = before = _State(np.zeros(size), np.zeros(self._face.size))
        at, last, results = 0.0, 0.0, list[Pressed]()
        for goal in indentations:
            step = goal - at
            while at < goal:
                step = min(step, goal - at)
                # Extrapolate from the last two states.
                part = step / last if last > 0.0 else 0.0
                guess = _State(state.q + part * (state.q - before.q), state.normal)
                try:
                    found = self._solve(guess, at + step)
                except ArithmeticError:
                    step *= 0.4
                    if step < SHORTEST * goal:
                        raise
                    continue
                before, state, last, at = state, found, step, at + step
                step *= 2.0
            results.append(self._result(state, goal))
        return results

    def _gap(self, q: Double, indentation: float) -> tuple[Double, Double, Double]:
        """Return the distance of the face's nodes from the sphere, and the direction of normals."""
        r = self.system.contact_radii + q[self._face]
        z = self.R - indentation - q[self._face + 1]  # height of the centre above the node
        distance = np.hypot(r, z)
        return distance - self.R, r / distance, -z / distance

    def _touching(self, state: _State, indentation: float, active: Numbers) -> _Touching:
        gap, n_r, n_z = (x[active] for x in self._gap(state.q, indentation))
        return _Touching(self._face[active], n_r, n_z, state.normal[active] / (gap + self.R))

    def _factors(self, touching: _Touching, stiffness: Any) -> tuple[Any, Any]:
        """Return a solver for displacements and forces, and the directions of these forces."""
        face, a, b, turn = touching
        size, free = stiffness.shape[0], self._free
        # Normal forces turn with their nodes.
        values = np.tile(turn, 4) * np.concatenate((1 - a * a, 1 - b * b, -a * b, -a * b))
        rows = np.concatenate((face, face + 1, face, face + 1))
        columns = np.concatenate((face, face + 1, face + 1, face))
        turned = stiffness - sparse.csr_matrix((values, (rows, columns)), shape=2 * (size,))
        places = np.concatenate((face, face + 1)), np.tile(np.arange(face.size), 2)
        normal = sparse.csc_matrix((np.concatenate((a, b)), places), shape=(size, face.size))
        border = sparse.hstack((normal, self._held))[free]
        matrix = sparse.bmat([[turned[free][:, free], -border], [-border.T, None]])
        return splu(matrix.tocsc(), permc_spec="COLAMD"), border

    def _solve(self, state: _State, indentation: float) -> _State:
        """Return the equilibrium at an indentation [m], from a first guess.

        Raises
        ------
        ArithmeticError
            If the iteration does not converge.
        """
        (q, normal), free = (x.copy() for x in state), self._free
        support = np.zeros(self._held.shape[1])
        for _ in range(ITERATIONS):
            touches = (normal > 0.0) | (self._gap(q, indentation)[0] < -1e-13 * self.R)
            active, normal = np.flatnonzero(touches), np.where(touches, normal, 0.0)
            _, force, stiffness = self.elastic(q)
            at = self._touching(_State(q, normal), indentation, active)
            solver, border = self._factors(at, stiffness)
            balance = force[free] - border @ np.concatenate((normal[active], support))
            gap = self._gap(q, indentation)[0]
            step = -solver.solve(np.concatenate((balance, -gap[active], -(self._held.T @ q))))
            moved, pushed, pulled = np.split(step, (free.size, free.size + active.size))
            if not np.max(np.abs(moved)) < self.system.plate.radius:
                break
            q[free] += moved
            normal[active] += pushed
            support = support + pulled
            through = self._gap(q, indentation)[0] < -1e-13 * self.R
            settled = np.array_equal(np.where(touches, normal > 0.0, through), touches)
            if settled and np.max(np.abs(moved)) < CLOSE * indentation:
                return _State(q, normal)
        raise ArithmeticError("contact: expected an equilibrium, found none")

    def _result(self, state: _State, indentation: float) -> Pressed:
        """Return the results of a state."""
        energy, _, stiffness = self.elastic(state.q)
        active = np.flatnonzero(state.normal > 0.0)
        at = self._touching(state, indentation, active)
        _, a, b, turn = at
        force = -state.normal[active] * b
        # The sphere moves along -z: the normals of fixed nodes turn, and their gaps decrease.
        moved = np.zeros(state.q.size)
        moved[at.face], moved[at.face + 1] = turn * a * b, -turn * (1 - b * b)
        held = np.zeros(self._held.shape[1])
        rates = -self._factors(at, stiffness)[0].solve(
            np.concatenate((moved[self._free], -b, held))
        )
        rate = np.zeros(state.q.size)
        rate[self._free] = rates[: self._free.size]
        pushed = rates[self._free.size :][: active.size]
        turning = -a * b * rate[at.face] + (1 - b * b) * (rate[at.face + 1] + 1.0)
        slope = -float(pushed @ b + turn @ turning)
        whole = np.zeros(state.normal.size)
        whole[active] = force
        fitted = self._pressure(state.q, whole)
        return Pressed(indentation, float(force.sum()), slope, *fitted[:2], energy, fitted[2])

    def _pressure(self, q: Double, force: Double) -> tuple[float, float, float]:
        """Return contact radius [m], pressure at the centre [Pa], and misfit [1].

        The pressure is a polynomial in s^2 times sqrt(1 - s^2), s being the deformed radius over
        the contact radius. Its forces on the nodes are fitted to the given vertical forces.
        """
        deformed = self.system.contact_radii + q[self._face]
        last = int(np.flatnonzero(force)[-1])
        low, high = deformed[max(last - 1, 1)], deformed[min(last + 1, force.size - 1)]
        tries = np.linspace(low, high, TRIES)
        best = int(np.argmin([self._fit(deformed, force, a)[0] for a in tries]))
        bounds = tries[max(best - 1, 0)], tries[min(best + 1, TRIES - 1)]
        found = minimize_scalar(
            lambda a: self._fit(deformed, force, a)[0], bounds=bounds, method="bounded"
        )
        misfit, pressure = self._fit(deformed, force, float(found.x))
        return float(found.x), pressure, misfit

    def _fit(self, deformed: Double, force: Double, a: float) -> tuple[float, float]:
        """Return misfit [1] and pressure at the centre [Pa] for a contact radius [m]."""
        degree = self.system.mesh.degree
        nodes, _, slope = lobatto(degree)
        t, weights = np.polynomial.legendre.leggauss(POINTS)
        columns = np.zeros((force.size, TERMS))
        for first in range(0, force.size - 1, degree):
            here = slice(first, first + degree + 1)
            r = deformed[here]
            if r[0] >= a:
                break
            x, w = t, weights
            if r[-1] > a:  # the pressure ends in this element; points are dense towards its end
                end = float(np.interp(a, r, nodes))
                for _ in range(8):
                    shapes = _lagrange(nodes, np.array([end]))
                    end -= float((shapes @ r - a)[0] / (shapes @ slope @ r)[0])
                x = -1.0 + (end + 1.0) * (1.0 - 0.25 * (1.0 - t) ** 2)
                w = weights * 0.5 * (1.0 - t) * (end + 1.0)
            shapes = _lagrange(nodes, x)
            at = shapes @ r
            s = np.minimum((at / a) ** 2, 1.0)
            load = 2.0 * np.pi * w * at * (shapes @ slope @ r) * np.sqrt(1.0 - s)
            columns[here] += shapes.T @ (load[:, None] * s[:, None] ** np.arange(TERMS))
        series = np.linalg.lstsq(columns, force, rcond=None)[0]
        return float(np.sum(np.abs(columns @ series - force)) / np.sum(force)), float(series[0])
