"""Changes in a fully plastic contact, which are the model error of step 31."""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Choice, Let
from derivation.plate.plasticity.theory import fully_plastic as theory
from derivation.plate.plasticity.theory.fully_plastic import pressure, steep, wide

grown, top = sp.symbols("grown top", positive=True)


@named_routine
def risen() -> Claims:
    """Return the mean pressure over that with the limit 1.6 Y, and a^2/(R delta)."""
    mean, risen_pressure = theory.mean_pressure(), theory.risen_pressure()
    steepness = theory.steepness()
    return Claims(
        (wide,),
        (
            Let(grown, risen_pressure),
            Choice(
                top,
                grown < theory.FULLY_PLASTIC,
                grown,
                theory.FULLY_PLASTIC,
                unclaimed="no",
                reason="the contact is fully plastic, and its pressure is constant",
            ),
        ),
        (top / mean, steepness.subs(pressure, top)),
        (risen_pressure / mean, steepness.subs(pressure, risen_pressure)),
        {},
        sp.simplify,
    )


@named_routine
def beyond() -> Claims:
    """Return force and restitution on a half-space over those with the limit 1.6 Y."""
    changed = theory.beyond()
    return Claims(
        (pressure, steep),
        (),
        (changed.force, changed.restitution),
        (changed.force, changed.restitution),
        {},
    )


ROUTINES = risen, beyond
