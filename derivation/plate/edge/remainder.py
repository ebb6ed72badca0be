"""Model error of the edge corrections, measured against three-dimensional elasticity.

Modes and polynomial states together satisfy all conditions except those on the edge r = b, which
they satisfy in the mean only. The remainder is an elastic field without load on the faces, caused
by the edge alone and smooth inside. Spectral elements compute it; Hertz pressure does not enter.
The edge conditions of the remainder are

    supported   w = 0,  sigma_rr = 0:   traction -sigma_rr and displacement -w of what is there,
    clamped     u = w = 0:              displacements -u and -w of what is there,

both on the whole edge, not only in the middle plane or in the mean. The model error is the centre
deflection of the contact face by both, minus the law's value, divided by delta. That of the stress
on the axis of the back face is their stress, minus the law's value, divided by this value.

The Gauss-Lobatto-Legendre elements all have one degree. The mesh is graded geometrically towards
the edge and its two corners, where a clamp is singular. Another degree and another layer of
elements show convergence. `python -m derivation.plate.edge.remainder` repeats the computation with
SciPy in minutes.
"""

import dataclasses
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.engine.files import measurements, write_file
from derivation.engine.outputs import sorted_json
from generated.back_face import (
    back_face_stress,
    clamped_back_face_stress,
    supported_back_face_stress,
)
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros
from generated.contact_law import indentation
from generated.edge import clamped_edge, supported_edge
from generated.mode_shapes import mode_g
from generated.pressure import A_j

Double = NDArray[np.float64]
SUPPORTS = ("supported", "clamped")
MODES = 6000
"""Number of modes in u at the edge; on the contact face the sum converges like N^(-3/2)."""
SIZES = (0.02, 0.035, 0.05, 0.1, 0.2, 0.25, 0.3, 0.5, 0.7, 1.0)
"""h/b."""
POISSON = (-0.7, -0.5, 0.0, 0.2, 0.3, 0.45, 0.499999)
WIDTHS = (0.01, 0.1, 0.3)
"""a/b."""
RADIUS = 1e3
"""Sphere radius over plate radius: the relative error does not depend on it."""


@dataclass(frozen=True)
class RemainderCase:
    """A plate of radius 1 and shear modulus 1."""

    support: str
    h: float
    nu: float

    @property
    def lam(self) -> float:
        """First Lame constant."""
        return 2.0 * self.nu / (1.0 - 2.0 * self.nu)


@dataclass(frozen=True)
class RemainderMesh:
    """Degree of the elements, and number of layers graded towards edge and corners."""

    degree: int = 8
    layers: int = 5


MESHES = (RemainderMesh(), RemainderMesh(degree=6), RemainderMesh(layers=4))
"""The mesh that is used, and two meshes that show its error."""


@cache
def lobatto(degree: int) -> tuple[Double, Double, Double]:
    """Return Gauss-Lobatto-Legendre nodes, weights and differentiation matrix on [-1, 1]."""
    from scipy.special import eval_legendre, roots_jacobi

    nodes = np.concatenate(([-1.0], roots_jacobi(degree - 1, 1, 1)[0], [1.0]))
    values = eval_legendre(degree, nodes)
    weights = 2.0 / (degree * (degree + 1) * values**2)
    gaps = nodes[:, None] - nodes
    np.fill_diagonal(gaps, 1.0)
    matrix = values[:, None] / values / gaps
    np.fill_diagonal(matrix, 0.0)
    matrix[0, 0], matrix[-1, -1] = -degree * (degree + 1) / 4.0, degree * (degree + 1) / 4.0
    return nodes, weights, matrix


def heights(h: float, layers: int) -> Double:
    """Return the element boundaries over the thickness, halved towards both faces."""
    steps = h * 0.5 ** np.arange(layers + 1)
    return np.concatenate((-h + np.append(0.0, steps[::-1]), h - steps[1:], [h]))


def radii(h: float, layers: int) -> Double:
    """Return the element boundaries along r: halved towards the edge, growing towards the axis."""
    steps = [min(h, 1.0) * 0.5**k for k in range(layers, -1, -1)]
    while steps[-1] < 1.0:
        steps.append(min(steps[-1] + max(h, 0.5 * steps[-1]), 1.0))
    if steps[-1] - steps[-2] < 0.2 * (steps[-2] - steps[-3]):
        steps.pop(-2)
    return np.unique(np.concatenate(([0.0], 1.0 - np.array(steps[:-1]), [1.0])))


def edge_displacement(case: RemainderCase, a: float, z: Double, modes: int = MODES) -> Double:
    """Return u(b, z) of a limited number of modes."""
    j = bessel_j0_zeros(modes)
    slope = bessel_j1_at_j0_zeros(modes)
    A = A_j(j, 1.0, RADIUS, a, case.lam, 1.0, slope)
    terms: Double = _mode_shapes(tuple(z), case.h, case.lam, modes) * (A * j * slope)
    # The last term is halved, because the sum alternates.
    total: Double = terms.sum(axis=1) - 0.5 * terms[:, -1]
    return total


@lru_cache(maxsize=2)
def _mode_shapes(z: tuple[float, ...], h: float, lam: float, modes: int) -> Double:
    """Return `mode_g` under A_j = 1 at all heights, which all contact radii and edges need."""
    shapes: Double = mode_g(np.array(z)[:, None], bessel_j0_zeros(modes), h, lam, 1.0, 1.0)
    return shapes


def moments(u: Double, z: Double, weights: Double, h: float) -> tuple[float, float]:
    """Return mean strain e = u/b and rotation k of the edge."""
    return float(weights @ u) / (2.0 * h), float(weights @ (u * z)) * 1.5 / h**3


class Elements:
    """Elements of one degree in a rectangle, with displacements u and w at each node.

    Parameters
    ----------
    x_ends, z_ends
        Boundaries of the elements along the plate and over its thickness.
    degree
        Polynomial degree.
    """

    def __init__(self, x_ends: Double, z_ends: Double, degree: int) -> None:
        self.x_ends, self.z_ends, self.degree = x_ends, z_ends, degree
        self.columns = (len(x_ends) - 1) * degree + 1
        self.rows = (len(z_ends) - 1) * degree + 1
        self.size = 2 * self.columns * self.rows
        self.z, self.edge_weights = self._edge_nodes()

    def _edge_nodes(self) -> tuple[Double, Double]:
        """Return the heights of the nodes on the edge and their quadrature weights."""
        nodes, weights, _ = lobatto(self.degree)
        z, w = np.zeros(self.rows), np.zeros(self.rows)
        for k, (low, high) in enumerate(itertools.pairwise(self.z_ends)):
            place = slice(k * self.degree, (k + 1) * self.degree + 1)
            z[place] = (low + high) / 2 + (high - low) / 2 * nodes
            w[place] += (high - low) / 2 * weights
        # Rounding must not move a node on a face beyond it.
        return np.clip(z, self.z_ends[0], self.z_ends[-1]), w

    def number(self, column: NDArray[Any], row: NDArray[Any], part: int) -> NDArray[Any]:
        """Return the index of an unknown: u (0) or w (1) at a node."""
        numbers: NDArray[Any] = 2 * (column * self.rows + row) + part
        return numbers

    def stiffness(self, lam: float, *, round_plate: bool) -> Any:
        """Return the sparse matrix of the strain energy, with shear modulus 1.

        Parameters
        ----------
        lam
            First Lame constant.
        round_plate
            Whether x is the radius of a round plate (the energy is then without the factor 2 pi);
            otherwise the strain is plane.
        """
        from scipy import sparse

        rows, columns, values = [], [], []
        for i in range(len(self.x_ends) - 1):
            for k in range(len(self.z_ends) - 1):
                block, numbers = self._element(i, k, lam, round_plate)
                rows.append(np.repeat(numbers, numbers.size))
                columns.append(np.tile(numbers, numbers.size))
                values.append(block.ravel())
        entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
        return sparse.csc_matrix(entries, shape=(self.size, self.size))

    def _element(
        self, i: int, k: int, lam: float, round_plate: bool
    ) -> tuple[Double, NDArray[Any]]:
        """Return an element's matrix and the indices of its unknowns."""
        nodes, weights, slope = lobatto(self.degree)
        (left, right), (low, high) = self.x_ends[i : i + 2], self.z_ends[k : k + 2]
        count = nodes.size
        one = np.eye(count)
        by_x = np.kron(slope * 2 / (right - left), one)
        by_z = np.kron(one, slope * 2 / (high - low))
        zero = np.zeros_like(by_x)
        normal = [np.hstack((by_x, zero)), np.hstack((zero, by_z))]
        shear = np.hstack((by_z, by_x))
        across = weights * (right - left) / 2
        if round_plate:
            r = (left + right) / 2 + (right - left) / 2 * nodes
            across = across * r
            # u/r at r = 0 is du/dr, because u is odd.
            over_r = np.diag(np.kron(1.0 / np.where(r > 0, r, 1.0), np.ones(count)))
            on_axis = np.kron(r == 0, np.ones(count, dtype=bool))
            over_r[on_axis] = by_x[on_axis]
            normal.append(np.hstack((over_r, zero)))
        area = np.kron(across, weights * (high - low) / 2)[:, None]
        whole: Double = np.sum(normal, axis=0)
        block = lam * whole.T @ (area * whole) + shear.T @ (area * shear)
        for strain in normal:
            block += 2.0 * strain.T @ (area * strain)
        column = np.repeat(i * self.degree + np.arange(count), count)
        row = np.tile(k * self.degree + np.arange(count), count)
        numbers = np.concatenate([self.number(column, row, part) for part in (0, 1)])
        return block, numbers


@lru_cache(maxsize=2)
def _stiffness(h: float, lam: float, mesh: RemainderMesh) -> Any:
    """Return the matrix of a round plate without its edge conditions."""
    whole = Elements(radii(h, mesh.layers), heights(h, mesh.layers), mesh.degree)
    return whole.stiffness(lam, round_plate=True)


def factorised(matrix: Any) -> Any:
    """Return SciPy's factors of a symmetric and positive definite matrix, without pivoting."""
    from scipy.sparse.linalg import splu

    return splu(
        matrix.tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )


class Field(Elements):
    """The remainder's finite-element system on one mesh."""

    def __init__(self, case: RemainderCase, mesh: RemainderMesh) -> None:
        self.case, self.mesh = case, mesh
        super().__init__(radii(case.h, mesh.layers), heights(case.h, mesh.layers), mesh.degree)

    def added(self, widths: Sequence[float], *, states: bool = True) -> list[tuple[float, float]]:
        """Return the changes by a support, by a/b: of -w at the centre, and of the stress.

        The former is on the contact face; the stress is sigma_rr on the axis of the back face. The
        polynomial states contribute most of both; without them the elements compute all.
        """
        known = [self._of_states(a) if states else (0.0, 0.0) for a in widths]
        fields = self._solved(widths, states)
        top = self.number(np.array([0]), np.array([self.rows - 1]), 1)[0]
        first = np.arange(self.degree + 1)
        bottom = self.number(first, np.zeros_like(first), 0)
        slope = lobatto(self.degree)[2][0] * 2.0 / self.x_ends[1]
        nu = self.case.nu
        stiffness = 2.0 * (1.0 + nu) / (1.0 - nu)  # the face is free, and both strains are equal
        return [
            (depth - float(one[top]), stiffness * (strain + float(slope @ one[bottom])))
            for (depth, strain), one in zip(known, fields, strict=True)
        ]

    def face(self, a: float) -> tuple[Double, Double]:
        """Return r, and the change by a support of the indentation -w of the contact face there."""
        nodes, columns = lobatto(self.degree)[0], np.arange(self.columns)
        ends = zip(self.x_ends[:-1], self.x_ends[1:], strict=True)
        inside = [(low + high) / 2 + (high - low) / 2 * nodes[:-1] for low, high in ends]
        r = np.append(np.concatenate(inside), self.x_ends[-1])
        (field,) = self._solved([a], states=False)
        return r, -field[self.number(columns, np.full_like(columns, self.rows - 1), 1)]

    def _solved(self, widths: Sequence[float], states: bool) -> list[Double]:
        """Return the displacements at all nodes, by a/b."""
        case, ring = self.case, np.arange(self.rows)
        matrix = _stiffness(case.h, case.lam, self.mesh)
        axis = self.number(np.zeros_like(ring), ring, 0)
        at_edge = [self.number(np.full_like(ring, self.columns - 1), ring, part) for part in (0, 1)]
        held = at_edge if case.support == "clamped" else at_edge[1:]
        fixed = np.concatenate((axis, *held))
        free = np.setdiff1d(np.arange(self.size), fixed)
        rows = matrix[free]
        solver = factorised(rows[:, free])
        fields = []
        for a in widths:
            values, load = np.zeros(self.size), np.zeros(self.size)
            pushed, values[at_edge[0]], values[at_edge[1]] = self._edge_values(a, states)
            load[at_edge[0]] = pushed * self.edge_weights
            values[free] += solver.solve(load[free] - rows @ values)
            fields.append(values)
        return fields

    def _of_states(self, a: float) -> tuple[float, float]:
        """Return the states' part of `added`: of -w, and of e_rr on the back face."""
        case = self.case
        e, k = moments(edge_displacement(case, a, self.z), self.z, self.edge_weights, case.h)
        thinning = case.lam / (case.lam + 2.0)
        w = k / 2 - thinning * (2.0 * e * case.h + k * case.h**2)
        part = 1.0 if case.support == "clamped" else -(1.0 - case.nu) / (1.0 + case.nu)
        return part * w, -part * (e - k * case.h)

    def _edge_values(self, a: float, states: bool) -> tuple[Double, Double, Double]:
        """Return the given traction, u and w on the edge; components that are not given are 0."""
        case, z = self.case, self.z
        u = edge_displacement(case, a, z)
        e, k = moments(u, z, self.edge_weights, case.h) if states else (0.0, 0.0)
        thinning = case.lam / (case.lam + 2.0)
        flat, deep = e + k * z, -thinning * (2.0 * e * z + k * z**2)
        if case.support == "clamped":
            return 0.0 * u, flat - u, deep
        ratio = (1.0 - case.nu) / (1.0 + case.nu)
        stiff = 2.0 * (3.0 * case.lam + 2.0) / (case.lam + 2.0)
        return 2.0 * u - ratio * stiff * flat, 0.0 * u, -ratio * deep


def edge_contribution(case: RemainderCase, a: float) -> tuple[float, float]:
    """Return the law's change by the edge, and its indentation with this change."""
    edge = {"supported": supported_edge, "clamped": clamped_edge}[case.support]
    more = float(edge(a, case.h, 1.0, case.lam, 1.0)) * a**2 / RADIUS
    return more, more + float(indentation(a, RADIUS, case.h, 1.0))


def back_face_stresses(case: RemainderCase, a: float) -> tuple[float, float]:
    """Return the law's stress on the axis of the back face with the paper's edge and a support."""
    held = {"supported": supported_back_face_stress, "clamped": clamped_back_face_stress}
    force = 8.0 / 3.0 / (1.0 - case.nu) * a**3 / RADIUS
    plate = np.array([force]), np.array([a]), case.h, 1.0, case.lam, 1.0
    stresses = (stress(*plate) for stress in (back_face_stress, held[case.support]))
    return tuple(stress.item() for stress in stresses)


def remainders(case: RemainderCase, mesh: RemainderMesh) -> list[tuple[float, float]]:
    """Return the law's model errors by a/b.

    They are that of the indentation, over the indentation, and that of the stress on the axis of
    the back face, over the law's stress.
    """
    errors = []
    for a, (depth, stress) in zip(WIDTHS, Field(case, mesh).added(WIDTHS), strict=True):
        more, whole = edge_contribution(case, a)
        paper, held = back_face_stresses(case, a)
        errors.append(((depth - more) / whole, (paper + stress) / held - 1.0))
    return errors


def rows(
    sizes: Sequence[float] = SIZES, poisson: Sequence[float] = POISSON
) -> list[dict[str, object]]:
    """Return the model error of every case, and its change with degree and layers of the mesh."""
    cases: list[dict[str, object]] = []
    for support, h, nu in itertools.product(SUPPORTS, sizes, poisson):
        case = RemainderCase(support, h, nu)
        finest, *others = (remainders(case, mesh) for mesh in MESHES)
        for a, errors, *rest in zip(WIDTHS, finest, *others, strict=True):
            row: dict[str, object] = {"support": support, "h_over_b": h, "nu": nu, "a_over_b": a}
            for error, *changed, prefix in zip(errors, *rest, ("", "stress_"), strict=True):
                changes = (float(f"{other - error:.1e}") for other in changed)
                names = ("relative_error", "lower_degree", "fewer_layers")
                numbers = (float(f"{error:.4g}"), *changes)
                row |= {prefix + name: x for name, x in zip(names, numbers, strict=True)}
            cases.append(row)
    return cases


def text() -> str:
    """Return all rows as JSON, with their settings."""
    import scipy

    provenance = {"numpy": np.__version__, "scipy": scipy.__version__, "modes": MODES}
    meshes = [dataclasses.asdict(mesh) for mesh in MESHES]
    record = {"meshes": meshes, "provenance": provenance, "rows": rows()}
    return sorted_json(record)


if __name__ == "__main__":
    write_file(measurements() / "edge_remainder.json", text())
