"""The plate: material and edge, its sparse matrices, and natural frequencies."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.checks.finite_elements.mesh import Double, Mesh
from derivation.plate.edge.remainder import lobatto

STRAIN_POWERS = np.array([1, 3, 5])
"""Powers of r in the radial displacement of the back face next to the axis."""
EDGES = ("paper", "simply-supported", "clamped")
"""Conditions on the whole edge r = b: w = 0 with a radial spring of stiffness 2 mu/b per area;
w = 0; u = w = 0."""
BENDING_PARITY = 1e-8
"""Product of the two faces' deflections at the axis, over the square of the largest displacement,
above which a mode is a bending mode."""


@dataclass(frozen=True)
class Plate:
    """A circular plate.

    Parameters
    ----------
    radius, thickness
        Dimensions [m].
    youngs_modulus
        Young's modulus [Pa].
    poissons_ratio
        Poisson's ratio [1].
    density
        Density [kg/m^3].
    edge
        One of `EDGES`.
    """

    radius: float
    thickness: float
    youngs_modulus: float
    poissons_ratio: float
    density: float
    edge: str = "paper"

    def __post_init__(self) -> None:
        if self.edge not in EDGES:
            raise ValueError(f"edge: expected one of {', '.join(EDGES)}, got {self.edge!r}")

    @property
    def mu(self) -> float:
        """Shear modulus [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))

    @property
    def lam(self) -> float:
        """First Lame constant [Pa]."""
        return 2.0 * self.mu * self.poissons_ratio / (1.0 - 2.0 * self.poissons_ratio)

    @property
    def modulus(self) -> float:
        """Plane-strain modulus E/(1 - nu^2) [Pa]."""
        return self.youngs_modulus / (1.0 - self.poissons_ratio**2)

    @property
    def pressure_wave_speed(self) -> float:
        """Speed of dilatational waves [m/s]."""
        return float(np.sqrt((self.lam + 2.0 * self.mu) / self.density))

    @property
    def shear_wave_speed(self) -> float:
        """Speed of shear waves [m/s]."""
        return float(np.sqrt(self.mu / self.density))


class System:
    """Stiffness and consistent mass matrix of a plate on a mesh, with its edge conditions."""

    def __init__(self, plate: Plate, mesh: Mesh) -> None:
        self.plate, self.mesh = plate, mesh
        self.r, self.z = _nodes(mesh.r_ends, mesh.degree), _nodes(mesh.z_ends, mesh.degree)
        size = 2 * mesh.columns * mesh.rows
        rows = np.arange(mesh.rows)
        edge = [self._number(np.full_like(rows, mesh.columns - 1), rows, part) for part in (0, 1)]
        held = edge if plate.edge == "clamped" else edge[1:]
        axis = self._number(np.zeros_like(rows), rows, 0)
        self.free = np.setdiff1d(np.arange(size), np.concatenate((axis, *held)))
        self.stiffness, self.mass = self._assembled(size, edge[0])
        touching = np.flatnonzero(self.r <= mesh.reach * (1.0 + 1e-9))
        top = self._number(touching, np.full_like(touching, mesh.rows - 1), 1)
        self.contact_nodes = np.searchsorted(self.free, top)
        self.contact_radii = self.r[touching]
        near = np.arange(1, 1 + STRAIN_POWERS.size)
        back = self._number(near, np.zeros_like(near), 0)
        self.back_nodes = np.searchsorted(self.free, back)

    def _number(self, column: NDArray[Any], row: NDArray[Any], part: int) -> NDArray[Any]:
        """Return the number of an unknown: u (0) or w (1) at a node."""
        number: NDArray[Any] = 2 * (column * self.mesh.rows + row) + part
        return number

    def _assembled(self, size: int, edge: NDArray[Any]) -> tuple[Any, Any]:
        """Return stiffness and mass matrix of the free unknowns."""
        from scipy import sparse

        mesh, numbers, stiff, heavy = self.mesh, [], [], []
        reference = _Reference(mesh.degree)
        for i in range(mesh.r_ends.size - 1):
            for k in range(mesh.z_ends.size - 1):
                block = reference.element(
                    self.plate, mesh.r_ends[i : i + 2], mesh.z_ends[k : k + 2]
                )
                stiff.append(block[0].ravel())
                heavy.append(block[1].ravel())
                column = i * mesh.degree + reference.column
                row = k * mesh.degree + reference.row
                numbers.append(np.concatenate([self._number(column, row, p) for p in (0, 1)]))
        index = np.array(numbers)
        places = (
            np.repeat(index, index.shape[1], axis=1).ravel(),
            np.tile(index, (1, index.shape[1])).ravel(),
        )
        stiffness = sparse.csr_matrix((np.concatenate(stiff), places), shape=(size, size))
        mass = sparse.csr_matrix((np.concatenate(heavy), places), shape=(size, size))
        if self.plate.edge == "paper":
            stiffness = stiffness + self._spring(size, edge)
        return tuple(m[self.free][:, self.free].tocsc() for m in (stiffness, mass))

    def _spring(self, size: int, edge: NDArray[Any]) -> Any:
        """Return the stiffness matrix of the condition sigma_rr = -(2 mu/b) u on the edge."""
        from scipy import sparse

        degree, heights = self.mesh.degree, np.diff(self.mesh.z_ends)
        line = np.zeros(edge.size)
        for k, height in enumerate(heights):
            line[k * degree : (k + 1) * degree + 1] += height / 2 * lobatto(degree)[1]
        entries = 2.0 * np.pi * 2.0 * self.plate.mu * line
        return sparse.csr_matrix((entries, (edge, edge)), shape=(size, size))

    @cached_property
    def _strain_weights(self) -> Double:
        """Weights of u at `back_nodes` in du/dr on the axis, for odd powers of r."""
        r = self.r[1 : 1 + STRAIN_POWERS.size]
        first = np.zeros(r.size)
        first[0] = 1.0 / r[-1]
        weights: Double = np.linalg.solve((r[:, None] / r[-1]) ** STRAIN_POWERS, np.eye(r.size))
        return first @ weights

    def back_face_stress(self, displacement: Double) -> float:
        """Return the stress on the axis of the back face [Pa], which is free of traction."""
        strain = float(self._strain_weights @ displacement[self.back_nodes])
        return self.plate.youngs_modulus / (1.0 - self.plate.poissons_ratio) * strain

    @cached_property
    def static_solver(self) -> Any:
        """Factors of the stiffness matrix."""
        return factorised(self.stiffness)

    def bending_frequencies(self, count: int) -> Double:
        """Return the lowest angular frequencies of bending modes [rad/s].

        Raises
        ------
        ArithmeticError
            If fewer than `count` of the computed modes are bending modes.
        """
        from scipy.sparse.linalg import LinearOperator, eigsh

        solver = self.static_solver
        inverse = LinearOperator(self.stiffness.shape, matvec=solver.solve)
        squares, shapes = eigsh(
            self.stiffness, 3 * count, self.mass, sigma=0.0, OPinv=inverse, tol=1e-11
        )
        faces = self._number(np.zeros(2, dtype=int), np.array([0, self.mesh.rows - 1]), 1)
        back, front = shapes[np.searchsorted(self.free, faces)]
        # In bending both faces move in the same direction, in extension in opposite directions.
        bending = np.sort(squares[back * front > BENDING_PARITY * (shapes**2).max(axis=0)])
        if bending.size < count:
            raise ArithmeticError(f"modes: expected {count} of bending, got {bending.size}")
        frequencies: Double = np.sqrt(bending[:count])
        return frequencies


class _Reference:
    """Shape functions of an element at the points of a Gauss rule."""

    def __init__(self, degree: int) -> None:
        nodes, _, slope = lobatto(degree)
        self.points, self.weights = np.polynomial.legendre.leggauss(degree + 1)
        values = _lagrange(nodes, self.points)
        slopes = values @ slope
        self.values = np.kron(values, values)
        self.by_r, self.by_z = np.kron(slopes, values), np.kron(values, slopes)
        self.column = np.repeat(np.arange(degree + 1), degree + 1)
        self.row = np.tile(np.arange(degree + 1), degree + 1)

    def element(self, plate: Plate, r_ends: Double, z_ends: Double) -> tuple[Double, Double]:
        """Return an element's stiffness and mass matrix."""
        width, height = np.diff(r_ends)[0], np.diff(z_ends)[0]
        r = np.repeat(r_ends.mean() + width / 2 * self.points, self.points.size)
        area = 2.0 * np.pi * np.kron(self.weights, self.weights) * r * width * height / 4
        zero = np.zeros_like(self.values)
        by_r, by_z = self.by_r * 2 / width, self.by_z * 2 / height
        rr, tt = np.hstack((by_r, zero)), np.hstack((self.values / r[:, None], zero))
        zz, rz = np.hstack((zero, by_z)), np.hstack((by_z, by_r))
        trace, weigh = rr + tt + zz, area[:, None]
        stiffness = plate.lam * trace.T @ (weigh * trace) + plate.mu * rz.T @ (weigh * rz)
        for strain in (rr, tt, zz):
            stiffness += 2.0 * plate.mu * strain.T @ (weigh * strain)
        one = plate.density * self.values.T @ (weigh * self.values)
        mass = np.kron(np.eye(2), one)
        return stiffness, mass


def factorised(matrix: Any) -> Any:
    """Return the factors of a symmetric positive definite sparse matrix."""
    from scipy.sparse.linalg import splu

    return splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )


def _nodes(ends: Double, degree: int) -> Double:
    """Return the coordinates of the nodes of a row of elements."""
    nodes = lobatto(degree)[0]
    low, high = ends[:-1, None], ends[1:, None]
    inner = (low + high) / 2 + (high - low) / 2 * nodes[:-1]
    return np.append(inner.ravel(), ends[-1])


def _lagrange(nodes: Double, points: Double) -> Double:
    """Return the Lagrange polynomials of nodes (columns) at points (rows)."""
    gaps = points[:, None, None] - nodes[None, None, :]
    scale = nodes[:, None] - nodes
    np.fill_diagonal(scale, 1.0)
    ratio = gaps / scale
    index = np.arange(nodes.size)
    ratio[:, index, index] = 1.0
    weights: Double = ratio.prod(axis=2)
    return weights
