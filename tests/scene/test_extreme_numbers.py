"""Extreme numbers: a scene gives results or an error with a remedy, never a warning of NumPy."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from derivation.scene import SceneError, explain, indent, read, simulate
from derivation.scene.rows.rows import solve

KEYS = (
    "sphere.radius", "sphere.mass", "sphere.youngs_modulus", "sphere.yield_stress",
    "sphere.retardation_time", "plate.radius", "plate.thickness", "plate.youngs_modulus",
    "plate.density", "plate.yield_stress", "plate.tensile_strength", "impact.speed",
    "impact.gravity",
)  # fmt: skip
"""Keys of a scene with positive numbers."""


def tables(**keys: float) -> dict[str, dict[str, Any]]:
    """Return a scene with other numbers."""
    scene: dict[str, dict[str, Any]] = {
        "sphere": {"radius": 0.01, "mass": 0.03, "youngs_modulus": 2e11, "poissons_ratio": 0.3},
        "plate": {
            "radius": 0.1, "thickness": 0.01, "density": 2500.0,
            "youngs_modulus": 7e10, "poissons_ratio": 0.2,
        },
        "impact": {"speed": 1.0},
    }  # fmt: skip
    for key, value in keys.items():
        table, name = key.split(".")
        scene[table][name] = value
    return scene


@pytest.mark.parametrize("key", KEYS)
@pytest.mark.parametrize("value", [0.9e-30, 1.1e30])
def test_numbers_beyond_the_limits_are_rejected_in_scenes_and_rows(key: str, value: float) -> None:
    if (key, value) == ("impact.gravity", 0.9e-30):
        return  # it may be zero
    least = "0" if key == "impact.gravity" else "1e-30"
    with pytest.raises(SceneError, match=f"expected a number from {least} to 1e\\+30") as error:
        read(tables(**{key: value}))
    rows = solve(read(tables()), {key: np.array([value])})
    assert rows.status[0] == "rejected"
    assert rows.reason[0] == str(error.value)


@given(
    st.dictionaries(st.sampled_from(KEYS), st.floats(-30, 30), min_size=1, max_size=8),
    st.sampled_from(["paper", "clamped", "simply-supported"]),
    st.sampled_from(["simulate", "explain", "indent"]),
)
@example({"plate.yield_stress": -12.0}, "paper", "simulate")
@example({"plate.thickness": -29.9}, "simply-supported", "simulate")
@settings(max_examples=60)
def test_extreme_scenes_give_numbers_or_an_error(
    exponents: dict[str, float], edge: str, command: str
) -> None:
    scene = tables(**{key: 10.0**exponent for key, exponent in exponents.items()})
    scene["plate"]["edge"] = edge
    words = ""
    try:
        if command == "explain":
            assert str(explain(read(scene)))
        elif command == "indent":
            assert 0.0 < indent(read(scene), force=1.0)[0].indentation < math.inf
        else:
            result = simulate(read(scene | {"effects": {"inertia": False}}))
            assert not result.complete or 0.0 < result.max_force < math.inf
    except SceneError as error:
        words = str(error)
    assert not words or "; " in words  # what is expected, and what to do


def test_force_that_underflows_is_rejected() -> None:
    """It was a division by zero."""
    with pytest.raises(SceneError, match="no finite number"):
        indent(read(tables()), force=1e-320)


def test_arrays_without_a_dimension_are_numbers() -> None:
    """A tolerance was rejected as outside of its own range, and a force could not be iterated."""
    scene = read(tables(**{"plate.thickness": 0.1}))
    assert simulate(scene, rtol=np.array(0.01)).max_force == simulate(scene, rtol=0.01).max_force
    assert indent(scene, force=np.array(5.0))[0] == indent(scene, force=5.0)[0]
