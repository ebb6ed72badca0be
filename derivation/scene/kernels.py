"""The generated functions that scenes use; other modules import them from here."""

import numpy as np

from generated.arrays import Double as Array
from generated.back_face import (
    back_face_stress,
    clamped_back_face_stress,
    supported_back_face_stress,
)
from generated.contact_kernels import slope_of_indentation
from generated.contact_law import (
    contact_radius,
    force_of_radius,
    indentation,
    max_pressure,
    radius_of_force,
    stiffness,
)
from generated.contact_series import (
    THICKEST,
    THINNEST,
    Piece,
    Plates,
    columns,
    correction_with_slope,
    plates_of,
    with_slope,
)
from generated.edge import (
    clamped_edge,
    clamped_edge_bound,
    clamped_edge_slope,
    supported_edge,
    supported_edge_bound,
    supported_edge_slope,
)
from generated.edge_curvature import clamped_edge_curvature, supported_edge_curvature
from generated.edge_kernels import law_of_square
from generated.effect_kernels import (
    hertz_constant,
    hertz_depth,
    hertz_force,
    hertz_pressure,
    hertz_stiffness,
    zener_rates,
    zener_time_unit,
)
from generated.effect_numbers import (
    LATERAL_CUBIC,
    LATERAL_GROWTH,
    LATERAL_LINEAR,
    PRESSURE_ABOVE,
    PRESSURE_BELOW,
    PRESSURE_EITHER,
    PRESSURE_LATERAL,
)
from generated.effects import (
    Sphere,
    bending,
    bending_period,
    echo_time,
    finite_radius,
    sphere_contact,
    zener_number,
)
from generated.impact import COARSE_QUADRATURE, FULL_QUADRATURE, ROUNDING, history, impact
from generated.impact_shapes import cut
from generated.plasticity_kernels import hertz_radius
from generated.plasticity_numbers import YIELD_LIMIT
from generated.pressure import p as hertz_profile
from generated.sensitivity import indentation_slope
from generated.simple_impact import Estimate, Plate, law_errors
from generated.sphere_kernels import (
    face_motion,
    sphere_logarithm,
    sphere_start,
    sphere_tail,
    sphere_term,
)
from generated.stretching_kernels import (
    edge_tension_clamped,
    stiffening_clamped,
    stiffening_paper,
    stiffening_supported,
    tension_clamped,
    tension_paper,
    tension_supported,
)
from generated.viscosity import ImpactExtremes, viscous_logarithms, viscous_number
from generated.viscous_bodies import retardation_of_two

Numbers = float | Array
"""A number of one scene, or a column of numbers of many scenes."""


def contact_plates(h: Numbers, b: Numbers) -> Plates:
    """Return the polynomials of the contact law of one or many plates; NaN for h/b out of range."""
    eta = np.ravel(np.asarray(h / b))
    return plates_of(np.where((eta >= THINNEST) & (eta <= THICKEST), eta, np.nan))


def plates_at(plates: Plates, index: Array) -> Plates:
    """Return some of many plates by their indices."""
    short, first = (Piece(*(x[..., index] for x in piece)) for piece in plates[3:])
    eta, reach, far = (x[index] for x in plates[:3])
    return Plates(eta, reach, far, short, first)


def plate_contribution(plates: Plates, a: Array, h: Numbers, b: Numbers) -> tuple[Array, Array]:
    """Return F and S - 1 of the contact law for one plate, or for many with a row of radii each.

    Parameters
    ----------
    plates
        `plates_of` h/b.
    a
        Contact radii [m], of shape (points,), or (plates, points).
    h, b
        Half-thickness and radius of the plate [m], or of the plates in shape (plates, 1).

    Returns
    -------
    tuple of ndarray
        F and S - 1 [1] in the shape of a; NaN outside 0 <= a < b.
    """
    A = np.where((a >= 0.0) & (a < b), a, np.nan) / h
    first = columns(plates.first, None if A.ndim == 1 else np.arange(plates.eta.size))
    value, slope = with_slope(A, first if A.ndim == 1 else cut(first, ...))
    reach = plates.reach if A.ndim == 1 else plates.reach[:, None]
    beyond = reach < A
    if beyond.any():
        owner = np.arange(plates.eta.size)[:, None] if A.ndim > 1 else np.zeros(1, dtype=np.intp)
        index = np.broadcast_to(owner, A.shape)[beyond]
        value[beyond], slope[beyond] = correction_with_slope(A[beyond], plates, index)
    one = np.ones(1)
    return value, slope_of_indentation(one, 2.0 * one, value, slope) - 1.0


__all__ = [
    "COARSE_QUADRATURE",
    "FULL_QUADRATURE",
    "LATERAL_CUBIC",
    "LATERAL_GROWTH",
    "LATERAL_LINEAR",
    "PRESSURE_ABOVE",
    "PRESSURE_BELOW",
    "PRESSURE_EITHER",
    "PRESSURE_LATERAL",
    "ROUNDING",
    "YIELD_LIMIT",
    "Estimate",
    "ImpactExtremes",
    "Numbers",
    "Plate",
    "Plates",
    "Sphere",
    "back_face_stress",
    "bending",
    "bending_period",
    "clamped_back_face_stress",
    "clamped_edge",
    "clamped_edge_bound",
    "clamped_edge_curvature",
    "clamped_edge_slope",
    "contact_plates",
    "contact_radius",
    "echo_time",
    "edge_tension_clamped",
    "face_motion",
    "finite_radius",
    "force_of_radius",
    "hertz_constant",
    "hertz_depth",
    "hertz_force",
    "hertz_pressure",
    "hertz_profile",
    "hertz_radius",
    "hertz_stiffness",
    "history",
    "impact",
    "indentation",
    "indentation_slope",
    "law_errors",
    "law_of_square",
    "max_pressure",
    "plate_contribution",
    "plates_at",
    "radius_of_force",
    "retardation_of_two",
    "sphere_contact",
    "sphere_logarithm",
    "sphere_start",
    "sphere_tail",
    "sphere_term",
    "stiffening_clamped",
    "stiffening_paper",
    "stiffening_supported",
    "stiffness",
    "supported_back_face_stress",
    "supported_edge",
    "supported_edge_bound",
    "supported_edge_curvature",
    "supported_edge_slope",
    "tension_clamped",
    "tension_paper",
    "tension_supported",
    "viscous_logarithms",
    "viscous_number",
    "zener_number",
    "zener_rates",
    "zener_time_unit",
]
