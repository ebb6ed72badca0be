"""Stretching: the middle plane of a deflected plate resists, and the plate becomes stiffer."""

import math

from derivation.scene.effects.effect import Bound, BoundContext, Effect, none_of
from derivation.scene.effects.inertia import PlateInertia
from derivation.scene.model import Model
from derivation.scene.quantity import ONE_DIGIT, percent


class Stretching(Effect):
    """Tension of the middle plane by the slope of the plate, in equilibrium in the plane."""

    name = "stretching"
    adds = "stretching of the plate's middle plane (von Karman)"
    equation = "q_j'' + omega_j^2 q_j = omega_j^2 c_j (P_j - 2 pi int_0^b N_r w' s_j' r dr)"
    parameter = "deflection over thickness w/H"
    source = "von Karman 1910; step 33"
    contains = PlateInertia.contains | {"inertia"}
    requires = PlateInertia.requires | {"inertia"}
    within = "inertia"
    static = False
    stretches = True
    remedy = "give plate.density [kg/m^3] and a plate of finite extent"
    cause = (
        "needed, because without it the model error of a result would be about "
        f"{percent(ONE_DIGIT)} or more"
    )

    def not_applicable_reason(self, model: Model) -> str:
        """Return a reason if it is not included, or the plate cannot stretch."""
        if not model.inertia.stretching:
            return "omitted; the model error includes its neglect"
        if not model.density:
            return "the density of the plate is unknown"
        return "the plate is infinite" if model.inertia.infinite_plate else ""

    def value(self, model: Model, a: float) -> float:  # noqa: ARG002
        """Return NaN: the deflection is known only after the simulation."""
        return math.nan

    def bound(self, model: Model, context: BoundContext) -> Bound:  # noqa: ARG002
        """Return no bound: the model error of a simulation without it is an estimate."""
        none = none_of(context.radii)
        return Bound(none, none, results=5 * (math.inf,))

    def proved(self, law: object) -> bool:  # noqa: ARG002
        """Return False: there is no bound."""
        return False
