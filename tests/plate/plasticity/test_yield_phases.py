"""Test quadratures of plastic impacts against time elements, and rows against single scenes."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from derivation.scene import SceneError, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.impact import selected_effects
from derivation.scene.quasi_static import plastic, yield_phases
from derivation.scene.result import UNITS
from derivation.scene.rows import rows as many
from derivation.scene.selection.method_selection import moved
from generated.arrays import Double as Array

BALL: dict[str, Any] = {"radius": 0.01, "material": "steel", "yield_stress": 1e9}
FORCED = {"inertia": False, "plasticity": True}


def scene_on(plate: dict[str, Any], speed: float, **effects: Any) -> dict[str, Any]:
    """Return the tables of a scene with plasticity."""
    table = {"material": "steel", "yield_stress": 1e9} | plate
    return {"sphere": BALL, "plate": table, "impact": {"speed": speed}, "effects": FORCED | effects}


def law_of(tables: dict[str, Any]) -> ContactLaw:
    """Return the contact law of a scene."""
    return selected_effects(read(tables))[1].law


def log_uniform(low: float, high: float) -> st.SearchStrategy[float]:
    """Draw numbers whose logarithms are uniform."""
    return st.floats(math.log(low), math.log(high)).map(math.exp)


@st.composite
def scenes(draw: st.DrawFn) -> dict[str, Any]:
    """Draw an impact whose contact may yield."""
    R = draw(log_uniform(1e-3, 5e-2))
    b = R * draw(log_uniform(2.0, 100.0))
    E = draw(log_uniform(1e8, 3e11))
    sphere = {"radius": R, "density": draw(log_uniform(500.0, 1e4))}
    if draw(st.booleans()):
        sphere |= {"youngs_modulus": draw(log_uniform(1e8, 3e11)), "poissons_ratio": 0.3}
    plate = {
        "radius": b,
        "half_thickness": b * draw(log_uniform(3e-3, 1.0)),
        "youngs_modulus": E,
        "poissons_ratio": draw(st.floats(-0.2, 0.49)),
        "yield_stress": E * draw(log_uniform(1e-4, 3e-2)),
        "edge": draw(st.sampled_from(["paper", "clamped", "simply-supported"])),
    }
    impact = {"speed": draw(log_uniform(1e-4, 30.0))}
    return {"sphere": sphere, "plate": plate, "impact": impact, "effects": FORCED}


@pytest.mark.one_version
@settings(max_examples=25)
@given(scenes())
def test_quadratures_agree_with_time_elements(tables: dict[str, Any]) -> None:
    law = law_of(tables)
    try:
        with np.errstate(all="ignore"):
            actual, expected = moved(law), plastic.by_time_elements(law)
    except SceneError:
        assume(False)
        raise
    allowed = actual.quadrature + expected.quadrature + 2.0 * plastic.ROUNDING
    np.testing.assert_allclose(actual.numbers, expected.numbers, rtol=allowed)
    assert actual.dent == pytest.approx(expected.dent, rel=1e-8)
    assert actual.energy_balance is not None
    assert abs(actual.energy_balance.residual) <= actual.quadrature + 1e-15


def speed_of_yield(plate: dict[str, Any]) -> float:
    """Return the lowest speed at which the quadratures of an impact find yield."""
    low, high = 1e-3, 20.0
    while (speed := 0.5 * (low + high)) not in (low, high):
        law = law_of(scene_on(plate, speed))
        with np.errstate(all="ignore"):
            yields = np.isfinite(yield_phases.yielded(law, 24).ratio.item())
        low, high = (low, speed) if yields else (speed, high)
    return high


PLATES = [
    {"radius": 0.3, "thickness": 0.3},
    {"radius": 0.3, "thickness": 0.01, "edge": "clamped"},
    {"radius": 0.3, "thickness": 0.01},
]


@pytest.mark.parametrize("plate", PLATES)
def test_impacts_that_just_yield_are_insensitive_to_rounding(plate: dict[str, Any]) -> None:
    """The times up to the onset of yield and after it change as the root of the excess energy."""
    onset = speed_of_yield(plate)
    below = moved(law_of(scene_on(plate, onset * (1.0 - 1e-13))))
    assert below.dent == 0.0
    for excess in 1e-13, 1e-12, 1e-10, 1e-8:
        above = moved(law_of(scene_on(plate, onset * (1.0 + excess))))
        assert above.quadrature <= 1e-13
        np.testing.assert_allclose(above.numbers, below.numbers, rtol=3e-13 + 4.0 * excess)


def test_yield_beyond_the_range_of_the_law_leaves_an_elastic_contact() -> None:
    hard = scene_on(PLATES[1] | {"yield_stress": 1e15}, 1.0, non_hertzian_pressure=False)
    hard["sphere"] = BALL | {"yield_stress": 1e15}
    law = law_of(hard)
    assert yield_phases.onset_in(law).a.item() == math.inf
    elastic = read(hard | {"effects": hard["effects"] | {"plasticity": False}})
    assert moved(law).max_force == pytest.approx(simulate(elastic).max_force, rel=1e-14)


def never(*_: object, **__: object) -> None:
    """Fail if a single scene is simulated."""
    raise AssertionError("a row was not computed in arrays")


@pytest.mark.parametrize("plate", [*PLATES, {"radius": 0.3, "thickness": 0.02,
                                             "edge": "simply-supported"}])  # fmt: skip
@pytest.mark.parametrize("rtol", [None, 0.1, 1e-6])
def test_rows_with_yield_are_computed_in_arrays_and_equal_simulations(
    plate: dict[str, Any], rtol: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    tables = scene_on(plate, 1.0, plasticity="auto")
    speeds: Array = np.geomspace(2e-3, 30.0, 9)
    columns = {"impact.speed": speeds, "plate.yield_stress": np.geomspace(2e9, 4e8, 9)}
    with monkeypatch.context() as patched:
        patched.setattr(many, "simulate", never)
        found = many.solve(read(tables), columns, rtol)
    assert any("plasticity" in effects for effects in found.effects)
    assert any(found.results["restitution"] < 0.9)
    for row, (speed, stress) in enumerate(zip(*columns.values(), strict=True)):
        one_plate = tables["plate"] | {"yield_stress": float(stress)}
        given_scene = tables | {"plate": one_plate, "impact": {"speed": float(speed)}}
        one = simulate(read(given_scene), rtol=rtol)
        assert found.effects[row] == " ".join(one.effects.included)
        assert found.reason[row] == "; ".join(one.warnings)
        assert (found.bound[row], found.model_error[row]) == (one.accuracy.bound, one.model_error)
        for name in UNITS:
            assert found.results[name][row] == getattr(one, name), name
