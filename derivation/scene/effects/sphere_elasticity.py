"""Elastic sphere: both bodies deform, and 1/E* is the sum for both."""

import numpy as np

from derivation.scene import kernels
from derivation.scene.effects.effect import Bound, BoundContext, Effect
from derivation.scene.model import Model


class SphereElasticity(Effect):
    """Elasticity of the sphere; it changes only the half-space term, not the plate terms."""

    name = "sphere_elasticity"
    adds = "elastic sphere"
    equation = "1/E* = (1 - nu^2)/E + (1 - nu_1^2)/E_1"
    parameter = "E/(1 - nu^2) of the plate over that of the sphere"
    source = "Hertz 1881; step 22"
    hertzian = True
    remedy = "give sphere.material, or sphere.youngs_modulus and sphere.poissons_ratio"

    def not_applicable_reason(self, model: Model) -> str:
        """Return a reason if the sphere is rigid."""
        return "" if model.softness else "the sphere is rigid (it has no elastic constants)"

    def softness(self, model: Model) -> float:
        """Return E/(1 - nu^2) of the plate over that of the sphere."""
        return model.softness

    def value(self, model: Model, a: float) -> float:  # noqa: ARG002
        """Return E/(1 - nu^2) of the plate over that of the sphere."""
        return model.softness

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return s^2 - 1 with s^3 = 1 + its parameter, plus or minus its product with K A^3."""
        a = context.radii
        log = np.log1p(model.softness) / 3.0
        growth = np.expm1(2.0 * log)
        plate, A, alpha = model.correction, a / model.h, a / model.b
        cubic = plate.rest * (A * A * A) + kernels.LATERAL_GROWTH * (alpha * alpha * alpha)
        sound = np.exp(log) * alpha < 1.0
        up = np.where(sound, growth * (1.0 + cubic), np.inf)
        low = np.where(sound, growth * np.maximum(cubic - 1.0, 0.0), np.inf)
        return Bound(low, up, radius=log)
