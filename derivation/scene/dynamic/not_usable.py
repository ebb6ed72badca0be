"""Impacts whose results are all useless, because the plate stretches: few modes are sufficient.

Thin plates are hit many times by a light sphere: such an impact would take up to half a minute.
"""

from collections.abc import Sequence

from derivation.scene.contact_law.corrections import stretching
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.infinite_plate import wave_returned
from derivation.scene.dynamic.mode_convergence import without_estimate
from derivation.scene.dynamic.mode_count import count_of
from derivation.scene.dynamic.runs import with_few_modes
from derivation.scene.dynamic.stretching_error import deflections_of, stretching_error
from derivation.scene.dynamic.time_in_contact import largest_deflection
from derivation.scene.dynamic.wave_motion import DynamicImpact
from derivation.scene.errors import SceneError
from derivation.scene.quantity import NO_DIGITS

EXPECTED = 1.0
"""Expected stiffening by stretching from which the impact is simulated with few modes first [1]."""
CERTAIN = 2.0 * NO_DIGITS
"""Error by stretching with which a result is certainly useless: more modes change the deflection of
the plate by far less than a half [1]."""
PART = 0.25
"""Number of modes over that of the first run of other impacts [1]."""


def not_usable(law: ContactLaw, outputs: Sequence[str]) -> DynamicImpact | None:
    """Return the impact with few modes, without an error bound, if all outputs are useless."""
    if (
        law.stretches
        or law.model.inertia.modes
        or stretching(law.model, largest_deflection(law)) < EXPECTED
    ):
        return None
    try:
        few = with_few_modes(law, PART)
    except SceneError:  # so few modes may make the plate more curved than the sphere
        return None
    if not few.inertia.complete or (law.model.inertia.infinite_plate and wave_returned(few)):
        return None
    errors = stretching_error(law, few, deflections_of(law, few))
    useless = all(errors[name] >= CERTAIN for name in outputs)
    return without_estimate(few) if useless else None


def has_few_modes(motion: DynamicImpact) -> bool:
    """Return whether `not_usable` returned an impact; others have at least twice as many modes."""
    given = motion.law.model.inertia.modes or motion.inertia.slow
    return not given and 2 * motion.inertia.modes < count_of(motion.law)
