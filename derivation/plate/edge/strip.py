"""Elastic constants of a clamped edge, computed for a strip in plane strain.

Near its edge a thin plate is a semi-infinite strip x <= 0, |z| <= 1. If it is clamped at x = 0,
u = w = 0, it does not bend as in plate theory, because the clamp also prevents thinning. With unit
curvature far away and n = nu/(1 - nu), the exact state of the strip is

    u = x z,  w = -x^2/2 - n z^2/2,

plus a field v, without load on the faces and without force and moment, that has
v = (0, n z^2/2) at x = 0. Far away v is a rigid motion u = theta z, w = n level - theta x:

    turn     theta/n^2, so that psi = chi eta psi' for the plate's rotation, chi = n^2 turn
    level    deflection of the middle plane at the edge; 1/6 if the mean of w were 0

A shear force bulges the end of a simply supported strip by u ~ (2 + n)/3 (z^3 - 3 z/5). A clamp
suppresses this bulge, and a deflection remains. Four times this deflection is recorded as `shear`:
its contribution to the plate's indentation in units of P b^2/(16 pi D) eta^3.

Elements, mesh and grading are those of `remainder`. `python -m derivation.plate.edge.strip` repeats
the computation in minutes.
"""

import dataclasses
from collections.abc import Sequence

import numpy as np

from derivation.engine.files import measurements, write_file
from derivation.engine.outputs import sorted_json
from derivation.plate.edge.remainder import Double, Elements, RemainderMesh, factorised, heights

LENGTH = 6.0
"""Length of the strip over its half-thickness: end effects decay at least like e^(-3.75 x)."""
THINNINGS = (-0.49, -0.4, -1 / 3, -1 / 6, -0.05, 0.05, 1 / 9, 0.25, 3 / 7, 2 / 3, 9 / 11, 0.96)
"""n; nu = n/(1 + n) ranges from -0.96 to 0.49."""
MESHES = (RemainderMesh(9, 9), RemainderMesh(7, 9), RemainderMesh(9, 7))
"""The mesh that is used, and two meshes that show its error."""


class Strip(Elements):
    """The strip's finite elements for one n, with shear modulus 1."""

    def __init__(self, n: float, mesh: RemainderMesh) -> None:
        steps = list(0.5 ** np.arange(mesh.layers, -1.0, -1.0))
        x_ends = np.concatenate((-np.arange(LENGTH, 1.0, -1.0), -np.array(steps[::-1]), [0.0]))
        super().__init__(x_ends, heights(1.0, mesh.layers), mesh.degree)
        self.n = n
        ring = np.arange(self.rows)
        self.clamped = self.number(np.full_like(ring, self.columns - 1), ring, 0)
        self.free = np.setdiff1d(np.arange(self.size), [self.clamped, self.clamped + 1])
        self.matrix = self.stiffness(2.0 * n / (1.0 - n), round_plate=False)[self.free]
        self.solver = factorised(self.matrix[:, self.free])

    def rigid(self, u: Double, w: Double) -> tuple[float, float]:
        """Return turn and level, far away, of the field with this displacement at x = 0."""
        values = np.zeros(self.size)
        values[self.clamped], values[self.clamped + 1] = u, w
        values[self.free] = self.solver.solve(-(self.matrix @ values))
        top, middle = 2 * (self.rows - 1), 2 * int(np.searchsorted(self.z, 0.0, side="left"))
        turn = (values[top] - values[0]) / 2.0
        return float(turn), float(values[middle + 1] + turn * self.x_ends[0])

    def constants(self) -> tuple[float, float, float]:
        """Return turn, level and shear."""
        turn, level = self.rigid(0.0 * self.z, self.z**2 / 2)
        bulge = (2 + self.n) / 3 * (self.z**3 - 3 * self.z / 5)
        return turn / self.n, level, 4.0 * self.rigid(bulge, 0.0 * self.z)[1]


def rows(
    thinnings: Sequence[float] = THINNINGS, meshes: Sequence[RemainderMesh] = MESHES
) -> list[dict[str, float]]:
    """Return the constants of every n, and their largest change on another mesh."""
    cases = []
    for n in thinnings:
        first, *others = (np.array(Strip(n, mesh).constants()) for mesh in meshes)
        change = max(float(np.abs(other - first).max()) for other in others)
        names = dict(
            zip(("turn", "level", "shear"), (float(f"{x:.7g}") for x in first), strict=True)
        )
        cases.append({"n": n, **names, "change": float(f"{change:.1e}")})
    return cases


def text() -> str:
    """Return all rows as JSON, with their settings."""
    import scipy

    record = {
        "length": LENGTH,
        "meshes": [dataclasses.asdict(mesh) for mesh in MESHES],
        "provenance": {"numpy": np.__version__, "scipy": scipy.__version__},
        "rows": rows(),
    }
    return sorted_json(record)


if __name__ == "__main__":
    write_file(measurements() / "edge_strip.json", text())
