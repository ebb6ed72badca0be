"""States which results are not usable because of their model error, and how to make them usable."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from derivation.scene.contact_law.corrections import stretching
from derivation.scene.dynamic.stretching_error import USABLE, Deflections
from derivation.scene.effects.effect import Results
from derivation.scene.output.error_causes import (
    SMALLEST,
    deflections_of_result,
    errors_of,
    retardation_errors,
    sphere_errors,
)
from derivation.scene.quantity import NO_DIGITS, percent, prefixed, up_to
from derivation.scene.scene import OUTPUTS
from derivation.scene.selection.effect_selection import NO_GROWTH
from derivation.scene.selection.method_selection import growth_of

if TYPE_CHECKING:
    from derivation.scene.result import Result

STEPS = 30
"""Number of bisections for the part of a deflection or a contact radius."""
GROWN = 2.0
"""Growth of the errors by vibration of the plate above which two speeds are named: a slower sphere
may be met again or not [1]."""
THICKER = 2.5
"""Power of the thickness by which the deflection over it decreases: w = v0 sqrt(m/k) under a heavy
sphere, on a plate of stiffness k ~ H^3. Under a light sphere it decreases faster, as H^-3. On a
plate that stretches, the error depends on the slope and not on the deflection over the thickness,
and stretching limits the deflection, see `_thicker`."""


def unusable(result: "Result") -> tuple[str, ...]:
    """Return the names of the results whose own model error is as large as the result."""
    errors = dict(result.model_errors)
    if math.isfinite(result.max_tensile_stress):
        errors["max_tensile_stress"] = result.tensile_stress.error
    return tuple(name for name, error in errors.items() if error >= NO_DIGITS)


def in_words(result: "Result") -> str:
    """Return which results are not usable, why, and how to make them usable.

    Empty if all are usable. The causes are different retardation times of both bodies or, without
    them, stretching of the plate, and finite size of the sphere together with strains, if they are
    large enough alone.
    """
    names = unusable(result)
    if not names:
        return ""
    why = _by_retardation(result) or f"{_by_stretching(result)} {_by_sphere(result)}".strip()
    listed = ", ".join(name.replace("_", " ") for name in names)
    if why and result.dynamics is not None:
        from derivation.scene.dynamic.not_usable import has_few_modes

        few = has_few_modes(result.dynamics)
        why += " As no result is usable, few plate modes are simulated." if few else ""
    return f"NOT USABLE: {listed}. {why}" if why else ""


def _by_retardation(result: "Result") -> str:
    """Return the remedy if different retardation times make all results useless."""
    model = result.model
    error = max(retardation_errors(result).values())
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
    one_body = error * (spread / model.retardation_spread) ** 2 < NO_DIGITS
    measured = result.scene.measured
    if measured is not None and measured.solve_for == "retardation_time":
        body = softer if one_body else "both"
        whose = f"the {softer}, the softer body, causes" if one_body else "both bodies cause"
        return f'{why} If {whose} the loss, set measured.body = "{body}".'
    if one_body:
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
    model, deflections = result.model, deflections_of_result(result)
    least = errors_of(result, deflections.times(SMALLEST))
    by_it = {name: result.model_errors[name] - least[name] for name in OUTPUTS}
    parts = {
        name: _part(result, deflections, name, least[name] + USABLE)
        for name, error in by_it.items()
        if error >= NO_DIGITS
    }
    if not parts:
        return ""
    thickness, remedies, slow = 2.0 * float(model.h), [], False
    weight, size = model.m * model.gravity / result.max_force, 0.0
    if result.effects.law.stretches:
        size = float(stretching(model, deflections.largest))
    for name, part in sorted(parts.items(), key=lambda item: -item[1]):
        thicker = _thicker(part, size) if size else part ** (-1.0 / THICKER)
        either = " ".join(prefixed(thickness * thicker, "m", 2))
        if slower := _slower(part, weight, size):
            speed, slow = " ".join(prefixed(model.v0 * slower, "m/s", 2)), True
            either = f"{speed} or {either}"
        remedies.append(f"{name.replace('_', ' ')} {either}")
    times, worst = deflections.largest / thickness, max(by_it.values())
    return (
        f"The plate deflects by {times:.2g} thicknesses{_neglected(result)} (error "
        f"{up_to(worst)}). "
        f"{'Speed or thickness' if slow else 'Thickness'} at which this error is about "
        f"{percent(USABLE)}: {', '.join(remedies)}."
    )


def _neglected(result: "Result") -> str:
    """Return what the model neglects of the large deflection, in words."""
    law = result.effects.law
    if law.stretches:
        return ", for which the model of its stretching is too simple"
    if not law.dynamic:
        return " and stretches, which the model without inertia of the plate neglects"
    if law.model.inertia.infinite_plate:
        return " and stretches, which the model of an infinite plate neglects"
    return " and stretches, which the model neglects without effects.stretching = true"


def _slower(part: float, weight: float, size: float = 0.0) -> float:
    """Return the part of the speed at which a plate deflects by a part of its deflection [1].

    It is 0 if the weight alone deflects it more. Under a sphere of weight mg a spring of stiffness
    k (1 + S) deflects by w with w^2 (1 + S/2) - 2 w mg/k = (v0^2 m)/k, S being proportional to w^2.

    Parameters
    ----------
    weight
        Weight of the sphere over the largest force [1].
    size
        The relative stiffening S by stretching, 0 if the plate does not stretch [1].
    """

    def square(part: float) -> float:
        energy = part * part * (1.0 + 0.5 * part * part * size)
        return energy - 2.0 * part * weight * (1.0 + size)

    slow = square(part)
    return math.sqrt(slow / square(1.0)) if slow > 0.0 else 0.0


def _thicker(part: float, size: float) -> float:
    """Return the factor of the thickness with which a stretching plate deflects by a part [1].

    A heavy sphere has the energy k w^2 (1 + S/2)/2, with k ~ H^3 and S ~ (w/H)^2.

    Parameters
    ----------
    size
        The relative stiffening S by stretching [1].
    """
    square = part * part

    def deflects_less(thinner: float) -> bool:
        stiffer = thinner**-3 + 0.5 * size * square / thinner
        return square * stiffer >= 1.0 + 0.5 * size

    return 1.0 / _largest(deflects_less)


def _by_sphere(result: "Result") -> str:
    """Return the remedy if the finite size of the sphere and strains make results useless."""
    error = max(sphere_errors(result).values())
    if error < NO_DIGITS:
        return ""
    assumes = "takes strains as infinitely small"
    if result.effects.law.softness:
        assumes = f"treats the sphere as a half-space and {assumes}"
    speed = _speed_of_sphere(result, growth_of(result.dynamics))
    if max(growth_of(result.dynamics)) > GROWN:
        once = _speed_of_sphere(result, NO_GROWTH)
        speed = f"{once} if the plate does not meet the sphere again, otherwise {speed}"
    return (
        f"The contact radius is {result.max_contact_radius / float(result.model.R):.2g} of the "
        f"sphere's radius, and the model {assumes} "
        f"(error {up_to(error)}). Speed at which this error is about {percent(USABLE)}: {speed}."
    )


def _speed_of_sphere(result: "Result", growth: Results) -> str:
    """Return the speed at which these errors are small enough."""
    part = _largest(lambda part: max(sphere_errors(result, part, growth).values()) <= USABLE)
    # In a Hertzian contact the radius is proportional to the power 2/5 of the speed.
    return " ".join(prefixed(result.model.v0 * part**2.5, "m/s", 2))


def _part(result: "Result", deflections: Deflections, name: str, most: float) -> float:
    """Return the largest part of the deflection with which an error is at most `most` [1]."""
    return _largest(lambda part: errors_of(result, deflections.times(part))[name] <= most)


def _largest(allowed: Callable[[float], bool]) -> float:
    """Return the largest part, from `SMALLEST` to 1, that is allowed."""
    low, high = math.log(SMALLEST), 0.0
    for _ in range(STEPS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if allowed(math.exp(middle)) else (low, middle)
    return math.exp(low)
