"""Decides whether an impact is simulated with stretching of the plate."""

from dataclasses import replace
from typing import TYPE_CHECKING

from derivation.scene.contact_law.corrections import stretching
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.stretching_error import DEPTH, deflections_of, stretching_error
from derivation.scene.dynamic.time_in_contact import deflection_of_infinite, least_deflection
from derivation.scene.effects.stretching import NAME, REPLACED
from derivation.scene.scene import Scene

if TYPE_CHECKING:
    from derivation.scene.result import Result


def certain(law: ContactLaw) -> bool:
    """Return whether stretching is certainly needed, before a simulation without it."""
    model = law.model
    settings = model.inertia
    if not law.dynamic or settings.stretching != "auto" or settings.infinite_plate:
        return False
    return _too_much(law, deflection_of_infinite(law)) and _too_much(law, least_deflection(law))


def _too_much(law: ContactLaw, deflection: float) -> bool:
    """Return whether a plate with a deflection [m] stretches too much."""
    return DEPTH * float(stretching(law.model, deflection)) >= REPLACED


def needed(result: "Result") -> bool:
    """Return whether the model error of a result by the neglect of stretching is too large."""
    law, motion = result.effects.law, result.dynamics
    settings = law.model.inertia
    if motion is None or settings.stretching != "auto" or settings.infinite_plate:
        return False
    errors = stretching_error(law, motion, deflections_of(law, motion))
    return max(errors[name] for name in result.effects.outputs) >= REPLACED


def with_stretching(scene: Scene) -> Scene:
    """Return a scene in which stretching is enabled."""
    effects = scene.effects.model_copy(update={NAME: True})
    return scene.model_copy(update={"effects": effects})


def not_stretched(error: Exception) -> str:
    """Return the warning that an impact could not be simulated with stretching."""
    return f"stretching of the plate is not included, because of this error: {error}"


def with_reason(result: "Result", scene: Scene) -> "Result":
    """Return a result with the scene as it was given, and the reason for stretching.

    A constant that a measurement determines depends on stretching: the scene then keeps it enabled.
    """
    reason = f"needed, because the model error without it exceeds {100.0 * REPLACED:g} %"
    rows = tuple(
        replace(row, reason=reason) if row.name == NAME else row for row in result.effects.rows
    )
    given = scene if scene.measured is None else result.scene
    return replace(result, scene=given, effects=replace(result.effects, rows=rows))
