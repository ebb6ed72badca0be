"""Spherical profile: deviation of the sphere from a paraboloid if a/R is not small."""

from typing import TYPE_CHECKING

import numpy as np

from derivation.scene.effects.effect import Bound, BoundContext, Effect, Reach
from derivation.scene.model import Model

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

MAX_A_OVER_R = 0.99
"""Largest contact radius over sphere radius for which the slope of the profile is resolved."""


class SphericalProfile(Effect):
    """Sneddon's law for a sphere: smaller contact radius and larger indentation at equal force."""

    name = "spherical_profile"
    adds = "spherical profile instead of a paraboloid"
    equation = "delta = (a/2) log((R+a)/(R-a)), dP = 2 E* a d delta"
    parameter = "a/R"
    source = "Sneddon 1965; step 21"
    reach = Reach(sphere=MAX_A_OVER_R)
    spherical = True

    def value(self, model: Model, a: float) -> float:
        """Return contact radius over sphere radius."""
        return a / model.R

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return S - 1 = a_Hertz/a - 1, which increases with a, evaluated at Hertz's radius."""
        ratio = np.cbrt(context.sphere_force(model.R))
        up = np.where(np.isfinite(ratio), ratio - 1.0, np.inf)
        return Bound(np.zeros_like(up), up, radius=np.log1p(up[..., -1:]))

    def bounded(self, law: "ContactLaw") -> bool:
        """Return False for non-Hertzian pressure."""
        return not law.solved
