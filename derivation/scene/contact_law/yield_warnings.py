"""Warnings for contacts far beyond the onset of yield, where the model pressure is too low.

As the plastic zone of a ductile solid spreads, the mean pressure rises beyond 1.6 Y to about 3 Y
(Johnson 1985). `derivation.plate.plasticity.theory.fully_plastic` estimates the effect on a
half-space from the contact radius over that at the onset of yield.
"""

import math
from typing import NamedTuple

import numpy as np

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.yielding import onset_of
from derivation.scene.input.body_materials import body_of, own_materials
from derivation.scene.input.settings import BODIES
from derivation.scene.quantity import ROUNDED, prefixed, upwards
from derivation.scene.scene import Scene
from generated.arrays import Double as Array
from generated.plasticity_kernels import beyond, risen
from generated.plasticity_numbers import FULLY_PLASTIC, YIELD_LIMIT

WARNED = 1.1
"""Factor of the restitution above which a warning is given [1]."""


class RisenPressure(NamedTuple):
    """Estimated factors by which a fully plastic pressure changes the results [1].

    Attributes
    ----------
    wide
        Contact radius over that at the onset of yield.
    force, restitution
        Factors of peak force and restitution of an impact; indentation and contact time are divided
        by that of the force.
    stiffness
        Factor of the force of a static contact at a given indentation.
    """

    wide: float
    force: float
    restitution: float
    stiffness: float


def risen_pressure(law: ContactLaw, a: float) -> RisenPressure | None:
    """Return the estimated factors at a contact radius [m]; None if they are small."""
    return risen_at(a / onset_of(law)) if law.plastic else None


def risen_at(wide: float) -> RisenPressure | None:
    """Return the estimated factors at a contact radius over that at the onset of yield."""
    if not wide > 1.0:
        return None
    pressure, steep = risen(np.array(wide))
    force, restitution = beyond(pressure, steep)
    rise = RisenPressure(wide, float(force), float(restitution), float(pressure * steep))
    return rise if rise.restitution > WARNED else None


def risen_restitution(wide: Array) -> Array:
    """Return the estimated factors of the restitution at `RisenPressure.wide` of at least 1."""
    return beyond(*risen(wide))[1]


def impact_warnings(wide: float) -> tuple[str, ...]:
    """Return a warning if the contact radius of an impact is far beyond that at the onset of yield.

    `wide` is their ratio.
    """
    rise = risen_at(wide)
    if rise is None:
        return ()
    text = (
        f"{_reason(rise.wide)}, restitution and force may be larger by factors of about "
        f"{rise.restitution:.2g} and {rise.force:.2g}; indentation and contact time may be "
        f"smaller by a factor of about {rise.force:.2g} (estimated on a half-space)"
    )
    return (text,)


def static_warnings(law: ContactLaw, a: float) -> tuple[str, ...]:
    """Return a warning if the radius [m] of a static contact is far beyond the onset of yield."""
    rise = risen_pressure(law, a)
    if rise is None:
        return ()
    text = (
        f"{_reason(rise.wide)}, the force at this local indentation may be larger by a factor of "
        f"about {rise.stiffness:.2g}"
    )
    return (text,)


def assumed_yield_stress(scene: Scene, pressure: float, bending: float) -> str:
    """Return which yield stress the results assume of bodies without one; empty if there is none.

    Parameters
    ----------
    pressure
        Largest contact pressure [Pa].
    bending
        Largest tensile stress on the back face of the plate [Pa].
    """
    own, contact = own_materials(scene.materials), pressure / YIELD_LIMIT
    bodies = {"sphere": body_of(scene.sphere, own), "plate": body_of(scene.plate, own)}
    if scene.measured is not None and scene.measured.solve_for == "yield_stress":
        for determined in BODIES[scene.measured.body]:
            del bodies[determined]
    assumed = {
        name: max(contact, bending) if name == "plate" else contact
        for name, body in bodies.items()
        if math.isinf(body.yield_stress) and math.isfinite(body.mu)
    }
    if not assumed:
        return ""
    stresses = {
        name: " ".join(prefixed(upwards((1.0 - ROUNDED) * x, 3), "Pa", 3))
        for name, x in assumed.items()
    }
    bent = ", in bending" if bending > contact else ""
    least = " and ".join(
        f"{x} ({name}{bent if name == 'plate' else ''})" for name, x in stresses.items()
    )
    if len(set(stresses.values())) == 1:
        least = next(iter(stresses.values()))
    named = " and ".join(f"the {name}" for name in assumed)
    return f"no yield stress is given for {named}; the results assume at least {least}"


def _reason(wide: float) -> str:
    return (
        f"the contact radius is {wide:.3g} times that at the onset of yield; in the model the "
        f"pressure is limited to {YIELD_LIMIT:g} times the yield stress, but in a ductile solid, "
        f"such as most metals, the mean pressure then rises towards {FULLY_PLASTIC:g} times this "
        "stress (Johnson 1985), and a brittle solid, such as ice, glass or a ceramic, cracks. If "
        "the solid is ductile"
    )
