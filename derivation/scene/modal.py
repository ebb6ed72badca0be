"""The plate as oscillators: its bending modes, and what of the contact law they leave at rest.

With P_j = int_0^a P'(c) sh(c phi_j) dc the part of the force that mode j feels, sh y = sin(y)/y,
and c_j its static compliance,

    z = delta(a) - sum c_j P_j s_j + sum s_j q_j,   q_j'' + omega_j^2 q_j = omega_j^2 c_j P_j

s_j = sh(a phi_j) = dP_j/dP conserves energy whatever the law delta(a); s_j = 1 takes the
deflection at the axis, as the paper defines the indentation.
"""

import math
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebder, chebvander
from numpy.typing import NDArray

from derivation.scene.effects.effect import Array
from derivation.scene.law import Law
from derivation.scene.model import Model
from derivation.scene.quadrature import gauss
from derivation.scene.scene import SceneError

MANY = 2000
"""Most oscillators of all branches, as many as memory and patience take."""
DEGREE, INNER = 32, 40
"""Degree of the tables, and nodes of the integral over the contact's growth."""


@dataclass(frozen=True)
class Modes:
    """Oscillators that the contact force drives.

    Attributes
    ----------
    phi
        Wave numbers [1/m], shape (modes,).
    omega
        Angular frequencies [1/s].
    drive
        Acceleration by a unit force [1/kg]; over omega^2 the static compliance.
    held
        c_j of modes J_0(phi_j r) - c_j I_0(phi_j r), which are 1 at the axis over 1 - c_j.
    admittance
        Velocity of an endless plate by a unit force [s/kg], 0 for one with an edge.
    """

    phi: Array
    omega: Array
    drive: Array
    held: Array
    admittance: float = 0.0

    @property
    def compliance(self) -> Array:
        """Static deflection at the axis by a unit force [m/N]."""
        return self.drive / self.omega**2

    def shapes(self, r: Array) -> Array:
        """Each mode at distances [m] over itself at the axis, shape (modes, distances)."""
        from generated.bessel import bessel_j0

        x, c = np.outer(self.phi, r), self.held[:, None]
        bent = c * np.i0(np.where(c == 0.0, 0.0, x))
        return np.asarray((bessel_j0(x) - bent) / (1.0 - c), dtype=np.float64)

    def shares_less_one(self, a: Array) -> Array:
        """s_j - 1 at contact radii [m], shape (radii, modes)."""
        y, c = np.outer(a, self.phi), self.held
        return (sinc_less_one(y) - c * _sinhc_less_one(np.where(c == 0.0, 0.0, y))) / (1.0 - c)


class Touch(NamedTuple):
    """The contact at radii: force [N], depth at rest [m], slopes by the radius, and of each mode
    the force it feels [N], its share in the depth less 1, and their slopes.
    """

    force: Array
    depth: Array
    felt: Array
    less: Array
    force_a: Array
    depth_a: Array
    felt_a: Array
    less_a: Array


def modes_of(model: Model, count: int, lagging: bool = False) -> Modes:
    """The first bending modes of the plate on its edge, of the branch A0 at their wave numbers.

    On the paper's edge J_0(phi_j r) are modes of every branch: of all of them, if the scene wants
    them, those no faster than the last of these. A plate simply supported or clamped has a thin
    plate's shapes.

    Parameters
    ----------
    lagging
        Whether the contact is viscous. Bending does not lag: modes then have a thin plate's
        compliance alone, and what else deflects them at rest stays with the contact.
    """
    from generated import inertia

    k, c, weight = _shapes_on_edge(model, count)
    x, nu = k * model.eta, model.poissons_ratio
    root, residue = inertia.bending_frequency(x, nu), inertia.bending_residue(x, nu)
    if model.inertia.branches == "all":
        place, root, residue = _all_branches(x, nu, float(root[-1]))
        k, c, weight = k[place], c[place], weight[place]
    if lagging:
        residue = 0.5 * (root / (x * x * math.sqrt(2.0 / (3.0 * (1.0 - nu))))) ** 2
    drive = residue * weight / (model.density * model.h * model.b * model.b)
    return Modes(k / model.b, root * (model.shear_speed / model.h), drive, c)


def _shapes_on_edge(model: Model, count: int) -> tuple[Array, Array, Array]:
    """Wave numbers times b, c_j, and w(0)^2 over the mean of w^2 over the plate's pi."""
    if model.edge == "soft-hinge":
        from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros

        weight = 1.0 / (np.pi * bessel_j1_at_j0_zeros(count) ** 2)
        return bessel_j0_zeros(count), np.zeros(count), weight
    from generated.held_modes import clamped_modes, supported_modes

    if model.edge == "clamped":
        return clamped_modes(count)
    return supported_modes(count, model.poissons_ratio)


def _all_branches(x: Array, nu: float, highest: float) -> tuple[NDArray[np.intp], Array, Array]:
    """Which x, frequency and residue, of every branch up to a frequency."""
    from generated.plate_waves import branches

    # At x = 0 branches begin pi/2 apart or wider, and none of them falls by much.
    count = math.ceil(highest / (math.pi / 2.0)) + 2
    kinds = [branches(x, nu, count, parity) for parity in ("antisymmetric", "symmetric")]
    root, residue = (np.hstack(parts) for parts in zip(*kinds, strict=True))
    place, which = np.nonzero((root <= highest * (1.0 + 1e-12)) & (residue > 0.0))
    if place.size > MANY:
        raise SceneError(
            f"inertia.branches: expected no more than {MANY} oscillators, got {place.size} with "
            f'{x.size} modes of all branches; give fewer inertia.modes, or branches = "A0"'
        )
    order = np.argsort(root[place, which], kind="stable")
    place, which = place[order], which[order]
    return place, root[place, which], residue[place, which]


def far_plate(model: Model) -> Modes:
    """No oscillator, but an endless thin plate: it yields at P/(8 sqrt(D rho H))."""
    H, none = 2.0 * model.h, np.zeros(0)
    bending = model.modulus * H**3 / 12.0
    return Modes(none, none, none, none, 1.0 / (8.0 * math.sqrt(bending * model.density * H)))


@dataclass(frozen=True)
class Contact:
    """Tables of a law beside oscillators, up to a contact radius [m]."""

    modes: Modes
    R: float
    top: float
    table: Array
    pointwise: bool = False

    def at(self, a: Array) -> Touch:
        """The contact at radii [m]; NaN beyond the top."""
        x = np.where(a <= self.top, a / self.top, np.nan)
        found = chebvander(2.0 * x - 1.0, DEGREE) @ self.table
        value, slope = np.split(found, 2, axis=1)
        cubes, squares = np.split(value, 2, axis=1)
        cube_x, square_x = np.split(slope, 2, axis=1)
        x = x[:, None]
        cube_a = (3.0 * cubes + x * cube_x) * x * x / self.top
        square_a = (2.0 * squares + x * square_x) * x / self.top
        cubes, squares = cubes * x**3, squares * x**2
        return Touch(
            cubes[:, 0],
            squares[:, 0],
            cubes[:, 1:],
            squares[:, 1:],
            cube_a[:, 0],
            square_a[:, 0],
            cube_a[:, 1:],
            square_a[:, 1:],
        )


def contact_of(law: Law, modes: Modes, top: float, pointwise: bool) -> Contact:
    """A law's tables up to a contact radius [m]."""
    x, analysis, mean = _knots()
    a = top * x
    shape = law.at(a)
    slope = 2.0 * (a / law.model.R) * shape.slope
    force, depth = law.force(a, shape), law.indentation(a, shape)
    less = modes.shares_less_one(a)
    # P' sh over x^2 is a polynomial, whose mean weighted by x^2 is P_j over x^3.
    growth = (law.stiffness(a, shape) * slope * top / x**2)[:, None]
    cubes = mean @ (analysis @ np.concatenate((growth, growth * (1.0 + less)), axis=1))
    if pointwise:
        less = np.zeros_like(less)
    moved = (cubes[:, 1:] * (1.0 + less)) @ modes.compliance * x
    rest = depth / x**2 - moved
    values = np.column_stack((force / x**3, cubes[:, 1:], rest, less / x[:, None] ** 2))
    table = analysis @ values
    slopes = np.zeros_like(table)
    slopes[:-1] = 2.0 * chebder(table)
    return Contact(modes, law.model.R, top, np.concatenate((table, slopes), axis=1), pointwise)


def sinc_less_one(y: Array) -> Array:
    """sin(y)/y - 1."""
    small = -y * y / 6.0 * (1.0 - y * y / 20.0 * (1.0 - y * y / 42.0 * (1.0 - y * y / 72.0)))
    return np.where(np.abs(y) < 0.1, small, np.sinc(y / np.pi) - 1.0)


def _sinhc_less_one(y: Array) -> Array:
    """sinh(y)/y - 1."""
    small = y * y / 6.0 * (1.0 + y * y / 20.0 * (1.0 + y * y / 42.0 * (1.0 + y * y / 72.0)))
    large = np.where(np.abs(y) < 0.1, 1.0, y)
    return np.where(np.abs(y) < 0.1, small, np.sinh(large) / large - 1.0)


@cache
def _knots() -> tuple[Array, Array, Array]:
    """Chebyshev's points on [0, 1], coefficients from values there, and int_0^1 t^2 f(x t) dt."""
    n = 2 * DEGREE
    x = (1.0 - np.cos(np.pi * (np.arange(n) + 0.5) / n)) / 2.0
    analysis = np.linalg.pinv(chebvander(2.0 * x - 1.0, DEGREE))
    t, weights = gauss(INNER)
    inner = chebvander(2.0 * np.outer(x, t) - 1.0, DEGREE)
    mean = np.einsum("i,kij->kj", weights * t * t, inner)
    return x, np.asarray(analysis, dtype=np.float64), np.asarray(mean, dtype=np.float64)
