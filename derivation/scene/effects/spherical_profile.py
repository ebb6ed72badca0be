"""Spherical profile: the sphere is no paraboloid where the contact is not small beside it."""

from typing import TYPE_CHECKING

import numpy as np

from derivation.scene.effects.effect import Bound, BoundContext, Effect, Reach
from derivation.scene.model import Model

if TYPE_CHECKING:
    from derivation.scene.law import ContactLaw

MAX_A_OVER_R = 0.99
"""Contact radius over sphere radius up to which the profile's slope is resolved."""


class SphericalProfile(Effect):
    """Sneddon's exact profile: a force takes a smaller contact and more indentation."""

    name = "spherical_profile"
    adds = "a sphere, not a paraboloid"
    equation = "delta = (a/2) log((R+a)/(R-a)), dP = 2 E* a d delta"
    parameter = "a/R"
    source = "Sneddon 1965; link 21"
    reach = Reach(sphere=MAX_A_OVER_R)
    spherical = True

    def value(self, model: Model, a: float) -> float:
        """Contact radius over sphere radius."""
        return a / model.R

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """S - 1 = a_Hertz/a - 1 grows with a, and a is at most Hertz's."""
        ratio = np.cbrt(context.sphere_force(model.R))
        up = np.where(np.isfinite(ratio), ratio - 1.0, np.inf)
        return Bound(np.zeros_like(up), up, radius=np.log1p(up[..., -1:]))

    def bounded(self, law: "ContactLaw") -> bool:
        """Under Hertz's pressure alone."""
        return not law.solved
