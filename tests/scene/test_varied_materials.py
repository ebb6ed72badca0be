"""A new elastic constant of a body: the other constants of its material stay."""

from typing import Any

import pytest

from derivation.scene import Scene, read, simulate
from derivation.scene.input.keys import varied
from derivation.scene.scene import OUTPUTS, SceneError

HAIL = {"youngs_modulus": 9e9, "poissons_ratio": 0.3, "density": 900.0, "yield_stress": 2e7}


def scene(sphere: dict[str, Any], plate: dict[str, Any]) -> Scene:
    whole: dict[str, Any] = {
        "sphere": {"radius": 0.0125} | sphere,
        "plate": {"radius": 0.2, "thickness": 0.004} | plate,
        "impact": {"speed": 2.0},
        "materials": {"hailstone": HAIL},
    }
    return read(whole)


ICE_ON_GLASS = scene({"material": "hailstone"}, {"material": "glass"})


def numbers(given: Scene) -> dict[str, float]:
    result = simulate(given)
    return {name: getattr(result, name) for name in OUTPUTS}


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("sphere.youngs_modulus", 9e9),
        ("sphere.poissons_ratio", 0.3),
        ("plate.youngs_modulus", 70e9),
        ("plate.poissons_ratio", 0.2),
    ],
)
def test_value_of_the_material_gives_the_same_impact(key: str, value: float) -> None:
    """Density, yield stress and the other elastic constant are kept: the ice yields on a vibrating
    plate.
    """
    given = read(varied(ICE_ON_GLASS, {key: value}))
    assert numbers(given) == pytest.approx(numbers(ICE_ON_GLASS), rel=1e-12)


def test_new_value_is_that_of_a_scene_without_material() -> None:
    plate = {"youngs_modulus": 60e9, "poissons_ratio": 0.2, "density": 2500.0}
    written = scene({"material": "hailstone"}, plate)
    given = read(varied(ICE_ON_GLASS, {"plate.youngs_modulus": 60e9}))
    assert numbers(given) == pytest.approx(numbers(written), rel=1e-12)


def test_both_constants_may_be_new_in_either_order() -> None:
    values = {"plate.youngs_modulus": 60e9, "plate.poissons_ratio": 0.25}
    [one, other] = (
        varied(ICE_ON_GLASS, dict(items)) for items in (values.items(), reversed(values.items()))
    )
    assert one == other
    assert one["plate"]["youngs_modulus"] == 60e9
    assert one["plate"]["poissons_ratio"] == 0.25
    assert one["plate"]["density"] == 2500.0


def test_lame_constants_and_youngs_modulus_are_converted() -> None:
    lame = scene({"mass": 0.01}, {"lame_lambda": 28e9, "lame_mu": 28e9})
    E, nu = 28e9 * 2.5, 0.25  # lambda = mu: nu = 1/4 and E = 5/2 mu
    given = varied(lame, {"plate.youngs_modulus": 2.0 * E})["plate"]
    assert given["poissons_ratio"] == pytest.approx(nu, rel=1e-15)
    assert "lame_mu" not in given
    back = varied(scene({"mass": 0.01}, {"material": "glass"}), {"plate.lame_mu": 28e9})["plate"]
    assert back["lame_lambda"] == pytest.approx(70e9 * 0.2 / (1.2 * 0.6), rel=1e-15)


def test_mass_replaces_the_density_of_the_material() -> None:
    heavy = scene({"material": "hailstone", "mass": 0.02}, {"material": "glass"})
    sphere = varied(heavy, {"sphere.youngs_modulus": 5e9})["sphere"]
    assert sphere["mass"] == 0.02
    assert "density" not in sphere
    assert sphere["yield_stress"] == 2e7


def test_given_constants_stay() -> None:
    own = scene({"material": "hailstone", "yield_stress": 3e7}, {"material": "glass"})
    assert varied(own, {"sphere.youngs_modulus": 5e9})["sphere"]["yield_stress"] == 3e7


def test_rigid_sphere_needs_both_constants() -> None:
    rigid = scene({"mass": 0.01}, {"material": "glass"})
    with pytest.raises(SceneError, match="poissons_ratio"):
        read(varied(rigid, {"sphere.youngs_modulus": 5e9}))
