"""The material constant that a measured restitution determines, and the bodies that have it."""

from collections.abc import Mapping
from typing import Any

from derivation.scene.input.settings import BODIES

UNITS = {"yield_stress": "Pa", "retardation_time": "s"}
EFFECTS = {"yield_stress": "plasticity", "retardation_time": "viscosity"}
"""The effect of each constant."""
LOSSLESS = {"yield_stress": 1e30, "retardation_time": 1e-30}
"""Value of each constant at which a body loses no energy by it: the limits of the keys."""


def name_of(key: str, body: str) -> str:
    """Return the name of a constant in messages; `body` is that of the table `measured`."""
    return f"{key} of sphere and plate" if body == "both" else f"{body}.{key}"


def with_constant(
    tables: Mapping[str, Any], key: str, body: str, value: float | None
) -> dict[str, Any]:
    """Return the tables of a scene with a value of the constant; without one, no energy is lost."""
    given = {key: LOSSLESS[key] if value is None else value}
    return dict(tables) | {one: tables[one] | given for one in BODIES[body]}
