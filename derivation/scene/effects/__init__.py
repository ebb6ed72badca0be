"""Physical effects, one module each: contribution to the contact law, parameter, error bound.

The base class is in `effect`. The order below is that of the effects table.
"""

from derivation.scene.effects.bending import Bending
from derivation.scene.effects.damping import Damping
from derivation.scene.effects.edge import Edge
from derivation.scene.effects.effect import Effect
from derivation.scene.effects.finite_radius import FiniteRadius
from derivation.scene.effects.finite_thickness import WHOLE_PLATE, FiniteThickness
from derivation.scene.effects.gravity import Gravity
from derivation.scene.effects.hertz import Hertz
from derivation.scene.effects.inertia import PlateInertia
from derivation.scene.effects.non_hertzian_pressure import NonHertzianPressure
from derivation.scene.effects.plasticity import Plasticity
from derivation.scene.effects.sphere_elasticity import SphereElasticity
from derivation.scene.effects.spherical_profile import SphericalProfile
from derivation.scene.effects.stretching import Stretching
from derivation.scene.effects.viscosity import Viscosity

EFFECTS: tuple[Effect, ...] = (
    Hertz(),
    SphereElasticity(),
    SphericalProfile(),
    Bending(),
    FiniteThickness(),
    FiniteRadius(),
    Edge(),
    NonHertzianPressure(),
    Plasticity(),
    Viscosity(),
    Gravity(),
    PlateInertia(),
    Stretching(),
    Damping(),
)
"""All effects, in the order of the effects table."""

BY_NAME = {effect.name: effect for effect in EFFECTS}
PAPER = WHOLE_PLATE | {effect.name for effect in EFFECTS if effect.always_included}
"""Effects of the paper's contact law."""

__all__ = ["BY_NAME", "EFFECTS", "PAPER", "WHOLE_PLATE"]
