"""Relative errors of the model of an impact itself, which no tolerance includes."""

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from derivation.scene.contact_law.corrections import stretching
from derivation.scene.contact_law.edge_curvature import curvature_errors
from derivation.scene.contact_law.edge_remainder import edge_remainder, edge_remainders
from derivation.scene.contact_law.finite_sphere import (
    finite_sphere_error,
    finite_sphere_errors,
    rebound_error,
)
from derivation.scene.contact_law.finite_strains import more_than_radius, radius_error
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import local_indentation
from derivation.scene.dynamic.model_error import curvature_error, end_error, inertia_error
from derivation.scene.dynamic.stretching_error import (
    Deflections,
    deflections_of,
    stretching_error,
)
from derivation.scene.dynamic.time_element import P
from derivation.scene.dynamic.unlike_bodies import unlike_bodies_errors
from derivation.scene.effects.effect import Results, weight_work_ratio
from derivation.scene.scene import OUTPUTS
from derivation.scene.selection.method_selection import growth_of
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.dynamic.wave_motion import DynamicImpact

WIDTH: Final = "max_contact_radius"
PRESSURE: Final = "max_pressure"


def deflections_in(
    law: ContactLaw, numbers: Results, motion: "DynamicImpact | None"
) -> Deflections:
    """Return the deflections of the plate in an impact with given outputs."""
    if motion is not None:
        return deflections_of(law, motion)
    return Deflections(numbers[1] - float(local_indentation(law, numbers[3])), np.zeros(0))


def model_errors(
    law: ContactLaw,
    numbers: Results,
    deflections: Deflections,
    motion: "DynamicImpact | None",
) -> dict[str, float]:
    """Return the relative model error of each output and of `max_pressure` [1].

    It is that by edge, waves, stretching, viscosity, finite size of the sphere and finite strains.
    """
    model, other_edge, a = law.model, law.other_edge, numbers[3]
    growth = growth_of(motion)
    unlike = unlike_bodies_errors(law, numbers[0], motion, growth)
    if motion is None:
        if other_edge:
            edge_remainder(model, a)  # outside its range it raises an error
        one = (np.array([x]) for x in (a, numbers[1], deflections.largest, numbers[4]))
        found = quasi_static_errors(law, *one)
        errors = {name: float(found[name][0]) + unlike[name] for name in OUTPUTS}
        return errors | {PRESSURE: float(found[PRESSURE][0]) + unlike[WIDTH]}
    sphere = dict(zip(OUTPUTS, finite_sphere_errors(law, numbers, growth), strict=True))
    from derivation.scene.dynamic.wave_problem import echo_time

    stretched = stretching_error(law, motion, deflections)
    waves = inertia_error(model, a, motion.contact_time)
    # The edge has no effect before a wave has returned from it.
    returned = other_edge and motion.inertia.total_time > echo_time(motion.law.model)
    edge = edge_remainder(model, a) if returned else 0.0
    waves[WIDTH] += curvature_error(motion.law, a, motion.inertia.curvature)
    for name, error in motion.flat_contact_errors.items():
        waves[name] += error
    if law.viscous:
        end = end_error(motion.histories[0][P], waves["max_force"])
        waves["contact_time"] = max(waves["contact_time"], end)
    errors = {
        name: max(waves[name] + stretched[name], edge) + unlike[name] + sphere[name]
        for name in OUTPUTS
    }
    return errors | {PRESSURE: errors[WIDTH] + float(more_than_radius(law, a))}


def quasi_static_errors(
    law: ContactLaw, a: Array, depth: Array, deflection: Array, restitution: Array
) -> dict[str, Array]:
    """Return the relative model errors of the outputs and of `max_pressure` [1], without inertia.

    Those of a viscoelastic contact whose bodies differ are not included.

    On a quasi-static plate, stretching changes the energy that a plastic or viscoelastic contact
    dissipates. The relative error of the restitution is larger by the ratio of that energy to the
    remaining energy.

    Parameters
    ----------
    law
        The law of one scene, or of many as columns.
    a, depth, deflection, restitution
        Largest contact radius, indentation and deflection of the plate [m], and restitution [1]:
        one number each, or columns.
    """
    edge, pressure = curvature_errors(law, a)
    pressed = np.where(edge < math.inf, pressure - edge, 0.0)
    if law.other_edge:
        edge = edge_remainders(law.model, a) + edge
    size = stretching(law.model, deflection)
    sphere = finite_sphere_error(law, a, depth)
    error = edge + size + sphere
    lost = size
    if law.viscous or law.plastic:
        supplied = 1.0 + weight_work_ratio(law.model, depth)
        dissipated = supplied / np.square(np.maximum(restitution, 1e-6)) - 1.0
        lost = size * np.maximum(1.0, dissipated)
    rebound = edge + lost + rebound_error(law, a, sphere, restitution)
    errors: dict[str, Array] = dict.fromkeys(OUTPUTS, error)
    wide = error + pressed + radius_error(law, a)
    pressure = wide + more_than_radius(law, a)
    return errors | {WIDTH: wide, PRESSURE: pressure, "restitution": rebound}
