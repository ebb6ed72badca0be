"""The specimen on which a restitution was measured: a thick block, or the plate itself."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from derivation.scene.measured.measurement import STATIC_RTOL, Measurement

BLOCK = 1e4
"""Radius and half-thickness of the block over the sphere radius."""


def measurement_of(tables: Mapping[str, Any], wanted: Mapping[str, Any]) -> Measurement:
    """Return the measurement on a thick block or on the plate, from the tables of a scene."""
    key, goal, body = wanted["solve_for"], wanted["restitution"], wanted.get("body", "plate")
    speed = wanted.get("tested_at", tables["impact"]["speed"])
    scene = dict(tables) | {"impact": tables["impact"] | {"speed": speed}}
    if wanted.get("target", "block") == "plate":
        on_plate = _with_one_plate(Measurement(scene, key, goal, body=body))
        return on_plate.to(STATIC_RTOL) if on_plate.static else on_plate
    size = BLOCK * tables["sphere"]["radius"]
    shape = "radius", "thickness", "half_thickness", "edge", "tensile_strength"
    block = {k: v for k, v in tables["plate"].items() if k not in shape}
    block |= {"radius": size, "thickness": 2.0 * size}
    still = dict.fromkeys(("bending", "finite_thickness", "finite_radius", "edge"), False)
    local = "sphere_elasticity", "spherical_profile", "gravity"
    effects = {k: v for k, v in tables.get("effects", {}).items() if k in local}
    effects |= still | {"inertia": False, "non_hertzian_pressure": False}
    kept = {k: v for k, v in scene.items() if k in ("sphere", "materials")}
    made = {"plate": block, "effects": effects, "impact": scene["impact"]}
    return Measurement(kept | made, key, goal, body=body).to(STATIC_RTOL)


def _with_one_plate(measured: Measurement) -> Measurement:
    """Return the measurement on a plate that stretches for all values of the constant, or none."""
    from derivation.scene.impact import selected_effects

    lossless = measured.scene(None)
    if not lossless.effects.may_stretch:
        return measured
    stretching = selected_effects(lossless)[1].law.stretches
    effects = measured.tables.get("effects", {}) | {"stretching": stretching}
    return replace(measured, tables=dict(measured.tables) | {"effects": effects})
