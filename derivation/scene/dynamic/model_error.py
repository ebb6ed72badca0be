"""Model error of impacts with plate inertia, measured against explicit finite-element simulations.

The recorded simulations are independent of the model (see `derivation.checks.finite_elements`). For
each result the model error is the largest difference between program and finite elements, plus the
error of the finite elements; the error bound of the program is not subtracted, because that of
another scene may be smaller. Short and wide contacts, in which thickness resonances make the force
rough and finite elements less accurate, are treated separately, and so are thick plates, on which
the edge matters more, and plates with a negative Poisson's ratio.
"""

import json
import math
from collections.abc import Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from derivation.engine.files import measurements
from derivation.scene import scales
from derivation.scene.model import Model
from derivation.scene.scene import OUTPUTS
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.contact_law.law import ContactLaw

SHORT, WIDE = 4.9, 0.21
"""Contact time over the time of a reflection across the thickness, below which a contact is short,
and contact radius over thickness, on the plate or on a half-space, above which it is wide. Other
contacts are within the range of recorded ones, from 5 and up to 0.2, in which waves hardly make the
force rough."""
CONVERGED, ROUGHLY = 1e-3, 1e-2
"""Largest finite-element error of comparisons that are used, and the same for rough contacts, thick
plates and a negative Poisson's ratio."""
RESOLVED, ROUGHLY_RESOLVED = 1e-2, 5e-2
"""The same of the largest tensile stress, which depends more on the contact of single nodes."""
PAPER = "paper"
THIN, ROUNDED = 0.3, 1e-12
"""Thickness over radius up to which all simulations are used; rounding error of this ratio [1]."""
STEP = 1e-4
"""Relative difference of the radii from which a steepness is computed."""
FLOOR = 1e-3
"""Smallest model error that is stated, the accuracy of the finite elements in all results."""


class _Simulation(NamedTuple):
    """A recorded simulation: the kind of impact, and the model error of each result.

    Attributes
    ----------
    rough
        Whether the contact is short or wide.
    thickness
        Thickness of the plate over its radius [1].
    held, auxetic
        Whether the edge is clamped or simply supported, and Poisson's ratio is negative.
    errors, stress
        Model error of each output, and of the largest tensile stress; the latter is 0 if finite
        elements do not resolve it.
    """

    rough: bool
    thickness: float
    held: bool
    auxetic: bool
    errors: dict[str, float]
    stress: float

    def counts(self, model: Model, rough: bool, thickest: float) -> bool:
        """Return whether it is used for a model, with plates up to a thickness over radius."""
        return (
            (rough or not self.rough)
            and (model.edge != PAPER or not self.held or self.thickness <= THIN)
            and (model.poissons_ratio < 0.0 or not self.auxetic)
            and self.thickness <= thickest
        )


def inertia_error(model: Model, a: float, contact_time: float) -> dict[str, float]:
    """Return the relative model error of each result.

    Parameters
    ----------
    model
        A model with plate inertia.
    a
        Largest contact radius [m].
    contact_time
        Duration of the first contact [s].
    """
    errors: dict[str, float] = dict.fromkeys(OUTPUTS, FLOOR)
    for case in _similar(model, a, contact_time):
        errors = {name: max(size, case.errors.get(name, 0.0)) for name, size in errors.items()}
    # Finite elements do not resolve the radius. By Hertz's law it is the cube root of the force.
    errors["max_contact_radius"] = max(errors["max_contact_radius"], errors["max_force"] / 3.0)
    return errors


def stress_error(model: Model, a: float, contact_time: float) -> float:
    """Return the relative model error of the largest tensile stress on the back face [1].

    The arguments are those of `inertia_error`.
    """
    return max((FLOOR, *(case.stress for case in _similar(model, a, contact_time))))


def _similar(model: Model, a: float, contact_time: float) -> list[_Simulation]:
    """Return the recorded simulations that are used for an impact.

    Those of thick plates are used up to the next recorded thickness.
    """
    rough, thickness = _is_rough(model, a, contact_time), 2.0 * model.eta
    recorded = {case.thickness for case in _cases()}
    thicker = [x for x in recorded if x >= max(thickness, THIN) * (1.0 - ROUNDED)]
    thickest = min(thicker, default=math.inf)
    return [case for case in _cases() if case.counts(model, rough, thickest)]


def curvature_error(law: "ContactLaw", a: float, change: float) -> float:
    """Return the relative error of contact radius and pressure by the curvature of the plate [1].

    Parameters
    ----------
    law
        The law of the simulated plate under a static load.
    a, change
        The contact radius [m], and its relative change by the curvature [1].

    Notes
    -----
    The change of the curvature is taken as the same everywhere under the contact. Between two
    static plates a formula of first order was wrong by up to 0.4 % of changes of 2 %, 4 % of 10 %
    and 90 % of 50 %; the present one by at most 1 % of changes up to 6 %. At a given force, the
    logarithm of the pressure at the centre changes by that of the radius times
    d log(p/P)/d log a: by twice as much on a half-space.
    """
    if not change:
        return 0.0
    radii = a * np.array([[1.0 - STEP], [1.0]])
    pressures = law.centre_pressure(radii) / law.force(radii, law.at(radii))
    steepness = abs(float(np.log(pressures[1, 0] / pressures[0, 0]))) / STEP
    return max(3.0, steepness) * abs(change) * (0.01 + 2.0 * abs(change))


def end_error(force: Array, error: float) -> float:
    """Return the relative error of a viscoelastic contact's duration by that of its force [1].

    Such a contact ends when its force vanishes, and the force may decrease slowly before. The error
    is the part of the contact in which the force is below its error.

    Parameters
    ----------
    force
        Force at equidistant times of the contact [N].
    error
        Error of the force over the largest one [1].
    """
    above = np.flatnonzero(force > error * np.max(force))
    return 1.0 - float(above[-1]) / (force.size - 1) if above.size else 1.0


def _half_space_radius(model: Model) -> float:
    """Return the largest contact radius [m] on a half-space, by Hertz's law."""
    return math.sqrt(model.R * scales.largest_depth(model))


def echoes_during(model: Model, contact_time: float) -> float:
    """Return how often a pressure wave returns from the back face during a contact [1]."""
    fastest = model.shear_speed * ((model.lam + 2.0 * model.mu) / model.mu) ** 0.5
    return float(contact_time * fastest / (4.0 * model.h))


def _is_rough(model: Model, a: float, contact_time: float) -> bool:
    # On a light plate the contact stays narrower, but the force rises as on a half-space.
    widest = max(a, _half_space_radius(model))
    return _rough(echoes_during(model, contact_time), widest / (2.0 * model.h))


def _rough(echoes: float, width: float) -> bool:
    return echoes < SHORT or width > WIDE


@cache
def _cases() -> tuple[_Simulation, ...]:
    """Return the recorded simulations that the program has repeated."""
    rows = json.loads((measurements() / "elastodynamics.json").read_text())["impacts"]
    cases = []
    for row in rows:
        program, parameters = row.get("program", {}), row["parameters"]
        if "values" not in program:
            continue
        thickness = parameters["thickness_over_radius"]
        held = not row["name"].endswith(PAPER)
        auxetic = row["scene"]["plate"]["poissons_ratio"] < 0.0
        rough = _rough(
            parameters["contact_time_over_echo"], parameters["contact_radius_over_thickness"]
        )
        # Larger differences are also visible with less accurate elements.
        roughly = rough or auxetic or thickness > THIN
        values, elements = program["values"], row["elements"]
        errors: dict[str, float] = {
            name: abs(values[name] / elements[name] - 1.0) + row["errors"][name]
            for name in OUTPUTS
            if name in elements and row["errors"][name] <= (ROUGHLY if roughly else CONVERGED)
            if name != "max_contact_radius"  # finite elements resolve it only to a node
        }
        stress = _stress_error(row, ROUGHLY_RESOLVED if roughly else RESOLVED)
        cases.append(_Simulation(rough, thickness, held, auxetic, errors, stress))
    return tuple(cases)


def _stress_error(row: Mapping[str, Any], resolved: float) -> float:
    """Return the model error of the largest tensile stress in a recorded simulation [1].

    It is 0 if the error of the finite elements exceeds `resolved`, or no stress is stated.
    """
    name = "max_tensile_stress"
    error, value = row["errors"][name], row["program"]["values"][name]
    if value is None or error > resolved:
        return 0.0
    return float(abs(value / row["elements"][name] - 1.0) + error)
