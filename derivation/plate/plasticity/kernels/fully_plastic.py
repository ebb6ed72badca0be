"""Changes in a fully plastic contact, which are the model error of step 31."""

import sympy as sp

from derivation.engine.emit.routine import Choice, Let, Routine, routine
from derivation.plate.plasticity.theory import fully_plastic as theory
from derivation.plate.plasticity.theory.fully_plastic import pressure, steep, wide

grown, top = sp.symbols("grown top", positive=True)


def risen() -> Routine:
    """Return the mean pressure over that of step 31, and s of an indentation a^2/(s R)."""
    mean, risen_pressure = theory.mean_pressure(), theory.risen_pressure()
    steepness = theory.steepness()
    return routine(
        "risen",
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
        "Return the mean pressure over that with the limit 1.6 Y, and a^2/(R delta).",
        {},
        sp.simplify,
    )


def beyond() -> Routine:
    """Return the resulting changes of an impact."""
    changed = theory.beyond()
    return routine(
        "beyond",
        (pressure, steep),
        (),
        (changed.force, changed.restitution),
        (changed.force, changed.restitution),
        "Return force and restitution on a half-space over those with the limit 1.6 Y.",
        {},
    )


ROUTINES = risen, beyond
