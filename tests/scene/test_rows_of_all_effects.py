"""Random scenes with every combination of static effects: each row equals its simulation."""

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from test_rows import check

from derivation.scene import SceneError, read
from derivation.scene.rows.rows import solve
from derivation.scene.scene import OUTPUTS, Scene
from generated.arrays import Double as Array

ROWS = 3
FORCED = (
    "sphere_elasticity", "spherical_profile", "bending", "finite_thickness", "finite_radius",
    "edge", "gravity",
)  # fmt: skip
"""Effects that scenes enable or disable."""
TOLERANCES = [None, 0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-9, 1e-12, 1e-13]
EXTREME = [0.0, -1.0, np.nan, 1e300, 1e-300]
Study = tuple[Scene, dict[str, Array], float | None]


def log_uniform(low: float, high: float) -> st.SearchStrategy[float]:
    """Draw numbers whose logarithms are uniform."""
    return st.floats(np.log10(low), np.log10(high)).map(lambda x: float(10.0**x))


def sometimes(draw: st.DrawFn, table: dict[str, Any], key: str, low: float, high: float) -> None:
    """Give a key in about half of the scenes."""
    if draw(st.booleans()):
        table[key] = draw(log_uniform(low, high))


@st.composite
def tables(draw: st.DrawFn) -> dict[str, dict[str, Any]]:
    """Draw an impact on a quasi-static plate, whose contact may yield or be viscoelastic."""
    R = draw(log_uniform(1e-3, 5e-2))
    b = R * draw(log_uniform(2.0, 100.0))
    sphere: dict[str, Any] = {"radius": R, "material": "steel"}
    if draw(st.booleans()):
        sphere = {"radius": R, "mass": 3e4 * R**3 * draw(log_uniform(0.1, 10.0))}
    sometimes(draw, sphere, "yield_stress", 1e8, 1e10)
    plate: dict[str, Any] = {
        "radius": b,
        "half_thickness": b * draw(log_uniform(3e-3, 1.0)),
        "edge": draw(st.sampled_from(["paper", "simply-supported", "clamped"])),
        "material": "pane",
    }
    sometimes(draw, plate, "tensile_strength", 1e6, 1e10)
    pane = {"youngs_modulus": draw(log_uniform(1e8, 2e11)), "density": 2400.0}
    pane["poissons_ratio"] = draw(st.floats(-0.2, 0.49))
    sometimes(draw, pane, "retardation_time", 1e-7, 1e-4)
    impact = {"speed": draw(log_uniform(1e-3, 3.0))}
    sometimes(draw, impact, "gravity", 1.0, 1e3)
    choice = st.sampled_from(["auto", "auto", "auto", True, False])
    effects = {name: draw(choice) for name in FORCED} | {"inertia": False}
    effects["non_hertzian_pressure"] = draw(st.sampled_from(["auto", "auto", True, False, False]))
    if "yield_stress" in sphere:
        effects["plasticity"] = draw(choice)
    if "retardation_time" in pane:
        effects["viscosity"] = draw(choice)
    return {
        "sphere": sphere, "plate": plate, "impact": impact, "effects": effects,
        "materials": {"pane": pane},
    }  # fmt: skip


@st.composite
def studies(draw: st.DrawFn) -> Study:
    """Draw a scene, columns of one to three of its keys, and a tolerance."""
    data = draw(tables())
    keys = {f"{table}.{key}": value for table in ("sphere", "plate", "impact")
            for key, value in data[table].items() if isinstance(value, float)}  # fmt: skip
    pane: Any = data["materials"]["pane"]
    keys |= {f"materials.pane.{key}": value for key, value in pane.items()}
    columns = {}
    for key in draw(st.lists(st.sampled_from(sorted(keys)), min_size=1, max_size=3, unique=True)):
        factors = draw(st.lists(log_uniform(0.3, 3.0), min_size=ROWS, max_size=ROWS))
        columns[key] = keys[key] * np.array(factors)
        if draw(st.integers(0, 9)) == 0:
            columns[key][draw(st.integers(0, ROWS - 1))] = draw(st.sampled_from(EXTREME))
    rtol = draw(st.sampled_from(TOLERANCES))
    if rtol is not None and draw(st.booleans()):  # as a key of the scene
        outputs = draw(st.lists(st.sampled_from(OUTPUTS), min_size=1, max_size=2, unique=True))
        data["accuracy"] = {"rtol": rtol, "outputs": outputs}
        rtol = None
    try:
        scene = read(data)
    except SceneError:  # an effect is enabled that does not apply
        assume(False)
        raise
    return scene, columns, rtol


@pytest.mark.one_version
@given(studies())
@settings(max_examples=60)
def test_each_row_equals_its_simulation(study: Study) -> None:
    check(*study)


def test_two_effects_without_a_bound_give_no_warning_of_numpy() -> None:
    """In a strongly viscoelastic contact plate inertia and damping have no bound."""
    scene = read(
        {
            "sphere": {"radius": 0.007, "material": "PMMA"},
            "plate": {"radius": 0.09, "thickness": 0.0036, "material": "rubber",
                      "retardation_time": 1e-2, "loss_factor": 0.1},
            "impact": {"speed": 1.0},
        }
    )  # fmt: skip
    solution = solve(scene, {"impact.speed": np.array([1.0])}, 0.03)
    assert solution.status[0] == "rejected"
