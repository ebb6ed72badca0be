"""Effects: their kernels, the law they make, impacts on it, and the gate that chooses them."""

import json
import math
import random
from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.integrate import solve_ivp

import derivation.effects_check
from derivation import pipeline
from derivation.cli import main
from derivation.formula.proof import ProofError
from derivation.measure import effects as measure
from derivation.scene import SceneError, explain, gate, indent, kernels, motion, read, simulate
from derivation.scene import map as map_
from derivation.scene.effects import BY_NAME, EFFECTS
from derivation.scene.gate import OUTPUTS, decide
from derivation.scene.law import CURVED, HELD, WHOLE_PLATE, Law
from derivation.scene.model import Model, model_of
from derivation.theory import curvature as curvature_theory
from derivation.theory import effects as effects_theory
from derivation.theory import plate_motion
from generated import contact_law
from generated.effects import (
    WALL_CUBIC,
    WALL_LINEAR,
    bending,
    bending_period,
    echo_time,
    side_wall,
    sphere_contact,
    zener_number,
)

ULP = 2.0**-52
Captured = pytest.CaptureFixture[str]


def model(**changes: Any) -> Model:
    """A steel-like ball on a plate of some softness, with changes."""
    values: dict[str, Any] = {
        "R": 0.1, "m": 3.0, "v0": 1.0, "h": 0.02, "b": 0.5, "lam": 2e9, "mu": 3e9,
        "sphere_modulus": 5e10, "gravity": 9.81, "edge": "simply-supported",
    }  # fmt: skip
    return Model(**{**values, **changes})


def scene(**tables: Mapping[str, Any]) -> Any:
    """The same as a scene, its sphere of glass, with keys replaced, or removed by None."""
    made: dict[str, dict[str, Any]] = {
        "sphere": {"radius": 0.1, "mass": 3.0, "material": "glass"},
        "plate": {
            "radius": 0.5, "half_thickness": 0.02, "lame_lambda": 2e9, "lame_mu": 3e9,
            "edge": "simply-supported",
        },
        "impact": {"speed": 1.0, "gravity": 9.81},
        "effects": {},
    }  # fmt: skip
    for name, keys in tables.items():
        merged = made.get(name, {}) | dict(keys)
        made[name] = {k: v for k, v in merged.items() if v is not None}
    return read(made)


ALL = frozenset(BY_NAME)
"""Every effect; the model's plate is simply supported."""


# --- theory


def test_links_are_proved_and_proofs_can_fail() -> None:
    for link in (curvature_theory.curvature, effects_theory.effects, plate_motion.plate_motion):
        for formula in link():
            assert formula.proof.residuals
    slope = curvature_theory.spherical_contact()[0].expression
    with pytest.raises(ProofError, match="halved"):
        curvature_theory.prove("Sphere", "", {"halved": slope - slope / 2})


def test_growth_of_the_side_wall_by_another_quadrature() -> None:
    with mp.workdps(20):
        found = 4 / mp.pi**2 * mp.quad(
            lambda y: (y * mp.cosh(y) - mp.sinh(y)) / (2 * y) * mp.besselk(0, y) / mp.besseli(0, y),
            [0, 0.1, 1, 5, 20, 60],
        )  # fmt: skip
    assert abs(float(effects_theory.wall_growth_ball()) - float(found)) < 1e-12
    assert found < kernels.WALL_GROWTH < 1.01 * found


# --- kernels


def test_sphere_on_a_half_space_by_sneddons_integrals() -> None:
    """delta = a int f'/sqrt(a^2 - r^2) dr and P = 2 E* int r^2 f'/sqrt(...) dr, r = a sin t."""
    with mp.workdps(30):
        for rho in (mpf("1e-6"), mpf("0.1"), mpf("0.7"), mpf("0.98")):

            def slope(t: mpf, rho: mpf = rho) -> mpf:
                r = rho * mp.sin(t)
                return r / mp.sqrt(1 - r * r)

            depth = rho * mp.quad(slope, [0, mp.pi / 2])
            force = 2 * mp.quad(
                lambda t, rho=rho: (rho * mp.sin(t)) ** 2 * slope(t, rho), [0, mp.pi / 2]
            )
            rho_double = float(rho)
            found = sphere_contact(rho_double)
            exact = mpf(rho_double)
            assert abs(found.depth * exact**2 / depth - 1) < 1e-13
            assert abs(found.force * mpf(4) / 3 * exact**3 / force - 1) < 1e-13


def test_sphere_kernel_within_its_budget() -> None:
    with mp.workdps(40):
        for rho in (1e-150, 1e-9, 0.1, 0.4999999, 0.5, 0.5000001, 0.9, 0.99, 1 - 2.0**-40):
            x = mpf(rho)
            arc = mp.atanh(x)
            force = mpf(3) / 4 * ((1 + x * x) * arc - x) / x**3 if rho > 1e-5 else 1 + 2 * x * x / 5
            depth, edge = arc / x, 1 / (1 - x * x)
            truth = (force, depth, (depth + edge) / 2)
            # Condition numbers: of the edge at most 2 x^2/(1 - x^2).
            allowed = 8 + float(x * x / (1 - x * x))
            for value, true in zip(sphere_contact(rho), truth, strict=True):
                assert abs(mpf(float(value)) - true) < allowed * float(np.spacing(float(true)))


def test_side_wall_within_its_budget() -> None:
    """Against the integral itself, y = u^3, at 40 digits since its numerator cancels."""
    with mp.workdps(40):
        for alpha in (0.01, 0.3, 0.999):
            a = mpf(alpha)
            integral = mp.quad(
                lambda u, a=a: 3 * u**2
                * (mp.cosh(a * u**3) * a * u**3 - mp.sinh(a * u**3)) / u**9
                * mp.besselk(0, u**3) / mp.besseli(0, u**3),
                [mpf("1e-6"), 0.1, 0.5, 1, 2, 3, 4.4],
            )  # fmt: skip
            true = -8 / (mp.pi**2 * a**2) * integral
            assert abs(mpf(float(side_wall(alpha).depth)) / true - 1) < 1e-14
    alpha = np.linspace(0.01, 0.99, 50)
    step = 1e-5
    low, high = (side_wall(alpha * f).depth * (alpha * f) ** 2 for f in (1 - step, 1 + step))
    slope = (high - low) / (2 * step * alpha) / (2 * alpha)
    np.testing.assert_allclose(side_wall(alpha).slope, slope, rtol=1e-8)
    assert (side_wall(alpha).slope <= 0).all()
    assert (-side_wall(alpha).slope <= WALL_LINEAR * alpha + WALL_CUBIC * alpha**3).all()


def test_bending_is_that_of_a_thin_plate() -> None:
    """delta = P b^2/(8 pi D), D = E* H^3/12."""
    a, R, h, b, E = 0.01, 0.3, 0.02, 0.7, 3e9
    P, D = 4 / 3 * E * a**3 / R, E * (2 * h) ** 3 / 12
    share = P * b**2 / (8 * math.pi * D) * R / a**2
    assert bending(a / h, h / b).depth == pytest.approx(share, rel=1e-15)
    assert BY_NAME["bending"].value(model(R=R, h=h, b=b), a) == pytest.approx(
        2 / math.pi * a * b**2 / (2 * h) ** 3, rel=1e-15
    )


def test_plate_motion_numbers_by_their_definitions() -> None:
    R, m, v0, h, b, lam, mu, rho = 0.01, 0.03, 2.0, 0.004, 0.5, 2e10, 3e10, 2500.0
    E, H = 4 * mu * (lam + mu) / (lam + 2 * mu), 2 * h
    D, K = E * H**3 / 12, 4 / 3 * E * math.sqrt(R)
    T = (m**2 / (K**2 * v0)) ** 0.2
    true = m / (8 * T * math.sqrt(D * rho * H))
    assert zener_number(R, m, v0, h, lam, mu, rho) == pytest.approx(true, rel=1e-14)
    omega = 2.404825557695773**2 / b**2 * math.sqrt(D / (rho * H))
    period = bending_period(h, b, lam, mu, rho)
    assert period == pytest.approx(2 * math.pi / omega, rel=1e-14)
    assert echo_time(h, lam, mu, rho) == pytest.approx(
        4 * H / math.sqrt((lam + 2 * mu) / rho), rel=1e-14
    )


@pytest.mark.parametrize(
    ("call", "good", "bad"),
    [
        (sphere_contact, (0.5,), [(-0.1,), (1.0,), (math.nan,), (math.inf,)]),
        (side_wall, (0.5,), [(-0.1,), (1.0,), (math.nan,)]),
        (bending, (0.5, 0.1), [(-1.0, 0.1), (1.0, 0.0), (1.0, -1.0)]),
        (echo_time, (1.0, 1.0, 1.0, 1.0), [(0.0, 1.0, 1.0, 1.0), (1.0, -1.0, 1.0, 1.0)]),
    ],
)
def test_domain_and_types(call: Any, good: tuple[float, ...], bad: list[tuple[float, ...]]) -> None:
    with np.errstate(all="raise"):
        for point in bad:
            assert np.isnan(np.asarray(call(*point))).all()
        single = np.asarray(call(*(np.float32(x) for x in good)))
        assert single.dtype == np.float32
        several = np.asarray(call(*([x, x] for x in good)))
        assert several.shape[-1] == 2
        assert np.isfinite(several).all()


# --- the law


def test_the_whole_plate_is_the_contact_law() -> None:
    m = model()
    law, a = Law(m, WHOLE_PLATE | {"hertz"}), np.geomspace(1e-8, 0.099, 40)
    shape = law.at(a)
    true = contact_law.indentation(a, m.R, m.h, m.b)
    np.testing.assert_allclose(law.indentation(a, shape), true, rtol=4e-15)
    stiff = contact_law.stiffness(a, m.R, m.h, m.b, m.lam, m.mu)
    np.testing.assert_allclose(law.stiffness(a, shape), stiff, rtol=4e-15)


def test_parts_of_the_plate_add_up() -> None:
    m, a = model(), np.geomspace(1e-4, 0.099, 40)
    whole = Law(m, WHOLE_PLATE).at(a)
    parts = [Law(m, frozenset({name})).at(a) for name in sorted(WHOLE_PLATE)]
    np.testing.assert_allclose(sum(p.depth - 1 for p in parts), whole.depth - 1, rtol=1e-12)
    np.testing.assert_allclose(sum(p.slope - 1 for p in parts), whole.slope - 1, rtol=1e-12)


def test_force_is_the_derivative_of_the_energy() -> None:
    """Virtual work: dU = P d delta, and the stiffness is dP/d delta, with all effects in."""
    law, a, step = Law(model(), ALL), np.linspace(0.005, 0.09, 9), 1e-5

    def at(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        shape = law.at(x)
        return law.force(x, shape), law.indentation(x, shape)

    (low, under), (high, over) = at(a * (1 - step)), at(a * (1 + step))
    np.testing.assert_allclose(
        law.stiffness(a, law.at(a)), (high - low) / (over - under), rtol=1e-8
    )
    slope = 2 * a / law.model.R * law.at(a).slope
    np.testing.assert_allclose(slope, (over - under) / (2 * step * a), rtol=1e-8)
    P = 4 / 3 * law.modulus * a**3 / law.model.R * law.at(a).force
    additive = law.modulus * 2 * (0.75 * P * law.model.R / law.modulus) ** (1 / 3)
    np.testing.assert_allclose(law.stiffness(a, law.at(a)), additive / law.at(a).additive)


def test_a_sphere_as_soft_as_its_plate_halves_the_modulus() -> None:
    """On a half-space; the bending of a plate stays what it was at the same force."""
    m = model(sphere_modulus=model().modulus, gravity=0.0)
    soft, rigid = Law(m, frozenset({"hertz", "sphere_elasticity"})), Law(m, frozenset({"hertz"}))
    assert soft.modulus == rigid.modulus / 2
    one, two = motion.impact(soft), motion.impact(rigid)
    assert one is not None
    assert two is not None
    assert one.contact_time / two.contact_time == pytest.approx(2**0.4, rel=1e-13)
    assert one.max_force / two.max_force == pytest.approx(2**-0.4, rel=1e-13)
    a = np.array([0.01])
    bent = Law(m, frozenset({"hertz", "sphere_elasticity", "bending"}))
    P = bent.force(a, bent.at(a))
    by_plate = bent.indentation(a, bent.at(a)) - a * a / m.R
    D = m.modulus * (2 * m.h) ** 3 / 12
    assert by_plate[0] == pytest.approx(P[0] * m.b**2 / (8 * math.pi * D), rel=1e-13)


def test_flat_spheres_tend_to_hertz() -> None:
    """delta at a force grows by (a/R)^2/15, and the pressure in the middle is Hertz's."""
    m = model(h=1e3, b=1e4)
    curved, flat = Law(m, frozenset({"hertz", "curvature"})), Law(m, frozenset({"hertz"}))
    for rho in (1e-3, 1e-2):
        a = np.array([rho * m.R])
        shape = curved.at(a)
        equal = a * np.cbrt(shape.force)
        ratio = curved.indentation(a, shape) / flat.indentation(equal, flat.at(equal))
        assert ratio[0] - 1 == pytest.approx(rho**2 / 15, rel=20 * rho**2 + 1e-8)
        assert curved.max_pressure(a[0]) == pytest.approx(flat.max_pressure(a[0]), rel=rho**2)
    P = flat.force(np.array([0.01]), flat.at(np.array([0.01])))[0]
    assert flat.max_pressure(0.01) == pytest.approx(1.5 * P / (math.pi * 1e-4), rel=1e-13)


# --- impacts


def by_steps(law: Law) -> tuple[float, float, float, float]:
    """The same impact by an adaptive integration in time, contact radius by bisection."""
    m = law.model
    radii = np.geomspace(1e-9, 0.9 * law.limit, 4000)
    depths = law.indentation(radii, law.at(radii))

    def force(z: float) -> float:
        if z <= 0:
            return 0.0
        a = float(np.interp(z, depths, radii))
        for _ in range(4):
            shape = law.at(np.array([a]))
            error = float(law.indentation(np.array([a]), shape)[0]) - z
            a -= error / (2 * a / m.R * float(shape.slope[0]))
        return float(law.force(np.array([a]), law.at(np.array([a])))[0])

    def motion_of(_: float, y: np.ndarray) -> list[float]:
        return [y[1], law.gravity - force(y[0]) / m.m]

    def released(_: float, y: np.ndarray) -> float:
        return float(y[0])

    def turned(_: float, y: np.ndarray) -> float:
        return float(y[1])

    released.terminal, released.direction = True, -1  # type: ignore[attr-defined]
    found = solve_ivp(
        motion_of, (0, 1.0), [1e-300, m.v0], method="DOP853", rtol=1e-11, atol=1e-16,
        events=(released, turned),
    )  # fmt: skip
    deepest = float(found.y_events[1][0][0])
    a = float(np.interp(deepest, depths, radii))
    return float(found.t_events[0][0]), deepest, force(deepest), a


def test_impact_by_time_steps() -> None:
    """Curved, elastic sphere under weight on a bending plate, against DOP853."""
    law = Law(
        model(v0=0.2), frozenset({"hertz", "sphere_elasticity", "curvature", "bending", "gravity"})
    )
    found = motion.impact(law)
    assert found is not None
    steps = by_steps(law)
    np.testing.assert_allclose(found.numbers[:3], steps[:3], rtol=2e-8)
    assert found.max_contact_radius == pytest.approx(steps[3], rel=1e-5)


def test_impact_of_the_whole_plate_is_the_generated_one() -> None:
    for changes in ({}, {"h": 0.5}, {"h": 0.002, "v0": 0.1}, {"v0": 1e-6}):
        m = model(**changes)
        found = motion.impact(Law(m, WHOLE_PLATE))
        assert found is not None
        np.testing.assert_allclose(found.numbers, kernels.impact(*m.numbers), rtol=4e-14)


@pytest.mark.parametrize(
    ("edge", "ratio"),
    [("simply-supported", lambda nu: (3 + nu) / (2 * (1 + nu))), ("clamped", lambda _: 0.5)],
)
def test_deflection_of_thin_plates_by_their_edge(edge: str, ratio: Any) -> None:
    """Over the soft hinge's, at equal force; the contact itself is next to nothing."""
    for nu in (-0.3, 0.0, 0.3, 0.45):
        m = model(h=1e-5, b=1.0, lam=2 * 3e9 * nu / (1 - 2 * nu), edge=edge)
        a, base = np.array([1e-5]), frozenset({"hertz", *WHOLE_PLATE})
        one, other = (Law(m, effects) for effects in (base, base | {"edge"}))
        found = other.indentation(a, other.at(a)) / one.indentation(a, one.at(a))
        assert found[0] == pytest.approx(ratio(nu), rel=1e-4)


def test_the_edges_model_error_is_said_and_refused() -> None:
    held = {"edge": "clamped", "half_thickness": 0.01}
    result = simulate(scene(plate=held))
    assert 0 < result.model_error < 0.01
    assert "beside this bound" in result.model_note
    assert result.to_json()["model_error"] == result.model_error
    with pytest.raises(SceneError, match="expected a clamped edge whose model is right to 1 %"):
        simulate(
            scene(
                plate={
                    "edge": "clamped",
                    "half_thickness": 0.1,
                    "poissons_ratio": 0.45,
                    "youngs_modulus": 1e8,
                    "lame_lambda": None,
                    "lame_mu": None,
                }
            )
        )
    with pytest.raises(SceneError, match="h/b up to 1"):
        simulate(scene(plate={"half_thickness": 0.6}, effects={"edge": True}))
    assert simulate(scene(plate={"edge": "soft-hinge"})).model_note == ""


@pytest.mark.parametrize(("bent", "factor"), [(False, 2.5), (True, 2.0)])
def test_peak_of_a_slow_sphere_under_its_weight(bent: bool, factor: float) -> None:
    """v0 -> 0: int P d delta = m g delta gives 5/2 m g for Hertz and 2 m g for a linear spring."""
    effects = {"hertz", "gravity"} | ({"bending"} if bent else set())
    m = model(v0=1e-9, h=1e-5 if bent else 0.02, b=5.0, mu=3e12, lam=2e12)
    found = motion.impact(Law(m, frozenset(effects)))
    assert found is not None
    assert found.max_force / (m.m * m.gravity) == pytest.approx(factor, rel=2e-4)


def test_history_keeps_the_energy_with_every_effect() -> None:
    result = simulate(scene(effects=dict.fromkeys(BY_NAME.keys() - {"hertz"}, True)))
    history, law = result.history(301), result.gate.law
    m = result.model
    stored = np.array([
        0.0 if a == 0 else derivation.scene.limits.energy_of(law, float(a))
        for a in history.contact_radius
    ])  # fmt: skip
    moving = 0.5 * m.m * history.velocity**2 - m.m * m.gravity * history.indentation
    np.testing.assert_allclose(moving + stored, 0.5 * m.m * m.v0**2, rtol=1e-12)
    assert history.indentation[150] == pytest.approx(result.max_indentation, rel=1e-12)
    assert history.force.max() == pytest.approx(result.max_force, rel=1e-12)
    assert history.velocity[-1] == pytest.approx(-m.v0, rel=1e-12)


def test_history_of_a_slow_and_heavy_sphere_keeps_the_energy() -> None:
    """It starts all at once beside the time it takes: 32 nodes in time leave 5e-5 of v0^2."""
    law = Law(model(v0=1e-3), frozenset({"hertz", "bending", "gravity", "curvature"}))
    m, found = law.model, motion.impact(law)
    assert found is not None
    times = np.linspace(0.0, found.contact_time, 101)
    depth, velocity, radius, _ = motion.history(law, found, times)
    stored = [derivation.scene.limits.energy_of(law, float(a)) if a else 0.0 for a in radius]
    whole = 0.5 * m.m * velocity**2 - m.m * m.gravity * depth + np.array(stored)
    np.testing.assert_allclose(whole / (0.5 * m.m * m.v0**2), 1.0, rtol=1e-8)


def test_at_rest_under_a_force() -> None:
    """A force of m g gives the static state; both bodies' modulus, the exact profile."""
    [row] = indent(scene(plate={"half_thickness": 1e3, "radius": 1e4}), force=30.0)
    E1, E2 = model_of(scene()).modulus, model_of(scene()).sphere_modulus
    E = 1 / (1 / E1 + 1 / E2)
    a = (0.75 * 30.0 * 0.1 / E) ** (1 / 3)
    assert row.contact_radius == pytest.approx(a, rel=1e-4)
    assert row.indentation == pytest.approx(a * a / 0.1, rel=1e-4)
    assert row.stiffness == pytest.approx(2 * E * a, rel=1e-4)


# --- the gate


def test_bounds_hold_in_random_scenes() -> None:
    rows = measure.judge(25, derivation.effects_check.gated, derivation.effects_check.everything)
    assert [row for row in rows if not row.kept] == []
    assert max(row.tightest for row in rows) > 0.5  # and are no mere caution
    included = [row.included for row in rows]
    assert included == sorted(included)


def test_a_bound_that_does_not_hold_is_noticed() -> None:
    rows = measure.judge(
        3, lambda *_: ([1.0, 1.0, 1.02, 1.0], ["hertz"], 1e-3), lambda _: ([1.0] * 4, ["hertz"])
    )
    assert not any(row.kept for row in rows)
    assert rows[0].quantity == "max_force"


def random_models(count: int) -> Iterator[Model]:
    generator = random.Random(4)
    for _ in range(count):
        yield model(
            h=10 ** generator.uniform(-3, 0.5), v0=10 ** generator.uniform(-3, 1),
            sphere_modulus=10 ** generator.uniform(9, 12), gravity=generator.choice([0.0, 9.81]),
        )  # fmt: skip


def test_a_looser_tolerance_takes_in_no_more() -> None:
    for m in random_models(10):
        taken = [decide(m, {}, rtol).law.effects for rtol in (1e-9, 1e-6, 1e-4, 1e-2, 1e-1)]
        for tight, loose in pairwise(taken):
            assert loose <= tight


def test_both_sides_of_a_threshold() -> None:
    """At the bound itself the effects may stay out; just below it one more is taken in."""
    for m in random_models(4):
        for rtol in (1e-2, 1e-4):
            found = decide(m, {}, rtol)
            if not 0 < found.error < math.inf:
                continue
            assert decide(m, {}, found.error).law.effects == found.law.effects
            tighter = decide(m, {}, found.error * (1 - 1e-9))
            assert len(tighter.law.effects) > len(found.law.effects)
            whole = motion.impact(Law(m, decide(m, {}, 0.0).law.effects))
            parts = motion.impact(found.law)
            assert whole is not None
            assert parts is not None
            for one, other in zip(whole.numbers, parts.numbers, strict=True):
                assert abs(other / one - 1) <= found.error * (1 + 1e-9)


def test_weight_under_the_true_pressure_moves_the_radius_within_the_bound() -> None:
    """There the contact radius grows up to 3.5 times as fast as Hertz' radius of the force."""
    data = measure.scene(226)
    whole = derivation.effects_check.everything(data)
    values, effects, bound = derivation.effects_check.gated(data, 1e-2)
    assert whole is not None
    assert "gravity" not in effects
    assert "pressure" in effects
    assert 0.5 * bound < abs(values[3] / whole[0][3] - 1) <= bound


def test_forced_choices_are_honoured_and_priced() -> None:
    m = model()
    out = decide(m, {"bending": False, "gravity": True}, 1e-1)
    assert "bending" not in out.law.effects
    assert "gravity" in out.law.effects
    rows = {row.name: row for row in out.rows}
    assert rows["bending"].why.startswith("false in the scene: costs")
    assert rows["gravity"].why == "true in the scene"
    small = {row.name: row for row in decide(m, {"side_wall": False}, 1e-9).rows}["side_wall"]
    assert f"up to {100 * small.bound:.2g} %" in small.why
    hertz = ALL - {"pressure"}
    whole, without = (motion.impact(Law(m, e)) for e in (hertz, hertz - {"side_wall"}))
    assert whole is not None
    assert without is not None
    changes = [abs(b / a - 1) for a, b in zip(whole.numbers, without.numbers, strict=True)]
    assert 0.3 * small.bound < max(changes) <= small.bound


def test_the_pressure_needs_the_whole_plate() -> None:
    off = decide(model(), {"bending": False}, 1e-6)
    assert "pressure" not in off.law.effects
    assert "bending is false" in {row.name: row.why for row in off.rows}["pressure"]
    with pytest.raises(SceneError, match=r"got bending = false; leave out effects\.bending"):
        decide(model(), {"bending": False, "pressure": True}, 1e-6)


def test_outputs_that_do_not_matter_take_in_nothing() -> None:
    """The sphere's profile moves the contact radius half as much again as the force."""
    m = model(sphere_modulus=math.inf, gravity=0.0, h=1e3, b=1e4, v0=0.1, edge="soft-hinge")
    worst = decide(m, {}, 0.0, OUTPUTS)
    assert "curvature" in worst.law.effects
    errors = {name: decide(m, {"curvature": "auto"}, 1.0, (name,)).error for name in OUTPUTS}
    assert errors["max_contact_radius"] > 1.4 * errors["max_force"]
    rtol = math.sqrt(errors["max_contact_radius"] * errors["max_force"])
    assert "curvature" in decide(m, {}, rtol, ("max_contact_radius",)).law.effects
    assert "curvature" not in decide(m, {}, rtol, ("max_force",)).law.effects


def test_what_is_out_is_not_called(monkeypatch: pytest.MonkeyPatch) -> None:
    """A half-space's impact calls no kernel of the plate's law, of the profile or of zeros."""
    calls: list[str] = []
    for name in ("indentation", "indentation_slope", "impact", "leading", "side_wall"):
        monkeypatch.setattr(
            kernels, name, lambda *_, name=name, **__: calls.append(name) or math.nan
        )
    thick = {"half_thickness": 1e3, "radius": 1e4}
    for name in ("supported_edge", "supported_edge_slope"):
        monkeypatch.setattr(kernels, name, lambda *_, name=name: calls.append(name) or math.nan)
    result = simulate(scene(plate=thick, effects={"curvature": False, "gravity": False}))
    assert result.gate.law.effects == {"hertz", "sphere_elasticity"}
    assert calls == []
    assert motion.impact(Law(model(), frozenset({"hertz", "bending"}))) is not None
    assert calls == []


def test_beyond_the_law_is_refused_with_its_limit() -> None:
    fast = {"speed": 1e7}
    with pytest.raises(SceneError, match=r"or the contact opens, at 0\.059.* m.*lower the speed"):
        simulate(scene(impact=fast))
    with pytest.raises(SceneError, match=rf"min\({HELD} b, {CURVED} R\) = 0\.099 m"):
        simulate(scene(impact=fast, effects={"pressure": False}))
    flat = {"curvature": False, "edge": False, "pressure": False}
    with pytest.raises(SceneError, match=r"min\(b, R\) = 0\.1 m"):
        simulate(scene(impact=fast, effects=flat))


def test_the_contact_opens_near_three_thicknesses() -> None:
    """Of a rigid paraboloid on a thin plate; a sphere's pressure is steeper and opens before."""
    m = model(sphere_modulus=math.inf, h=0.001, R=10.0, edge="soft-hinge")
    limit = Law(m, ALL - {"curvature", "edge", "gravity"}).limit
    assert limit == 6 * m.h  # 3.01 thicknesses are beyond the law's own limit
    steep = Law(model(h=0.02), ALL).limit
    assert 0.04 < steep < 0.12
    shape = Law(model(h=0.02), ALL).at(np.array([0.999 * steep]))
    assert np.isfinite(shape.force).all()


def test_the_paper_scene_without_any_choice() -> None:
    """Deciding what is unnecessary does not cost the whole law's time in calls of its kernels."""
    thick = scene(plate={"half_thickness": 1e3, "radius": 1e4}, sphere={"material": None})
    result = simulate(thick, rtol=1e-2)
    assert result.accuracy.method == "hertz"
    assert result.gate.law.effects == {"hertz"}
    assert result.accuracy.bound <= 1e-2


# --- what is said


def test_explain_simulates_nothing_and_says_why(capsys: Captured, tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(
        "[sphere]\nradius = 0.01\nmaterial = 'steel'\n[plate]\nradius = 0.5\nthickness = 0.01\n"
        "material = 'glass'\n[impact]\nspeed = 1\n[effects]\nside_wall = false\n"
    )
    assert main(["explain", str(path), "--rtol", "1e-4", "--json", f"{tmp_path}/e.json"]) == 0
    shown = capsys.readouterr().out
    data = json.loads((tmp_path / "e.json").read_text())
    assert [row["name"] for row in data["effects"]] == [effect.name for effect in EFFECTS]
    assert set(data["costs"]) == set(data["included"])
    assert "false in the scene" in json.dumps(data["effects"])
    assert "no impact.gravity" in json.dumps(data["effects"])
    assert data["bound"] <= data["rtol"]
    for row in data["effects"]:
        assert row["name"] in shown
    assert data["notes"] == []
    found = explain(scene())
    assert "inertia is not judged" in found.notes[0]
    assert "<table>" in found._repr_html_()


def test_inertia_is_warned_of_by_its_numbers() -> None:
    pane = {"material": "glass", "lame_lambda": None, "lame_mu": None, "half_thickness": 0.002}
    texts = simulate(scene(plate=pane, impact={"speed": 0.01, "gravity": None})).warnings
    assert "Zener's number lambda" in texts[-1]
    assert "first bending period" in texts[-1]
    slab = pane | {"half_thickness": 0.5, "edge": "soft-hinge"}
    small = {"radius": 0.005, "mass": None}
    texts = simulate(scene(plate=slab, sphere=small, impact={"speed": 1.0})).warnings
    assert len(texts) == 1
    assert "echoes through the thickness" in texts[0]


def test_yield_is_warned_of_on_one_side_only() -> None:
    pressure = simulate(scene()).max_pressure
    for factor, warned in ((0.999, True), (1.001, False)):
        plate = {"yield_stress": factor * pressure / 1.6}
        assert any("yields" in text for text in simulate(scene(plate=plate)).warnings) is warned


def test_the_map_marks_the_scene(tmp_path: Path) -> None:
    example = Path(derivation.scene.__file__).parent / "examples" / "ball_drop.toml"
    assert main(["map", str(example), "--plot", f"{tmp_path}/m.svg"]) == 0
    drawn = (tmp_path / "m.svg").read_text()
    for name in ("curvature", "bending", "edge", "pressure", "the scene"):
        assert name in drawn
    assert main(["map", str(example), "--plot", f"{tmp_path}/m.txt"]) == 2


def test_a_maps_line_is_where_the_bound_is_the_tolerance() -> None:
    """Bending's share of S, 3/2 A/(4 pi eta^2), at a point of the grid."""
    m = model()
    found = map_.shares(m, BY_NAME["bending"])
    true = 1.5 * map_.RADII[20] / (4 * math.pi * map_.THICKNESSES[30] ** 2)
    assert found[20, 30] == pytest.approx(true, rel=1e-12)


def test_the_reference_names_what_it_leaves_out() -> None:
    example = Path(derivation.scene.__file__).parent / "examples" / "glass_pane.toml"
    found = pipeline.in_doubles(example)
    assert found.gate.law.effects == WHOLE_PLATE | {"hertz"}
    assert "leaves out edge, gravity, sphere_elasticity" in found.warnings[-1]


def test_rows_are_shown_in_every_output() -> None:
    result = simulate(scene())
    made = result.to_json()["effects"]
    assert json.loads(json.dumps(made)) == made
    assert [row["name"] for row in made] == [effect.name for effect in EFFECTS]
    assert gate.HEADS[0] in result._repr_html_()
    assert result.model == model_of(scene())
