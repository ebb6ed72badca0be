"""Finite radius: the plate is stiffer than one without a lateral surface."""

from derivation.scene import kernels
from derivation.scene.effects.effect import (
    Array,
    Bound,
    BoundContext,
    Contribution,
    PlateEffect,
    none_of,
)
from derivation.scene.model import Model


class FiniteRadius(PlateEffect):
    """The integral over K0/I0, a function of a/b alone."""

    name = "finite_radius"
    adds = "finite radius of the plate"
    equation = "F = -(8/(pi^2 alpha^2)) int (x cosh x - sinh x) y^-3 K0/I0 dy, x = alpha y"
    parameter = "0.37 a/b"
    source = "contour integral over Y0/J0; links 12 and 22"

    def value(self, model: Model, a: float) -> float:
        """Its leading share of the indentation over Hertz's."""
        return 2.0 / 3.0 * kernels.WALL_LINEAR * a / model.b

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Between nothing and the leading terms."""
        a = context.radii
        alpha = a / model.b
        growing = kernels.WALL_LINEAR + kernels.WALL_CUBIC * (alpha * alpha)
        return Bound(alpha * growing, none_of(a))

    def contribution(self, model: Model, a: Array) -> Contribution:
        """By its power series."""
        return Contribution(*kernels.side_wall(a / model.b))
