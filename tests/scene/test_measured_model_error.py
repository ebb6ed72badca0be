"""The model error of a constant that follows from a measured restitution."""

from typing import Any

from scipy.integrate import solve_ivp

from derivation.scene import read, simulate
from derivation.scene.measured.measured import error_of, error_of_constant, solved


def test_error_of_the_constant_includes_the_model_error_of_the_measurement() -> None:
    """An earlier version showed four digits of a retardation time that was 4 % off.

    The local indentation of an incompressible sphere is smaller by 0.56 a/R of its own part than
    that of a half-space. Both bodies have the same modulus here, and only the plate a loss.
    """
    R, mass, speed, time = 0.01, 5e-3, 1.0, 1e-4
    body = {"youngs_modulus": 1e7, "poissons_ratio": 0.499}
    modulus = 0.5 * 1e7 / (1.0 - 0.499**2)

    def law(a: float) -> tuple[float, float, float]:
        narrower = 0.5 * 0.56 * a / R
        force, force_a = 4 / 3 * modulus * a**3 / R, 4.0 * modulus * a * a / R
        return force, force_a, a / R * (2.0 - 3.0 * narrower)

    def force(a: float, v: float) -> float:
        elastic, by_a, depth_a = law(a)
        return elastic + 0.5 * time * by_a * v / depth_a

    def left(_: float, y: Any) -> Any:
        return force(*y) + (y[1] > 0.0)

    left.terminal = True  # type: ignore[attr-defined]
    moved = solve_ivp(
        lambda _, y: (y[1] / law(y[0])[2], -force(*y) / mass), (0.0, 1.0), (1e-7, speed),
        method="LSODA", events=left, rtol=1e-9, atol=1e-12,
    )  # fmt: skip
    scene = read({
        "sphere": body | {"radius": R, "mass": mass},
        "plate": body | {"radius": 1.0, "thickness": 1.0},
        "impact": {"speed": speed},
        "measured": {"restitution": float(-moved.y[1, -1]), "solve_for": "retardation_time"},
        "effects": {"inertia": False, "spherical_profile": False},
    })  # fmt: skip
    off = abs(solved(scene) / time - 1.0)
    assert 0.02 < off < error_of_constant(scene) < 0.5
    assert simulate(scene).model_error > error_of(scene)


def test_unknown_constant_is_shown_without_a_unit() -> None:
    """The retardation times differ so much that the model error exceeds 100 %."""
    scene = {
        "sphere": {"radius": 0.012, "material": "rubber"},
        "plate": {"radius": 0.3, "thickness": 0.02, "material": "concrete"},
        "impact": {"speed": 2.0},
        "measured": {"restitution": 0.75, "solve_for": "retardation_time"},
    }
    note = simulate(read(scene)).measured_note
    assert note.startswith("plate.retardation_time = unknown, from the restitution 0.75")
