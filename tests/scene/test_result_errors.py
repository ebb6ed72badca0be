"""Errors and digits of single results, including those to which no tolerance applies."""

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

from derivation.scene import read, simulate
from derivation.scene.output.answer import plain
from derivation.scene.rows.rows import solve
from derivation.scene.scene import OUTPUTS

BALL = {"radius": 0.01, "material": "steel"}
PANE = {"radius": 0.1, "thickness": 0.01, "material": "glass", "edge": "clamped"}
STILL = {"inertia": False}


def scene(plate: dict[str, Any], speed: float = 1.0, **tables: Any) -> Any:
    tables = {"effects": STILL} | tables
    return read({"sphere": BALL, "plate": PANE | plate, "impact": {"speed": speed}} | tables)


@pytest.mark.parametrize("requested", OUTPUTS)
@pytest.mark.parametrize("rtol", [3e-3, 0.3])
def test_other_outputs_have_bounds_of_their_own(requested: str, rtol: float) -> None:
    """An earlier version showed 12 digits of the force, because the restitution is exact."""
    plate, accuracy = {"thickness": 0.004}, {"rtol": rtol, "outputs": [requested]}
    reference, result = simulate(scene(plate)), simulate(scene(plate, accuracy=accuracy))
    for name in (*OUTPUTS, "max_pressure", "max_tensile_stress"):
        error = abs(getattr(result, name) / getattr(reference, name) - 1.0)
        assert error <= result.bound_of(name) + reference.accuracy.bound
    rows = dict(line.split()[:2] for line in plain(result).splitlines())
    for name in OUTPUTS:  # at most the last digit but one is wrong
        if rows[name] != "unknown":
            shown = float(rows[name]) / getattr(reference, name) - 1.0
            assert abs(shown) < 10.0 * max(result.bound_of(name), result.model_errors[name], 0.05)


def test_outputs_without_a_digit_are_unknown() -> None:
    accuracy = {"rtol": 1e-3, "outputs": ["restitution"]}
    result = simulate(scene({"thickness": 0.004, "edge": "paper"}, accuracy=accuracy))
    assert result.effects.included == ("hertz",)
    assert result.accuracy.bound < 1e-10 < 1.0 < result.bound_of("max_force")
    assert "max force unknown" in " ".join(str(result).split())
    assert "which accuracy.outputs does not name" in " ".join(str(result).split())


def test_requested_outputs_keep_their_bound() -> None:
    result = simulate(scene({}), rtol=1e-2)
    assert {result.bound_of(name) for name in OUTPUTS} == {result.accuracy.bound}
    assert result.bound_of("max_pressure") == result.accuracy.pressure_bound
    some = simulate(scene({}, accuracy={"rtol": 1e-2, "outputs": ["max_indentation", "max_force"]}))
    changed = "change max indentation and max force by at most"
    assert changed in some.effects.summary
    assert any(changed in row.reason for row in some.effects.rows)


@pytest.mark.parametrize("requested", ["restitution", "max_force"])
def test_limits_are_compared_within_the_error_of_stress_and_pressure(requested: str) -> None:
    """Also in many rows at once, whose warnings are those of a single simulation."""
    accuracy = {"rtol": 0.05, "outputs": [requested]}
    found = simulate(scene({}, accuracy=accuracy))
    error = found.bound_of("max_tensile_stress") + found.tensile_stress.error
    limits = {
        "tensile_strength": found.max_tensile_stress * (1.0 + 0.5 * error),
        "yield_stress": found.max_pressure / 1.6 * (1.0 + 0.5 * found.bound_of("max_pressure")),
    }
    given = scene(limits, accuracy=accuracy, effects=STILL | {"plasticity": False})
    one = simulate(given)
    assert one.effects.included == found.effects.included
    assert any("may yield" in text for text in one.warnings)
    assert any("may fail" in text for text in one.warnings)
    rows = solve(given, {"impact.speed": np.array([1.0, 1.0])})
    assert rows.reason.tolist() == 2 * ["; ".join(one.warnings)]


@pytest.mark.parametrize("thickness", [0.02, 0.4])
def test_error_of_the_dent_covers_omitted_effects_near_the_onset_of_yield(
    thickness: float,
) -> None:
    """The dent is as the squared distance from the onset; an earlier bound was 0.035, not 1.6."""
    plate = {"thickness": thickness, "radius": 4.0 * thickness}
    elastic = simulate(scene(plate))
    plate["yield_stress"] = elastic.max_pressure / 1.6 / 1.02
    reference, result = simulate(scene(plate)), simulate(scene(plate), rtol=0.1)
    assert result.effects.law.plastic
    assert set(result.effects.included) < set(reference.effects.included)
    error = abs(result.dent / reference.dent - 1.0)
    assert result.accuracy.effects.bound < error <= result.bound_of("dent")
    assert result.bound_of("dent") < 1e3 * error


@pytest.mark.parametrize("beyond", [1.01, 1.03, 1.045])
def test_errors_of_pressure_and_dent_cover_omitted_plasticity(beyond: float) -> None:
    """An earlier version stated 1.7 % for an error of 3 % of the pressure, 0 for the dent."""
    plate = {"radius": 0.8, "thickness": 0.009, "youngs_modulus": 40e9, "poissons_ratio": 0.44}
    tables: dict[str, Any] = {
        "sphere": {"radius": 0.03, "density": 180.0},
        "plate": plate | {"edge": "clamped"},
        "impact": {"speed": 0.7},
        "effects": STILL,
    }
    tables["plate"]["yield_stress"] = simulate(read(tables)).max_pressure / 1.6 / beyond
    reference, result = simulate(read(tables)), simulate(read(tables), rtol=0.2)
    assert reference.effects.law.plastic
    assert not result.effects.law.plastic
    error = result.max_pressure / reference.max_pressure - 1.0
    assert result.accuracy.pressure_bound < error <= result.bound_of("max_pressure") + 1e-12
    assert result.bound_of("max_pressure") < 1.1 * error
    assert reference.dent > result.dent == 0.0
    assert math.isinf(result.bound_of("dent"))
    disabled = simulate(read(tables | {"effects": STILL | {"plasticity": False}}))
    assert disabled.bound_of("dent") == 0.0


def test_error_of_the_dent_is_twice_that_of_the_distance_from_the_onset() -> None:
    plate = {"thickness": 0.1}
    plate["yield_stress"] = simulate(scene(plate)).max_pressure / 1.6 / 1.01
    result = simulate(scene(plate))
    accuracy = result.accuracy
    worse = dataclasses.replace(accuracy, law=dataclasses.replace(accuracy.law, bound=3e-5))
    result = dataclasses.replace(result, accuracy=worse)
    without = dataclasses.replace(worse, effects=dataclasses.replace(worse.effects, bound=0.0))
    result = dataclasses.replace(result, accuracy=without)
    # The Hertz radius of the force is 1.01 times that at the onset of yield: 2 * 1e-5 * 1.01/0.01.
    assert result.bound_of("dent") == pytest.approx(2e-3, rel=0.2)
