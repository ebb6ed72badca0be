"""Estimates how long a sphere touches a plate with inertia, before the impact is simulated.

The sphere is attached to the plate by a linear spring, as stiff as the contact on a plate that does
not deflect. Until this sphere stops, contacts and flights follow each other about as the force of
the spring changes its sign.
"""

import math

import numpy as np

from derivation.scene import scales
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_sequence
from derivation.scene.dynamic.contact_errors import HEAVY
from derivation.scene.dynamic.modal import Modes, plate_of
from derivation.scene.dynamic.mode_count import affordable, branching, count_of
from derivation.scene.dynamic.next_element import PHASE
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.errors import SceneError
from generated.arrays import Double as Array

NODES, MANY = (32, 24), 200
"""Nodes of an element, and number of modes above which it has the fewer ones. With 16 nodes of
10,000 damped modes, the tolerance and not the fastest mode limits its length: runs took longer."""
FEWER = 2
"""Difference in the number of nodes between a run and the coarser one that checks it."""
IN_CONTACT = 0.7
"""Least fraction of half the period of a heavy sphere in contact; 0.77 in random scenes."""
STOPPED = 64
"""Largest number of modes from which the least time in contact is estimated."""
TIMES = 801
"""Number of times at which the velocity of the sphere is evaluated, over half the first period."""
TOUCHING = 0.4
"""Least sum of all contacts over the time in which the attached sphere stops; random scenes with a
sphere of at least `LIGHTEST` times the mass of the first mode have at least 0.51."""
LIGHTEST = 0.05
"""Sphere mass over mass of the first mode below which contacts may be shorter than that."""


def stopping_time(law: ContactLaw, modes: Modes) -> float:
    """Return the time [s] after which the attached sphere first has no velocity.

    It is at most half the period of its slowest vibration.
    """
    model = law.model
    stiffness = scales.hertz_constant(model, law.modulus)
    depth = scales.largest_depth(model, law.modulus)
    omega, fractions = _vibrations(model.m, 1.25 * stiffness * math.sqrt(depth), modes)
    times = np.linspace(0.0, math.pi / float(omega[omega > 0.0][0]), TIMES)
    velocity = np.cos(np.multiply.outer(times, omega)) @ fractions
    back = np.flatnonzero(velocity < 0.0)
    return float(times[back[0]] if back.size else times[-1])


def _vibrations(m: float, spring: float, modes: Modes) -> tuple[Array, Array]:
    """Return angular frequencies [1/s] of sphere and plate, and their fractions of the velocity.

    Parameters
    ----------
    m
        Mass of the sphere [kg].
    spring
        Stiffness of the spring between them [N/m].
    """
    stretch = np.append(-np.sqrt(modes.inverse_modal_mass), 1.0 / math.sqrt(m))
    matrix = spring * np.multiply.outer(stretch, stretch)
    matrix[np.diag_indices(modes.omega.size)] += modes.omega**2
    squares, shapes = np.linalg.eigh(matrix)
    return np.sqrt(np.maximum(squares, 0.0)), shapes[-1] ** 2


def time_in_contact(law: ContactLaw, modes: Modes) -> float:
    """Return an estimate [s] that the sum of all contacts exceeds; 0 for a very light sphere."""
    if law.model.m * float(modes.inverse_modal_mass[0]) < LIGHTEST:
        return 0.0
    return TOUCHING * stopping_time(law, modes)


def nodes_for(problem: DynamicProblem) -> int:
    """Return the number of nodes of an element: fewer for many modes, to save time."""
    return NODES[problem.omega.size > MANY]


def half_period(m: float, modes: Modes) -> float:
    """Return half the period [s] of a mass [kg] on the static compliance of the plate."""
    return math.pi * math.sqrt(m * float(np.sum(modes.compliance)))


def check_long(law: ContactLaw, tolerance: float) -> None:
    """Reject a sphere that stays on the plate for more time steps than are allowed.

    The fastest mode limits the time step. The contacts of a heavy sphere last about half a period;
    of any other the least time in contact counts.
    """
    model = law.model
    if model.inertia.modes or model.inertia.infinite_plate:
        return
    ratio, swing = heaviness(law)
    if ratio < HEAVY:
        _check_time_in_contact(law, tolerance)
        return
    steps, most = least_steps(law, 2 * affordable(law), tolerance, IN_CONTACT * swing)
    if steps > most:
        raise SceneError(
            f"effects.inertia: the sphere is {ratio:.3g} times as heavy as the first mode of the "
            f"plate and stays in contact for about {swing:.2g} s, which needs at least {steps:.2g} "
            f"time steps, more than the limit of {most}; set effects.inertia = false (for such a "
            "sphere the plate is nearly quasi-static), or choose inertia.modes"
        )


def heaviness(law: ContactLaw) -> tuple[float, float]:
    """Return sphere mass over mass of the first mode [1], and half its period on the plate [s]."""
    modes = plate_of(law, count_of(law)).modes
    return law.model.m * float(modes.inverse_modal_mass[0]), half_period(law.model.m, modes)


def _check_time_in_contact(law: ContactLaw, tolerance: float) -> None:
    """Reject a sphere whose first run, with the lowest branch, needs too many time steps."""
    if law.model.inertia.branches == "auto":
        law = branching(law, "A0")
    count = affordable(law)
    least = time_in_contact(law, plate_of(law, min(count, STOPPED)).modes)
    steps, most = least_steps(law, count, tolerance, least, FEWER)
    if steps > most:
        raise SceneError(
            f"effects.inertia: expected an impact of at most {most} time steps, got one with an "
            f"estimated time in contact of at least {least:.2g} s, which needs {steps:.2g} time "
            f"steps with the {count} modes that its short contacts require; use a lighter "
            "sphere, or a thicker or smaller plate"
        )


def least_steps(
    law: ContactLaw, count: int, tolerance: float, time: float, fewer: int = 0
) -> tuple[float, int]:
    """Return the least number of time elements during a time [s] in contact, and their limit.

    The tables of the contact, on which the limit depends, are computed only if they are needed:
    with thousands of modes they would take minutes.
    """
    each = time * float(np.max(plate_of(law, count).modes.omega)) / PHASE
    steps, most = each / NODES[0], contact_sequence.ELEMENTS
    if steps <= most:
        problem = problem_of(law, count, tolerance)
        n = nodes_for(problem) - fewer
        steps, most = each / n, contact_sequence.steps_of(problem, n)
    return steps, most
