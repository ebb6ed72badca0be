"""The only door to the generated package: the kernels a scene needs."""

from generated.back_face import clamped_far_stress, far_stress, supported_far_stress
from generated.contact_law import (
    contact_radius,
    force_of_radius,
    indentation,
    max_pressure,
    radius_of_force,
    stiffness,
)
from generated.edge import (
    clamped_edge,
    clamped_edge_bound,
    clamped_edge_slope,
    supported_edge,
    supported_edge_bound,
    supported_edge_slope,
)
from generated.effect_numbers import PRESSURE_WALL, WALL_CUBIC, WALL_GROWTH, WALL_LINEAR
from generated.effects import (
    Sphere,
    bending,
    bending_period,
    echo_time,
    side_wall,
    sphere_contact,
    zener_number,
)
from generated.impact import COARSE_QUADRATURE, FULL_QUADRATURE, ROUNDING, history, impact
from generated.plasticity_numbers import YIELD_LIMIT
from generated.sensitivity import indentation_slope
from generated.simple_impact import Estimate, Plate, hertz, law_errors, leading, plate_of
from generated.viscosity import Course, viscous_logarithms, viscous_number
from generated.viscous_bodies import retardation_of_two

__all__ = [
    "COARSE_QUADRATURE",
    "FULL_QUADRATURE",
    "PRESSURE_WALL",
    "ROUNDING",
    "WALL_CUBIC",
    "WALL_GROWTH",
    "WALL_LINEAR",
    "YIELD_LIMIT",
    "Course",
    "Estimate",
    "Plate",
    "Sphere",
    "bending",
    "bending_period",
    "clamped_edge",
    "clamped_edge_bound",
    "clamped_edge_slope",
    "clamped_far_stress",
    "contact_radius",
    "echo_time",
    "far_stress",
    "force_of_radius",
    "hertz",
    "history",
    "impact",
    "indentation",
    "indentation_slope",
    "law_errors",
    "leading",
    "max_pressure",
    "plate_of",
    "radius_of_force",
    "retardation_of_two",
    "side_wall",
    "sphere_contact",
    "stiffness",
    "supported_edge",
    "supported_edge_bound",
    "supported_edge_slope",
    "supported_far_stress",
    "viscous_logarithms",
    "viscous_number",
    "zener_number",
]
