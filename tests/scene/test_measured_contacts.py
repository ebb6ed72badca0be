"""Restitutions of several contacts, which depend on the constant without any order.

A light sphere is hit again by the thin plate, so that yield or viscosity can increase its
restitution.
"""

import re
from typing import Any

import pytest

from derivation.scene import Result, SceneError, read, simulate
from derivation.scene.dynamic.inertia_details import InertiaDetails
from derivation.scene.measured import scan
from derivation.scene.measured.measured import solved
from derivation.scene.measured.measurement import Measurement
from derivation.scene.measured.rough_search import HALF

pytestmark = pytest.mark.one_version

LIGHT: dict[str, Any] = {
    "sphere": {"radius": 0.008, "material": "bearing steel"},
    "plate": {"radius": 0.123, "thickness": 0.002, "material": "steel"},
    "impact": {"speed": 3.7},
    "accuracy": {"rtol": 0.02},
    "effects": {"stretching": False},  # the automatic decision would take seconds
}
CLAMPED: dict[str, Any] = {
    "sphere": {
        "radius": 0.00463, "mass": 1.136e-4, "youngs_modulus": 2e11, "poissons_ratio": 0.3,
    },
    "plate": {
        "radius": 0.0203, "thickness": 1.31e-3, "youngs_modulus": 17.4e9, "poissons_ratio": 0.28,
        "density": 1458.0, "edge": "clamped",
    },
    "impact": {"speed": 1.32},
    "accuracy": {"rtol": 0.02},
    "effects": {"stretching": False},
}  # fmt: skip
THICKER: dict[str, Any] = LIGHT | {"plate": LIGHT["plate"] | {"thickness": 0.004}}


def details(result: Result) -> InertiaDetails:
    """Return the details of an impact on a plate with inertia."""
    assert result.dynamics is not None
    return result.dynamics.inertia


def with_constant(tables: Any, key: str, value: float) -> Result:
    """Return the impact on a plate with a constant."""
    return simulate(read(tables | {"plate": tables["plate"] | {key: value}}))


def measured(tables: Any, key: str, restitution: float) -> Any:
    """Return the scene of a plate with a measured restitution."""
    wanted = {"restitution": restitution, "solve_for": key, "target": "plate"}
    return read(tables | {"measured": wanted})


@pytest.mark.parametrize(
    ("tables", "key", "value"),
    [(LIGHT, "yield_stress", 3e8), (CLAMPED, "retardation_time", 2.4e-7)],
)
def test_a_restitution_above_that_without_loss_determines_the_constant(
    tables: Any, key: str, value: float
) -> None:
    """An earlier version rejected each restitution above that without loss."""
    given = with_constant(tables, key, value)
    assert given.restitution > 1.1 * simulate(read(tables)).restitution
    scene = measured(tables, key, given.restitution)
    result = simulate(scene)
    assert abs(result.restitution / given.restitution - 1.0) <= result.accuracy.bound <= 0.02
    assert solved(scene) == pytest.approx(value, rel=1e-2)
    assert any("other values of plate." in text for text in result.warnings)


def test_the_largest_restitution_of_several_contacts_is_named() -> None:
    """An accurate simulation with the named value gives the named restitution."""
    with pytest.raises(SceneError, match=r"the largest restitution that a plate") as error:
        simulate(measured(LIGHT, "yield_stress", 0.25))
    found = re.search(r"less than about (\S+), .* at about (\S+) Pa", str(error.value))
    assert found
    named = with_constant(LIGHT, "yield_stress", float(found[2])).restitution
    assert 1.5 * simulate(read(LIGHT)).restitution < named < 0.25
    assert named == pytest.approx(float(found[1]), rel=0.1)


def test_a_restitution_that_is_not_searched_is_rejected_with_the_end_of_the_search() -> None:
    """Restitutions above that without loss are possible, as the first test of this file shows."""
    with pytest.raises(SceneError, match=r"several contacts .* may increase") as error:
        simulate(measured(LIGHT, "yield_stress", 0.9))
    ends = re.search(
        r"less than about (\S+), .* up to a restitution of about (\S+)", str(error.value)
    )
    assert ends
    without_loss, last = map(float, ends.groups())
    assert without_loss + 0.3 < last < 0.9


def test_a_later_minimum_with_the_retardation_time_is_found() -> None:
    """A restitution of half the first minimum was rejected as smaller than all restitutions."""
    tables = {
        "sphere": {"radius": 0.00113, "material": "glass"},
        "plate": {
            "radius": 0.007, "thickness": 1.48e-3, "youngs_modulus": 26.9e9,
            "poissons_ratio": 0.165, "density": 1262.0,
        },
        "impact": {"speed": 0.031},
        "accuracy": {"rtol": 0.03, "outputs": ["restitution"]},
    }  # fmt: skip
    first, later = (with_constant(tables, "retardation_time", x) for x in (3.8e-5, 2.14e-4))
    assert later.restitution < 0.6 * first.restitution
    scene = measured(tables, "retardation_time", later.restitution)
    found = with_constant(tables, "retardation_time", solved(scene))
    assert found.restitution == pytest.approx(later.restitution, rel=0.03)


def test_warning_if_a_sphere_that_is_hit_again_has_the_restitution_of_a_single_contact() -> None:
    """An earlier version warned only of several contacts with the constant that it found."""
    for stress, warned in ((5e8, True), (1e9, False)):
        given = with_constant(THICKER, "yield_stress", stress)
        assert len(details(given).contacts) == 1
        result = simulate(measured(THICKER, "yield_stress", given.restitution))
        assert any("is hit again" in text for text in result.warnings) is warned


def test_a_restitution_without_loss_does_not_determine_the_constant() -> None:
    """An earlier message was about a tolerance that is not a number."""
    elastic = with_constant(THICKER, "yield_stress", 5e9).restitution
    with pytest.raises(SceneError, match="does not determine the constant"):
        simulate(measured(THICKER, "yield_stress", elastic))


def test_a_search_finds_values_between_and_around_the_first_ones() -> None:
    """Few modes have the restitution of the value that the search returns."""
    half = Measurement(LIGHT, "yield_stress", 0.18, HALF).to(0.1)
    lossless = half.simulated(None)
    first = [half.point(x).above for x in scan.values_of("yield_stress", lossless)]
    assert max(first) < 0.0
    value = scan.searched(half, lossless, SceneError("rejected"))
    assert half.simulated(value).restitution == pytest.approx(0.18, rel=scan.UNSURE)
