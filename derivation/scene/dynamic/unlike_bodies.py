"""Model error of viscoelastic contacts whose bodies have different retardation times.

The law has the mean of both times, weighted with the compliances. The factors below are not proved:
they cover impacts in which each body has its own time, simulated with and without vibration of the
plate by another program.
"""

from typing import TYPE_CHECKING

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects.effect import Results
from derivation.scene.effects.viscosity import later_end, unlike_bodies_error
from derivation.scene.quantity import percent
from derivation.scene.scene import OUTPUTS

if TYPE_CHECKING:
    from derivation.scene.dynamic.wave_motion import DynamicImpact

VIBRATING = 5 / 3
"""Increase of the changes of a single contact by vibration of the plate: at most 1.4 in 517 random
impacts."""
LATER = 3.0
"""Changes of the results of an impact with several contacts over the change of the first one's
duration, without the growth by the time between contacts: at most 2.5 in 165 random impacts of 2 to
24 contacts."""


def unlike_bodies_errors(
    law: ContactLaw, contact_time: float, motion: "DynamicImpact | None", growth: Results
) -> dict[str, float]:
    """Return the estimated relative model error of each output [1].

    Parameters
    ----------
    contact_time
        Duration of the first contact [s].
    motion
        The impact, if the plate has inertia.
    growth
        Growth of a change of each output by the time between contacts [1].
    """
    size = unlike_bodies_error(law.model) if law.viscous else 0.0
    end = size + later_end(law.model, contact_time) if size else 0.0
    if motion is not None:
        size *= VIBRATING
    errors: dict[str, float] = dict.fromkeys(OUTPUTS, size)
    if motion is not None and len(motion.inertia.contacts) > 1:
        pairs = zip(OUTPUTS, growth, strict=True)
        errors = {name: max(size, LATER * end * factor) for name, factor in pairs}
    return errors | {"contact_time": max(size, end)}


def unlike_jump_warnings(law: ContactLaw, motion: "DynamicImpact") -> tuple[str, ...]:
    """Warn if the different retardation times may split the first contact, or join the next one."""
    contact_time = motion.numbers[0]
    change = unlike_bodies_errors(law, contact_time, motion, 5 * (1.0,))["contact_time"]
    if not change or change < motion.decisive_change:
        return ()
    text = (
        f"the different retardation times of sphere and plate change the first contact by "
        f"{percent(change)}, which may split it or join it with the next one: contact_time may "
        "change by a jump"
    )
    return (text,)
