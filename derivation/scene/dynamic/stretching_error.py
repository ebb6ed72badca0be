"""Model error of impacts by stretching of the plate, which the linear modes neglect.

The estimates are multiples of the relative stiffening S = A (w/H)^2 under a static load. They are
not proved: their factors were chosen so that they cover the differences between a linear and a
von Karman plate in 460 simulated impacts of one to 150 contacts, with w/H from 0.05 to 7 and three
edges, apart from jumps of the contact time. The tests repeat a few such impacts.
"""

from typing import TYPE_CHECKING

from derivation.scene.contact_law.corrections import stretching
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.quantity import percent

if TYPE_CHECKING:
    from derivation.scene.dynamic.wave_motion import DynamicImpact

TIME, PEAK = 1.0, 2.0
"""Relative changes over S of the first contact's duration, and of force and contact radius that are
largest in the first contact, with the deflection up to then."""
DEPTH, FORCE, RADIUS, SPEED = 1.0, 12.0, 4.0, 2.0
"""The same with the largest deflection up to the last contact: of the indentation, and of force and
contact radius that are largest in a later contact; and the change of the restitution itself."""
SMALLEST = 0.005
"""Stiffening during the first contact from which a warning says that it may split this contact:
half of the smallest one that did."""


def stretching_error(law: ContactLaw, motion: "DynamicImpact") -> dict[str, float]:
    """Return the relative error of each result by the neglect of stretching.

    Later contacts, and with them the restitution, depend on the phase of the plate's vibration, and
    change more. If the first contact splits or joins the next one, its duration may change by more,
    see `jump_warnings`.
    """
    model, contacts = law.model, motion.inertia.contacts
    size, first, begun = (
        float(stretching(model, w))
        for w in (
            motion.deflection_before_separation(law),
            motion.deflection_during(law, 0),
            motion.deflection_during(law, 0, to_peak=True),
        )
    )
    rebound = abs(motion.restitution) if motion.inertia.complete else 1.0  # else unknown
    later = max((one.peak_force for one in contacts[1:]), default=0.0) >= contacts[0].peak_force
    return {
        "contact_time": TIME * first,
        "max_indentation": DEPTH * size,
        "max_force": FORCE * size if later else PEAK * begun,
        "max_contact_radius": RADIUS * size if later else PEAK * begun,
        "restitution": SPEED * size / max(rebound, 1e-6),
    }


def jump_warnings(law: ContactLaw, motion: "DynamicImpact") -> tuple[str, ...]:
    """Warn if stretching may split the first contact, or join it with the next one."""
    first = float(stretching(law.model, motion.deflection_during(law, 0)))
    if first < max(SMALLEST, motion.decisive_change):
        return ()
    text = (
        f"stretching makes the plate stiffer by {percent(first)} during the first contact, which "
        "may split this contact or join it with the next one: contact_time may change by a jump"
    )
    return (text,)
