"""Gravity: the sphere's weight during the contact."""

import math

from derivation.scene.effects.effect import Array, Bound, Effect, none_of
from derivation.scene.model import Model


class Gravity(Effect):
    """m g on top of the sphere's inertia, while in contact."""

    name = "gravity"
    adds = "weight of the sphere"
    equation = "m z'' = m g - P"
    number = "m g a^2/(R E)"
    source = "energy balance; link 22"

    def absent(self, model: Model) -> str:
        """None where the scene gives none."""
        return "" if model.gravity else "no impact.gravity"

    def value(self, model: Model, a: float) -> float:
        """Work of the weight over Hertz' indentation, over the sphere's energy."""
        return 2.0 * model.gravity * a * (a / model.R) / model.v0 / model.v0

    def bound(self, model: Model, a: Array) -> Bound:
        """As `of_depth`, of Hertz' indentation; the gate knows the law's."""
        return self.of_depth(model, a, float(a[-1] * (a[-1] / model.R)))

    def of_depth(self, model: Model, a: Array, depth: float) -> Bound:
        """-log(1 - e), e the work of the weight over the largest indentation over the energy."""
        share = 2.0 * model.gravity * depth / model.v0 / model.v0
        energy = -math.log1p(-share) if share < 1.0 else math.inf
        return Bound(none_of(a), none_of(a), energy=energy)
