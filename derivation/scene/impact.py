"""Simulates an impact: from the scene to contact time, indentation, force and their history."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

from derivation.scene.edge_remainder import edge_remainder
from derivation.scene.effect_selection import Gate, decide
from derivation.scene.limits import (
    check_radius,
    contact_warnings,
    local_indentation,
    motion_warnings,
    neglects_inertia,
    pressure_warnings,
    tension_warnings,
    warnings_at,
)
from derivation.scene.method_selection import check_rtol, moving, solve_gated
from derivation.scene.model import model_of
from derivation.scene.model_error import inertia_error
from derivation.scene.result import Result
from derivation.scene.scene import OUTPUTS, TIGHTEST, Scene

if TYPE_CHECKING:
    from derivation.scene.wave_motion import WaveMotion

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
    law, model = gate.law, gate.law.model
    check_radius(law, a, "impact.speed", "lower the speed")
    motion = moving(gate, rtol) if law.dynamic else None
    pressure = law.max_pressure(a)
    model_error = _model_error(gate, a, motion)
    share = 1.0 - float(local_indentation(law, a)) / delta
    deflection = motion.largest_deflection(law) if motion is not None else None
    warnings = (
        *warnings_at(law, a, delta, deflection),
        *motion_warnings(model, contact_time, share, motion is not None),
        *pressure_warnings(pressure, scene.plate.yield_stress, law.viscous),
    )
    neglected = neglects_inertia(model, contact_time, share, motion is not None)
    strength, yield_stress = scene.plate.tensile_strength, scene.plate.yield_stress
    if strength is not None or yield_stress is not None:
        tension = law.max_tension(a, force, not gate.edge_disabled)
        warnings += tension_warnings(tension, strength, yield_stress)
    if motion is not None:
        closing = [touch.closing for touch in motion.inertia.contacts]
        warnings += contact_warnings(closing, motion.least)
    result = Result(
        *numbers, pressure, accuracy, model_error, warnings, scene, gate,
        inertia_neglected=neglected,
    )  # fmt: skip
    return result if times is None else result.at(times)


def _model_error(gate: Gate, a: float, motion: "WaveMotion | None") -> float:
    """The largest model error of the outputs [1]: of the edge, and of the plate's inertia."""
    model, other_edge = gate.law.model, gate.law.other_edge
    if motion is None:
        return edge_remainder(model, a) if other_edge else 0.0
    found = inertia_error(model, a, motion.contact_time)
    size = max(found[name] for name in gate.outputs)
    from derivation.scene.waves import echo_time

    # Before a wave has come back the edge has no effect.
    if other_edge and motion.inertia.total_time > echo_time(motion.law.model):
        size = max(size, edge_remainder(model, a))
    return size


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
    wanted = scene.effects.model_dump()
    return rtol, decide(model_of(scene), wanted, share, outputs, default=rtol is None)
