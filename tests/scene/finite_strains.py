"""A rigid sphere pressed into a plate of finite elements with finite strains.

The elements are those of `derivation.checks.finite_elements`, in r and z, with Green's strain and a
linear law between it and the second Piola-Kirchhoff stress. Nodes of the contact face touch the
sphere without friction, along its normal, in the deformed state. No thin plate, no half-space and
no contact law is assumed.
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

ITERATIONS, CLOSE = 40, 1e-9
"""Largest number of Newton's iterations; relative residual that ends them."""
REACH = 1.6
"""Radius of the nodes that may touch the sphere over the expected contact radius."""
TERMS, FINE = 4, 24
"""Number of terms of the pressure over the radius; Gauss points per element of the contact face."""


class Fineness(NamedTuple):
    """Mesh density.

    Attributes
    ----------
    contact
        Number of elements over the contact radius.
    halved
        How often elements are halved towards the end of the contact, from both sides.
    far
        Largest radial element size over the thickness.
    degree
        Polynomial degree.
    edge
        How often the element at the edge is halved.
    """

    contact: int = 8
    halved: int = 3
    far: float = 2.0
    degree: int = 4
    edge: int = 3


def edge_mesh(b: float, thickness: float, radius: float, fine: Fineness) -> Mesh:
    """Return a mesh of a plate of radius b [m] whose elements are smallest at a radius [m]."""
    size = radius / fine.contact
    inner = np.linspace(0.0, radius, fine.contact + 1)
    more = radius - size * 0.5 ** np.arange(1, fine.halved + 1)
    smallest = size * 0.5**fine.halved
    outer = _growing_intervals(smallest, b - radius, 2.0, fine.far * thickness, fine.edge)
    depth = _growing_intervals(2.0 * smallest, thickness, 2.0, 0.5 * thickness, 0)
    r_ends = np.concatenate((inner[:-1], more, radius + outer))
    z_ends = thickness / 2 - depth[::-1]
    r_ends[-1], z_ends[0], z_ends[-1] = b, -thickness / 2, thickness / 2
    reach = float(r_ends[r_ends <= REACH * radius][-1])
    return Mesh(r_ends, z_ends, fine.degree, reach)


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
        Sum of the deviations of the node forces from the fitted pressure, over the force [1].
    touching
        Number of touching nodes.
    """

    indentation: float
    force: float
    stiffness: float
    radius: float
    pressure: float
    energy: float
    misfit: float
    touching: int


class _State(NamedTuple):
    """Displacements, and normal forces on the nodes of the contact face."""

    q: Double
    normal: Double


@dataclass(frozen=True)
class PressedPlate:
    """A plate and a rigid sphere.

    Attributes
    ----------
    system
        Unknowns and edge conditions of the plate.
    R
        Radius of the sphere [m].
    mean
        Whether only the mean deflection of the edge vanishes, so that it may turn by any angle.
    """

    system: System
    R: float
    mean: bool = False

    @classmethod
    def of(
        cls, plate: Plate, R: float, radius: float, fine: Fineness, mean: bool = False
    ) -> "PressedPlate":
        """Return a plate whose mesh is fine under an expected contact radius [m] and at its end."""
        mesh = edge_mesh(plate.radius, plate.thickness, radius, fine)
        return cls(System(plate, mesh), R, mean and plate.edge != "clamped")

    @property
    def mesh(self) -> Mesh:
        """The mesh."""
        return self.system.mesh

    @cached_property
    def _reference(self) -> _Reference:
        return _Reference(self.mesh.degree)

    @cached_property
    def _numbers(self) -> NDArray[np.intp]:
        """Numbers of the unknowns of each element: all u, then all w."""
        one, mesh = self._reference, self.mesh
        i, k = np.divmod(
            np.arange((mesh.r_ends.size - 1) * (mesh.z_ends.size - 1)), mesh.z_ends.size - 1
        )
        column = i[:, None] * mesh.degree + one.column
        row = k[:, None] * mesh.degree + one.row
        first = 2 * (column * mesh.rows + row)
        return np.concatenate((first, first + 1), axis=1)

    @cached_property
    def _gradients(self) -> tuple[Double, Double, Double, Double]:
        """Return d/dr, d/dz and 1/r of the shape functions of each element at Gauss' points.

        The last array contains the weights of the points.
        """
        one, mesh = self._reference, self.mesh
        width, height = np.diff(mesh.r_ends), np.diff(mesh.z_ends)
        middle = (mesh.r_ends[1:] + mesh.r_ends[:-1]) / 2
        by_r = np.repeat(one.by_r[None] * (2 / width)[:, None, None], height.size, axis=0)
        by_z = np.tile(one.by_z[None] * (2 / height)[:, None, None], (width.size, 1, 1))
        r = np.repeat(middle[:, None] + width[:, None] / 2 * one.points, one.points.size, axis=1)
        square = 2.0 * np.pi * np.kron(one.weights, one.weights) * r / 4
        weights = (width[:, None] * square)[:, None] * height[:, None]
        over_r = np.repeat(one.values / r[..., None], height.size, axis=0)
        return by_r, by_z, over_r, weights.reshape(-1, r.shape[1])

    @cached_property
    def _spring(self) -> Any:
        """Stiffness of the elastic edge, for all unknowns."""
        size, mesh = 2 * self.mesh.columns * self.mesh.rows, self.mesh
        if self.system.plate.edge != "paper":
            return sparse.csr_matrix((size, size))
        rows = np.arange(mesh.rows)
        return self.system._spring(size, 2 * ((mesh.columns - 1) * mesh.rows + rows))

    @cached_property
    def _free(self) -> NDArray[np.intp]:
        """Unknowns that are not zero."""
        if not self.mean:
            return self.system.free
        return np.union1d(self.system.free, self._edge)

    @cached_property
    def _edge(self) -> NDArray[np.intp]:
        """Deflections of the edge."""
        rows = np.arange(self.mesh.rows)
        return 2 * ((self.mesh.columns - 1) * self.mesh.rows + rows) + 1

    @cached_property
    def _held(self) -> Any:
        """Additional condition on all unknowns, in a column: the mean deflection of the edge."""
        size = 2 * self.mesh.columns * self.mesh.rows
        if not self.mean:
            return sparse.csc_matrix((size, 0))
        degree, line = self.mesh.degree, np.zeros(self.mesh.rows)
        for k, height in enumerate(np.diff(self.mesh.z_ends)):
            line[k * degree : (k + 1) * degree + 1] += height / 2 * lobatto(degree)[1]
        line /= np.sum(line)
        return sparse.csc_matrix((line, (self._edge, 0 * self._edge)), shape=(size, 1))

    @cached_property
    def _face(self) -> NDArray[np.intp]:
        """Numbers of u of the nodes of the contact face that may touch the sphere."""
        top = np.arange(self.system.contact_radii.size) * self.mesh.rows + self.mesh.rows - 1
        return 2 * top

    def inside(self, q: Double) -> tuple[float, Double, Any]:
        """Return the elastic energy, and its first and second derivative for all unknowns."""
        plate, (by_r, by_z, over_r, weights) = self.system.plate, self._gradients
        n = by_r.shape[2]
        of_element = q[self._numbers]
        u, w = of_element[:, :n, None], of_element[:, n:, None]
        u_r, u_z, w_r, w_z = (x[..., 0] for x in (by_r @ u, by_z @ u, by_r @ w, by_z @ w))
        hoop = (over_r @ u)[..., 0]
        rr = u_r + 0.5 * (u_r**2 + w_r**2)
        zz = w_z + 0.5 * (u_z**2 + w_z**2)
        tt = hoop + 0.5 * hoop**2
        rz = u_z + w_r + u_r * u_z + w_r * w_z  # twice the shear strain
        trace, lam, mu = rr + tt + zz, plate.lam, plate.mu
        energy = 0.5 * lam * trace**2 + mu * (rr**2 + zz**2 + tt**2 + 0.5 * rz**2)
        s_rr, s_zz, s_tt = (lam * trace + 2.0 * mu * x for x in (rr, zz, tt))
        s_rz = mu * rz

        def both(one: Double, of_u: Double, other: Double, of_w: Double) -> Double:
            return np.concatenate((of_u[..., None] * one, of_w[..., None] * other), axis=2)

        d_rr, d_zz = both(by_r, 1.0 + u_r, by_r, w_r), both(by_z, u_z, by_z, 1.0 + w_z)
        d_rz = both(by_z, 1.0 + u_r, by_z, w_r) + both(by_r, u_z, by_r, 1.0 + w_z)
        d_tt = both(over_r, 1.0 + hoop, over_r, 0.0 * hoop)
        stresses = (s_rr, s_zz, s_tt, s_rz)
        changes = (d_rr, d_zz, d_tt, d_rz)
        force = sum(
            np.einsum("eg,egi->ei", weights * s, d) for s, d in zip(stresses, changes, strict=True)
        )
        all_of = d_rr + d_zz + d_tt
        parts = [np.sqrt(weights * lam)[..., None] * all_of] if lam >= 0 else []
        assert parts, "Poisson's ratio is negative"
        parts += [np.sqrt(weights * 2.0 * mu)[..., None] * d for d in (d_rr, d_zz, d_tt)]
        parts += [np.sqrt(weights * mu)[..., None] * d_rz]
        stacked = np.concatenate(parts, axis=1)
        stiffness = np.swapaxes(stacked, 1, 2) @ stacked
        weighed = [(weights * s)[..., None] for s in stresses]
        across = np.swapaxes(by_r, 1, 2) @ (weighed[3] * by_z)
        turning = (
            np.swapaxes(by_r, 1, 2) @ (weighed[0] * by_r)
            + np.swapaxes(by_z, 1, 2) @ (weighed[1] * by_z)
            + across
            + np.swapaxes(across, 1, 2)
        )
        stiffness[:, n:, n:] += turning
        stiffness[:, :n, :n] += turning + np.swapaxes(over_r, 1, 2) @ (weighed[2] * over_r)
        size, index = q.size, self._numbers
        whole = np.zeros(size)
        np.add.at(whole, index.ravel(), np.asarray(force).ravel())
        places = (
            np.repeat(index, 2 * n, axis=1).ravel(),
            np.tile(index, (1, 2 * n)).ravel(),
        )
        matrix = sparse.csr_matrix((stiffness.ravel(), places), shape=(size, size)) + self._spring
        pull = self._spring @ q
        return float(np.sum(weights * energy) + 0.5 * q @ pull), whole + pull, matrix

    def gap(self, q: Double, indentation: float) -> tuple[Double, Double, Double]:
        """Return distance from the sphere, and direction from its centre, at the face's nodes."""
        x = self.system.contact_radii + q[self._face]
        z = self.R - indentation - q[self._face + 1]  # height of the centre above the node
        distance = np.hypot(x, z)
        return distance - self.R, x / distance, -z / distance

    def press(self, indentations: Sequence[float]) -> list[Pressed]:
        """Return the contacts at increasing indentations [m], in few steps between them.

        Raises
        ------
        ArithmeticError
            If Newton's iteration does not converge in a short step.
        """
        size = 2 * self.mesh.columns * self.mesh.rows
        state, at, results = _State(np.zeros(size), np.zeros(self._face.size)), 0.0, []
        before: tuple[_State, float] | None = None
        for goal in indentations:
            step = goal - at
            while at < goal:
                step = min(step, goal - at)
                if step < 1e-3 * goal:
                    raise ArithmeticError("contact: no convergence")
                guess = state
                if before is not None:
                    part = step / (at - before[1])
                    guess = _State(state.q + part * (state.q - before[0].q), state.normal)
                try:
                    found = self._solve(guess, at + step)
                except ArithmeticError:
                    step *= 0.4
                    continue
                before, state, at = (state, at), found, at + step
                step *= 2.0
            results.append(self._result(state, goal))
        return results

    def _system(self, state: _State, active: NDArray[np.intp], stiffness: Any, depth: float) -> Any:
        """Return the matrix of all unknowns, the normal forces and the edge."""
        gap, n_r, n_z = self.gap(state.q, depth)
        face, size = self._face[active], state.q.size
        force, length = state.normal[active], gap[active] + self.R
        # Derivative of the direction of the normal force.
        a, b = n_r[active], n_z[active]
        values = np.concatenate([(1 - a * a), (1 - b * b), -a * b, -a * b])
        rows = np.concatenate([face, face + 1, face, face + 1])
        columns = np.concatenate([face, face + 1, face + 1, face])
        turn = sparse.csr_matrix(
            (np.tile(force / length, 4) * values, (rows, columns)), shape=(size, size)
        )
        places = np.arange(active.size)
        normal = sparse.csc_matrix(
            (np.concatenate((a, b)), (np.concatenate((face, face + 1)), np.tile(places, 2))),
            shape=(size, active.size),
        )
        free, held = self._free, self._held
        border = sparse.hstack((normal, held))[free]
        matrix = sparse.bmat([[(stiffness - turn)[free][:, free], -border], [-border.T, None]])
        return splu(matrix.tocsc(), permc_spec="COLAMD"), border

    def _solve(self, state: _State, depth: float) -> _State:
        """Return the equilibrium at an indentation [m], from a first guess.

        Raises
        ------
        ArithmeticError
            If the iteration does not converge.
        """
        q, normal = state.q.copy(), state.normal.copy()
        support = np.zeros(self._held.shape[1])
        free = self._free
        with np.errstate(all="ignore"):
            for _ in range(ITERATIONS):
                gap, n_r, n_z = self.gap(q, depth)
                touching = np.where(normal > 0.0, True, gap < -1e-13 * self.R)
                if not touching.any():
                    touching[0] = True
                active = np.flatnonzero(touching)
                normal = np.where(touching, normal, 0.0)
                _, force, stiffness = self.inside(q)
                solver, border = self._system(_State(q, normal), active, stiffness, depth)
                loads = np.concatenate((normal[active], support))
                residual = np.concatenate((
                    force[free] - border @ loads,
                    -gap[active] , -(self._held.T @ q),
                ))
                step = solver.solve(-residual)
                if not np.isfinite(step).all():
                    raise ArithmeticError("contact: not finite")
                q[free] += step[: free.size]
                m = active.size
                normal[active] += step[free.size : free.size + m]
                support = support + step[free.size + m :]
                if np.max(np.abs(step[: free.size])) > 10 * self.system.plate.radius:
                    raise ArithmeticError("contact: diverges")
                gap = self.gap(q, depth)[0]
                same = np.array_equal(
                    np.where(touching, normal > 0.0, gap < -1e-13 * self.R), touching
                )
                small = np.max(np.abs(step[: free.size])) < CLOSE * depth
                if same and small and not (normal < 0).any():
                    return _State(q, normal)
        raise ArithmeticError("contact: no convergence")

    def _result(self, state: _State, depth: float) -> Pressed:
        """Return the results of a state."""
        q, normal = state
        energy, _, stiffness = self.inside(q)
        active = np.flatnonzero(normal > 0.0)
        _, n_r, n_z = self.gap(q, depth)
        force = float(-normal @ n_z)
        # The sphere moves by one unit along -z: its constraint changes by -n_z.
        solver, border = self._system(state, active, stiffness, depth)
        free, m = self._free, active.size
        # Derivative of the residual with respect to the indentation, at fixed displacements.
        face, length = self._face[active], self.R
        a, b = n_r[active], n_z[active]
        moved = np.zeros(q.size)  # -d(normal force)/d(depth)
        scale = normal[active] / length
        moved[face] = -scale * (-a * b)
        moved[face + 1] = -scale * (1 - b * b)
        gap_rate = b * 1.0  # d gap/d depth = n . (0, 1)
        rate = np.concatenate((moved[free], -gap_rate, np.zeros(self._held.shape[1])))
        step = solver.solve(-rate)
        dq = np.zeros(q.size)
        dq[free] = step[: free.size]
        d_normal = step[free.size : free.size + m]
        d_bz = -a * b / length * dq[face] + (1 - b * b) / length * (dq[face + 1] + 1.0)
        slope = float(-d_normal @ b - normal[active] @ d_bz)
        radius, pressure, misfit = self._pressure(q, -normal * n_z, force)
        return Pressed(depth, force, slope, radius, pressure, energy, misfit, m)

    def _pressure(self, q: Double, vertical: Double, force: float) -> tuple[float, float, float]:
        """Return contact radius [m], pressure at the centre [Pa] and misfit of a smooth pressure.

        The pressure is sqrt(1 - s^2) times a polynomial in s^2, s being the deformed radius over
        the contact radius. Its forces on the nodes are fitted to the vertical ones.
        """
        degree, nodes = self.mesh.degree, self.system.contact_radii
        deformed = nodes + q[self._face]
        points, weights = np.polynomial.legendre.leggauss(FINE)
        local, _, slope = lobatto(degree)
        shapes = _lagrange(local, points)
        slopes = shapes @ slope
        last = int(np.flatnonzero(vertical > 0.0)[-1])
        ends = np.arange(0, nodes.size - 1, degree)

        def fit(a: float) -> tuple[float, Double]:
            columns = np.zeros((nodes.size, TERMS))
            for first in ends:
                here = slice(first, first + degree + 1)
                if deformed[first] >= a:
                    break
                r, dr = shapes @ deformed[here], slopes @ deformed[here]
                w, s_of = weights * dr * r, shapes
                if deformed[first + degree] > a:  # the pressure ends in this element
                    low, high = -1.0, 1.0
                    for _ in range(60):
                        x = 0.5 * (low + high)
                        inside = float(_lagrange(local, np.array([x]))[0] @ deformed[here]) < a
                        low, high = (x, high) if inside else (low, x)
                    # Dense points towards the end of the pressure.
                    t = 0.5 * (points + 1.0)
                    x = -1.0 + (low + 1.0) * (1.0 - (1.0 - t) ** 2)
                    s_of = _lagrange(local, x)
                    r, dr = s_of @ deformed[here], (s_of @ slope) @ deformed[here]
                    w = weights * (1.0 - t) * (low + 1.0) * dr * r
                s = np.minimum((r / a) ** 2, 1.0)
                for k in range(TERMS):
                    columns[here, k] += s_of.T @ (2 * np.pi * w * np.sqrt(1.0 - s) * s**k)
            best = np.linalg.lstsq(columns, vertical, rcond=None)[0]
            return float(np.sum(np.abs(columns @ best - vertical))), best

        low = deformed[max(last - 1, 1)]
        high = deformed[min(last + 1, nodes.size - 1)]
        tries = np.linspace(low, high, 25)
        sums = [fit(float(a))[0] for a in tries]
        best = int(np.argmin(sums))
        bounds = tries[max(best - 1, 0)], tries[min(best + 1, tries.size - 1)]
        found = minimize_scalar(lambda a: fit(a)[0], bounds=bounds, method="bounded")
        misfit, series = fit(float(found.x))
        return float(found.x), float(series[0]), misfit / force
