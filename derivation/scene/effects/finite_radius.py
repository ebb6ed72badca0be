"""Finite plate radius: correction for the lateral surface, which stiffens the plate."""

from derivation.scene import kernels
from derivation.scene.effects.effect import Bound, BoundContext, Contribution, PlateEffect, none_of
from derivation.scene.model import Model
from generated.arrays import Double as Array


class FiniteRadius(PlateEffect):
    """Integral over the ratio K0/I0 of Bessel functions; it depends only on a/b."""

    name = "finite_radius"
    adds = "finite radius of the plate"
    equation = "F = -(8/(pi^2 alpha^2)) int (x cosh x - sinh x) y^-3 K0/I0 dy, x = alpha y"
    parameter = "0.37 a/b"
    source = "contour integral over Y0/J0; steps 12 and 22"

    def value(self, model: Model, a: float) -> float:
        """Return the leading term of its contribution to the indentation over Hertz's."""
        return 2.0 / 3.0 * kernels.LATERAL_LINEAR * a / model.b

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return the bound: between zero and the leading terms."""
        a = context.radii
        alpha = a / model.b
        growing = kernels.LATERAL_LINEAR + kernels.LATERAL_CUBIC * (alpha * alpha)
        return Bound(alpha * growing, none_of(a))

    def contribution(self, model: Model, a: Array) -> Contribution:
        """Return the contribution by its power series."""
        return Contribution(*kernels.finite_radius(a / model.b))
