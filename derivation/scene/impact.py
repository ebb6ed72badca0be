"""Simulates an impact: from a scene to contact time, indentation, force and error bound."""

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from derivation.scene.contact_law.impact_errors import ImpactErrors
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import (
    check_radius,
    hollow_warnings,
    local_indentation,
    motion_warnings,
    neglects_inertia,
    warnings_at,
)
from derivation.scene.contact_law.stress_limits import pressure_warnings, stress_warnings
from derivation.scene.contact_law.yield_warnings import impact_warnings
from derivation.scene.contact_law.yielding import onset_of
from derivation.scene.dynamic.contact_warnings import (
    branch_warnings,
    duration_warnings,
    fall_warnings,
    grazing_warnings,
    model_jump_warnings,
)
from derivation.scene.dynamic.stretching_error import (
    Deflections,
    deflections_of,
    jump_warnings,
)
from derivation.scene.dynamic.unlike_bodies import unlike_jump_warnings
from derivation.scene.effects.effect import Results
from derivation.scene.errors import SceneError, ToleranceError
from derivation.scene.input.units import unit_warnings, with_unit_warnings
from derivation.scene.measured.measured import (
    ambiguity_warnings,
    error_of,
    inaccurate_constant,
    model_error_of,
    remaining_of,
    toleranced,
    without_constant,
)
from derivation.scene.model import model_of
from derivation.scene.model_errors import model_errors
from derivation.scene.result import Result
from derivation.scene.scene import OUTPUTS, TIGHTEST, Scene, check_scene
from derivation.scene.selection.achieved_accuracy import ESTIMATED, AchievedAccuracy, Part
from derivation.scene.selection.candidates import check_enabled
from derivation.scene.selection.effect_selection import SelectedEffects, decide
from derivation.scene.selection.method_selection import (
    accuracy_on,
    check_rtol,
    dynamic_impact,
    growth_of,
    solve_selected,
)
from derivation.scene.tensile_stress import TensileStress, tensile_stress

DEFAULT = 1e-3
"""Tolerance of the effect selection if the scene has no tolerance [1]."""
REPEATED = 0.5
"""Part of what remains of the tolerance for the omitted effects, if the simulation is repeated with
more [1]."""


def simulate(
    scene: Scene, times: Iterable[float] | None = None, rtol: float | None = None
) -> Result:
    """Simulate the impact of a scene.

    Parameters
    ----------
    scene
        The scene, as `load` returns it.
    times
        Times after first contact [s] at which `Result.history` is evaluated: a number, a list or a
        one-dimensional array. By default times evenly spaced over the impact.
    rtol
        Relative tolerance of the results [1], from 1e-13 to 1: the fastest combination of effects
        and method whose error bound meets it is used. By default the tolerance of the scene; if
        the scene has none, omitted effects may change the results by 1e-3, and the remaining law
        is evaluated by the full method. The history always uses the full method.

    Returns
    -------
    Result
        Contact time [s], largest indentation [m], force [N] and contact radius [m], restitution
        [1], with the method and its error bound.

    Raises
    ------
    SceneError
        If the impact exceeds the range of the contact law, a required key is missing, a time lies
        outside the impact, or the tolerance is not between 1e-13 and 1 or cannot be met.

    Examples
    --------
    >>> import platecontact as pc
    >>> scene = pc.Scene(
    ...     sphere=pc.Sphere(radius=0.01, material="steel"),
    ...     plate=pc.Plate(radius=0.3, thickness=0.05, material="glass"),
    ...     impact=pc.Impact(speed=1.0),
    ... )
    >>> result = pc.simulate(scene)
    >>> print(f"{result.max_force:.3g} N, {result.restitution:.2f}")
    1.29e+03 N, 0.97
    """
    check_scene(scene)
    on_units = unit_warnings(scene)
    try:
        result = _simulated(scene, rtol, on_units)
    except SceneError as error:
        if not on_units:
            raise
        raise with_unit_warnings(error, on_units) from error
    return result if times is None else result.at(times)


def _simulated(scene: Scene, rtol: float | None, on_units: tuple[str, ...]) -> Result:
    """Simulate the impact of a scene, with the warnings about its units first."""
    scene = toleranced(scene, None if rtol is None else check_rtol(rtol))
    if scene.measured is not None:
        _check_before_fit(scene, rtol)
    rtol, selected = selected_effects(scene, rtol)
    selected, numbers, accuracy = _solved(scene, selected, rtol)
    contact_time, delta, _, a, _ = numbers
    law, model = selected.law, selected.law.model
    check_radius(law, a, "impact.speed", "reduce the speed")
    motion = dynamic_impact(selected, accuracy.remaining) if law.dynamic else None
    if motion is None:
        pressure = law.max_pressure(a)
    else:  # it is proportional to P/a^2, and in the static law of the simulated plate to a
        pressure = motion.law.max_pressure(a) * motion.at_equal_radius
    pressure = min(pressure, law.pressure_limit)
    local = float(local_indentation(law, a))
    fraction, deflection = 1.0 - local / delta, delta - local
    deflections = Deflections(deflection, np.zeros(0))
    if motion is not None:
        deflection, deflections = motion.largest_deflection(law), deflections_of(law, motion)
    errors, measured = model_errors(law, numbers, deflections, motion), model_error_of(scene)
    errors = {name: error + measured for name, error in errors.items()}
    model_error = max(errors[name] for name in selected.outputs)
    names = ImpactErrors._fields
    stated = ImpactErrors(*(accuracy_on((x,), selected, motion, accuracy).bound for x in names))
    dynamic = motion is not None
    neglected = neglects_inertia(model, contact_time, fraction, dynamic, errors=stated)
    moving = model  # with the wave branches that the simulation chose
    if motion is not None:
        moving = replace(model, inertia=motion.law.model.inertia)
    strength, yield_stress = scene.plate.tensile_strength, _known(model.plate_yield_stress)
    stress = TensileStress(math.nan, math.nan, static=motion is None)
    if strength is not None or yield_stress is not None:
        stress = tensile_stress(law, motion, numbers, not selected.edge_disabled)
    pressed = accuracy_on(OUTPUTS, selected, motion, accuracy)
    loaded = accuracy_on(("max_force",), selected, motion, accuracy)
    pressure_error = pressed.pressure_bound + errors["max_pressure"]
    stress_error = loaded.bound + stress.error + measured
    warnings = (
        *on_units,
        *hollow_warnings(model),
        *warnings_at(law, a, delta, deflection, errors=stated),
        *motion_warnings(moving, contact_time, fraction, dynamic, errors=stated),
        *_yield_warnings(law, a, pressure, pressure_error),
        *stress_warnings(stress.value, strength, yield_stress, stress_error, motion is None),
        *ambiguity_warnings(scene),
    )
    if motion is not None:
        from derivation.scene.dynamic.mode_count import needs_infinite_plate

        speeds = [touch.relative_approach_speed for touch in motion.inertia.contacts]
        warnings += grazing_warnings(speeds, motion.least)
        warnings += duration_warnings(motion.inertia.jump, math.isfinite(stated.contact_time))
        omitted = max(motion.inertia.omitted_branch_error)
        if law.model.inertia.branches == "auto" and needs_infinite_plate(motion.law):
            warnings += branch_warnings(omitted)
        jumps = (*jump_warnings(law, motion), *unlike_jump_warnings(law, motion))
        warnings += jumps or model_jump_warnings(motion.decisive_change, errors["max_force"])
        rebound = motion.restitution * model.v0
        returned = accuracy_on(("restitution",), selected, motion, accuracy)
        speed_error = returned.bound + errors["restitution"]
        warnings += fall_warnings(model.gravity, rebound, motion.later_deflection, speed_error)
    return Result(
        *numbers, pressure, accuracy, model_error, warnings, scene,
        selected.grown(growth_of(motion)), inertia_neglected=neglected,
        model_errors=errors,
    )  # fmt: skip


def _check_before_fit(scene: Scene, rtol: float | None) -> None:
    """Reject a scene that fails for any value of a constant before the value is determined.

    Raises
    ------
    SceneError
        If its plate has inertia, and the impact cannot be simulated.
    """
    from derivation.scene.dynamic.waves import check_simulable

    rtol, selected = selected_effects(without_constant(scene), rtol)
    if selected.law.dynamic:
        check_simulable(selected.law, rtol)


def _solved(
    scene: Scene, selected: SelectedEffects, rtol: float | None
) -> tuple[SelectedEffects, Results, AchievedAccuracy]:
    """Return the effects, the outputs and their accuracy, with the error of a fitted constant.

    If the bounds on the omitted effects leave too little of the tolerance, perhaps because the
    simulation increases them, it is repeated with more effects.
    """
    rest = remaining_of(scene, rtol)
    try:
        try:
            numbers, accuracy = solve_selected(selected, rest)
        except ToleranceError as error:
            if not error.growth:
                raise
            more = selected_effects(scene, rtol, error.growth / REPEATED)[1]
            if more.law.effects == selected.law.effects:
                raise
            selected = more
            numbers, accuracy = solve_selected(selected, rest)
    except ToleranceError as error:
        raise inaccurate_constant(scene, rtol, error) from None
    constant = None if scene.measured is None else Part(error_of(scene), ESTIMATED)
    return selected, numbers, replace(accuracy, rtol=rtol, constant=constant)


def _yield_warnings(law: ContactLaw, a: float, pressure: float, error: float) -> tuple[str, ...]:
    """Return warnings about yielding that the law neglects, or that exceeds its range.

    `error` is the relative error of the pressure [1].
    """
    if law.plastic:
        return impact_warnings(a / onset_of(law))
    model = law.model
    weaker = "sphere" if model.yield_stress < model.plate_yield_stress else "plate"
    return pressure_warnings(pressure, _known(model.yield_stress), law.viscous, weaker, error)


def _known(stress: float) -> float | None:
    """Return a yield stress [Pa]; None if it is unknown."""
    return stress if math.isfinite(stress) else None


def selected_effects(
    scene: Scene, rtol: float | None = None, growth: float = 1.0
) -> tuple[float | None, SelectedEffects]:
    """Return the tolerance of a scene and the effects that it requires, without a simulation.

    Parameters
    ----------
    growth
        Factor by which the simulation is expected to increase the bounds [1].

    Raises
    ------
    SceneError
        If the tolerance is not between 1e-13 and 1, or a required or enabled effect cannot be
        computed.
    """
    check_scene(scene)
    outputs = OUTPUTS
    if scene.accuracy is not None:
        outputs = scene.accuracy.outputs
        rtol = scene.accuracy.rtol if rtol is None else rtol
    wanted, tolerance = scene.effects.model_dump(), selection_tolerance(rtol)
    scene = toleranced(scene, rtol)
    model = model_of(scene)
    check_enabled(scene, model)
    if scene.measured is not None:
        tolerance = selection_tolerance(remaining_of(scene, rtol))
    selected = decide(model, wanted, tolerance, outputs, rtol is None, growth)
    if _needs_stretching(scene, rtol, selected):
        from derivation.scene.dynamic.stretching_needed import stretched

        model = stretched(selected.law).model
        selected = decide(model, wanted, tolerance, outputs, rtol is None, growth)
    return rtol, selected


def _needs_stretching(scene: Scene, rtol: float | None, selected: SelectedEffects) -> bool:
    """Return whether a plate must stretch for accurate results, if the scene does not decide it.

    In a measurement, the plate without the constant decides it for all values of the constant.
    """
    if not (scene.effects.may_stretch and selected.law.dynamic):
        return False
    if scene.measured is not None:
        return selected_effects(without_constant(scene), rtol)[1].law.stretches
    from derivation.scene.dynamic.stretching_needed import needs_stretching

    stress = scene.plate.tensile_strength is not None
    return needs_stretching(selected.law, selected.outputs, stress)


def selection_tolerance(rtol: float | None) -> float:
    """Return the tolerance of the effect selection [1] for a tolerance of the results.

    Raises
    ------
    SceneError
        If the tolerance is not between 1e-13 and 1.
    """
    return DEFAULT if rtol is None else max(check_rtol(rtol) - TIGHTEST, 0.0)
