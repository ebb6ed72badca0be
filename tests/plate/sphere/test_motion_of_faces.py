"""Test the errors by the finite sphere and the motion of its face: a sphere on a rigid plane.

A series of vector spherical harmonics includes what Hertz's theory neglects: the pressure acts on
the deformed face, and the points of the face move along it. R and shear modulus are 1.
"""

import math

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy.optimize import brentq

from derivation.scene.contact_law.finite_sphere import finite_size
from generated.arrays import Double
from generated.sphere_kernels import face_motion

NU = (-0.5, 0.0, 0.3, 0.45)


def compliances(count: int, nu: float) -> Double:
    """Return for each degree n the matrix from stresses rr, rt to displacements r, t.

    Radial parts are multiples of P_n, tangential parts of dP_n/dtheta. Degree 1 is
    relative to the centre of mass, and a uniform force on the mass balances it.
    """
    n = np.arange(count, dtype=np.float64)
    one = np.ones(count)
    rows = ((n + 1) * (n * n - n - 2 - 2 * nu), n * (n - 1)), (n * n + 2 * n - 1 + 2 * nu, n - 1)
    stress = 2 * np.array(rows).transpose(2, 0, 1)
    moved = np.array((((n + 1) * (n - 2 + 4 * nu), n), (n + 5 - 4 * nu, one))).transpose(2, 0, 1)
    # u = grad(r^3 cos theta) carries the force.
    lam = 2 * nu / (1 - 2 * nu)
    stress[1, :, 1], moved[1, :, 1] = (10 * lam + 12, 4), (3, 1)
    moved[1] -= (moved[1, 0] + 2 * moved[1, 1]) / 5
    result = np.zeros((count, 2, 2))
    result[0, 0, 0] = (1 - 2 * nu) / (2 * (1 + nu))
    result[1:] = moved[1:] @ np.linalg.inv(stress[1:])
    return result


def harmonics(count: int, cosine: Double) -> tuple[Double, Double]:
    """Return P_n and dP_n/dtheta."""
    value = np.empty((count, cosine.size))
    value[0], value[1] = 1.0, cosine
    for n in range(1, count - 1):
        value[n + 1] = ((2 * n + 1) * cosine * value[n] - n * value[n - 1]) / (n + 1)
    slope, sine = np.zeros_like(value), np.sqrt(np.maximum(1 - cosine**2, 1e-300))
    slope[1:] = np.arange(1, count)[:, None] * (cosine * value[1:] - value[:-1]) / sine
    return value, np.where(cosine < 1.0, slope, 0.0)


def change(nu: float, angle: float, axial: bool) -> tuple[float, float]:
    """Return a/R, and the relative change of the indentation at equal force, divided by a/R.

    With `axial`, the pressure acts along the axis, and tangential displacements count. Without it,
    the pressure acts along the radius, and they do not.
    """
    count, half = int(100 / angle), math.sin(angle / 2)
    x, weights = leggauss(160)
    phi = (x + 1) * np.pi / 4
    s, area = np.sin(phi), weights * np.pi * half**2 * np.sin(phi) * np.cos(phi)
    cosine = 1 - 2 * (half * s) ** 2
    at = 1 - 2 * (half * np.linspace(0.0, 0.98, 25)) ** 2
    (value, slope), (value_at, slope_at) = harmonics(count, cosine), harmonics(count, at)
    n, matrices = np.arange(count), compliances(count, nu)
    part = (2 * n + 1) / np.where(n, 2.0 * n * (n + 1), np.inf)
    shapes = [np.cos(phi) * s ** (2 * k) for k in range(6)]
    columns = []
    for shape in shapes:
        along, across = (cosine, np.sqrt(1 - cosine**2)) if axial else (1.0, 0.0)
        pressure = (n + 0.5) * (value @ (-shape * area * along))
        shear = part * (slope @ (shape * area * across))
        radial, tangential = np.einsum("nij,jn->in", matrices, np.array([pressure, shear]))
        inwards = -(radial @ value_at) * at
        if axial:
            inwards += (tangential @ slope_at) * np.sqrt(1 - at**2)
        columns.append(inwards)
    matrix = np.column_stack([*columns, -np.ones(at.size)])
    solved = np.linalg.lstsq(matrix, at - 1, rcond=None)[0]
    forces = [2 * math.pi * np.sum(q * area * (1.0 if axial else cosine)) for q in shapes]
    force = float(solved[:-1] @ forces)
    a = brentq(
        lambda a: 4 / (1 - nu) * ((1 + a * a) / 2 * math.atanh(a) - a / 2) - force, 1e-9, 0.9
    )
    return a, float((solved[-1] / (a * math.atanh(a)) - 1.0) / a)


@pytest.mark.parametrize("nu", NU)
def test_motion_of_faces_is_the_limit_of_forces_along_the_axis(nu: float) -> None:
    """The difference of both solutions tends to F for small a/R."""
    apart = []
    for angle in (0.05, 0.1):
        pairs = [change(nu, angle, axial) for axial in (True, False)]
        apart.append(pairs[0][1] - pairs[1][1])
    limit = 2 * apart[0] - apart[1]
    assert limit == pytest.approx(-float(face_motion(np.array(nu))), abs=4e-3)


@pytest.mark.parametrize("nu", NU)
def test_change_is_the_sum_of_finite_size_and_motion_of_faces(nu: float) -> None:
    values = [change(nu, angle, axial=True) for angle in (0.05, 0.1)]
    rest = [d - float(finite_size(nu, a)) / a + float(face_motion(np.array(nu))) for a, d in values]
    assert max(map(abs, rest)) < 0.1
    assert 2 * rest[0] - rest[1] == pytest.approx(0.0, abs=0.015)
