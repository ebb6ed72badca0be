"""Errors of contacts that do not end, or that have no solution."""

import math
from dataclasses import replace

import numpy as np

from derivation.scene.dynamic.problem import DynamicProblem, ImpactState
from derivation.scene.dynamic.yield_events import turned
from derivation.scene.effects.effect import Array
from derivation.scene.effects.inertia import WIDER
from derivation.scene.errors import (
    EndlessError,
    IncompleteError,
    Slower,
    StiffUnloadingError,
    WideContactError,
    wide_contact,
)
from derivation.scene.input.settings import FEWEST_MODES

STUCK = 1e-7
"""Length of an element in x, over max(x, 1), below which the simulation ends if the element has no
solution. In 75 impacts, shorter elements had a solution only after failures of elements longer than
6e-5."""
LOOSEST = 1e-8
"""Largest tolerance of an element, also without a tolerance of the results [1]."""
TOO_WIDE = 1.05
"""Contact radius over the limit of the law at which a simulation ends: with more modes, so wide a
contact would not be within the limit either."""
GRID, SAFE = 400, 0.97
"""Number of radii for the energy of a contact, and safety factor of a speed that follows from
it."""
WIDE = 1.01
"""Contact radius over the limit above which a completed simulation is not repeated with more
modes."""
HEAVY = 10.0
"""Sphere mass over mass of the first mode above which the plate acts as a spring."""
INSTANT = 1e-9
"""Retardation time over the unit of time below which a contact without a solution has none because
rounding hides how the face lags."""
SHARP = 0.05
"""Slope of the gap over that without vibration below which the contact is no longer circular."""


def too_many_steps(problem: DynamicProblem, t: float, most: int, tolerance: float) -> EndlessError:
    """Return the error of a simulation with too many time steps of a tolerance [1]."""
    larger = ", or increase accuracy.rtol" if tolerance < LOOSEST else ""
    remedy = f"reduce inertia.modes{larger}{or_quasi_static(problem)}"
    if math.isfinite(problem.first_echo):
        remedy = 'use a thicker plate or a lighter sphere, or remove extent = "infinite"'
    return EndlessError(
        f"the sphere was still in contact {problem.T * t:.6g} s after first contact, when the "
        f"limit of {most} time steps was reached",
        remedy,
    )


def or_quasi_static(problem: DynamicProblem) -> str:
    """Return the remedy of a plate without inertia; none if it stretches, which needs inertia."""
    if problem.middle_plane is not None:
        return ""
    return ", or set effects.inertia = false for a quasi-static plate"


def check_width(problem: DynamicProblem, radius: float) -> None:
    """Raise an error if a plastic contact is far wider than the law allows.

    Yielding widens a contact beyond the radius of the elastic law, at which its tables end.
    Narrower contacts are checked with the results.

    Parameters
    ----------
    radius
        Radius of the elastic law, in units of the problem.

    Raises
    ------
    SceneError
        If the contact radius exceeds `TOO_WIDE` times the limit.
    """
    branch, a = problem.yielding, problem.a * np.array([radius])
    if branch is None or not branch.loading:
        return
    widest = float(branch.widened(a, problem.contact.at(a).force)[0])
    if widest > TOO_WIDE * problem.limit:
        raise _too_wide(problem, widest, "at least ")


def check_whole_width(problem: DynamicProblem, widest: float) -> None:
    """Raise an error if a simulated contact is too wide, and would be so with more modes, too.

    Parameters
    ----------
    widest
        Its largest contact radius [m].

    Raises
    ------
    SceneError
        If it exceeds `WIDE` times the limit of the law.
    """
    if widest > WIDE * problem.limit:
        raise _too_wide(problem, widest)


def _too_wide(problem: DynamicProblem, widest: float, least: str = "") -> WideContactError:
    """Return the error of a contact of a radius [m]; `least` is text in front of the radius."""
    got, ratio = f"{least}{widest:.6g}", widest / problem.limit
    return wide_contact("impact.speed", problem.range_end, got, advice_for_width(problem), ratio)


def advice_for_width(problem: DynamicProblem) -> Slower:
    """Return advice that makes a contact narrower, with a low enough speed if there is one."""
    weight = " or impact.gravity" if problem.weight else ""
    speed = sufficient_speed(problem)
    others = f"{weight}, or use a lighter sphere or a thicker plate"
    return Slower(speed if speed < problem.v0 else 0.0, others)


def sufficient_speed(problem: DynamicProblem) -> float:
    """Return a speed [m/s] at which the first contact stays within the limit of the law.

    At this speed the sphere has less energy than the contact absorbs up to the limit if the modes
    do not move; moving modes only take energy from it. The result is 0 if the tables of the contact
    end before the limit, or if the weight alone exceeds it.
    """
    a = min(problem.limit, problem.contact.top) * np.linspace(0.0, 1.0, GRID)[1:]
    at = problem.contact.at(a)
    depth_a, wide = at.depth_a, a
    if problem.yielding is not None:
        begun = replace(problem.yielding, ratio=1.0, loading=True)
        yields = begun.hertz_radius(at.force) > begun.onset
        depth_a = depth_a + np.where(yields, begun.added(at.force, at.force_a).depth_a, 0.0)
        wide = np.where(yields, begun.widened(a, at.force), a)
    if wide[-1] < problem.limit:
        return 0.0
    last = int(np.searchsorted(wide, problem.limit))
    if last < 2:  # the contact yields, and is too wide, as soon as it begins
        return 0.0
    # Each sum is less than its integral, and the last interval is omitted.
    work = float(np.sum(at.force[: last - 1] * np.diff(a[:last]) * depth_a[: last - 1]))
    depth = float(np.sum(np.diff(a[:last]) * depth_a[: last - 1]))
    weight = problem.weight * problem.v0 / problem.T
    speed = math.sqrt(max(0.0, 2.0 * (work / problem.m - weight * depth)))
    return rounded_down(SAFE * speed)


def rounded_down(x: float) -> float:
    """Return a number to two digits, rounded down; 0 for 0."""
    unit = 10.0 ** (math.floor(math.log10(x)) - 1) if x > 0.0 else 1.0
    return math.floor(x / unit) * unit


def no_solution(
    problem: DynamicProblem, state: ImpactState, radius: float, time: float
) -> IncompleteError:
    """Return the error of a contact without a solution: too wide, not circular, or extreme."""
    deflection = problem.depth * float(np.sum(state.q))
    why = (
        f"has no solution at a contact radius of {problem.a * radius:.3g} m and a plate deflection "
        f"of {deflection:.3g} m"
    )
    remedy: str | Slower = "reduce impact.speed, or use a smaller sphere or a thicker plate"
    if 0.0 < problem.retardation_time < INSTANT:
        remedy = "set effects.viscosity = false, because the retardation time is extremely short"
    beyond = np.nextafter(problem.contact.top, 0.0) / problem.a
    if radius > 0.99 * beyond:
        why = (
            f"grows wider than {problem.contact.top:.4g} m, {WIDER:g} times the largest contact "
            "radius on a plate that does not deflect"
        )
        if problem.contact.top >= problem.limit:
            why = f"grows wider than the contact law allows, {problem.range_end}"
        remedy = advice_for_width(problem)
    bent = problem.contact.modes.by_shape(state.q)
    # The present radius and a larger one; for a plastic contact also that where unloading begins.
    for branch in (problem, turned(problem, radius)):
        for a in (radius, 1.2 * radius):
            at = branch.at(problem.a * np.array([min(a, beyond)]))
            elastic_slope = at.depth_a[0] / problem.depth
            if a > 0.0 and not elastic_slope + at.less_a[0] @ bent > SHARP * elastic_slope:
                why = "is not circular, because the plate is more curved than the sphere"
                remedy = advice_for_curvature(problem)
                if _circular_without_yield(problem, min(a, beyond), bent):
                    return _stiff_unloading(problem, time)
    return IncompleteError(f"the contact at {time:.6g} s {why}", remedy)


def _stiff_unloading(problem: DynamicProblem, time: float) -> StiffUnloadingError:
    """Return the error of a yielded contact that is not circular with so many modes."""
    modes = problem.contact.modes
    fewer = modes.first.size // 2
    return StiffUnloadingError(
        f"the contact at {time:.6g} s has no solution, because the yielded contact unloads more "
        "stiffly than the short modes of the plate respond",
        fewer if fewer >= FEWEST_MODES else 0,
        branched=modes.first.size < modes.omega.size,
    )


def advice_for_curvature(problem: DynamicProblem) -> str:
    """Return advice that makes the plate less curved than the sphere."""
    first = problem.inverse_modal_mass[problem.by_speed[:1]]
    # A quasi-static plate does not stretch.
    if not np.any(first > HEAVY) or problem.middle_plane is not None:
        return "use a smaller sphere or a thicker plate, or reduce impact.speed"
    return (
        "use a smaller sphere or a thicker plate, reduce impact.speed, or try effects.inertia = "
        "false: for so heavy a sphere the plate is nearly quasi-static"
    )


def _circular_without_yield(problem: DynamicProblem, a: float, bent: Array) -> bool:
    """Return whether the plate is more curved than the sphere only because this yielded."""
    if problem.yielding is None:
        return False
    at = problem.contact.at(problem.a * np.array([a]))
    elastic_slope = at.depth_a[0] / problem.depth
    return bool(elastic_slope + at.less_a[0] @ bent > SHARP * elastic_slope)
