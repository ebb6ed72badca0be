"""Warns of contacts so far beyond the onset of yield that the limited pressure is too low.

The plastic zone of a metal spreads, and its pressure rises beyond 1.6 Y to about 3 Y (Johnson
1985). The theory, `derivation.plate.plasticity.theory.fully_plastic`, estimates what that changes
on a half-space, by the contact radius over that at the onset.
"""

from typing import NamedTuple

import numpy as np

from derivation.scene.law import ContactLaw
from derivation.scene.yielding import onset_of
from generated.plasticity_kernels import beyond, risen
from generated.plasticity_numbers import FULLY_PLASTIC, YIELD_LIMIT

WARNED = 1.1
"""Factor of the restitution from which on there is a warning [1]."""


class RisenPressure(NamedTuple):
    """What the risen pressure may multiply, by an estimate that is right to 10 % in that model [1].

    `wide` is the contact radius over that at the onset; `force` and `restitution` are those of an
    impact, indentation and contact time being divided by the first; `stiffness` is the force at a
    given indentation, of a static contact.
    """

    wide: float
    force: float
    restitution: float
    stiffness: float


def risen_pressure(law: ContactLaw, a: float) -> RisenPressure | None:
    """What the risen pressure may change at a contact radius [m]; None where that is little."""
    wide = a / onset_of(law) if law.plastic else 0.0
    if not wide > 1.0:
        return None
    pressure, steep = risen(np.array(wide))
    force, restitution = beyond(pressure, steep)
    found = RisenPressure(wide, float(force), float(restitution), float(pressure * steep))
    return found if found.restitution > WARNED else None


def impact_warnings(law: ContactLaw, a: float) -> tuple[str, ...]:
    """Warn of an impact with a largest contact radius [m] far beyond the onset of yield."""
    found = risen_pressure(law, a)
    if found is None:
        return ()
    text = (
        f"{_why(found.wide)}: the restitution may be about {found.restitution:.2g} and the force "
        f"about {found.force:.2g} times as large, indentation and contact time smaller by the "
        "latter factor (estimated on a half-space)"
    )
    return (text,)


def static_warnings(law: ContactLaw, a: float) -> tuple[str, ...]:
    """Warn of a static contact with a radius [m] far beyond the onset of yield."""
    found = risen_pressure(law, a)
    if found is None:
        return ()
    text = (
        f"{_why(found.wide)}: the force at this local indentation may be about "
        f"{found.stiffness:.2g} times as large"
    )
    return (text,)


def _why(wide: float) -> str:
    return (
        f"the contact radius is {wide:.3g} times that at the onset of yield, where the mean "
        f"pressure of a metal rises towards {FULLY_PLASTIC:g} yield stresses (Johnson 1985) but "
        f"that of the model to {YIELD_LIMIT:g}"
    )
