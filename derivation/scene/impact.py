"""Simulates an impact: from the scene to contact time, indentation, force and their history."""

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING

from derivation.scene.edge_remainder import edge_remainder
from derivation.scene.effect_selection import SelectedEffects, decide
from derivation.scene.law import ContactLaw
from derivation.scene.limits import (
    PlateTimes,
    check_radius,
    contact_warnings,
    hollow_warnings,
    local_indentation,
    motion_warnings,
    neglects_inertia,
    pressure_warnings,
    stress_warnings,
    warnings_at,
)
from derivation.scene.method_selection import check_rtol, dynamic_impact, solve_selected
from derivation.scene.model import model_of
from derivation.scene.model_error import inertia_error
from derivation.scene.result import Result
from derivation.scene.scene import OUTPUTS, TIGHTEST, Scene
from derivation.scene.yield_warnings import impact_warnings

if TYPE_CHECKING:
    from derivation.scene.wave_motion import DynamicImpact

DEFAULT = 1e-3
"""What effects may change if they are to be left out and no tolerance is given [1]."""


def simulate(
    scene: Scene, times: Iterable[float] | None = None, rtol: float | None = None
) -> Result:
    """Simulate the impact of a scene.

    Parameters
    ----------
    scene
        The scene, as `load` returns it.
    times
        Times after first contact [s] at which `Result.history` is to be given; without them
        it covers the contact evenly.
    rtol
        Relative tolerance of the results [1]: of effects and methods the cheapest are taken
        whose bounds meet it. Without it that of the scene counts; without that too effects
        may change 1e-3, and the law that they leave is computed by the full method.
        The history is by the full method always.

    Returns
    -------
    Result
        Contact time [s], largest indentation [m], force [N] and contact radius [m], with the
        method and the bound of its error.

    Raises
    ------
    SceneError
        If the impact leaves the contact law's range, a time lies outside the contact, or the
        tolerance is not between 1e-13 and 1.
    """
    rtol, selected = selected_effects(scene, rtol)
    numbers, accuracy = solve_selected(selected, rtol)
    contact_time, delta, force, a, _ = numbers
    law, model = selected.law, selected.law.model
    check_radius(law, a, "impact.speed", "lower the speed")
    motion = dynamic_impact(selected, rtol) if law.dynamic else None
    pressure = min(law.max_pressure(a), law.pressure_limit)
    model_error = _model_error(selected, a, motion)
    share = 1.0 - float(local_indentation(law, a)) / delta
    deflection = motion.largest_deflection(law) if motion is not None else None
    neglected = neglects_inertia(model, contact_time, share, motion is not None)
    strength, yield_stress = scene.plate.tensile_strength, _known(model.plate_yield_stress)
    stress = math.nan
    if strength is not None or yield_stress is not None:
        stress = law.max_tensile_stress(a, force, not selected.edge_disabled)
    warnings = warnings_of(law, contact_time, delta, a, pressure, stress, strength, deflection)
    if motion is not None:
        speeds = [touch.relative_approach_speed for touch in motion.inertia.contacts]
        warnings += contact_warnings(speeds, motion.least)
    result = Result(
        *numbers, pressure, accuracy, model_error, warnings, scene, selected,
        inertia_neglected=neglected,
    )  # fmt: skip
    return result if times is None else result.at(times)


def warnings_of(
    law: ContactLaw,
    contact_time: float,
    delta: float,
    a: float,
    pressure: float,
    stress: float,
    strength: float | None,
    deflection: float | None = None,
    known: PlateTimes | None = None,
) -> tuple[str, ...]:
    """What to know about an impact, but for its contacts one by one.

    Parameters
    ----------
    contact_time, delta, a, pressure
        Contact time [s], and largest indentation [m], contact radius [m] and pressure [Pa].
    stress, strength
        Largest tensile stress on the back face and the plate's strength [Pa], if it is given.
    deflection
        Largest deflection of the plate [m], if its motion was computed.
    known
        The plate's times, if they are known already.
    """
    model, moves = law.model, deflection is not None
    share = 1.0 - float(local_indentation(law, a)) / delta
    return (
        *hollow_warnings(model),
        *warnings_at(law, a, delta, deflection),
        *motion_warnings(model, contact_time, share, moves, known),
        *_yield_warnings(law, a, pressure),
        *stress_warnings(stress, strength, _known(model.plate_yield_stress)),
    )


def _yield_warnings(law: ContactLaw, a: float, pressure: float) -> tuple[str, ...]:
    """Whether a body yields that the law takes for elastic, or far beyond what the law covers."""
    if law.plastic:
        return impact_warnings(law, a)
    model = law.model
    weaker = "sphere" if model.yield_stress < model.plate_yield_stress else "plate"
    return pressure_warnings(pressure, _known(model.yield_stress), law.viscous, weaker)


def _known(stress: float) -> float | None:
    """A yield stress [Pa], None if it is not known."""
    return stress if math.isfinite(stress) else None


def _model_error(selected: SelectedEffects, a: float, motion: "DynamicImpact | None") -> float:
    """The largest model error of the outputs [1]: of the edge, and of the plate's inertia."""
    model, other_edge = selected.law.model, selected.law.other_edge
    if motion is None:
        return edge_remainder(model, a) if other_edge else 0.0
    found = inertia_error(model, a, motion.contact_time)
    size = max(found[name] for name in selected.outputs)
    from derivation.scene.waves import echo_time

    # Before a wave has come back the edge has no effect.
    if other_edge and motion.inertia.total_time > echo_time(motion.law.model):
        size = max(size, edge_remainder(model, a))
    return size


def selected_effects(
    scene: Scene, rtol: float | None = None
) -> tuple[float | None, SelectedEffects]:
    """The tolerance that applies, and the effects that it requires; nothing is simulated.

    Raises
    ------
    SceneError
        If the tolerance is not between 1e-13 and 1.
    """
    outputs = OUTPUTS
    if scene.accuracy is not None:
        outputs = scene.accuracy.outputs
        rtol = scene.accuracy.rtol if rtol is None else rtol
    wanted, share = scene.effects.model_dump(), selection_tolerance(rtol)
    return rtol, decide(model_of(scene), wanted, share, outputs, default=rtol is None)


def selection_tolerance(rtol: float | None) -> float:
    """What the effects omitted may change, of a tolerance, or if none is given [1].

    Raises
    ------
    SceneError
        If the tolerance is not between 1e-13 and 1.
    """
    return DEFAULT if rtol is None else max(check_rtol(rtol) - TIGHTEST, 0.0)
