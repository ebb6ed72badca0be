"""Plasticity: a contact pressure that the softer body's yield stress limits, and a dent."""

from typing import TYPE_CHECKING

import numpy as np

from derivation.scene.effects.effect import Bound, BoundContext, Effect
from derivation.scene.model import Model

if TYPE_CHECKING:
    from derivation.scene.law import ContactLaw

_LARGEST = 1e50


class Plasticity(Effect):
    """Elastic up to 1.6 Y, then of limited pressure; unloading is elastic, and a dent remains."""

    name = "plasticity"
    adds = "yielding contact"
    equation = "p = min(Hertz's pressure, 1.6 Y); unloading with R_p = R P_e/P"
    parameter = "p_0/(1.6 Y)"
    source = "Johnson 1985; Thornton 1997; link 31"
    hertzian = True
    plastic = True
    takes_rows = False

    def not_applicable_reason(self, model: Model) -> str:
        """Without a yield stress nothing yields."""
        return "" if np.isfinite(model.yield_stress) else "no yield_stress of sphere or plate"

    def value(self, model: Model, a: float) -> float:
        """Hertz's pressure over the limit at a contact radius."""
        return a / _onset(model) / (1.0 + model.softness)

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """On loading S is xi, on unloading c, in a half-space; an elastic plate helps."""
        from generated.plasticity_kernels import hertz_modulus, unloaded, worked

        # The radii are Hertz's of the forces by the law's modulus, which they thus tell.
        last = context.radii[-1]
        modulus = hertz_modulus(context.samples.force[-1], np.array(model.R), last)
        onset = _onset(model) * (model.modulus / modulus)
        ratio = np.minimum(context.radii / onset, _LARGEST)
        largest = np.maximum(ratio[-1], 1.0)
        flat = float(unloaded(largest)[0])
        slower = -float(np.log(worked(largest)[1]))
        return Bound(
            np.full_like(ratio, 1.0 - flat),
            np.maximum(ratio - 1.0, 0.0),
            radius=-float(np.log(flat)),
            results=(slower, 0.0, 0.0, 0.0, slower),
        )

    def proved(self, law: "ContactLaw") -> bool:  # noqa: ARG002
        """Return False: tested on random scenes."""
        return False


def _onset(model: Model) -> float:
    """Hertz's radius at the onset of yield, of a rigid sphere [m]."""
    from generated.plasticity import yield_radius

    return float(yield_radius(model.R, model.lam, model.mu, model.yield_stress))
