"""Gravity: weight of the sphere during contact."""

import numpy as np

from derivation.scene.effects.effect import (
    Bound,
    BoundContext,
    Effect,
    none_of,
    weight_work_ratio,
)
from derivation.scene.effects.plasticity import plastic_depth
from derivation.scene.model import Model
from derivation.scene.scene import Scene


class Gravity(Effect):
    """Weight m g of the sphere in its equation of motion during contact."""

    name = "gravity"
    adds = "weight of the sphere during contact"
    equation = "m z'' = m g - P"
    parameter = "2 g a^2/(R v0^2)"
    source = "energy balance; step 22"
    static = False
    hertzian = True
    remedy = "give impact.gravity [m/s^2]"

    def not_applicable_reason(self, model: Model) -> str:
        """Return a reason if the scene gives no gravity."""
        return "" if model.gravity else "impact.gravity is not given"

    def without_change(self, scene: Scene) -> bool:
        """Return whether the given acceleration is 0."""
        return scene.impact.gravity == 0.0

    def gravity(self, model: Model) -> float:
        """Return the gravitational acceleration of the scene."""
        return model.gravity

    def value(self, model: Model, a: float) -> float:
        """Return the work of the weight over Hertz's indentation, over the kinetic energy."""
        return 2.0 * model.gravity * a * (a / model.R) / model.v0 / model.v0

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return -log(1 - e), with e the work of the weight over the kinetic energy.

        A contact that yields is deeper, so that the weight does more work.
        """
        work_ratio = weight_work_ratio(model, plastic_depth(model, context))
        energy = np.where(np.less(work_ratio, 1.0), -np.log1p(-np.minimum(work_ratio, 1.0)), np.inf)
        none = none_of(context.radii)
        return Bound(none, none, energy=energy)
