"""Bending: deflection of a thin plate under the contact force."""

from typing import TYPE_CHECKING

from derivation.scene import kernels
from derivation.scene.effects.effect import Bound, BoundContext, Contribution, PlateEffect, none_of
from derivation.scene.model import Model
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw


class Bending(PlateEffect):
    """Deflection P b^2/(8 pi D) with the paper's edge; its part of c_1 is 1/(4 pi eta^2)."""

    name = "bending"
    adds = "bending deflection of the plate"
    equation = "delta = P b^2/(8 pi D), D = E H^3/(12 (1 - nu^2))"
    parameter = "(2/pi) a b^2/H^3"
    source = "Kirchhoff plate; step 22"
    bends = True

    def value(self, model: Model, a: float) -> float:
        """Return its contribution to the indentation over Hertz's."""
        return float(kernels.bending(a / model.h, model.eta).depth)

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return the contribution itself, which is exact."""
        a = context.radii
        return Bound(none_of(a), self.contribution(model, a).slope)

    def bounded(self, law: "ContactLaw") -> bool:
        """Return False if the edge would become viscoelastic without bending."""
        return not (law.other_edge and law.viscous)

    def contribution(self, model: Model, a: Array) -> Contribution:
        """Return the contribution, linear in the radius."""
        return Contribution(*kernels.bending(a / model.h, model.eta))
