"""States which results are not usable because of their model error, and how to make them usable."""

import math
from typing import TYPE_CHECKING

import numpy as np

from derivation.scene.contact_law.limits import local_indentation
from derivation.scene.dynamic.stretching_error import USABLE, Deflections, deflections_of
from derivation.scene.dynamic.unlike_bodies import unlike_bodies_errors
from derivation.scene.model_errors import model_errors
from derivation.scene.quantity import NO_DIGITS, percent, prefixed, up_to
from derivation.scene.scene import OUTPUTS
from derivation.scene.selection.method_selection import growth_of

if TYPE_CHECKING:
    from derivation.scene.result import Result

SMALLEST, STEPS = 1e-5, 30
"""Smallest part of the deflection that a message considers, and number of bisections for it."""
THICKER = 2.5
"""Power of the thickness by which the deflection over it decreases: w = v0 sqrt(m/k) under a heavy
sphere, on a plate of stiffness k ~ H^3. Under a light sphere it decreases faster, as H^-3."""


def unusable(result: "Result") -> tuple[str, ...]:
    """Return the names of the results whose own model error is as large as the result."""
    errors: dict[str, float] = {name: result.model_errors[name] for name in OUTPUTS}
    errors["max_pressure"] = errors["max_contact_radius"]
    if math.isfinite(result.max_tensile_stress):
        errors["max_tensile_stress"] = result.tensile_stress.error
    return tuple(name for name, error in errors.items() if error >= NO_DIGITS)


def in_words(result: "Result") -> str:
    """Return which results are not usable, why, and how to make them usable.

    Empty if all are usable, or not because of other errors than those by stretching of the plate
    and by different retardation times of sphere and plate.
    """
    names = unusable(result)
    if not names:
        return ""
    why = _by_retardation(result) or _by_stretching(result)
    listed = ", ".join(name.replace("_", " ") for name in names)
    return f"NOT USABLE: {listed}. {why}" if why else ""


def _by_retardation(result: "Result") -> str:
    """Return the remedy if different retardation times make all results useless."""
    model, motion = result.model, result.dynamics
    by_time = unlike_bodies_errors(
        result.effects.law, result.contact_time, motion, growth_of(motion)
    )
    error = max(by_time.values())
    if error < NO_DIGITS:
        return ""
    why = (
        "The retardation times of sphere and plate differ so much that the model, which combines "
        f"them, has a model error of {percent(error)}."
    )
    # The softer body alone, with the same retardation time of the contact.
    softer = "sphere" if model.softness > 1.0 else "plate"
    compliance = max(model.softness, 1.0) / (1.0 + model.softness)
    alone = model.retardation_time / compliance
    spread = alone * math.sqrt(compliance * (1.0 - compliance))
    if error * (spread / model.retardation_spread) ** 2 < NO_DIGITS:
        time, unit = prefixed(alone, "s", 4)
        return (
            f"{why} If the {softer}, the softer body, causes the loss, give it alone "
            f"{softer}.retardation_time, for example {time} {unit} for the same contact."
        )
    time, unit = prefixed(model.retardation_time, "s", 4)
    return (
        f"{why} If both bodies cause the loss, give both the same retardation_time, {time} {unit} "
        "for the same contact."
    )


def _by_stretching(result: "Result") -> str:
    """Return the remedies if stretching of the plate makes results useless."""
    model, deflections = result.model, _deflections(result)
    least = _errors(result, deflections.times(SMALLEST))
    by_it = {name: result.model_errors[name] - least[name] for name in OUTPUTS}
    parts = {
        name: _part(result, deflections, name, least[name] + USABLE)
        for name, error in by_it.items()
        if error >= NO_DIGITS
    }
    if not parts:
        return ""
    thickness, remedies = 2.0 * float(model.h), []
    for name, part in sorted(parts.items(), key=lambda item: -item[1]):
        speed = " ".join(prefixed(model.v0 * part, "m/s", 2))
        thicker = " ".join(prefixed(thickness * part ** (-1.0 / THICKER), "m", 2))
        remedies.append(f"{name.replace('_', ' ')} {speed} or {thicker}")
    times, worst = deflections.largest / thickness, max(by_it.values())
    return (
        f"The plate deflects by {times:.2g} thicknesses and stretches, which the model neglects "
        f"(error {up_to(worst)}). Speed or thickness for an error of about "
        f"{percent(USABLE)}: {', '.join(remedies)}."
    )


def _errors(result: "Result", deflections: Deflections) -> dict[str, float]:
    """Return the model errors of an impact with other deflections."""
    numbers = (
        result.contact_time, result.max_indentation, result.max_force, result.max_contact_radius,
        result.restitution,
    )  # fmt: skip
    return model_errors(result.effects.law, numbers, deflections, result.dynamics)


def _deflections(result: "Result") -> Deflections:
    """Return the deflections that the model errors refer to."""
    law = result.effects.law
    if result.dynamics is not None:
        return deflections_of(law, result.dynamics)
    local = float(local_indentation(law, result.max_contact_radius))
    return Deflections(result.max_indentation - local, np.zeros(0))


def _part(result: "Result", deflections: Deflections, name: str, most: float) -> float:
    """Return the largest part of the deflection with which an error is at most `most` [1]."""
    low, high = math.log(SMALLEST), 0.0
    for _ in range(STEPS):
        middle = 0.5 * (low + high)
        enough = _errors(result, deflections.times(math.exp(middle)))[name] <= most
        low, high = (middle, high) if enough else (low, middle)
    return math.exp(low)
