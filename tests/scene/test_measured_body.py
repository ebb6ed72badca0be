"""A measured restitution determines the constant of the plate, of the sphere or of both."""

import math
from typing import Any

import pytest
from scipy.integrate import solve_ivp

from derivation.scene import SceneError, read, simulate
from derivation.scene.measured.measured import fitted, solved
from derivation.scene.output.unusable import in_words, unusable

BALL: dict[str, Any] = {
    "sphere": {"radius": 0.02, "mass": 0.045, "youngs_modulus": 1e8, "poissons_ratio": 0.45},
    "plate": {"radius": 0.05, "thickness": 0.01, "material": "steel", "edge": "clamped"},
    "impact": {"speed": 2.0},
}
"""A soft ball on a steel plate."""
STEEL: dict[str, Any] = {
    "sphere": {"radius": 0.005, "material": "steel"},
    "plate": {"radius": 0.1, "thickness": 0.01, "material": "steel"},
    "impact": {"speed": 1.0},
}
TIME = {"restitution": 0.8, "solve_for": "retardation_time"}


def kuwabara_kono(mass: float, stiffness: float, time: float, speed: float) -> float:
    """Return the restitution of m z'' = -k z^(3/2) - (3/2) A_v k z^(1/2) z', integrated."""

    def force(z: float, v: float) -> float:
        return stiffness * math.sqrt(max(z, 0.0)) * (max(z, 0.0) + 1.5 * time * v)

    def separated(_: float, y: Any) -> float:
        return force(*y) if y[1] < 0.0 else 1.0

    separated.terminal = True  # type: ignore[attr-defined]
    scale = (mass**2 / stiffness**2 / speed) ** 0.2
    run = solve_ivp(
        lambda _, y: (y[1], -force(*y) / mass), (0.0, 30.0 * scale), (0.0, speed), rtol=1e-10,
        atol=1e-14, events=separated, max_step=0.02 * scale,
    )  # fmt: skip
    return float(-run.y_events[0][0][1]) / speed


@pytest.mark.parametrize("body", ["sphere", "both"])
def test_time_of_a_soft_ball_agrees_with_an_integrated_impact(body: str) -> None:
    flat = {"spherical_profile": False}
    time = solved(read(BALL | {"measured": TIME | {"body": body}, "effects": flat}))
    of_ball, of_steel = (1 - 0.45**2) / 1e8, (1 - 0.3**2) / 210e9
    stiffness = 4 / 3 / (of_ball + of_steel) * math.sqrt(0.02)
    contact = time * (1.0 if body == "both" else of_ball / (of_ball + of_steel))
    assert kuwabara_kono(0.045, stiffness, contact, 2.0) == pytest.approx(0.8, rel=1e-5)


def test_a_ball_that_causes_the_loss_is_usable() -> None:
    ball = BALL | {"measured": TIME}
    assert 'set measured.body = "sphere"' in in_words(result := simulate(read(ball)))
    assert "restitution" in unusable(result)
    result = simulate(read(BALL | {"measured": TIME | {"body": "sphere"}}))
    assert not unusable(result)
    assert result.measured_note.startswith("sphere.retardation_time = ")
    assert result.energy_balance is not None
    assert result.energy_balance.viscous_loss > 0.0
    assert result.restitution == pytest.approx(0.8, rel=0.02)  # the steel plate takes little


def test_two_bodies_of_one_material_have_one_time() -> None:
    """If the plate alone has the time, its difference from that of the sphere causes an error."""
    one, both = (
        simulate(read(STEEL | {"measured": TIME | {"body": body}})) for body in ("plate", "both")
    )
    assert both.restitution == pytest.approx(one.restitution, rel=1e-4)
    assert both.model_errors["restitution"] < 0.25 * one.model_errors["restitution"]
    tables = fitted(both.scene).to_json()
    assert tables["sphere"]["retardation_time"] == tables["plate"]["retardation_time"]
    assert both.measured_note.startswith("retardation_time of sphere and plate = ")


@pytest.mark.parametrize("body", ["sphere", "both"])
def test_yield_stress_is_that_of_the_body_that_yields(body: str) -> None:
    wanted = {"restitution": 0.6, "solve_for": "yield_stress"}
    of_plate = solved(read(STEEL | {"measured": wanted}))
    scene = read(STEEL | {"measured": wanted | {"body": body}})
    assert solved(scene) == pytest.approx(of_plate, rel=1e-12)
    result = simulate(scene)
    assert result.to_json()["yield_stress"] == solved(scene)
    assert ("no yield stress is given" in str(result)) == (body == "sphere")


def test_a_constant_of_the_other_body_remains() -> None:
    plate = STEEL["plate"] | {"yield_stress": 2e8}
    wanted = {"restitution": 0.2, "solve_for": "yield_stress", "body": "sphere"}
    tables = fitted(read(STEEL | {"plate": plate, "measured": wanted})).to_json()
    assert tables["plate"]["yield_stress"] == 2e8
    assert tables["sphere"]["yield_stress"] < 2e8


@pytest.mark.parametrize("body", ["sphere", "both"])
def test_constants_that_are_given_or_of_a_rigid_sphere_are_rejected(body: str) -> None:
    wanted = TIME | {"body": body}
    sphere = STEEL["sphere"] | {"retardation_time": 1e-6}
    with pytest.raises(SceneError, match=r"measured\.solve_for: .*; remove sphere\.retardation_t"):
        read(STEEL | {"sphere": sphere, "measured": wanted})
    rigid = {"radius": 0.005, "density": 7850.0}
    with pytest.raises(SceneError, match=r"measured\.body: .*rigid.*add sphere\.material"):
        read(STEEL | {"sphere": rigid, "measured": wanted})
    with pytest.raises(SceneError, match=r'measured\.body: expected "plate", "sphere" or "both"'):
        read(STEEL | {"measured": TIME | {"body": "ball"}})
