"""Test the stress on the back face: theory, references, functions, limits, predicted failure."""

import math
import re
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import flint
import numpy as np
import platecontact as pc
import pytest
import sympy as sp
from flint import arb
from mpmath import mp, mpf
from shared_scenes import lame, scene

from derivation.engine.formula.ball import evaluate
from derivation.engine.formula.proof import ProofError, prove
from derivation.plate import derived
from derivation.plate.back_face import oracle as back_face_balls
from derivation.plate.back_face import route as back_face_routes
from derivation.plate.back_face import theory as back_face
from derivation.plate.modes.route.exponentials import ModeMaterial, unit_mode
from derivation.plate.vocabulary import T
from derivation.scene import load, read, simulate
from derivation.scene.contact_law.stress_limits import stress_warnings
from derivation.scene.output.answer import plain
from derivation.scene.tensile_stress import TensileStress
from generated import back_face as kernels
from generated import contact_law, modal_sum
from generated.arrays import Double as Array

BITS = 160
KERNELS: dict[str, Callable[..., np.ndarray]] = {
    "soft": kernels.back_face_stress,
    "supported": kernels.supported_back_face_stress,
    "clamped": kernels.clamped_back_face_stress,
}
Point = tuple[float, float, float, float, float, float]


pytestmark = pytest.mark.usefixtures("silent")


def scaled(stress: np.ndarray, P: float, h: float, ratio: float) -> float:
    """Return the stress divided by (1 + nu) P/(2 pi H^2)."""
    return float(stress) * 8 * math.pi * h * h / (P * (1 + ratio))


# --- theory


def test_wrong_factor_is_rejected() -> None:
    wrong = back_face.back_face_function() * sp.cosh(T)
    with pytest.raises(ProofError, match="radial"):
        prove(
            "Back face",
            "",
            {"radial stress": wrong - derived.formulas()["back_face_factor"].expression},
        )


@pytest.mark.parametrize(("wave", "ratio"), [(0.03, 0.3), (1.7, -0.8), (9.0, 0.49)])
def test_factor_agrees_with_numerical_traction_conditions(wave: float, ratio: float) -> None:
    """The factor agrees with the mpmath solution of a mode's traction conditions.

    On the axis sigma_rr = S_rr - mu phi u, which is -(1 + nu)/2 times the factor for a unit
    pressure coefficient.
    """
    first, second = lame(ratio)
    factor = evaluate(
        derived.formulas()["back_face_factor"].expression, {T: Fraction(2 * Fraction(wave))}, 30
    )
    with mp.workdps(40):
        mode = unit_mode(mpf(wave), mpf(1), ModeMaterial(mpf(first), mpf(second)), mpf(-1))
        nu = mpf(first) / (2 * (mpf(first) + second))
        stress = -2 / (1 + nu) * (mode.rr - second * wave * mode.u)
        with flint.ctx.workprec(BITS):
            assert abs(factor / arb(mp.nstr(stress, 35)) - 1) < 1e-25


# --- references


@pytest.mark.parametrize(("thickness", "width"), [(0.02, 0.3), (0.1, 0.01), (0.1, 0.9), (0.3, 0.5)])
def test_references_agree(thickness: float, width: float) -> None:
    ball = back_face_balls.back_face_sum(width, thickness, 1, 24)
    with mp.workdps(40):
        route = back_face_routes.back_face_sum(width, thickness, 1, 24)
        with flint.ctx.workprec(BITS):
            assert abs(ball / arb(mp.nstr(route, 35)) - 1) < 1e-22


@pytest.mark.parametrize(("thickness", "width", "ratio"), [(0.05, 0.3, 0.25), (0.7, 0.4, -0.5)])
def test_references_agree_on_the_edge(thickness: float, width: float, ratio: float) -> None:
    n = Fraction(ratio)
    ball = back_face_balls.back_face_edge(width, thickness, 1, 2 * n, 1 - 2 * n, 24)
    with mp.workdps(40):
        route = back_face_routes.back_face_edge(width, thickness, 1, ratio, 24)
        with flint.ctx.workprec(BITS):
            assert abs(ball / arb(mp.nstr(route, 35)) - 1) < 1e-22


def test_reference_rejects_invalid_arguments() -> None:
    with pytest.raises(ValueError, match="a < b"):
        back_face_balls.back_face_sum(1.0, 0.1, 1.0)


# --- generated functions


def test_thin_plates_differ_by_a_logarithm() -> None:
    """At equal a/h the sum for a smaller h/b exceeds that for h/b = 1/64 by 3 log(1/(64 h/b))."""
    for A in (1e-30, 0.25, 6.0, 19.0, 21.0, 60.0):
        with flint.ctx.workprec(BITS):
            start = back_face_balls.back_face_sum(A / 64, 1 / 64, 1, 25)
            for power in (-10, -170):
                exact = start + 3 * (arb(2) ** (-power) / 64).log()
                h = 2.0**power
                got = scaled(kernels.back_face_stress(1.0, A * h, h, 1.0, 0.0, 1.0), 1.0, h, 0.0)
                assert abs(got / float(exact) - 1) < 3e-15, (A, power)


def test_results_are_nan_outside_the_domain() -> None:
    plate = (0.1, 1.0, *lame(0.3))
    for function, last in (
        (kernels.back_face_stress, 1.0),
        (kernels.clamped_back_face_stress, 0.9001),
    ):
        assert np.isnan(function(1.0, [0.0, -1.0, last, np.nan], *plate)).all()
        assert np.isnan(function(-1.0, 0.1, *plate))
        assert np.isnan(function(1.0, 0.1, [0.0, 1e-91, 1e91], *plate[1:])).all()
        assert np.isnan(function(1.0, 0.1, 0.1, 1.0, -2.0, 3.0))
        assert function(0.0, 0.1, *plate) == 0
    assert kernels.back_face_stress(1.0, 0.5, 1e4, 1.0, 1.0, 1.0) == 0  # underflows


# --- known answers


def test_wide_load_agrees_with_kirchhoff() -> None:
    """The stress of a very thin plate is that of Kirchhoff's theory.

    For a simply supported plate it is
    3 P/(2 pi H^2) [(1 + nu) <log b/r> + (1 - nu)/2 (1 - <r^2>/b^2)]. For a clamped plate the
    last term is -(1 + nu)/2 (1 - <r^2>/b^2). The means over Hertz's pressure are
    <log a/r> = 4/3 - log 2 and <r^2> = 2 a^2/5.
    """
    nu, h, a = 0.3, 1e-8, 0.2
    mean = math.log(1 / a) + 4 / 3 - math.log(2)
    span = (1 - 0.4 * a * a) / 2
    for edge, last in (("supported", 1 - nu), ("clamped", -1 - nu)):
        known = 3 / (2 * math.pi * (2 * h) ** 2) * ((1 + nu) * mean + last * span)
        actual = float(KERNELS[edge](1.0, a, h, 1.0, *lame(nu)))
        assert math.isclose(actual, known, rel_tol=1e-8)


def test_small_loads_agree_with_westergaard_and_timoshenko() -> None:
    """The stress under a small load agrees with two published formulas.

    Westergaard uses the equivalent radius 0.325 H. Nadai's formula is equation (97) of
    Timoshenko's Theory of Plates and Shells.
    """
    nu = 0.3
    for h in (0.05, 0.01):
        H = 2 * h
        actual = float(kernels.supported_back_face_stress(1.0, 1e-9, h, 1.0, *lame(nu))) * H * H
        westergaard = 3 / (2 * math.pi) * ((1 + nu) * math.log(1 / (0.325 * H)) + 1)
        nadai = (1 + nu) * (0.485 * math.log(1 / H) + 0.52) + 0.48
        assert actual == pytest.approx(westergaard, rel=3e-3)
        assert actual == pytest.approx(nadai, rel=1e-2)


def test_stress_is_small_in_thick_plates() -> None:
    h = np.array([0.5, 1.0, 2.0, 4.0])
    actual = kernels.back_face_stress(1.0, 1e-3, h, 1.0, 0.0, 1.0) * 8 * np.pi * h * h
    j, slope = 2.404825557695773, 0.5191474972894669
    first = 16 * h * h * (2 * h * j) * np.exp(-2 * h * j) / slope**2
    assert (np.diff(np.log(actual)) < 0).all()
    assert actual[-1] == pytest.approx(first[-1], rel=1e-6)


def test_interior_stress_agrees_with_a_sum_over_many_modes() -> None:
    h, b, R, a, lam, mu = 0.1, 1.0, 0.13, 0.02, 0.36e9, 0.43e9
    P = float(contact_law.force_of_radius(a, R, lam, mu))
    for field in (modal_sum.sigma_rr, modal_sum.sigma_tt):
        got = float(field(0.0, -h, h, b, R, a, lam, mu, modes=400))
        assert got == pytest.approx(float(kernels.back_face_stress(P, a, h, b, lam, mu)), rel=1e-13)


# --- scenes

PANE = "derivation/scene/examples/glass_pane.toml"


def pane(**plate: Any) -> Any:
    keys = {"radius": 0.3, "thickness": 0.008, "half_thickness": None, "lame_lambda": None}
    keys |= {"lame_mu": None, "material": "glass", "edge": "clamped"}
    return scene(plate=keys | plate)


def test_stress_of_a_pane_follows_from_its_force() -> None:
    result = simulate(read(load(PANE).to_json() | {"effects": {"inertia": False}}))
    force, a = result.max_force, result.max_contact_radius
    m = result.model
    expected = kernels.supported_back_face_stress(force, a, m.h, m.b, m.lam, m.mu)
    assert result.max_tensile_stress == float(expected)
    assert result.to_json()["max_tensile_stress"] == result.max_tensile_stress
    (shown,) = re.findall(r"max_tensile_stress (\S+) Pa", plain(result))
    assert float(shown) == pytest.approx(
        result.max_tensile_stress, rel=10.0 ** (1 - result.digits_of_result("max_tensile_stress"))
    )
    assert f"= {70e6 / result.max_tensile_stress:.3g}" in result.strength_note
    assert result.inertia_neglected
    assert "plate inertia is neglected" in result.strength_note
    assert result.strength_note in result._repr_html_().replace("&#x27;", "'")


def test_stress_with_inertia_is_below_the_static_stress_at_the_largest_force() -> None:
    """No wave has returned from the edge: the plate is bent near the contact only."""
    data = load(PANE).to_json() | {"effects": {"inertia": "auto"}}
    result = simulate(read(data | {"plate": data["plate"] | {"tensile_strength": 1e9}}))
    assert result.dynamics is not None
    force, a, m = result.max_force, result.max_contact_radius, result.model
    static = kernels.supported_back_face_stress(force, a, m.h, m.b, m.lam, m.mu)
    assert result.max_tensile_stress == result.dynamics.back_face.stress < 0.6 * float(static)
    assert "quasi-static" not in result.strength_note
    assert "inertia is neglected" not in result.strength_note


def test_failure_is_predicted_on_one_side_of_the_strength() -> None:
    stress = simulate(pane()).max_tensile_stress
    for factor, verdict in (
        (0.6, "predicted to fail"),
        (0.999, "may fail"),
        (1.001, "may fail"),
        (3.0, ""),
    ):
        result = simulate(pane(tensile_strength=factor * stress))
        [*failures] = (text for text in result.warnings if "the plate" in text and " fail," in text)
        assert [verdict in text for text in failures] == ([True] if verdict else [])
        assert bool(result.strength_note) is not bool(verdict)
    assert simulate(pane()).strength_note == ""


def test_failure_within_the_error_of_the_stress_is_possible() -> None:
    for error, verdict in ((0.2, "may fail"), (0.05, "is predicted to fail")):
        (text,) = stress_warnings(1.1e6, 1e6, error=error, static=False)
        assert verdict in text
        assert "quasi-static" not in text
    (text,) = stress_warnings(0.95e6, 1e6, error=0.1, static=False)
    assert "0.95 times the strength, within its error of 10 %: the plate may fail" in text
    stress = TensileStress(0.95e6, 0.1, static=False)
    assert stress.safety(1e6, 0.0, inertia_neglected=False) == ""
    assert "no failure predicted" in stress.safety(1.1e6, 0.0, inertia_neglected=False)
    assert stress.safety(1.1e6, 0.1, inertia_neglected=False) == ""
    unknown = TensileStress(1.0, math.inf, static=False).safety(1e6, 0.0, False)
    assert unknown.endswith("= 1e+06, and the error of the stress is unknown")
    assert TensileStress(math.nan, math.nan, static=False).safety(1e6, 0.0, False) == ""


def test_omitted_effects_change_only_the_force() -> None:
    """At a given force, omitted effects do not change the stress; only `on_edge` changes it."""
    whole = simulate(pane(), rtol=1e-9)
    law, a, force = whole.effects.law, whole.max_contact_radius, whole.max_force
    loose = simulate(pane(), rtol=0.5).effects.law
    assert loose.effects < law.effects
    assert (
        loose.max_tensile_stress(a, force)
        == law.max_tensile_stress(a, force)
        == whole.max_tensile_stress
    )
    soft = law.max_tensile_stress(a, force, on_edge=False)
    m = law.model
    assert soft == float(kernels.back_face_stress(force, a, m.h, m.b, m.lam, m.mu))
    assert soft > whole.max_tensile_stress


def resultant(distance: Array, pressure: Array) -> float:
    return float(np.trapezoid(2 * math.pi * distance * pressure, distance))


@pytest.mark.parametrize("inertia", [False, True])
@pytest.mark.parametrize("speed", [3.0, 24.0])
def test_profile_of_a_plastic_contact_carries_the_force(speed: float, inertia: bool) -> None:
    """The contact of the soft sphere is wider than the plate thickness."""
    soft = pc.Sphere(
        radius=0.01, youngs_modulus=1e8, poissons_ratio=0.3, density=1100.0, yield_stress=1e7
    )
    hard = pc.Sphere(radius=0.01, material="steel", yield_stress=3e8)
    for sphere in (hard,) if inertia else (soft, hard):
        result = pc.simulate(
            pc.Scene(
                sphere=sphere,
                plate=pc.Plate(radius=0.1, thickness=0.004, material="aluminium", edge="clamped"),
                impact=pc.Impact(speed=speed if sphere is soft else 0.2 * speed),
                effects=pc.Effects(inertia=inertia),
            )
        )
        profile = result.pressures(4001)
        carried = resultant(profile.distance, profile.pressure)
        assert carried == pytest.approx(result.max_force, rel=1e-4)
        assert profile.pressure.max() == pytest.approx(result.max_pressure, rel=1e-9)


@pytest.mark.parametrize(
    "chosen",
    [
        {"spherical_profile": False, "non_hertzian_pressure": False},
        {"spherical_profile": True, "non_hertzian_pressure": False},
        {"spherical_profile": True, "non_hertzian_pressure": True},
    ],
)
def test_profiles_carry_the_force(chosen: dict[str, bool]) -> None:
    result = simulate(scene(effects=chosen))
    pressures = result.pressures(4001)
    for pressure in (pressures.pressure, pressures.hertz):
        assert resultant(pressures.distance, pressure) == pytest.approx(result.max_force, rel=1e-5)
    assert pressures.pressure[0] == pytest.approx(result.max_pressure, rel=1e-9)
    same = np.allclose(
        pressures.pressure, pressures.hertz, rtol=1e-6, atol=1e-6 * pressures.hertz[0]
    )
    assert same is not any(chosen.values())
