"""Finite thickness: shear, compression and other contributions of the modes beyond bending."""

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects.bending import Bending
from derivation.scene.effects.effect import Bound, BoundContext, Contribution, PlateEffect
from derivation.scene.effects.finite_radius import FiniteRadius
from derivation.scene.model import Model
from generated.arrays import Double as Array

WHOLE_PLATE = frozenset({"bending", "finite_thickness", "finite_radius"})
"""Effects contained in `plate_contribution`."""


class FiniteThickness(PlateEffect):
    """Sum over the modes of the plate factor G minus 1, without the bending term."""

    name = "finite_thickness"
    adds = "shear and compression of the plate"
    equation = "F = (8/(pi alpha^2)) sum s(alpha j_n) (G(2 eta j_n) - 1)/(j_n^4 J_1^2) - F_bending"
    parameter = "c_1 a/h minus that of bending"
    source = "sum over the modes; steps 12, 18 and 22"
    difference = True
    contains = frozenset({"bending", "finite_radius"})  # the whole plate is faster to compute

    def value(self, model: Model, a: float) -> float:
        """Return the leading term of its contribution to the indentation over Hertz's."""
        linear = model.correction.bend * a / model.h
        return float(linear - kernels.bending(a / model.h, model.eta).depth)

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return 3/2 c_1 A - K_3 A^3 <= S - 1 <= 3/2 c_1 A minus bending and finite radius."""
        a = context.radii
        plate, A, alpha = model.correction, a / model.h, a / model.b
        linear = 1.5 * plate.bend * A - kernels.bending(A, model.eta).slope
        wrong = 1.5 * plate.bend_error * A
        wall = alpha * (kernels.LATERAL_LINEAR + kernels.LATERAL_CUBIC * (alpha * alpha))
        up = np.maximum(linear + wrong + wall, 0.0)
        low = np.maximum(plate.rest * (A * A * A) + wrong - linear, 0.0)
        # The sign may change; the bound is the largest one up to each radius.
        return Bound(np.maximum.accumulate(low, axis=-1), np.maximum.accumulate(up, axis=-1))

    def contribution(self, model: Model, a: Array) -> Contribution:
        """Return the contribution of the whole plate minus its other parts."""
        whole_plate = plate_contribution(model, a)
        parts = Bending().contribution(model, a), FiniteRadius().contribution(model, a)
        return Contribution(
            whole_plate.depth - parts[0].depth - parts[1].depth,
            whole_plate.slope - parts[0].slope - parts[1].slope,
        )


def plate_contribution(model: Model, a: Array) -> Contribution:
    """Return the sum of bending, finite thickness and finite radius: law minus half-space."""
    return Contribution(*kernels.plate_contribution(model.plates, a, model.h, model.b))
