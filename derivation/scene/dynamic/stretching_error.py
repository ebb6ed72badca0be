"""Model error of impacts by stretching of the plate: by its neglect, or what remains with it.

The estimates are multiples of the relative stiffening S = A (w/H)^2 under a static load. They are
not proved: their factors were chosen so that they cover the differences between a linear and a
von Karman plate in 2228 simulated impacts of one to 170 contacts, with w/H from 0.04 to 7 and three
edges, apart from jumps of the contact time. 659 of the impacts are elastic without damping, 599
plastic, 548 viscoelastic; in 222 the plate is damped, and in 200 damping is combined with a plastic
or viscoelastic contact. The tests repeat a few of them.

Since then the condition of the paper's edge in its plane has changed, and A with it. 136 random
elastic impacts on that edge, about half of them damped, changed by at most 0.6 of the estimates,
apart from one jump with its warning.
"""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from derivation.scene.contact_law.corrections import membrane_stress, stretching
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.time_element import A, P
from derivation.scene.quantity import percent
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.dynamic.wave_motion import DynamicImpact

TIME, PEAK = 1.0, 2.0
"""Relative changes over S of the first contact's duration, and of force and contact radius at any
time in the first contact, with the deflection up to then."""
DEPTH, FORCE, RADIUS, SPEED = 1.0, 12.0, 4.0, 2.0
"""The same with the largest deflection up to the last contact: of the indentation, and of force and
contact radius in later contacts; and the change of the restitution itself."""
END, DIP = 0.5, 6.0
"""Force over the largest force and over S below which the first contact may end, and the same of a
minimum of the force. On a light plate the force decreases long before it vanishes: durations
changed by up to 6 S, and by 41 S after a minimum of 4.1 S."""
USABLE = 0.1
"""Error by stretching for which a message recommends a speed or a thickness [1]."""
SMALL = 0.02
"""Error by omitted modes over that by stretching, below which more modes are not useful."""
SMALLEST, MARGIN = 7e-4, 2.5
"""Stiffening during the first contact from which a warning says that it may split this contact, or
join it with the next one: half of the smallest one that did; and the same over the change that
splits or joins it: the smallest one that did was 1/1.9 of it."""


ROTATION, IN_PLANE = 2.5, 10.0
"""Relative error of all forces of a plate that stretches over the mean square of its slope, and of
the forces of stretching over H/(c_p T) with the speed c_p of pressure waves in the plane and the
duration T of the first contact.

Large rotations were simulated with two measures of strain in 85 random impacts of one to 20
contacts: mean squares of the slope from 6e-5 to 0.08, deflections of 0.3 to 6.7 thicknesses, three
edges, Poisson's ratios from -0.5 to 0.48. Restitution and largest values changed by at most 0.4 of
the errors by the former, except for the force of a later contact in three impacts of 9 to 19
contacts: it changed by less than 0.5 %, up to 0.7 of its error. An earlier version stated the
square of the slope times the stiffening, as if bending had no rotations; 31 of these impacts
changed by more, up to 36 times as much.

In 300 random impacts of spheres of 0.01 to 2 times the mass of the first mode, some on damped
plates, force, radius and restitution changed by at most 0.35 of their errors, and the indentation
by 0.15, in one of them by 0.7. An earlier version decreased the errors in the first contact as the
square of the deflection so far. But waves are steeper than the plate is at its largest deflection:
in 16 of these impacts the largest force, an early one, changed by more, up to 4.6 times as much.

In 46 random impacts on von Karman plates whose middle plane has inertia, restitution and largest
values changed by at most 0.4 of the errors by the latter, for stiffenings from 1e-4 to 1."""


class Deflections(NamedTuple):
    """Deflections of the plate at the axis [m].

    Attributes
    ----------
    largest
        The largest one up to the last separation.
    so_far
        The largest one up to each time of the first contact, as many times as in its history; empty
        on a quasi-static plate.
    """

    largest: float
    so_far: Array

    def times(self, factor: float) -> "Deflections":
        """Return the deflections times a factor [1], about those of a faster or slower sphere."""
        return Deflections(factor * self.largest, factor * self.so_far)


def deflections_of(law: ContactLaw, motion: "DynamicImpact") -> Deflections:
    """Return the deflections of a plate with inertia."""
    return Deflections(motion.deflection_before_separation(law), motion.deflections_so_far(law, 0))


def stretching_error(
    law: ContactLaw, motion: "DynamicImpact", deflections: Deflections
) -> dict[str, float]:
    """Return the relative error of each result by the neglect of stretching.

    If the plate stretches, the error of its forces remains.

    Later contacts, and with them the restitution, depend on the phase of the plate's vibration, and
    change more. If the first contact splits or joins the next one, its duration may change by more,
    see `jump_warnings`.
    """
    size = float(stretching(law.model, deflections.largest))
    sizes = np.asarray(stretching(law.model, deflections.so_far), dtype=np.float64)
    if law.stretches:
        remains = force_error(law, motion, deflections)
        size = remains.rotation + remains.in_plane * min(1.0, size)
        sizes = remains.so_far + remains.in_plane * np.minimum(1.0, sizes)
    rebound = abs(motion.restitution) if motion.inertia.complete else 1.0  # else unknown
    return {
        "contact_time": max(TIME * float(sizes[-1]), earlier_end(motion.histories[0][P], sizes)),
        "max_indentation": DEPTH * size,
        "max_force": _higher([rows[P] for rows in motion.histories], sizes, FORCE * size),
        "max_contact_radius": _higher([rows[A] for rows in motion.histories], sizes, RADIUS * size),
        "restitution": SPEED * size / max(rebound, 1e-6),
    }


class ForceError(NamedTuple):
    """Relative errors of the forces on a plate that stretches.

    Attributes
    ----------
    rotation
        That of all forces at the largest deflection: the angle of a steep plate is not its slope.
    so_far
        The same up to each time of the first contact. Waves are steeper than the whole plate is
        at the same deflection.
    in_plane
        That of the forces of stretching: the middle plane has inertia.
    """

    rotation: float
    so_far: Array
    in_plane: float


def force_error(law: ContactLaw, motion: "DynamicImpact", deflections: Deflections) -> ForceError:
    """Return the relative errors of forces by what the model of stretching neglects."""
    model, steep = law.model, motion.steepness
    part = deflections.largest / steep.deflection
    fastest = math.sqrt(model.modulus / model.density)
    transit = 2.0 * float(model.h) / (fastest * motion.contact_time)
    factor = ROTATION * part * part
    return ForceError(factor * steep.largest, factor * steep.so_far, IN_PLANE * transit)


def exceeds_modes(law: ContactLaw, motion: "DynamicImpact", outputs: Sequence[str]) -> bool:
    """Return whether stretching changes each of some outputs much more than the omitted modes."""
    inertia = motion.inertia
    if law.stretches:
        return False
    # This is nearly the error of the indentation, without evaluating the deflection over time.
    rough = DEPTH * float(stretching(law.model, motion.max_indentation))
    if inertia.recounted or inertia.error_of_modes("max_indentation") > SMALL * rough:
        return False
    errors = stretching_error(law, motion, deflections_of(law, motion))
    return all(inertia.error_of_modes(name) <= SMALL * errors[name] for name in outputs)


def stress_change(law: ContactLaw, motion: "DynamicImpact") -> float:
    """Return the relative change of the largest tensile stress on the back face by stretching.

    It is the tension of the middle plane, and the stiffening in the first or `FORCE` times that in
    later contacts. It was at least twice the change in 360 random elastic impacts (three edges,
    deflections of 0.03 to 4 thicknesses, Poisson's ratios of 0.05 to 0.45).
    """
    deflection = motion.deflection_before_separation(law)
    size = float(stretching(law.model, deflection))
    factor = 1.0 if len(motion.histories) == 1 else FORCE
    if law.stretches:
        remains = force_error(law, motion, deflections_of(law, motion))
        return factor * remains.rotation + remains.in_plane * min(1.0, FORCE * size)
    return float(membrane_stress(law.model, deflection)) + factor * size


def earlier_end(force: Array, sizes: Array) -> float:
    """Return the fraction of the first contact from which on it may end, after its largest force.

    A force that rises again after a minimum is due to waves that return, as in a later contact.
    """
    peak = int(np.argmax(force))
    after, size = force[peak:] / force[peak], sizes[peak:]
    may_end = after <= END * size
    dips = (after[1:-1] < after[:-2]) & (after[1:-1] <= after[2:])
    may_end[1:-1] |= dips & (after[1:-1] <= DIP * size[1:-1])
    may_end[-1] = True
    return 1.0 - (peak + int(np.argmax(may_end))) / (force.size - 1)


def _higher(histories: list[Array], sizes: Array, later: float) -> float:
    """Return the largest possible increase of the largest value of the contacts, over this value.

    A value that is smaller in the linear motion may become the largest one.

    Parameters
    ----------
    histories
        The value over time in each contact.
    sizes
        The stiffening in the first contact, up to each time.
    later
        Relative change of the largest values in later contacts.
    """
    first, *others = histories
    highest = max((float(np.max(history)) for history in others), default=0.0)
    increased = max(float(np.max(first * (1.0 + PEAK * sizes))), highest * (1.0 + later))
    return increased / max(float(np.max(first)), highest) - 1.0


def jump_warnings(law: ContactLaw, motion: "DynamicImpact") -> tuple[str, ...]:
    """Warn if neglected stretching may split the first contact, or join it with the next one."""
    if law.stretches:
        return ()
    first = float(stretching(law.model, motion.deflection_during(law, 0)))
    if first < max(SMALLEST, motion.decisive_change / MARGIN):
        return ()
    text = (
        f"stretching makes the plate stiffer by {percent(first)} during the first contact, which "
        "may split this contact or join it with the next one: contact_time may change by a jump"
    )
    return (text,)
