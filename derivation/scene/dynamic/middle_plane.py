"""Forces on the modes of a plate by stretching of its middle plane (von Karman, 1910)."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.polynomial.legendre import legder, leggauss, legvander

from derivation.scene.dynamic.modal import Modes
from derivation.scene.effects.edge import CLAMPED, SUPPORTED
from derivation.scene.model import Model
from generated.arrays import Double as Array

MOST = 48
"""Largest number of shapes that stretch the middle plane."""
POINTS, MORE_POINTS = 3, 16
"""Points on the radius per shape, and additional ones."""


@dataclass(frozen=True)
class MiddlePlane:
    """The middle plane of a plate, which deflects in the first shapes.

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
        Force of stretching [N/m^3] over the cube of deflections.
    """

    slopes: Array
    tension: Array
    on_axis: Array
    unit: float

    @classmethod
    def of(cls, model: Model, modes: Modes) -> Self:
        """Return the middle plane of a plate."""
        count = min(MOST, modes.phi.size)
        n = POINTS * count + MORE_POINTS
        nodes, weights = leggauss(n)
        x, w = (1.0 + nodes) / 2.0, weights / 2.0
        analysis = (legvander(nodes, n - 1) * weights[:, None] * (np.arange(n) + 0.5)).T
        slope_of = 2.0 * legvander(nodes, n - 2) @ legder(np.eye(n), axis=0) @ analysis
        slopes = modes.shapes(x * model.b)[:count] @ slope_of.T
        inner = legvander(np.outer(x, 1.0 + nodes) - 1.0, n - 1) @ analysis
        up_to = np.einsum("i,j,ijk->ik", x, w, inner)
        nu = model.poissons_ratio
        edge = {CLAMPED: (1.0 + nu) / (1.0 - nu), SUPPORTED: -1.0}.get(model.edge, 0.0)
        inside = up_to * x / (x * x)[:, None]
        beyond = (w - up_to) / x
        matrix = inside + beyond + edge * w * x
        weighted = (w * x)[:, None] * matrix
        young = 2.0 * model.mu * (1.0 + nu)
        unit = 2.0 * np.pi * young * (2.0 * model.h) / 4.0 / model.b**2
        return cls(slopes, 0.5 * (weighted + weighted.T), w / x + edge * w * x, unit)

    def forces(self, q: Array) -> Array:
        """Return the force [N] on each shape for deflections [m], along the last axis."""
        slope = q[..., : self.slopes.shape[0]] @ self.slopes
        tension = (slope * slope) @ self.tension
        pull = np.zeros_like(q)
        pull[..., : self.slopes.shape[0]] = -self.unit * (tension * slope) @ self.slopes.T
        return pull

    def energy(self, q: Array) -> Array:
        """Return the energy of stretching [J] for deflections [m], along the last axis."""
        square = (q[..., : self.slopes.shape[0]] @ self.slopes) ** 2
        return np.asarray(0.25 * self.unit * np.vecdot(square @ self.tension, square))

    def stiffness(self, q: Array) -> Array:
        """Return the stiffness of the tension [N/m] for each stretched shape, at one time."""
        slope = q[: self.slopes.shape[0]] @ self.slopes
        tension = (slope * slope) @ self.tension
        return np.asarray(self.unit * ((self.slopes * self.slopes) @ tension))
