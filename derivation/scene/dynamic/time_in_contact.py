"""Estimates how long a sphere touches a plate with inertia, before the impact is simulated.

In the estimate the sphere is attached to the plate by a linear spring, as stiff as the contact on a
plate that does not deflect. Until this sphere stops, the force of the spring is positive about as
long as the sphere is in contact.
"""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from derivation.scene import scales
from derivation.scene.contact_law.corrections import doubling_deflection
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_sequence
from derivation.scene.dynamic.contact_errors import HEAVY, rounded_down
from derivation.scene.dynamic.modal import Modes, plate_of
from derivation.scene.dynamic.mode_count import FEWEST, affordable, branching, count_of
from derivation.scene.dynamic.next_element import PHASE
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.stretching_error import FORCE, USABLE
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.errors import SceneError
from generated.arrays import Double as Array

NODES, MANY = (32, 24), 200
"""Nodes of an element, and number of modes above which an element has the smaller number of nodes.
With 16 nodes and 10,000 damped modes, the tolerance and not the fastest mode limits its length, so
that runs take longer."""
FEWER = 2
"""Difference in the number of nodes between a run and the coarser one that checks it."""
IN_CONTACT = 0.7
"""Smallest contact time of a heavy sphere over half its period on the plate; 0.77 in random
scenes."""
SPRING, DEFLECTED = 5.0, 0.9
"""Sphere mass over mass of the first mode from which the plate deflects about as a spring, and the
smallest ratio of its deflection to that of the spring: 0.92 to 0.98 in 22 random impacts."""
STOPPED = 64
"""Largest number of modes from which the least time in contact is estimated."""
TIMES = 801
"""Number of times at which the velocity of the sphere is evaluated, over half the first period."""
TOUCHING = 0.4
"""Least sum of all contacts over the time in which the attached sphere stops; random scenes with a
sphere of at least `LIGHTEST` times the mass of the first mode have at least 0.51."""
QUICK, MORE = 4e6, 1.25
"""Largest expected work of a run with slow modes: a few seconds; ratio of the numbers of modes that
are tried."""
LEAST_OF_TIME = 0.05
"""Error of the contact time that a run with slow modes hardly ever falls below: it did in three of
281 random ones."""
LIGHTEST = 0.05
"""Sphere mass over mass of the first mode below which contacts may be shorter than that."""


def stopping_time(law: ContactLaw, modes: Modes) -> float:
    """Return the time [s] after which the velocity of the attached sphere first vanishes.

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
    root_inverse_mass = np.append(-np.sqrt(modes.inverse_modal_mass), 1.0 / math.sqrt(m))
    matrix = spring * np.multiply.outer(root_inverse_mass, root_inverse_mass)
    matrix[np.diag_indices(modes.omega.size)] += modes.omega**2
    squares, shapes = np.linalg.eigh(matrix)
    return np.sqrt(np.maximum(squares, 0.0)), shapes[-1] ** 2


def time_in_contact(law: ContactLaw, modes: Modes) -> float:
    """Return an estimated lower limit [s] of the sum of all contact times; 0 for a light sphere."""
    if law.model.m * float(modes.inverse_modal_mass[0]) < LIGHTEST:
        return 0.0
    return TOUCHING * stopping_time(law, modes)


def nodes_for(problem: DynamicProblem) -> int:
    """Return the number of nodes of an element: fewer for many modes, to save time."""
    return NODES[problem.omega.size > MANY]


def half_period(m: float, modes: Modes) -> float:
    """Return half the period [s] of a mass [kg] on the static compliance of the plate."""
    return math.pi * math.sqrt(m * float(np.sum(modes.compliance)))


def largest_deflection(law: ContactLaw) -> float:
    """Return the largest deflection [m] of the plate, roughly.

    It is at most about that under a heavy sphere, and that of an infinite plate under an inelastic
    impact; both without weight.
    """
    model = law.model
    _, swing = _heaviness(law)
    infinite = scales.time_unit(model, law.modulus) * scales.zener_number(model)
    return model.v0 * min(swing / math.pi, infinite)


def static_deflection(law: ContactLaw) -> float:
    """Return the deflection [m] of the plate under the weight of the sphere."""
    return law.model.gravity * (_heaviness(law)[1] / math.pi) ** 2


class Long(NamedTuple):
    """An impact that lasts too long for modes as fast as the contact.

    Attributes
    ----------
    time
        Least time in contact [s].
    shown
        The expected or the least time on the plate, in words.
    modes
        Number of modes for which it lasts too long.
    steps, most
        Number of time steps that they need at least, and the largest number.
    """

    time: float
    shown: str
    modes: int
    steps: float
    most: int


def slow_count(law: ContactLaw, tolerance: float, timed: float = math.inf) -> int:
    """Return the number of modes for an impact that lasts too long for faster ones, else 0.

    Parameters
    ----------
    timed
        Largest error of the contact time with which it is useful [1].

    Raises
    ------
    SceneError
        If it lasts too long even for the fewest modes, or the contact time with slow modes is
        hardly ever as accurate, or a heavy sphere deflects a plate that does not stretch too far.
    """
    if law.model.inertia.modes or law.model.inertia.infinite_plate:
        return 0
    check_deflected(law, tolerance)
    long = _too_long(law, tolerance)
    if long is None:
        return 0
    if timed < LEAST_OF_TIME:
        why = " that a contact_time of this tolerance usually requires"
        other = "remove contact_time from accuracy.outputs, increase the tolerance, "
        raise _rejected(law, long, why, other)
    lowest, count = branching(law, "A0"), FEWEST
    steps, most = _steps(lowest, count, tolerance, long.time, FEWER)
    if steps > most:
        raise _rejected(law, long._replace(modes=count, steps=steps, most=most))
    while steps <= most and (more := math.ceil(MORE * count)) < affordable(lowest):
        steps, most = _steps(lowest, more, tolerance, long.time, FEWER, QUICK)
        count = more if steps <= most else count
    return count


def _too_long(law: ContactLaw, tolerance: float) -> Long | None:
    """Return why an impact needs more time steps than are allowed, if it does.

    The fastest mode limits the time step. The contacts of a heavy sphere last about half a period;
    for any other sphere the least time in contact is used. The second run, which shows the error of
    the first one, has twice as many modes. It does not count for a sphere lighter than the first
    mode: slow modes hardly resolve its contacts.
    """
    ratio, swing = _heaviness(law)
    if ratio >= HEAVY:
        time, shown = IN_CONTACT * swing, f"about {swing:.2g}"
    else:
        law = branching(law, "A0") if law.model.inertia.branches == "auto" else law
        time = time_in_contact(law, plate_of(law, min(affordable(law), STOPPED)).modes)
        shown = f"at least about {time:.2g}"
    count, fewer = (2 * affordable(law), 0) if ratio >= 1.0 else (affordable(law), FEWER)
    steps, most = _steps(law, count, tolerance, time, fewer)
    return Long(time, shown, count, steps, most) if steps > most else None


def _rejected(law: ContactLaw, long: Long, why: str = "", other: str = "") -> SceneError:
    """Return the error of an impact with too many time steps.

    Parameters
    ----------
    why
        Why it needs so many modes.
    other
        Remedies beside another sphere or plate.
    """
    remedy = f"{other}use a lighter sphere, or a thicker or smaller plate"
    if _heaviness(law)[0] >= HEAVY and not law.stretches:  # a quasi-static plate would not
        remedy += (
            ", or set effects.inertia = false (for such a sphere the plate is nearly quasi-static)"
        )
    return SceneError(
        f"effects.inertia: the sphere stays on the plate for {long.shown} s, which needs at least "
        f"{long.steps:.2g} time steps with the {long.modes} plate modes{why}, more than the limit "
        f"of {long.most}; {remedy}"
    )


def deflects_too_far(law: ContactLaw) -> bool:
    """Return whether a heavy sphere deflects a plate until stretching would double its stiffness.

    On a plate that does not stretch, such an impact may have up to a hundred contacts.
    """
    return _heavy_deflection(law) >= doubling_deflection(law.model)


def _heavy_deflection(law: ContactLaw) -> float:
    """Return a lower estimate of the deflection [m] under a heavy sphere, 0 under any other."""
    ratio, swing = _heaviness(law)
    return DEFLECTED * law.model.v0 * swing / math.pi if ratio > SPRING else 0.0


def check_deflected(law: ContactLaw, tolerance: float) -> None:
    """Reject a heavy sphere that deflects a plate which does not stretch too far.

    Parameters
    ----------
    tolerance
        Tolerance of the time elements [1], on which it depends whether a slower sphere can be
        simulated.
    """
    model = law.model
    free = model.inertia.modes or model.inertia.infinite_plate or law.stretches
    if free or not deflects_too_far(law):
        return
    deflection, limit = _heavy_deflection(law), doubling_deflection(model)
    thicknesses, (ratio, swing) = deflection / (2.0 * float(model.h)), _heaviness(law)
    raise SceneError(
        f"effects.inertia: expected a deflection of less than {limit:.2g} m, at which stretching, "
        "which the scene disables, doubles the stiffness of the plate, got at least about "
        f"{deflection:.2g} m ({thicknesses:.2g} thicknesses) under a sphere {ratio:.3g} times as "
        "heavy as its first mode; remove effects.stretching = false, use a thicker or smaller plate"
        f"{_slower(law, tolerance, limit, swing)}, or set inertia.modes to simulate a plate that "
        "does not stretch"
    )


def _slower(law: ContactLaw, tolerance: float, limit: float, swing: float) -> str:
    """Return a lighter or slower sphere as a remedy, with a speed if one is low enough.

    Parameters
    ----------
    limit
        Deflection [m] at which stretching doubles the stiffness of the plate.
    swing
        Half the period [s] of the sphere on the plate.
    """
    sag = static_deflection(law)

    def speed_for(deflection: float) -> float:
        """Return the speed [m/s] for a largest deflection [m]; 0 if the weight alone exceeds it."""
        square = deflection * (deflection - 2.0 * DEFLECTED * sag)
        return math.sqrt(max(0.0, square)) * math.pi / (DEFLECTED * swing)

    speed = rounded_down(speed_for(limit))
    low = rounded_down(speed_for(limit * math.sqrt(USABLE / FORCE)))  # of later contacts

    def simulable(speed: float) -> float:
        """Return a speed, or 0 if it needs too many time steps."""
        slow = replace(law, model=replace(law.model, v0=speed))
        return 0.0 if _too_long(slow, tolerance) else speed

    speed = simulable(speed) if speed else 0.0
    if not speed:
        return " or a lighter sphere"
    low = simulable(low) if low else 0.0
    usable = f", about {low:.2g} m/s for usable results" if low else ""
    return (
        f", a lighter sphere or a lower impact.speed (at most {speed:.2g} m/s for this limit alone"
        f"{usable})"
    )


def _heaviness(law: ContactLaw) -> tuple[float, float]:
    """Return sphere mass over mass of the first mode [1], and half its period on the plate [s]."""
    modes = plate_of(law, count_of(law)).modes
    return law.model.m * float(modes.inverse_modal_mass[0]), half_period(law.model.m, modes)


def _steps(
    law: ContactLaw,
    count: int,
    tolerance: float,
    time: float,
    fewer: int = 0,
    work: float = contact_sequence.WORK,
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
        steps, most = each / n, contact_sequence.steps_of(problem, n, work)
    return steps, most
