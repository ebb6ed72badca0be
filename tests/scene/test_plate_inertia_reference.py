"""Impacts with plate inertia compared with infinite plates and finite elements."""

import json
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import derivation.scene
from derivation.engine.files import measurements
from derivation.scene import SceneError, indent, read, simulate
from derivation.scene.contact_law.edge_remainder import edge_remainder
from derivation.scene.dynamic.model_error import inertia_error
from derivation.scene.model import model_of
from derivation.scene.result import Result
from derivation.scene.scene import OUTPUTS
from generated.edge_modes import clamped_waves, supported_waves

pytestmark = pytest.mark.one_version

EXAMPLES = Path(derivation.scene.__file__).parent / "examples"
EDGES = ("paper", "simply-supported", "clamped")
DATA = json.loads((measurements() / "elastodynamics.json").read_text())
COMPARED = tuple(name for name in OUTPUTS if name != "max_contact_radius")
"""Results that are compared: finite elements give the contact radius only to a node."""


def pane(b: float, thickness: float, **plate: Any) -> Mapping[str, Any]:
    return {
        "sphere": {"radius": 0.01, "material": "steel"},
        "plate": {"radius": b, "thickness": thickness, "material": "glass", **plate},
        "impact": {"speed": 2.0},
    }


def differ(one: Result, other: Result) -> float:
    return max(abs(getattr(one, name) / getattr(other, name) - 1.0) for name in OUTPUTS)


@pytest.mark.parametrize("thickness", [0.008, 0.02])
@pytest.mark.parametrize("b", [0.3, 0.6])
def test_edge_has_no_influence_before_a_wave_returns(b: float, thickness: float) -> None:
    first, *others = (simulate(read(pane(b, thickness, edge=edge))) for edge in EDGES)
    fastest = 1.1 * first.model.shear_speed
    assert first.total_time < 2.0 * b / fastest
    for other in others:
        assert "edge" in other.effects.law.effects
        assert differ(first, other) < 2e-5


def test_infinite_plate_does_not_depend_on_the_radius() -> None:
    """An infinite plate gives the same results as a finite one before a wave returns."""
    ball = {"radius": 0.005, "density": 7850.0}
    for pressure in ("auto", False):
        actual = []
        for b, kind in ((0.05, "infinite"), (2.0, "infinite"), (0.3, "finite")):
            scene = dict(pane(b, 0.008), sphere=ball, impact={"speed": 1.0})
            tables = {"inertia": {"extent": kind}, "effects": {"non_hertzian_pressure": pressure}}
            actual.append(simulate(read(scene | tables)))
        assert actual[0].restitution == actual[1].restitution
        assert differ(actual[0], actual[2]) < 1e-4
        assert actual[0].restitution == pytest.approx(0.747, abs=1e-3)


def test_infinite_plate_of_unknown_density_is_rejected() -> None:
    """However stiff: the restitution tends to 0 with the density, and depends on no radius."""
    ball = {"radius": 0.01, "mass": 1e-3, "youngs_modulus": 2e11, "poissons_ratio": 0.3}
    block = {"radius": 0.06, "thickness": 0.1, "youngs_modulus": 2e11, "poissons_ratio": 0.3}
    scene = {"sphere": ball, "plate": block, "impact": {"speed": 1e-3}, "accuracy": {"rtol": 0.3}}
    endless: dict[str, Any] = {"inertia": {"extent": "infinite"}}
    assert simulate(read(scene)).accuracy.bound < 0.05
    with pytest.raises(SceneError, match=r"^plate\.density: expected a density"):
        simulate(read(scene | endless))
    light = simulate(read(scene | endless | {"plate": block | {"density": 1e-4}}))
    assert light.restitution < 0.5


def test_extent_does_not_change_a_quasi_static_plate() -> None:
    """Without inertia an infinite plate has radius and edge of the scene, whatever the density."""
    scene = dict(pane(0.1, 0.005, edge="clamped"), effects={"inertia": False})
    endless: dict[str, Any] = {"inertia": {"extent": "infinite"}}
    finite, infinite = simulate(read(scene)), simulate(read(scene | endless))
    assert "edge" in infinite.effects.included
    assert differ(infinite, finite) == 0.0
    moving = {key: table for key, table in scene.items() if key != "effects"}
    slow = moving | endless | {"impact": {"speed": 0.1}}
    contacts = [indent(read(one), force=10.0)[0] for one in (scene, moving | endless, slow)]
    assert len({contact.indentation for contact in contacts}) == 1


REJECTED = [row for row in DATA["impacts"] if "rejected" in row["program"]]
SIMULATED = [row for row in DATA["impacts"] if row not in REJECTED]


@pytest.mark.parametrize("row", SIMULATED, ids=lambda row: row["name"])
def test_recorded_finite_elements_are_within_the_stated_errors(row: Mapping[str, Any]) -> None:
    """Differences are at most the sum of bound, model error and finite-element error."""
    program = row["program"]
    for name in COMPARED:
        off = abs(program["values"][name] / row["elements"][name] - 1.0)
        assert off <= program["bound"] + program["model_error"] + row["errors"][name]


def test_plates_without_a_model_error_are_rejected() -> None:
    """The error of a simply supported edge for a negative Poisson's ratio exceeds 1 %."""
    assert 0 < len(REJECTED) <= 4
    for row in REJECTED:
        plate = row["scene"]["plate"]
        assert plate["edge"] == "simply-supported"
        assert plate["poissons_ratio"] < 0.0
        with pytest.raises(SceneError, match="expected a model error of the simply-supported edge"):
            simulate(read({**row["scene"], "effects": {"inertia": True}}))


def test_message_on_an_edge_shows_an_error_above_the_limit() -> None:
    """An earlier message read "at most 1 % ..., got 1 %" for a block of rubber."""
    block = {"radius": 0.03, "thickness": 0.03, "material": "rubber", "edge": "clamped"}
    sphere = {"radius": 0.01, "material": "steel"}
    with pytest.raises(SceneError, match=r"at most 1 % of the indentation, got 1\.\d+ %"):
        simulate(read({"sphere": sphere, "plate": block, "impact": {"speed": 1.0}}))


def test_record_covers_the_range_of_the_model_error() -> None:
    plates = [row["scene"]["plate"] for row in DATA["impacts"]]
    assert len(plates) >= 40
    assert {plate["edge"] for plate in plates} == set(EDGES)
    assert len({plate["poissons_ratio"] for plate in plates}) >= 4
    ratios = [plate["thickness"] / plate["radius"] for plate in plates]
    assert min(ratios) <= 0.03
    assert max(ratios) >= 0.8
    assert min(plate["poissons_ratio"] for plate in plates) <= -0.6


@pytest.mark.parametrize("number", range(0, len(SIMULATED), 9))
def test_program_still_agrees_with_the_record(number: int) -> None:
    """Every ninth case is simulated again and agrees with the record within its bound."""
    row = SIMULATED[number]
    effects = {"spherical_profile": row["spherical_profile"], "inertia": True}
    result = simulate(read({**row["scene"], "effects": effects}))
    for name in COMPARED:
        value = row["program"]["values"][name]
        assert getattr(result, name) == pytest.approx(value, rel=max(1e-6, row["program"]["bound"]))


def _plate(row: Mapping[str, Any]) -> str:
    return f"{row['edge']} {row['thickness_over_radius']} {row['poissons_ratio']}"


HELD = [row for row in DATA["plates"] if row["edge"] != "paper"]


@pytest.mark.parametrize("row", HELD, ids=_plate)
def test_frequencies_agree_with_three_dimensional_elasticity(row: Mapping[str, Any]) -> None:
    """The first three frequencies agree within 0.3 % for H/b <= 0.2, and 1 % for thicker plates."""
    run = clamped_waves if row["edge"] == "clamped" else supported_waves
    eta = row["thickness_over_radius"] / 2.0
    actual = run(3, eta, row["poissons_ratio"]).root / eta
    limit = 3e-3 if row["thickness_over_radius"] <= 0.2 else 1e-2
    np.testing.assert_allclose(actual, row["frequencies"][: actual.size], rtol=limit)
    assert actual.size >= 2


@pytest.mark.parametrize("edge", EDGES[1:])
def test_light_supported_plate_agrees_with_the_static_law(edge: str) -> None:
    """The results of a very light plate are those of the quasi-static plate."""
    plate = {"radius": 0.1, "thickness": 0.01, "youngs_modulus": 7e10, "poissons_ratio": 0.3,
             "density": 0.1, "edge": edge}  # fmt: skip
    data = dict(pane(0.1, 0.01), plate=plate, inertia={"modes": 4, "branches": "A0"})
    light, still = (
        simulate(read(data | {"effects": {"inertia": inertia, "non_hertzian_pressure": False}}))
        for inertia in (True, False)
    )
    # The force still oscillates by about 1 %; the other results are averages over time.
    for name in ("contact_time", "max_indentation", "restitution"):
        assert getattr(light, name) == pytest.approx(getattr(still, name), rel=2e-3)


def test_short_contacts_have_a_larger_model_error() -> None:
    model = simulate(read(pane(0.3, 0.008))).model
    calm, rough = (inertia_error(model, 1e-4, time) for time in (1e-3, 1e-6))
    assert all(rough[name] >= calm[name] >= 1e-3 for name in OUTPUTS)
    assert rough["max_force"] > calm["max_force"]
    for errors in (calm, rough):  # the force is the cube of the radius, by Hertz's law
        assert 3.0 * errors["max_contact_radius"] >= errors["max_force"]


def test_wide_contacts_have_the_larger_model_error() -> None:
    """The larger model error applies if the contact radius on a half-space would be above 0.3 H.

    That of thick plates, and for a negative Poisson's ratio, is larger in any case.
    """
    for row in DATA["impacts"]:
        parameters, model = row["parameters"], model_of(read(row["scene"]))
        wide = parameters["contact_radius_over_thickness"] > 0.3
        errors = inertia_error(model, 1e-3 * model.h, 1.0)
        if parameters["thickness_over_radius"] > 0.3 or model.poissons_ratio < 0.0:
            assert max(errors["contact_time"], errors["max_force"]) > 3e-3, row["name"]
        else:
            assert (errors["max_force"] > 5e-3) == wide, row["name"]


def test_plates_too_thick_for_edge_modes_are_rejected() -> None:
    with pytest.raises(SceneError, match=r"plate\.edge: expected a clamped plate with bending"):
        simulate(read(pane(0.01, 0.011, edge="clamped") | {"effects": {"inertia": True}}))
    assert edge_remainder(simulate(read(pane(0.3, 0.008, edge="clamped"))).model, 1e-3) < 1e-3


def test_long_contact_with_a_steep_rise_excites_reflections() -> None:
    """The force rises in 1/30 of the contact time and excites through-thickness reflections."""
    scene = tomllib.loads((EXAMPLES / "membrane.toml").read_text())
    lowest = simulate(read(scene))
    del scene["accuracy"]
    every = simulate(read(scene | {"inertia": {"branches": "all", "modes": 200}}))
    change = abs(lowest.max_force / every.max_force - 1.0)
    assert 2e-3 < change < lowest.accuracy.bound


def test_bound_of_a_chosen_number_of_modes_covers_more_modes() -> None:
    """The bound covers 340 modes, although 90 and 180 modes agree on the peak force by chance."""
    scene = tomllib.loads((EXAMPLES / "membrane.toml").read_text())
    del scene["accuracy"]
    few, more = (
        simulate(read(scene | {"inertia": {"branches": "all", "modes": modes}}))
        for modes in (180, 340)
    )
    change = abs(few.max_force / more.max_force - 1.0)
    assert change > 1e-3
    assert few.accuracy.bound > change


def test_contact_too_short_for_the_modes_is_rejected() -> None:
    """A scene is rejected if its modes are too slow for the contact, which makes them wrong."""
    scene = pane(6.4, 0.09) | {
        "sphere": {"radius": 0.0043, "mass": 7e-5},
        "impact": {"speed": 37.0},
        "effects": {"inertia": True},
    }
    with pytest.raises(SceneError, match=r"inertia\.modes: .* frequencies up to .*infinite"):
        simulate(read(scene))
    # Infinite plates agree if no through-thickness reflection returns during the contact.
    actual = []
    for thickness in (0.05, 0.06):
        scene["plate"] = pane(6.4, thickness)["plate"]
        actual.append(simulate(read(scene | {"inertia": {"extent": "infinite"}})))
        assert actual[-1].contact_time < thickness / actual[-1].model.shear_speed
    assert differ(*actual) < actual[0].accuracy.bound + actual[1].accuracy.bound < 0.1


def test_all_branches_of_a_thick_block_are_computed() -> None:
    """Finite elements and radiation into a half-space both give a restitution of 0.9907."""
    scene = tomllib.loads((EXAMPLES / "impact_echo.toml").read_text())
    result = simulate(read(scene | {"inertia": {"branches": "all"}}))
    assert result.dynamics is not None
    assert result.dynamics.inertia.modes > 2000
    assert result.restitution == pytest.approx(0.9907, abs=5e-4)


def test_branches_are_included_if_the_tolerance_needs_them() -> None:
    """A tolerance of 0.1 % needs more modes than one of 3 %, and both results are within bounds."""
    scene = pane(0.1, 0.02) | {"impact": {"speed": 1.0}}
    fine = simulate(read(scene | {"inertia": {"branches": "all"}}))
    rough, exact = (simulate(read(scene), rtol=rtol) for rtol in (3e-2, 1e-3))
    assert rough.dynamics is not None
    assert exact.dynamics is not None
    assert rough.dynamics.inertia.modes < exact.dynamics.inertia.modes
    for result in (rough, exact):
        assert differ(result, fine) <= result.accuracy.bound + fine.accuracy.bound
