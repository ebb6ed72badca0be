"""Simulates an impact: from the scene to contact time, indentation, force and their history."""

from collections.abc import Iterable
from dataclasses import replace

from derivation.scene.choice import check_rtol, solve_gated
from derivation.scene.edge_remainder import edge_remainder
from derivation.scene.gate import Gate, decide
from derivation.scene.limits import (
    check_numbers,
    check_radius,
    contact_warnings,
    local_indentation,
    motion_warnings,
    pressure_warnings,
    tension_warnings,
    warnings_at,
)
from derivation.scene.model import model_of
from derivation.scene.result import Result
from derivation.scene.scene import OUTPUTS, TIGHTEST, Scene

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
    rtol, gate = gated(scene, rtol)
    numbers, accuracy = solve_gated(gate, rtol)
    contact_time, delta, force, a, _ = numbers
    model = gate.law.model
    check_radius(gate.law, a, "impact.speed", "lower the speed")
    check_numbers(model, *numbers)
    pressure = gate.law.max_pressure(a)
    model_error = edge_remainder(model, a) if "edge" in gate.law.effects else 0.0
    deflection = 1.0 - local_indentation(model, a, gate.law.effects) / delta
    warnings = (
        *warnings_at(model, a, delta, gate.law.effects),
        *motion_warnings(model, contact_time, deflection, "inertia" in gate.law.effects),
        *pressure_warnings(pressure, scene.plate.yield_stress, "viscosity" in gate.law.effects),
    )
    if scene.plate.strength is not None:
        tension = gate.law.max_tension(a, force, scene.effects.edge is not False)
        warnings += tension_warnings(tension, scene.plate.strength)
    result = Result(*numbers, pressure, accuracy, model_error, warnings, scene, gate)
    if result.moving is not None:
        closing = [touch.closing for touch in result.moving.inertia.contacts]
        more = contact_warnings(closing, result.moving.least)
        result = replace(result, warnings=result.warnings + more)
    return result if times is None else result.at(times)


def gated(scene: Scene, rtol: float | None = None) -> tuple[float | None, Gate]:
    """The tolerance that counts, and what the gate decides by it; nothing is simulated.

    Raises
    ------
    SceneError
        If the tolerance is not between 1e-13 and 1.
    """
    outputs = OUTPUTS
    if scene.accuracy is not None:
        outputs = scene.accuracy.outputs
        rtol = scene.accuracy.rtol if rtol is None else rtol
    share = DEFAULT if rtol is None else max(check_rtol(rtol) - TIGHTEST, 0.0)
    return rtol, decide(model_of(scene), scene.effects.model_dump(), share, outputs)
