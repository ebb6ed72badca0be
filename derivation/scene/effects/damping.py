"""Damping: the plate modes dissipate energy, so that vibration and reflected waves decay."""

from functools import reduce
from typing import TYPE_CHECKING

import numpy as np

from derivation.scene.effects.effect import (
    NO_BOUND,
    Bound,
    BoundContext,
    Effect,
    Numbers,
    bounded_where,
    none_of,
    weight_work_ratio,
)
from derivation.scene.effects.inertia import (
    SENSITIVITY,
    SLOWEST,
    PlateInertia,
    after_yield,
    dissipated,
    dynamic_deviation,
    total_deviation,
)
from derivation.scene.effects.plasticity import plastic_restitution
from derivation.scene.effects.viscosity import viscous_number
from derivation.scene.model import Model
from derivation.scene.scene import Scene
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

VARIATION = 2.0
"""Total variation of a force that rises and falls once, over its peak."""
TURNING = 27.0
"""Bound on the response to the rate of such a force, over its peak, times omega T: factor 2 from an
oscillator, 4 from the variation of the rate, 2.9 from the largest rate of Hertz's contact, and a
margin of 16 %."""


class Damping(Effect):
    """Equivalent viscous damping of each mode at its natural frequency."""

    name = "damping"
    adds = "damping of the plate modes"
    equation = "q_j'' + eta_l omega_j q_j' + omega_j^2 q_j = omega_j^2 c_j P_j"
    parameter = "loss factor eta_l = 2 x damping ratio"
    source = "Cremer, Heckl and Petersson 2005; step 32"
    contains = PlateInertia.contains | {"inertia"}
    requires = PlateInertia.requires | {"inertia"}
    within = "inertia"
    static = False
    damps = True
    remedy = "give plate.loss_factor and plate.density [kg/m^3]"

    def not_applicable_reason(self, model: Model) -> str:
        """Return a reason if the loss factor or the density is missing."""
        if not model.loss_factor:
            return "plate.loss_factor is not given"
        return "" if model.density else "the density of the plate is unknown"

    def without_change(self, scene: Scene) -> bool:
        """Return whether the given loss factor is 0."""
        return scene.plate.loss_factor == 0.0

    def value(self, model: Model, a: float) -> float:  # noqa: ARG002
        """Return the loss factor."""
        return model.loss_factor

    def bound(self, model: Model, context: BoundContext) -> Bound:
        """Return the change of all modes over the indentation; infinite if inertia has no bound.

        If plate vibration determines when and how often the sphere separates, no bound is known.
        Omitting the damping adds the response to 2 zeta omega q', with q of the damped mode. It is
        at most 2 zeta times the variation of q, which is bounded in two parts: that of the
        quasi-static c P, and that of the free vibration, whose change is also at most twice its
        amplitude. Random scenes use at most 6 % of the bound.
        """
        none = none_of(context.radii)
        heavier = 1.0 + weight_work_ratio(model, context.depth)
        T = SLOWEST * context.depth / (model.v0 * np.sqrt(heavier))
        a, force = context.radii[..., -1:], context.samples.force[..., -1:]
        viscous = viscous_number(model)
        inertia = PlateInertia().bound(model, context).results
        known = np.asarray(reduce(np.maximum, inertia) < NO_BOUND)

        def changed(phase: Array, rise: Numbers) -> Array:
            steady = np.minimum(VARIATION, np.minimum(phase * phase, TURNING / (phase * rise)))
            ringing = dynamic_deviation(phase, rise, viscous)
            return model.loss_factor * steady + np.minimum(
                2.0 * ringing, model.loss_factor * ringing * phase
            )

        off = force / context.depth * total_deviation(model, a, T, changed)
        logs: list[Numbers] = [factor * off for factor in SENSITIVITY]
        logs[0], logs[4] = heavier * logs[0], heavier * logs[4]
        logs = after_yield(logs, plastic_restitution(model, context))
        return Bound(none, none, results=bounded_where(known, dissipated(logs, viscous)))

    def proved(self, law: "ContactLaw") -> bool:  # noqa: ARG002
        """Return False: tested on random scenes."""
        return False
