"""Gravity: the sphere's weight during the contact."""

import numpy as np

from derivation.scene.effects.effect import Bound, BoundContext, Effect, none_of
from derivation.scene.model import Model


class Gravity(Effect):
    """m g on top of the sphere's inertia, while in contact."""

    name = "gravity"
    adds = "weight of the sphere"
    equation = "m z'' = m g - P"
    parameter = "m g a^2/(R E)"
    source = "energy balance; link 22"
    static = False
    hertzian = True

    def not_applicable_reason(self, model: Model) -> str:
        """None where the scene gives none."""
        return "" if model.gravity else "no impact.gravity"

    def gravity(self, model: Model) -> float:
        """All of it."""
        return model.gravity

    def value(self, model: Model, a: float) -> float:
        """Work of the weight over Hertz's indentation, over the sphere's energy."""
        return 2.0 * model.gravity * a * (a / model.R) / model.v0 / model.v0

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """-log(1 - e), e the work of the weight over the largest indentation over the energy."""
        share = 2.0 * model.gravity * context.depth / model.v0 / model.v0
        energy = np.where(np.less(share, 1.0), -np.log1p(-np.minimum(share, 1.0)), np.inf)
        none = none_of(context.radii)
        return Bound(none, none, energy=energy)
