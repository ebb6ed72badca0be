"""A measured restitution: the yield stress or retardation time of the plate that gives it.

The restitution that is measured on a thick block, which takes no energy as a plate does, or on the
plate itself is met by simulating that impact again and again. It falls as the plate yields earlier
or its contact is more viscous, so that the value is the only one.
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
"""Digits of the value that are shown."""
BLOCK = 1e4
"""Size of the block over the sphere radius: it neither bends nor ends."""
EFFECTS = {"yield_stress": "plasticity", "retardation_time": "viscosity"}
"""The effect that a quantity belongs to."""
EARLY = 1e-2
"""Retardation time over contact time that is tried first."""
STEPS, FACTOR = 40, 2.0
"""How many values are tried until the one looked for lies between two, and how far apart they
are."""
CLOSE = {"block": 1e-9, "plate": 1e-4}
"""Relative accuracy of the value found [1]: a moving plate's restitution is not smoother."""
BLOCK_RTOL = 1e-8
"""Relative tolerance of impacts on a block [1]."""


def fitted(scene: "Scene") -> "Scene":
    """The scene with the value that its measured restitution tells, and without the measurement.

    Raises
    ------
    SceneError
        If no value gives the restitution, or an impact on the way is refused.
    """
    from derivation.scene.scene import read

    return read(json.loads(_fitted(json.dumps(scene.to_json()))))


def solved(scene: "Scene") -> float:
    """The value that the measured restitution of a scene tells [Pa or s]."""
    assert scene.measured is not None
    return float(fitted(scene).plate.model_dump()[scene.measured.solve_for])


def in_words(scene: "Scene") -> str:
    """The same in a sentence."""
    wanted = scene.measured
    assert wanted is not None
    value, unit = prefixed(solved(scene), UNITS[wanted.solve_for], DIGITS)
    struck = "a thick block" if wanted.target == "block" else "the plate"
    return (
        f"plate.{wanted.solve_for} = {value} {unit}, from the restitution "
        f"{wanted.restitution:g} of {struck} at {wanted.tested_at or scene.impact.speed:g} m/s"
    )


@lru_cache(maxsize=64)
def _fitted(text: str) -> str:
    """The same of scenes as JSON."""
    tables = json.loads(text)
    wanted = tables.pop("measured")
    key, goal = wanted["solve_for"], wanted["restitution"]
    measured = _measurement(tables, wanted)
    close = CLOSE[wanted.get("target", "block")]
    tables["plate"][key] = _solved(measured, key, goal, close)
    return json.dumps(tables)


def _measurement(tables: dict[str, Any], wanted: dict[str, Any]) -> dict[str, Any]:
    """The scene of the measurement."""
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
    """The impact with a value of the plate's, or without loss in the contact."""
    from derivation.scene.impact import simulate
    from derivation.scene.scene import read

    effects = tables.get("effects", {}) | {EFFECTS[key]: value is not None}
    plate = tables["plate"] | ({} if value is None else {key: value})
    return simulate(read(tables | {"plate": plate, "effects": effects}))


def _solved(tables: dict[str, Any], key: str, goal: float, close: float) -> float:
    """The value at which the restitution is the one measured.

    What the contact takes grows as the yield stress falls below its pressure, and with the
    retardation time.
    """
    from scipy.optimize import brentq

    lossless = _simulated(tables, key, None)
    if not goal < lossless.restitution:
        raise SceneError(
            f"measured.restitution: expected less than {lossless.restitution:.6g}, which is left "
            f"without any loss in the contact, got {goal:.6g}; correct it, or the target"
        )

    def above(x: float) -> float:
        return _simulated(tables, key, math.exp(x)).restitution - goal

    first = lossless.max_pressure if key == "yield_stress" else EARLY * lossless.contact_time
    more = -math.log(FACTOR) if key == "yield_stress" else math.log(FACTOR)
    x = math.log(first)
    # Towards a larger loss as long as too little is taken, else towards a smaller one.
    step = more if above(x) > 0.0 else -more
    for _ in range(STEPS):
        if above(x + step) * step * more <= 0.0:
            break
        x += step
    else:
        raise SceneError(
            f"measured.restitution: expected one that some {key} gives, got {goal:.6g}, which none "
            f"gave up to {math.exp(x):.6g}; correct it, or solve for the other quantity"
        )
    return math.exp(float(brentq(above, x, x + step, xtol=close)))
