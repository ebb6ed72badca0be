"""The only door to the generated package: the kernels a scene needs."""

from generated.contact_law import (
    contact_radius,
    force_of_radius,
    indentation,
    max_pressure,
    radius_of_force,
    stiffness,
)
from generated.impact import COARSE_QUADRATURE, FULL_QUADRATURE, ROUNDING, history, impact
from generated.simple_impact import hertz, leading

__all__ = [
    "COARSE_QUADRATURE",
    "FULL_QUADRATURE",
    "ROUNDING",
    "contact_radius",
    "force_of_radius",
    "hertz",
    "history",
    "impact",
    "indentation",
    "leading",
    "max_pressure",
    "radius_of_force",
    "stiffness",
]
