"""Forces on the modes of a plate by stretching of its middle plane (von Karman, 1910)."""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from derivation.scene import kernels
from derivation.scene.dynamic.modal import Modes
from derivation.scene.effects.edge import CLAMPED, SUPPORTED
from derivation.scene.input.materials import engineering_constants
from derivation.scene.model import Model
from derivation.scene.numerics.quadrature import derivative, gauss, up_to
from generated.arrays import Double as Array

POINTS, MORE_POINTS = 2, 16
"""Points on the radius per shape, and additional ones."""


class Steepness(NamedTuple):
    """Mean square of a plate's slope [1], weighted with the energy of stretching.

    Attributes
    ----------
    largest
        The largest one, up to the last separation.
    so_far
        The largest one up to each of some times of the first contact.
    deflection
        Largest deflection at the axis up to the last separation [m].
    """

    largest: float
    so_far: Array
    deflection: float


@dataclass(frozen=True)
class MiddlePlane:
    """The middle plane of a plate that deflects in its first shapes, in units of the problem.

    Attributes
    ----------
    slopes
        Slope of each shape times the plate radius, over its deflection on the axis [1], shape
        (shapes, points).
    tension
        Symmetric matrix from squares of the slope to the tension at each point, times the weight
        of the point, shape (points, points).
    on_axis
        The same for the tension on the axis, without a weight, shape (points,).
    unit
        Force of stretching over the cube of deflections.
    tension_unit
        Tension [N/m] over the square of deflections.
    """

    slopes: Array
    tension: Array
    on_axis: Array
    unit: float
    tension_unit: float

    @classmethod
    def of(cls, model: Model, modes: Modes, depth: float, force: float, part: int = 1) -> Self:
        """Return the middle plane of a plate, for the units of depth [m] and force [N].

        The tension is that of derivation step 33, with the integrals of the polynomial through the
        values at Gauss' points. Of the shapes that stretch the plate, 1/part are included.
        """
        count, nu = min(model.inertia.shapes, modes.phi.size) // part, model.poissons_ratio
        n = POINTS * count + MORE_POINTS
        x, w = gauss(n)
        slopes = modes.shapes(x * model.b)[:count] @ derivative(n).T
        inside, held = up_to(n), float(kernels.edge_tension_clamped(np.asarray(nu)))
        kappa = {CLAMPED: held, SUPPORTED: -1.0}.get(model.edge, 0.0)
        everywhere = kappa * w * x
        tension = everywhere + inside * x / (x * x)[:, None] + (w - inside) / x
        weighted = (w * x)[:, None] * tension
        young, _ = engineering_constants(model.lam, model.mu)
        tension_unit = 0.5 * young * model.h * (depth / model.b) ** 2
        unit = 2.0 * np.pi * tension_unit * depth / force
        return cls(slopes, 0.5 * (weighted + weighted.T), w / x + everywhere, unit, tension_unit)

    def squares(self, q: Array) -> tuple[Array, Array]:
        """Return slope and its square at the points for deflections, along the last axis."""
        slope = q[..., : self.slopes.shape[0]] @ self.slopes
        return slope, slope * slope

    def forces(self, q: Array) -> Array:
        """Return the force on each shape for deflections, along the last axis."""
        slope, square = self.squares(q)
        pull = (square @ self.tension * slope) @ self.slopes.T
        pull *= -self.unit
        if pull.shape == q.shape:
            return np.asarray(pull)
        every = np.zeros_like(q)
        every[..., : pull.shape[-1]] = pull
        return every

    def slope_of_forces(self, q: Array) -> Array:
        """Return the derivative of the force on each shape with respect to each deflection.

        It is for the deflections of the stretched shapes at one time; no eigenvalue is positive.
        """
        slope, square = self.squares(q)
        turned = self.slopes * slope
        by_tension = (self.slopes * (square @ self.tension)) @ self.slopes.T
        by_slope = 2.0 * turned @ self.tension @ turned.T
        return np.asarray(-self.unit * (by_tension + by_slope))

    def energy(self, q: Array) -> Array:
        """Return the energy of stretching for deflections, along the last axis."""
        square = self.squares(q)[1]
        return np.asarray(0.25 * self.unit * np.vecdot(square @ self.tension, square))

    def axis_tension(self, q: Array) -> Array:
        """Return the tension on the axis [N/m] for deflections, along the last axis."""
        return np.asarray(self.tension_unit * (self.squares(q)[1] @ self.on_axis))

    def stiffness(self, q: Array) -> Array:
        """Return the stiffness of each stretched shape by the tension at one time."""
        square = self.squares(q)[1]
        return np.asarray(self.unit * (self.slopes * self.slopes) @ (square @ self.tension))

    def steepness(self, q: Array) -> tuple[float, float]:
        """Return the integrals of N_r w'^2 r and N_r w'^4 r for deflections at one time.

        They are in the same unit; the slope is that over the plate radius, without a unit of depth.
        """
        square = self.squares(q)[1]
        tension = square @ self.tension
        return float(tension @ square), float(tension @ (square * square))
