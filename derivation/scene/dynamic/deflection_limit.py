"""Rejects impacts in which stretching would double the stiffness of the plate.

The error of each result by the neglect of stretching is then as large as the result. A heavy sphere
is rejected before the simulation, any other one after its first contact.
"""

import math
from collections.abc import Callable
from dataclasses import replace

from derivation.scene.contact_law.corrections import doubling_deflection
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.contact_errors import rounded_down
from derivation.scene.dynamic.contact_sequence import ENOUGH, ContactRun, ImpactHistory
from derivation.scene.dynamic.mode_count import affordable
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.results import dynamic_impact_of
from derivation.scene.dynamic.stretching_error import FORCE, USABLE
from derivation.scene.dynamic.time_in_contact import IN_CONTACT, heaviness, least_steps
from derivation.scene.errors import SceneError

SPRING, DEFLECTED = 5.0, 0.9
"""Sphere mass over mass of the first mode from which the plate deflects about as a spring, and the
smallest ratio of its deflection to that of the spring: 0.92 to 0.98 in 22 random impacts."""
SLOWER = 0.9
"""Part of the speed in proportion to the deflection that a message proposes."""
Contacts = tuple[ContactRun, ...]


def _is_limited(law: ContactLaw) -> bool:
    """Return whether the deflection is limited: the number of modes is not given, nor the edge."""
    return not (law.model.inertia.modes or law.model.inertia.infinite_plate)


def check_deflected(law: ContactLaw, tolerance: float) -> None:
    """Reject a heavy sphere that deflects the plate too far, before up to a hundred contacts.

    Parameters
    ----------
    tolerance
        Tolerance of the time elements [1], on which it depends whether a slower sphere can be
        simulated.

    Raises
    ------
    SceneError
        If the expected deflection exceeds the limit.
    """
    ratio, swing = heaviness(law)
    deflection = DEFLECTED * law.model.v0 * swing / math.pi
    limit = doubling_deflection(law.model)
    if not _is_limited(law) or ratio <= SPRING or deflection < limit:
        return
    raise _too_deflected(
        law,
        f"at least about {_in_thicknesses(law, deflection)} under a sphere {ratio:.3g} times as "
        "heavy as its first mode",
        f"a thicker or smaller plate{_slower(law, tolerance, limit, swing)}",
    )


def limited(
    law: ContactLaw, problem: DynamicProblem, enough: Callable[[Contacts], bool] | None = None
) -> Callable[[Contacts], bool]:
    """Return `enough` of `impact_history` with a check of the deflection in the first contact.

    Parameters
    ----------
    enough
        A function to be called after the check; without it, all contacts are simulated.

    Raises
    ------
    SceneError
        By the returned function, if the deflection exceeds the limit.
    """

    def checked(contacts: Contacts) -> bool:
        if len(contacts) == 1 and _is_limited(law):
            yielded = replace(problem, yielding=contacts[-1].yielding)
            begun = dynamic_impact_of(law, ImpactHistory(yielded, contacts, ENOUGH))
            _check_first_contact(law, begun.deflection_during(law, 0))
        return enough is not None and enough(contacts)

    return checked


def _check_first_contact(law: ContactLaw, deflection: float) -> None:
    """Reject a largest deflection [m] in the first contact that exceeds the limit."""
    part = doubling_deflection(law.model) / deflection if deflection else math.inf
    if part > 1.0:
        return
    speed = rounded_down(SLOWER * part * law.model.v0)
    raise _too_deflected(
        law,
        f"{_in_thicknesses(law, deflection)} in the first contact",
        f"a thicker plate{_at_most(speed, speed * math.sqrt(USABLE / FORCE))}",
    )


def _too_deflected(law: ContactLaw, got: str, remedy: str) -> SceneError:
    """Return the error of a deflection above the limit."""
    return SceneError(
        f"effects.inertia: expected a deflection of less than {doubling_deflection(law.model):.2g} "
        "m, at which stretching, which the model neglects, doubles the stiffness of the plate, got "
        f"{got}; use {remedy}, or set inertia.modes to simulate a plate that does not stretch"
    )


def _in_thicknesses(law: ContactLaw, deflection: float) -> str:
    """Return a deflection [m] in metres and in thicknesses of the plate."""
    return f"{deflection:.2g} m ({deflection / (2.0 * float(law.model.h)):.2g} thicknesses)"


def _slower(law: ContactLaw, tolerance: float, limit: float, swing: float) -> str:
    """Return a lighter or slower sphere as a remedy, with a speed if one is low enough.

    Parameters
    ----------
    limit
        Deflection [m] at which stretching doubles the stiffness of the plate.
    swing
        Half the period [s] of the sphere on the plate.
    """
    sag = law.model.gravity * (swing / math.pi) ** 2

    def speed_for(deflection: float) -> float:
        """Return the speed [m/s] for a largest deflection [m]; 0 if the weight alone exceeds it."""
        square = deflection * (deflection - 2.0 * DEFLECTED * sag)
        return math.sqrt(max(0.0, square)) * math.pi / (DEFLECTED * swing)

    speed = rounded_down(speed_for(limit))
    if speed:
        slow = replace(law, model=replace(law.model, v0=speed))
        steps, most = least_steps(slow, 2 * affordable(slow), tolerance, IN_CONTACT * swing)
        speed = speed if steps <= most else 0.0
    return _at_most(speed, speed_for(limit * math.sqrt(USABLE / FORCE)))  # of later contacts


def _at_most(speed: float, usable: float) -> str:
    """Return a lighter sphere or these speeds [m/s] as a remedy; 0 if there is none."""
    if not speed:
        return " or a lighter sphere"
    low = rounded_down(usable)
    results = f" (about {low:.2g} m/s for usable results)" if low else ""
    return f", a lighter sphere or an impact.speed of at most {speed:.2g} m/s{results}"
