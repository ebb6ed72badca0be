"""The only door to the generated package: the kernels a scene needs."""

from generated.contact_law import (
    contact_radius,
    force_of_radius,
    indentation,
    max_pressure,
    radius_of_force,
    stiffness,
)
from generated.impact import history, impact

__all__ = [
    "contact_radius",
    "force_of_radius",
    "history",
    "impact",
    "indentation",
    "max_pressure",
    "radius_of_force",
    "stiffness",
]
