"""Model error of an impact with plate inertia: measured against explicit finite elements.

The recorded simulations of plate and sphere share nothing with the model (see
`derivation.checks.finite_elements`). For each result the model error is the largest difference
between program and elements, plus the elements' own error, less the bound that the program states.
In short and wide contacts thickness resonances make the force rough, and the elements resolve it
less well; these count apart.
"""

import json
import math
from functools import cache
from typing import NamedTuple

from derivation.engine.files import measurements
from derivation.scene.model import Model
from derivation.scene.scene import OUTPUTS

SHORT, WIDE = 4.0, 0.3
"""Contact time over that of a thickness echo, below which a contact is short; and contact radius
over thickness, on the plate or on a half-space, from which it is wide."""
CONVERGED, ROUGHLY = 1e-3, 1e-2
"""Own error of the elements up to which a comparison counts, and that of a rough contact."""
FLOOR = 1e-3
"""Least model error that is stated: the elements are not better than that in all results."""


class _Simulation(NamedTuple):
    """A recorded simulation: whether it is short or wide, and the model error of each result."""

    rough: bool
    errors: dict[str, float]


def inertia_error(model: Model, a: float, contact_time: float) -> dict[str, float]:
    """Model error of each result [1].

    Parameters
    ----------
    model
        A model with plate inertia.
    a
        Largest contact radius [m].
    contact_time
        Duration of the first contact [s].
    """
    fastest = model.shear_speed * ((model.lam + 2.0 * model.mu) / model.mu) ** 0.5
    # A light plate gives way: the contact stays narrower, but the force rises as on a half-space.
    widest = max(a, _half_space_radius(model))
    rough = _rough(contact_time * fastest / (4.0 * model.h), widest / (2.0 * model.h))
    found: dict[str, float] = dict.fromkeys(OUTPUTS, FLOOR)
    for case in _cases():
        if rough or not case.rough:
            found = {name: max(size, case.errors.get(name, 0.0)) for name, size in found.items()}
    return found


def _half_space_radius(model: Model) -> float:
    """Largest contact radius [m] on a half-space, by Hertz."""
    stiffness = 4.0 / 3.0 * model.modulus / (1.0 + model.softness) * math.sqrt(model.R)
    depth = math.pow(1.25 * model.m / stiffness, 0.4) * math.pow(model.v0, 0.8)
    return math.sqrt(model.R * depth)


def _rough(echoes: float, width: float) -> bool:
    return echoes < SHORT or width > WIDE


@cache
def _cases() -> tuple[_Simulation, ...]:
    """The recorded simulations that the program has repeated."""
    rows = json.loads((measurements() / "elastodynamics.json").read_text())["impacts"]
    found = []
    for row in rows:
        program, place = row.get("program", {}), row["parameters"]
        if "values" not in program:
            continue
        values, elements = program["values"], row["elements"]
        rough = _rough(place["contact_time_over_echo"], place["contact_radius_over_thickness"])
        errors: dict[str, float] = {
            name: abs(values[name] / elements[name] - 1.0) + row["errors"][name] - program["bound"]
            for name in OUTPUTS
            if name in elements and row["errors"][name] <= (ROUGHLY if rough else CONVERGED)
            if name != "max_contact_radius"  # that of a node
        }
        found.append(_Simulation(rough, errors))
    return tuple(found)
