"""Determines the yield stress or retardation time of the plate from a measured restitution.

The restitution was measured on a thick block, which does not vibrate, or on the plate itself. The
impact is simulated repeatedly until the restitution agrees. The solution is unique, because
restitution decreases with decreasing yield stress and with increasing retardation time.
"""

import json
import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any

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
CLOSE = {"block": 1e-9, "plate": 1e-4}
"""Relative accuracy of the constant by specimen [1]; with plate inertia the restitution is less
smooth."""
BLOCK_RTOL = 1e-8
"""Relative tolerance of impacts on a block [1]."""


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
    close = CLOSE[wanted.get("target", "block")]
    tables["plate"][key] = _solved(measured, key, goal, close)
    return json.dumps(tables)


def _measurement(tables: dict[str, Any], wanted: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of the measurement: the impact on a thick block or on the plate."""
    speed = wanted.get("tested_at", tables["impact"]["speed"])
    scene = tables | {"impact": tables["impact"] | {"speed": speed}}
    if wanted.get("target", "block") == "plate":
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
    return kept | made | {"accuracy": {"rtol": BLOCK_RTOL}}


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
    step = more if above(x) > 0.0 else -more
    for _ in range(STEPS):
        if above(x + step) * step * more <= 0.0:
            break
        x += step
    else:
        raise SceneError(
            f"measured.restitution: expected a value that some plate.{key} gives, got {goal:.6g}, "
            f"which no value from {first:.6g} to {math.exp(x):.6g} {UNITS[key]} gives; correct it, "
            "or change measured.solve_for"
        )
    return math.exp(float(brentq(above, x, x + step, xtol=close)))
