"""Determines the yield stress or retardation time of the plate from a measured restitution.

The restitution was measured on a thick block, which does not vibrate, or on the plate itself. The
impact is simulated repeatedly until the restitution agrees. On a block the solution is unique:
restitution decreases with decreasing yield stress and with increasing retardation time. On a plate
that bends, an infinite retardation time leaves an elastic plate: the solution with the smaller one
is returned, if there is any.
"""

import json
import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from derivation.scene.achieved_accuracy import rounded_up
from derivation.scene.effects import BY_NAME
from derivation.scene.errors import SceneError
from derivation.scene.quantity import prefixed
from derivation.scene.settings import TIGHTEST

if TYPE_CHECKING:
    from derivation.scene.scene import Scene

UNITS = {"yield_stress": "Pa", "retardation_time": "s"}
DIGITS = 4
"""Number of significant digits of the constant that are shown."""
BLOCK = 1e4
"""Radius and half-thickness of the block over the sphere radius."""
EFFECTS = {"yield_stress": "plasticity", "retardation_time": "viscosity"}
"""The effect of each constant."""
EARLY = 1e-2
"""First trial value of the retardation time over the contact time without viscosity [1]."""
STEPS, FACTOR = 40, 2.0
"""Largest number of steps until two trial values enclose the solution, and ratio of a step."""
RISING = 3
"""Number of steps in which restitution increases, from which it has passed its smallest value."""
CLOSE = {"static": 1e-12, "dynamic": 1e-4}
"""Relative accuracy of the constant [1]; with plate inertia the restitution is less smooth."""
STATIC_RTOL = 1e-9
"""Relative tolerance of measurements without plate inertia [1]."""
PART, FINER = 0.5, 4.0
"""Part of the tolerance for the error due to a constant; if a measurement with plate inertia does
not meet it, its own tolerance is divided by `FINER`."""
LOOSE, ROUGH = 0.1, 1e-3
"""Tolerance of the simulations that search for the constant, and its accuracy in them [1]."""
NEAR, FURTHEST, POLISHES = 0.02, 0.2, 6
"""First and largest change of the logarithm of a constant after the search, and largest number of
simulations."""
ENOUGH = 2.0
"""Tolerance that a message recommends over the error bound: both increase together."""
AGREES = 0.1
"""Relative difference from the measured restitution that suffices, over the error bound."""
CHANGE, DYNAMIC = 1e-2, 3.0
"""Relative change of the constant that gives the sensitivity of a measurement without plate
inertia; and error of the results over that of one with plate inertia, an estimate."""


class UnreachedError(SceneError):
    """The error of a restitution below all that the constant gives, within their bounds `least`."""

    def __init__(self, text: str, least: float) -> None:
        super().__init__(text, least)
        self.text, self.least = text, least

    def __str__(self) -> str:
        return self.text


class Trial(NamedTuple):
    """The results of a measurement with a trial value: time [s], restitution, pressure [Pa]."""

    contact_time: float
    restitution: float
    max_pressure: float
    bound: float


def fitted(scene: "Scene") -> "Scene":
    """Return the scene with the constant that its measured restitution determines.

    It has no table `measured`.

    Raises
    ------
    SceneError
        If no value gives the restitution, or a simulation with a trial value fails.
    """
    from derivation.scene.scene import read

    return read(json.loads(_fitted(json.dumps(scene.to_json()))))


def toleranced(scene: "Scene", rtol: float | None) -> "Scene":
    """Return a scene with a measurement whose tolerance is that of the results, if one is given."""
    if scene.measured is None or rtol is None:
        return scene
    from derivation.scene.scene import read

    tables = scene.to_json()
    return read(tables | {"accuracy": tables.get("accuracy", {}) | {"rtol": rtol}})


def solved(scene: "Scene") -> float:
    """Return the constant that the measured restitution of a scene determines [Pa or s]."""
    assert scene.measured is not None
    return float(fitted(scene).plate.model_dump()[scene.measured.solve_for])


def in_words(scene: "Scene") -> str:
    """Return a phrase with the constant, the measured restitution, specimen and speed."""
    wanted = scene.measured
    assert wanted is not None
    value, unit = prefixed(solved(scene), UNITS[wanted.solve_for], DIGITS)
    specimen = "a thick block" if wanted.target == "block" else "the plate"
    return (
        f"plate.{wanted.solve_for} = {value} {unit}, from the restitution "
        f"{wanted.restitution:g} measured on {specimen} at "
        f"{wanted.tested_at or scene.impact.speed:g} m/s"
    )


@lru_cache(maxsize=64)
def _fitted(text: str) -> str:
    """Return the scene with its constant, both as JSON text; results are cached."""
    tables = json.loads(text)
    wanted = tables.pop("measured")
    key, goal = wanted["solve_for"], wanted["restitution"]
    measured = _measurement(tables, wanted)
    found = None
    if not _static(measured):
        found = _polished(measured, key, goal)
    if found is None:
        close = CLOSE["static" if _static(measured) else "dynamic"]
        found = _solved(measured, key, goal, close)
    tables["plate"][key] = found
    return json.dumps(tables)


def _polished(tables: dict[str, Any], key: str, goal: float) -> float | None:
    """Return the value of the constant from a search with a large tolerance, then made accurate.

    A simulation to the tolerance of the measurement may take seconds; few of them are needed near
    the solution. None if they do not lead to it.
    """
    loose = tables | {"accuracy": tables.get("accuracy", {}) | {"rtol": LOOSE}}
    _lossless(loose, key, goal, 1.0)
    try:
        x = math.log(_solved(loose, key, goal, ROUGH))
    except UnreachedError as error:
        if goal < error.least:
            raise
        return None
    except SceneError:
        return None
    off, change = math.inf, NEAR if key == "retardation_time" else -NEAR
    for _ in range(POLISHES):
        try:
            trial = _accurate(tables, key, math.exp(x))
        except SceneError:
            return None
        # The results have at least about the error of the measurement, and that of the constant.
        _check_error(tables, DYNAMIC * trial.bound, trial.bound)
        before, off = off, trial.restitution / goal - 1.0
        if abs(off) <= AGREES * trial.bound:
            return math.exp(x)
        change *= math.copysign(1.0, off) if math.isinf(before) else off / (before - off or off)
        if not abs(change) < FURTHEST:
            return None
        x += change
    return None


def error_of(scene: "Scene") -> float:
    """Return the estimated relative error of the results due to the fitted constant [1].

    Without plate inertia it is the error of the constant: the results change at most about as much.
    With plate inertia the measurement has errors of the same size as the results.
    """
    assert scene.measured is not None
    key, tables = scene.measured.solve_for, scene.to_json()
    measured, value = _measurement(tables, tables.pop("measured")), solved(scene)
    static = _static(measured)
    found = (_simulated if static else _accurate)(measured, key, value)
    error = found.bound + abs(found.restitution / scene.measured.restitution - 1.0)
    if not static:
        return DYNAMIC * error
    changed = _simulated(measured, key, (1.0 + CHANGE) * value)
    return error * CHANGE / abs(math.log(changed.restitution / found.restitution))


def _check_error(tables: dict[str, Any], error: float, others: float) -> None:
    """Raise an error if a constant from a measurement is not accurate enough for the results.

    Parameters
    ----------
    error, others
        Error of the results due to the constant, and their other errors [1].
    """
    rtol = tables["accuracy"]["rtol"] if "accuracy" in tables else math.inf
    if error + others > rtol:
        raise inaccurate_constant(error + others, error, rtol)


def inaccurate_constant(bound: float, error: float, rtol: float) -> SceneError:
    """Return the error of a constant that is not accurate enough for a tolerance.

    Parameters
    ----------
    bound
        Error bound of the results [1].
    error
        Their error due to the constant [1].
    rtol
        Their tolerance [1].
    """
    return SceneError(
        f"accuracy.rtol: expected at least {rounded_up(bound)}, because the constant from the "
        f"measured restitution causes an error of {rounded_up(error)}, got {rtol:g}; increase the "
        f"tolerance to {rounded_up(ENOUGH * bound)}, or give the constant instead of [measured]"
    )


def _static(measured: dict[str, Any]) -> bool:
    """Return whether a measurement is without plate inertia."""
    wanted = measured.get("effects", {})
    return any(effect.dynamic and wanted.get(effect.name) is False for effect in BY_NAME.values())


def _measurement(tables: dict[str, Any], wanted: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of the measurement: the impact on a thick block or on the plate."""
    speed = wanted.get("tested_at", tables["impact"]["speed"])
    scene = tables | {"impact": tables["impact"] | {"speed": speed}}
    if wanted.get("target", "block") == "plate":
        if _static(scene):
            return scene | {"accuracy": {"rtol": STATIC_RTOL}}
        return scene
    size = BLOCK * tables["sphere"]["radius"]
    shape = "radius", "thickness", "half_thickness", "edge", "tensile_strength"
    block = {k: v for k, v in tables["plate"].items() if k not in shape}
    block |= {"radius": size, "thickness": 2.0 * size}
    still = dict.fromkeys(("bending", "finite_thickness", "finite_radius", "edge"), False)
    local = "sphere_elasticity", "spherical_profile"
    effects = {k: v for k, v in tables.get("effects", {}).items() if k in local}
    effects |= still | {"inertia": False, "non_hertzian_pressure": False}
    kept = {k: v for k, v in scene.items() if k in ("sphere", "materials")}
    made = {"plate": block, "effects": effects, "impact": {"speed": speed}}
    return kept | made | {"accuracy": {"rtol": STATIC_RTOL}}


def _accurate(tables: dict[str, Any], key: str, value: float) -> Trial:
    """Simulate a measurement with plate inertia, more accurately if the results require it."""
    trial = _simulated(tables, key, value)
    if "accuracy" not in tables:
        return trial
    rtol = tables["accuracy"]["rtol"]
    if DYNAMIC * trial.bound <= PART * rtol or trial.bound > rtol:  # or the tolerance cannot be met
        return trial
    finer = tables["accuracy"] | {"rtol": max(TIGHTEST, rtol / FINER)}
    return _simulated(tables | {"accuracy": finer}, key, value)


def _simulated(tables: dict[str, Any], key: str, value: float | None) -> Trial:
    """Simulate the impact with a trial value; without one, the effect of the constant is off.

    With plate inertia the error may exceed the tolerance: that of the last trial counts.
    """
    from derivation.scene.impact import selected_effects
    from derivation.scene.limits import check_radius
    from derivation.scene.method_selection import solve_selected
    from derivation.scene.scene import read

    effects = tables.get("effects", {}) | {EFFECTS[key]: value is not None}
    plate = tables["plate"] | ({} if value is None else {key: value})
    rtol, selected = selected_effects(read(tables | {"plate": plate, "effects": effects}))
    numbers, accuracy = solve_selected(selected, rtol, within=_static(tables))
    time, _, _, a, restitution = numbers
    law = selected.law
    check_radius(law, a, "impact.speed", "reduce the speed")
    return Trial(time, restitution, min(law.max_pressure(a), law.pressure_limit), accuracy.bound)


def _lossless(tables: dict[str, Any], key: str, goal: float, margin: float = 0.0) -> Trial:
    """Return the measurement without energy loss in the contact.

    Parameters
    ----------
    margin
        Factor on the error bound by which the measured restitution may exceed that one.

    Raises
    ------
    SceneError
        If its restitution does not exceed the measured one.
    """
    trial = _simulated(tables, key, None)
    most = trial.restitution * (1.0 + margin * trial.bound)
    if goal < most:
        return trial
    raise SceneError(
        f"measured.restitution: expected less than {most:.{3 if margin else 6}g}, the restitution "
        f"without energy loss in the contact, got {goal:.6g}; correct measured.restitution or "
        "measured.target"
    )


def _solved(tables: dict[str, Any], key: str, goal: float, close: float) -> float:
    """Return the value of the constant at which the restitution agrees with the measurement.

    Raises
    ------
    SceneError
        If the restitution exceeds that without energy loss in the contact, or no trial value
        encloses it.
    """
    from scipy.optimize import brentq

    lossless = _lossless(tables, key, goal)

    least = math.inf

    def above(x: float) -> float:
        nonlocal least
        try:
            trial = _simulated(tables, key, math.exp(x))
            least = min(least, trial.restitution * (1.0 - trial.bound))
            return trial.restitution - goal
        except SceneError as error:
            raise SceneError(
                "measured.restitution: expected a value that can be computed, got "
                f"{goal:.6g}, for which the simulation of the measurement fails with plate.{key} = "
                f"{math.exp(x):.6g} {UNITS[key]} ({str(error).partition(';')[0]}); correct "
                "measured.restitution or measured.target"
            ) from None

    first = lossless.max_pressure if key == "yield_stress" else EARLY * lossless.contact_time
    more = -math.log(FACTOR) if key == "yield_stress" else math.log(FACTOR)
    x = math.log(first)
    # Towards a larger energy loss if the restitution is too large, else towards a smaller one.
    now, rising = above(x), 0
    step = more if now > 0.0 else -more
    for _ in range(STEPS):
        before, now = now, above(x + step)
        if now * step * more <= 0.0:
            break
        # An elastic plate under a contact that hardly moves returns the energy again.
        rising = rising + 1 if step == more and now > before else 0
        if rising == RISING:
            raise UnreachedError(
                f"measured.restitution: expected at least the smallest restitution that a "
                f"plate.{key} gives, got {goal:.6g}, but it increases again from "
                f"{goal + before:.6g} at {math.exp(x):.6g} {UNITS[key]}; correct "
                "measured.restitution or measured.target",
                least,
            )
        x += step
    else:
        raise SceneError(
            f"measured.restitution: expected a value that some plate.{key} gives, got {goal:.6g}, "
            f"which no value from {first:.6g} to {math.exp(x):.6g} {UNITS[key]} gives; correct it, "
            "or change measured.solve_for"
        )
    return math.exp(float(brentq(above, x, x + step, xtol=close)))
