"""Decides whether the results of an impact require that the plate stretches, with few modes."""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

from derivation.scene.contact_law.corrections import stretching
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.not_usable import EXPECTED, PART
from derivation.scene.dynamic.runs import with_few_modes
from derivation.scene.dynamic.stretching_error import (
    FORCE,
    deflections_of,
    stress_change,
    stretching_error,
)
from derivation.scene.dynamic.time_in_contact import (
    deflects_too_far,
    largest_deflection,
    static_deflection,
)
from derivation.scene.effects import EFFECTS
from derivation.scene.errors import SceneError
from derivation.scene.quantity import ONE_DIGIT

NEEDED = ONE_DIGIT
"""Model error by the neglect of stretching from which it is included: one digit would be left."""
BETTER = 0.5
"""Largest remaining model error over that by the neglect for which stretching is included [1]. The
remaining error is estimated without a plate that stretches: in 325 random scenes with an error of
at least `NEEDED`, the decision was that of a simulation with stretching in all but four."""
MOST = 1.5e6
"""Largest work of the simulation with few modes, about one second. In 240 random impacts on thin
plates the decision was that without this limit."""
SMALL = NEEDED / FORCE / 20.0
"""Rough estimate of the stiffening below which no impact is simulated for this decision [1]. The
stiffening was at most 20 times this estimate in 212 random impacts (47 with weight), and at most
3.3 times in nine of ten."""


@lru_cache(maxsize=64)
def needs_stretching(law: ContactLaw, outputs: Sequence[str], stress: bool = False) -> bool:
    """Return whether a result is much more accurate if the plate stretches.

    Parameters
    ----------
    law
        The law of an impact on a plate that does not stretch.
    outputs
        The results that count.
    stress
        Whether the largest tensile stress on the back face counts, too.
    """
    if not law.dynamic or law.model.inertia.infinite_plate:
        return False
    try:
        deflection = largest_deflection(law) + 2.0 * static_deflection(law)  # by a sudden weight
        rough = float(stretching(law.model, deflection))
        if rough < SMALL:
            return False
        if deflects_too_far(law):
            return True
    except SceneError:  # the simulation states why the plate has no modes
        return False
    try:
        motion = with_few_modes(law, PART, MOST)
    except SceneError:
        return rough >= EXPECTED
    deflections = deflections_of(law, motion)
    without = [stretching_error(law, motion, deflections)[name] for name in outputs]
    size = float(stretching(law.model, deflections.largest))
    part = math.sqrt(2.0 / (1.0 + math.sqrt(1.0 + 2.0 * size)))  # of a stiffening spring
    other = stretched(law)
    errors = stretching_error(other, motion, deflections.times(part))
    remaining = [errors[name] for name in outputs]
    if stress:
        without.append(stress_change(law, motion))
        remaining.append(stress_change(other, motion))
    return any(
        error >= NEEDED and left <= BETTER * error
        for error, left in zip(without, remaining, strict=True)
    )


def stretched(law: ContactLaw) -> ContactLaw:
    """Return the law of the same plate that stretches."""
    inertia = replace(law.model.inertia, stretching=True)
    effects = law.effects | {effect.name for effect in EFFECTS if effect.stretches}
    return ContactLaw(replace(law.model, inertia=inertia), effects)
