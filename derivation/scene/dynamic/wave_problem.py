"""The dynamic problem of a scene with plate inertia."""

import math
from functools import lru_cache

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.yielding import units_of, yielding_of
from derivation.scene.dynamic.contact_tables import TAIL, contact_of
from derivation.scene.dynamic.middle_plane import MiddlePlane
from derivation.scene.dynamic.modal import ModalPlate, bending_fraction, plate_of
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.effects.inertia import WIDER
from derivation.scene.model import Model

FINER = 1e-2
"""Last coefficients of the contact tables over the tolerance of the time elements."""
ROUGH, FEWEST = 8, 4
"""Number of shapes that stretch the plate over that in a rough flight, and the least number of the
latter: a simulation of such a flight takes about a fiftieth of the time."""


@lru_cache(maxsize=1)  # the work of a run is estimated before it starts
def problem_of(law: ContactLaw, count: int, tolerance: float = 0.0) -> DynamicProblem:
    """Return the dynamic problem of a law with a number of bending modes.

    Parameters
    ----------
    tolerance
        Tolerance of the time elements [1], than which the contact tables are more accurate.
    """
    return problem_with(law, plate_of(law, count), max(TAIL, FINER * tolerance))


def problem_with(law: ContactLaw, plate: ModalPlate, tail: float = TAIL) -> DynamicProblem:
    """Return the problem in units of the impact on a plate that does not deflect.

    Parameters
    ----------
    tail
        Largest value of the last coefficients of the contact tables over the largest one [1].
    """
    model, (a, T) = law.model, units_of(law)
    rest = law.only(lambda e: e.static and not e.other_edge)
    contact = contact_of(rest, plate, min(WIDER * a, law.limit), model.inertia.pointwise, tail)
    retardation = model.retardation_time / T if law.viscous else 0.0
    first_echo = echo_time(model) / T if model.inertia.infinite_plate else math.inf
    weight = law.gravity * (T / model.v0)
    units = a, T, model.m, model.v0
    elastic_fraction = bending_fraction(model, plate.modes) if retardation else 1.0
    limit = float(law.limit), law.limit_in_words
    depth, force = model.v0 * T, model.m * model.v0 / T
    plane = rough = None
    if law.stretches:
        plane = MiddlePlane.of(model, plate.modes, depth, force)
        if plane.slopes.shape[0] >= ROUGH * FEWEST:
            rough = MiddlePlane.of(model, plate.modes, depth, force, ROUGH)
    return DynamicProblem(
        contact,
        *units,
        weight,
        retardation,
        first_echo,
        law.damping_ratio,
        yielding_of(law),
        *limit,
        elastic_fraction,
        plane,
        rough,
    )


def echo_time(model: Model) -> float:
    """Return the time [s] before which no wave returns from the edge: 2 b over the largest speed.

    The group speed of A0 is at most 1.1 times that of shear waves; that of any branch is at most
    that of pressure waves.
    """
    fastest = 1.1
    if model.inertia.branches == "all":
        fastest = math.sqrt((model.lam + 2.0 * model.mu) / model.mu)
    return 2.0 * model.b / (fastest * model.shear_speed)
