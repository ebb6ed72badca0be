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
from typing import TYPE_CHECKING, Any

from derivation.scene.effects import BY_NAME
from derivation.scene.errors import SceneError
from derivation.scene.quantity import prefixed

if TYPE_CHECKING:
    from derivation.scene.result import Result
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
CHANGE, DYNAMIC = 1e-2, 3.0
"""Relative change of the constant that gives the sensitivity of a measurement without plate
inertia; and error of the results over that of one with plate inertia, an estimate."""


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
    close = CLOSE["static" if _static(measured) else "dynamic"]
    tables["plate"][key] = _solved(measured, key, goal, close)
    return json.dumps(tables)


def error_of(scene: "Scene") -> float:
    """Return the estimated relative error of the results due to the fitted constant [1].

    Without plate inertia it is the error of the constant: the results change at most about as much.
    With plate inertia the measurement has errors of the same size as the results.
    """
    assert scene.measured is not None
    key, tables = scene.measured.solve_for, scene.to_json()
    measured, value = _measurement(tables, tables.pop("measured")), solved(scene)
    found = _simulated(measured, key, value)
    error = found.accuracy.bound + abs(found.restitution / scene.measured.restitution - 1.0)
    if not _static(measured):
        return DYNAMIC * error
    changed = _simulated(measured, key, (1.0 + CHANGE) * value)
    return error * CHANGE / abs(math.log(changed.restitution / found.restitution))


def _static(measured: dict[str, Any]) -> bool:
    """Return whether a measurement is without plate inertia."""
    wanted = measured.get("effects", {})
    return any(effect.dynamic and wanted.get(effect.name) is False for effect in BY_NAME.values())


def _measurement(tables: dict[str, Any], wanted: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of the measurement: the impact on a thick block or on the plate."""
    speed = wanted.get("tested_at", tables["impact"]["speed"])
    scene = tables | {"impact": tables["impact"] | {"speed": speed}}
    if wanted.get("target", "block") == "plate":
        return scene | ({"accuracy": {"rtol": STATIC_RTOL}} if _static(scene) else {})
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


def _simulated(tables: dict[str, Any], key: str, value: float | None) -> "Result":
    """Simulate the impact with a trial value; without one, the effect of the constant is off."""
    from derivation.scene.impact import simulate
    from derivation.scene.scene import read

    effects = tables.get("effects", {}) | {EFFECTS[key]: value is not None}
    plate = tables["plate"] | ({} if value is None else {key: value})
    return simulate(read(tables | {"plate": plate, "effects": effects}))


def _solved(tables: dict[str, Any], key: str, goal: float, close: float) -> float:
    """Return the value of the constant at which the restitution agrees with the measurement.

    Raises
    ------
    SceneError
        If the restitution exceeds that without energy loss in the contact, or no trial value
        encloses it.
    """
    from scipy.optimize import brentq

    lossless = _simulated(tables, key, None)
    if not goal < lossless.restitution:
        raise SceneError(
            f"measured.restitution: expected less than {lossless.restitution:.6g}, the restitution "
            f"without energy loss in the contact, got {goal:.6g}; correct measured.restitution or "
            "measured.target"
        )

    def above(x: float) -> float:
        try:
            return _simulated(tables, key, math.exp(x)).restitution - goal
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
            raise SceneError(
                f"measured.restitution: expected at least the smallest restitution that a "
                f"plate.{key} gives, got {goal:.6g}, but it increases again from "
                f"{goal + before:.6g} at {math.exp(x):.6g} {UNITS[key]}; correct "
                "measured.restitution or measured.target"
            )
        x += step
    else:
        raise SceneError(
            f"measured.restitution: expected a value that some plate.{key} gives, got {goal:.6g}, "
            f"which no value from {first:.6g} to {math.exp(x):.6g} {UNITS[key]} gives; correct it, "
            "or change measured.solve_for"
        )
    return math.exp(float(brentq(above, x, x + step, xtol=close)))
