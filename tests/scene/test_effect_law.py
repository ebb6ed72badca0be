"""The contact law with its effects, and its impacts, against independent and exact solutions."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from shared_scenes import ALL, model, scene

from derivation.scene import indent, kernels, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import energy_of, last_radius
from derivation.scene.effects import WHOLE_PLATE
from derivation.scene.errors import SceneError
from derivation.scene.indentation import static_law
from derivation.scene.model import model_of
from derivation.scene.quasi_static import motion
from generated import contact_law


def test_all_parts_of_the_plate_give_the_contact_law() -> None:
    m = model()
    law, a = ContactLaw(m, WHOLE_PLATE | {"hertz"}), np.geomspace(1e-8, 0.099, 40)
    shape = law.at(a)
    exact = contact_law.indentation(a, m.R, m.h, m.b)
    np.testing.assert_allclose(law.indentation(a, shape), exact, rtol=4e-15)
    stiff = contact_law.stiffness(a, m.R, m.h, m.b, m.lam, m.mu)
    np.testing.assert_allclose(law.stiffness(a, shape), stiff, rtol=4e-15)


def test_parts_of_the_plate_add_up() -> None:
    m, a = model(), np.geomspace(1e-4, 0.099, 40)
    whole = ContactLaw(m, WHOLE_PLATE).at(a)
    parts = [ContactLaw(m, frozenset({name})).at(a) for name in sorted(WHOLE_PLATE)]
    np.testing.assert_allclose(sum(p.depth - 1 for p in parts), whole.depth - 1, rtol=1e-12)
    np.testing.assert_allclose(sum(p.slope - 1 for p in parts), whole.slope - 1, rtol=1e-12)


@pytest.mark.parametrize(
    "omitted", [set(), {"non_hertzian_pressure"}], ids=["integral equation", "hertz"]
)
def test_force_is_the_derivative_of_the_energy(omitted: set[str]) -> None:
    """The stiffness dP/d delta and the slope d delta/da agree with finite differences."""
    law, a, step = ContactLaw(model(), ALL - omitted), np.linspace(0.005, 0.09, 9), 1e-5

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


def test_sphere_of_equal_modulus_halves_the_effective_modulus() -> None:
    """On a half-space only the local indentation depends on the sphere, not the plate bending."""
    m = model(sphere_modulus=model().modulus, gravity=0.0)
    soft, rigid = (
        ContactLaw(m, frozenset({"hertz", "sphere_elasticity"})),
        ContactLaw(m, frozenset({"hertz"})),
    )
    assert soft.modulus == rigid.modulus / 2
    one, two = motion.impact(soft), motion.impact(rigid)
    assert one.contact_time / two.contact_time == pytest.approx(2**0.4, rel=1e-13)
    assert one.max_force / two.max_force == pytest.approx(2**-0.4, rel=1e-13)
    a = np.array([0.01])
    bent = ContactLaw(m, frozenset({"hertz", "sphere_elasticity", "bending"}))
    P = bent.force(a, bent.at(a))
    by_plate = bent.indentation(a, bent.at(a)) - a * a / m.R
    D = m.modulus * (2 * m.h) ** 3 / 12
    assert by_plate[0] == pytest.approx(P[0] * m.b**2 / (8 * math.pi * D), rel=1e-13)


def test_small_contacts_of_a_sphere_tend_to_hertz() -> None:
    """At equal force delta exceeds Hertz's by (a/R)^2/15; the central pressure tends to Hertz's."""
    m = model(h=1e3, b=1e4)
    curved, flat = (
        ContactLaw(m, frozenset({"hertz", "spherical_profile"})),
        ContactLaw(m, frozenset({"hertz"})),
    )
    for rho in (1e-3, 1e-2):
        a = np.array([rho * m.R])
        shape = curved.at(a)
        equal = a * np.cbrt(shape.force)
        ratio = curved.indentation(a, shape) / flat.indentation(equal, flat.at(equal))
        assert ratio[0] - 1 == pytest.approx(rho**2 / 15, rel=20 * rho**2 + 1e-8)
        assert curved.max_pressure(a[0]) == pytest.approx(flat.max_pressure(a[0]), rel=rho**2)
    P = flat.force(np.array([0.01]), flat.at(np.array([0.01])))[0]
    assert flat.max_pressure(0.01) == pytest.approx(1.5 * P / (math.pi * 1e-4), rel=1e-13)


def test_central_pressure_agrees_with_the_integral_equation() -> None:
    """The sum over flat punches agrees with the Fredholm equation for a steep sphere on a block."""
    m = model(h=1e3, b=1e4, sphere_modulus=math.inf)
    summed = ContactLaw(m, frozenset({"hertz", "spherical_profile"}))
    solved = ContactLaw(m, WHOLE_PLATE | {"hertz", "spherical_profile", "non_hertzian_pressure"})
    for rho in (0.1, 0.5, 0.8):
        a = rho * m.R
        assert summed.max_pressure(a) == pytest.approx(solved.max_pressure(a), rel=1e-4)


def by_steps(law: ContactLaw) -> tuple[float, float, float, float]:
    """Return results of the impact by adaptive integration in time, with Newton's iteration."""
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
    solution = solve_ivp(
        motion_of, (0, 1.0), [1e-300, m.v0], method="DOP853", rtol=1e-11, atol=1e-16,
        events=(released, turned),
    )  # fmt: skip
    deepest = float(solution.y_events[1][0][0])
    a = float(np.interp(deepest, depths, radii))
    return float(solution.t_events[0][0]), deepest, force(deepest), a


def test_impact_agrees_with_time_integration() -> None:
    """The impact of a heavy elastic sphere on a bending plate agrees with DOP853."""
    law = ContactLaw(
        model(v0=0.2),
        frozenset({"hertz", "sphere_elasticity", "spherical_profile", "bending", "gravity"}),
    )
    result = motion.impact(law)
    steps = by_steps(law)
    np.testing.assert_allclose(result.numbers[:3], steps[:3], rtol=2e-8)
    assert result.max_contact_radius == pytest.approx(steps[3], rel=1e-5)


def test_impact_with_all_parts_agrees_with_the_generated_function() -> None:
    for changes in ({}, {"h": 0.5}, {"h": 0.002, "v0": 0.1}, {"v0": 1e-6}):
        m = model(**changes)
        result = motion.impact(ContactLaw(m, WHOLE_PLATE))
        np.testing.assert_allclose(result.numbers[:4], kernels.impact(*m.numbers), rtol=4e-14)


@pytest.mark.parametrize(
    ("edge", "ratio"),
    [("simply-supported", lambda nu: (3 + nu) / (2 * (1 + nu))), ("clamped", lambda _: 0.5)],
)
def test_deflection_of_thin_plates_depends_on_the_edge(edge: str, ratio: Any) -> None:
    """The ratio to the deflection with the paper's edge at equal force is that of plate theory."""
    for nu in (-0.3, 0.0, 0.3, 0.45):
        m = model(h=1e-5, b=1.0, lam=2 * 3e9 * nu / (1 - 2 * nu), edge=edge)
        a, base = np.array([1e-5]), frozenset({"hertz", *WHOLE_PLATE})
        one, other = (ContactLaw(m, effects) for effects in (base, base | {"edge"}))
        actual = other.indentation(a, other.at(a)) / one.indentation(a, one.at(a))
        assert actual[0] == pytest.approx(ratio(nu), rel=1e-4)


@pytest.mark.parametrize(("bent", "factor"), [(False, 2.5), (True, 2.0)])
def test_peak_force_of_a_slow_heavy_sphere(bent: bool, factor: float) -> None:
    """For v0 -> 0, int P d delta = m g delta gives 5/2 m g (Hertz) and 2 m g (linear spring)."""
    effects = {"hertz", "gravity"} | ({"bending"} if bent else set())
    m = model(v0=1e-9, h=1e-5 if bent else 0.02, b=5.0, mu=3e12, lam=2e12)
    result = motion.impact(ContactLaw(m, frozenset(effects)))
    assert result.max_force / (m.m * m.gravity) == pytest.approx(factor, rel=2e-4)


@pytest.mark.one_version
def test_history_conserves_energy_with_every_effect() -> None:
    wanted = dict.fromkeys(ALL - {"hertz", "viscosity", "plasticity"}, True)
    result = simulate(scene(effects=wanted))
    history, law = result.history(301), result.effects.law
    m = result.model
    stored = np.array([
        0.0 if a == 0 else energy_of(law, float(a))
        for a in history.contact_radius
    ])  # fmt: skip
    moving = 0.5 * m.m * history.velocity**2 - m.m * m.gravity * history.indentation
    np.testing.assert_allclose(moving + stored, 0.5 * m.m * m.v0**2, rtol=1e-12)
    assert history.indentation[150] == pytest.approx(result.max_indentation, rel=1e-12)
    assert history.force.max() == pytest.approx(result.max_force, rel=1e-12)
    assert history.velocity[-1] == pytest.approx(-m.v0, rel=1e-12)


def test_history_of_a_slow_heavy_sphere_conserves_energy() -> None:
    """The onset is short compared with the contact, so the time quadrature needs many nodes."""
    law = ContactLaw(
        model(v0=1e-3), frozenset({"hertz", "bending", "gravity", "spherical_profile"})
    )
    m, result = law.model, motion.impact(law)
    times = np.linspace(0.0, result.contact_time, 101)
    depth, velocity, radius, _ = result.history(law, times)
    stored = [energy_of(law, float(a)) if a else 0.0 for a in radius]
    whole = 0.5 * m.m * velocity**2 - m.m * m.gravity * depth + np.array(stored)
    np.testing.assert_allclose(whole / (0.5 * m.m * m.v0**2), 1.0, rtol=1e-8)


def test_number_of_nodes_is_doubled_until_convergence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """For a slow and heavy sphere fewer nodes give a larger error, within its estimate."""
    law = ContactLaw(
        model(v0=1e-5), frozenset({"hertz", "bending", "gravity", "spherical_profile"})
    )
    result = motion.impact(law)
    monkeypatch.setattr(motion, "MORE_TIMES", ())
    few = motion.impact(law)
    assert result.quadrature < 1e-13
    assert 1e-9 < abs(few.contact_time / result.contact_time - 1) <= few.quadrature


def test_velocity_is_the_derivative_of_the_indentation() -> None:
    """Central differences of the indentation agree with the velocity."""
    law = ContactLaw(model(), frozenset({"hertz", "bending", "gravity", "spherical_profile"}))
    result = motion.impact(law)
    T = result.contact_time
    middle, step = np.linspace(0.05, 0.95, 47) * T, 1e-5 * T
    after, before = (result.history(law, middle + x)[0] for x in (step, -step))
    _, velocity, _, _ = result.history(law, middle)
    np.testing.assert_allclose((after - before) / (2 * step), velocity, atol=1e-6)


def test_static_contact_at_a_given_force() -> None:
    """The static contact on a very thick plate is Hertz's with the modulus of both bodies."""
    [row] = indent(scene(plate={"half_thickness": 1e3, "radius": 1e4}), force=30.0)
    E1, E2 = model_of(scene()).modulus, model_of(scene()).sphere_modulus
    E = 1 / (1 / E1 + 1 / E2)
    a = (0.75 * 30.0 * 0.1 / E) ** (1 / 3)
    assert row.contact_radius == pytest.approx(a, rel=1e-4)
    assert row.indentation == pytest.approx(a * a / 0.1, rel=1e-4)
    assert row.stiffness == pytest.approx(2 * E * a, rel=1e-4)


@given(
    thickness=st.floats(-1.0, 2.0), width=st.floats(-1.0, 2.0),
    ratio=st.sampled_from([0.0, 0.3, 0.45]), edge=st.sampled_from(["paper", "clamped"]),
)  # fmt: skip
def test_law_with_hertz_pressure_is_finite_up_to_its_limit(
    thickness: float, width: float, ratio: float, edge: str
) -> None:
    """Also if Hertz's radius of the force, at which the plate deflects, exceeds the contact's."""
    h = 10.0**thickness
    scene = read({
        "sphere": {"radius": 1.0, "density": 1e3},
        "plate": {
            "radius": max(h / 50, 10.0**width), "half_thickness": h,
            "youngs_modulus": 1e9, "poissons_ratio": ratio, "edge": edge,
        },
        "impact": {"speed": 1.0},
        "effects": {"non_hertzian_pressure": False},
    })  # fmt: skip
    law = static_law(scene)
    radii = np.linspace(0.01, 1.0, 30) * last_radius(law)
    shape = law.at(radii)
    assert np.isfinite(shape).all()
    assert np.all(np.diff(law.force(radii, shape)) > 0.0)


def test_plastic_contact_wider_than_the_law_allows_is_rejected() -> None:
    """Yielding widens a contact whose elastic radius is within the limit."""
    scene = read({
        "sphere": {"radius": 0.01, "density": 7800.0},
        "plate": {
            "radius": 0.012, "thickness": 0.02, "youngs_modulus": 1e9, "poissons_ratio": 0.3,
            "yield_stress": 1e6,
        },
        "impact": {"speed": 1.0},
        "effects": {"non_hertzian_pressure": False},
    })  # fmt: skip
    [wide] = indent(scene, contact_radius=0.009)
    with pytest.raises(SceneError, match=r"expected a contact radius below .*reduce the force"):
        indent(scene, force=2.0 * wide.force)
