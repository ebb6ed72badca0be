"""Test plastic contact against Thornton's formula, two other integrations, and its limits."""

import itertools
import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq, minimize_scalar

from derivation.scene import indent, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.yielding import yielding_of
from derivation.scene.dynamic.contact_sequence import contact
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.time_element import P
from derivation.scene.dynamic.wave_problem import problem_of
from derivation.scene.effects import BY_NAME, WHOLE_PLATE
from derivation.scene.model import Model
from derivation.scene.numerics.collocation import ONSET
from derivation.scene.quasi_static import plastic
from derivation.scene.scene import OUTPUTS, SceneError
from derivation.scene.selection.method_selection import moved
from derivation.scene_code import scene_code
from generated.plasticity import plastic_restitution, yield_radius, yield_speed

BALL = Model(R=0.005, m=4.1e-3, v0=1.0, h=0.5, b=1.0, lam=121.15e9, mu=80.77e9, yield_stress=500e6)
HALF_SPACE = frozenset({"hertz", "plasticity"})
DROP = {
    "sphere": {"radius": 0.025, "material": "steel"},
    "plate": {
        "radius": 0.2, "thickness": 0.02, "material": "aluminium", "edge": "clamped",
        "yield_stress": 240e6,
    },
    "impact": {"speed": 1.98},
}  # fmt: skip


def thornton(ratio: float) -> float:
    """Return the restitution at the ratio v_y/v0 (Thornton 1997, equation 20)."""
    part = ratio / (ratio + 2.0 * math.sqrt(1.2 - 0.2 * ratio**2))
    return math.sqrt(1.2 * math.sqrt(3.0) * (1.0 - ratio**2 / 6.0)) * part**0.25


def at_speeds(ratio: float) -> Model:
    """Return the model with an impact speed of `ratio` times the yield speed."""
    speed = float(yield_speed(BALL.R, BALL.m, BALL.lam, BALL.mu, BALL.yield_stress))
    return replace(BALL, v0=ratio * speed)


def drop(effects: dict[str, object] | None = None, **plate: object) -> dict[str, object]:
    """Return the ball-drop scene with other effects or plate keys."""
    return DROP | {"plate": DROP["plate"] | plate, "effects": effects or {}}


def test_onset_is_at_the_limit_of_the_shear_stress() -> None:
    # Stresses on the axis of Hertz's contact for nu = 0.3: Johnson (1985), equation 3.45.
    def difference(z: float) -> float:
        radial = -1.3 * (1.0 - z * math.atan(1.0 / z)) + 0.5 / (1.0 + z * z)
        return -abs(radial + 1.0 / (1.0 + z * z))

    largest = -float(minimize_scalar(difference, bounds=(0.1, 2.0)).fun)
    a = float(yield_radius(1.0, 1.5e11, 1e11, 1e8))
    modulus = 4e11 * (1.5e11 + 1e11) / (1.5e11 + 2e11)
    peak = 2.0 * modulus * a / math.pi
    assert peak * largest == pytest.approx(1e8, rel=1e-2)


@given(st.floats(0.0, 3.0))
def test_half_space_agrees_with_thornton(power: float) -> None:
    ratio = 10.0**power
    xi = ((6.0 * ratio**2 - 1.0) / 5.0) ** (1.0 / 6.0)
    assert float(plastic_restitution(xi)) == pytest.approx(thornton(1.0 / ratio), rel=1e-14)


@pytest.mark.parametrize("run", [moved, plastic.by_time_elements])
@pytest.mark.parametrize("ratio", [1.001, 1.7, 6.0, 100.0])
def test_impacts_agree_with_thornton(
    ratio: float, run: Callable[[ContactLaw], plastic.PlasticMotion]
) -> None:
    result = run(ContactLaw(at_speeds(ratio), HALF_SPACE))
    assert result.restitution == pytest.approx(thornton(1.0 / ratio), rel=1e-12)
    assert result.energy_balance is not None
    assert abs(result.energy_balance.residual) < 1e-13


def test_slow_impact_agrees_with_hertz() -> None:
    model = at_speeds(0.9)
    result = moved(ContactLaw(model, HALF_SPACE))
    elastic = moved(ContactLaw(replace(model, yield_stress=1e20), HALF_SPACE))
    assert result.numbers == elastic.numbers
    assert result.restitution == pytest.approx(1.0, abs=1e-14)
    assert result.dent == 0.0


def test_fast_impacts_of_steel_on_steel_follow_the_fourth_root() -> None:
    # Johnson (1985), section 11.5: e is proportional to v^(-1/4) in a fully plastic contact.
    speeds = np.geomspace(1.0, 100.0, 5)
    actual = [moved(ContactLaw(replace(BALL, v0=v), HALF_SPACE)).restitution
             for v in speeds.tolist()]  # fmt: skip
    slopes = np.diff(np.log(actual)) / np.diff(np.log(speeds))
    assert np.all(np.abs(slopes + 0.25) < 0.002)
    assert abs(slopes[-1] + 0.25) < abs(slopes[0] + 0.25)


@pytest.mark.parametrize("gravity", [0.0, 9.81])
def test_bending_plate_agrees_with_energy_and_quadrature(gravity: float) -> None:
    effects = WHOLE_PLATE | HALF_SPACE | ({"gravity"} if gravity else set())
    model = Model(
        R=0.02, m=0.26, v0=0.5, h=0.005, b=0.1, lam=52e9, mu=26e9, yield_stress=3e8,
        gravity=gravity,
    )  # fmt: skip
    law = ContactLaw(model, frozenset(effects))
    result = moved(law)
    onset = float(yield_radius(model.R, model.lam, model.mu, model.yield_stress))

    def elastic(u: float) -> tuple[float, float]:
        a = np.array([u])
        shape = law.at(a)
        return float(law.force(a, shape)[0]), float(law.indentation(a, shape)[0])

    def loaded(u: float) -> float:
        wide = max(0.0, (2.0 * u**3 / onset + onset**2) / 3.0 - u * u) if u > onset else 0.0
        return elastic(u)[1] + wide / model.R

    def work(depth: object, top: float) -> float:
        # int P d delta = P delta - int delta dP, and dP = 3 P du/u.
        def integrand(u: float) -> float:
            return float(depth(u)) * 3.0 * elastic(u)[0] / u  # type: ignore[operator]

        parts = [0.0, min(onset, top), top]
        complement = sum(quad(integrand, *ends, epsabs=0, epsrel=1e-11)[0]
                    for ends in itertools.pairwise(parts))  # fmt: skip
        return elastic(top)[0] * float(depth(top)) - complement  # type: ignore[operator]

    def difference_at(u: float) -> float:
        weight = model.m * gravity * loaded(u)
        return work(loaded, u) - 0.5 * model.m * model.v0**2 - weight

    top = float(brentq(difference_at, onset, 0.02, xtol=1e-16, rtol=1e-14))
    wide = math.sqrt((2.0 * top**3 / onset + onset**2) / 3.0)
    flat = top / wide
    dent = wide**2 / model.R * (1.0 - flat**3)

    def unloaded(u: float) -> float:
        return elastic(u)[1] - (1.0 - flat) * u * u / model.R

    back = work(unloaded, top) - model.m * gravity * unloaded(top)
    assert result.max_force == pytest.approx(elastic(top)[0], rel=1e-9)
    assert result.max_indentation == pytest.approx(loaded(top), rel=1e-9)
    assert result.max_contact_radius == pytest.approx(wide, rel=1e-9)
    assert result.restitution == pytest.approx(math.sqrt(2.0 * back / model.m) / model.v0, rel=1e-9)
    assert result.dent == pytest.approx(dent, rel=1e-9)


class Marched:
    """First contact on a plate with inertia by a Runge-Kutta method, with a fixed dent per step."""

    def __init__(self, problem: DynamicProblem, onset: float) -> None:
        self.problem, self.onset, self.top = problem, onset, onset
        self.y = np.concatenate(([0.0, 1.0], np.zeros(2 * problem.omega.size)))

    def added(self, a: float) -> float:
        """Return the plastic part of the indentation times R."""
        onset, top = self.onset, self.top
        if a > top:
            return (2.0 * a**3 / onset + onset**2) / 3.0 - a * a
        wide = math.sqrt((2.0 * top**3 / onset + onset**2) / 3.0)
        return wide**2 * (1.0 - (top / wide) ** 3) - (1.0 - top / wide) * a * a

    def radius(self, y: np.ndarray) -> float:
        """Return the radius at which the indentation equals the displacement of the sphere."""
        problem, shapes = self.problem, self.problem.contact.modes
        q = shapes.by_shape(np.split(y[2:], 2)[0])

        def difference_at(a: float) -> float:
            at = problem.contact.at(np.array([a]))
            depth = (float(at.depth[0]) + self.added(a) / problem.contact.R) / problem.depth
            return depth + float((1.0 + at.weights_less_one[0]) @ q) - float(y[0])

        return float(brentq(difference_at, 1e-9, 0.99 * problem.contact.top, xtol=1e-16))

    def rate(self, _: float, y: np.ndarray) -> np.ndarray:
        problem, (q, q_dot) = self.problem, np.split(y[2:], 2)
        at = problem.contact.at(np.array([self.radius(y) if y[0] > 0.0 else 1e-9]))
        modal_force = at.modal_forces[0][problem.contact.modes.shape] / problem.force
        pull = problem.inverse_modal_mass * modal_force - problem.omega**2 * q
        return np.concatenate(([y[1], -float(at.force[0]) / problem.force], q_dot, pull))

    def step(self, t: float, dt: float) -> float:
        """Integrate one step and return the force after it [N]."""
        solution = solve_ivp(self.rate, (t, t + dt), self.y, rtol=1e-9, atol=1e-12)
        self.y = solution.y[:, -1]
        a = self.radius(self.y)
        self.top = max(self.top, a)
        return float(self.problem.contact.at(np.array([a])).force[0])


def test_plate_with_inertia_agrees_with_another_integrator() -> None:
    model = Model(
        R=0.01, m=0.02, v0=1.0, h=0.002, b=0.1, lam=52e9, mu=26e9, density=2700.0,
        yield_stress=2e8,
    )  # fmt: skip
    law = ContactLaw(model, WHOLE_PLATE | HALF_SPACE | {"inertia", "edge"})
    problem, branch = problem_of(law, 4), yielding_of(law)
    assert branch is not None
    with np.errstate(all="ignore"):
        pieces = contact(problem, 16, problem.begin(), 0.0, 0.0).pieces
    end = (pieces[-1].element.x + pieces[-1].element.length) ** ONSET
    times = np.arange(0.0, 0.9 * end, 2e-3)
    marched = Marched(problem, branch.onset)
    steps = itertools.pairwise(times.tolist())
    expected = np.array([marched.step(t, later - t) for t, later in steps])
    x = times[1:] ** (1.0 / ONSET)
    index = np.searchsorted([piece.element.x for piece in pieces], x, side="right") - 1
    actual = [
        problem.force * float(pieces[k].element.at(np.array([one]))[P, 0])
        for k, one in zip(index, x, strict=True)
    ]
    # The largest radius is updated once per step, so its square has an error of first order.
    assert marched.top > 1.5 * branch.onset
    assert np.max(np.abs(actual - expected)) < 2e-4 * max(actual)


def test_energy_balance_closes_over_several_contacts() -> None:
    result = simulate(read(drop()))
    assert result.dynamics is not None
    balance = result.dynamics.energy_balance
    assert len(result.dynamics.inertia.contacts) > 1
    assert abs(balance.residual) < 1e-11
    assert balance.plastic_loss > 0.3 * balance.initial_kinetic
    assert result.dent > 0.0
    assert result.max_pressure == 1.6 * 240e6


def test_plate_with_high_yield_stress_gives_the_elastic_results() -> None:
    elastic = simulate(read(drop({"plasticity": False})))
    for stress in (3e9, 1e12):
        hard = simulate(read(drop({"plasticity": True}, yield_stress=stress)))
        for name in OUTPUTS:
            assert getattr(hard, name) == pytest.approx(getattr(elastic, name), rel=1e-10)


def test_stated_error_covers_the_speed_of_a_contact_that_does_not_yield() -> None:
    """Runs with 14 and 16 nodes agree to 7e-11, but have errors of 9e-11 (large deflection)."""
    plate = {"radius": 0.0755, "half_thickness": 1.75e-4, "youngs_modulus": 1.3e11}
    scene = {
        "sphere": {"radius": 0.0417, "density": 2120.0},
        "plate": plate | {"poissons_ratio": -0.4, "yield_stress": 8.12e7},
        "impact": {"speed": 4.09e-3},
        "effects": {"inertia": False, "plasticity": True},
    }
    motion = plastic.by_time_elements(simulate(read(scene)).effects.law)
    assert motion.dent == 0.0
    assert 0.0 < abs(motion.restitution - 1.0) <= motion.quadrature


def test_plates_agree_before_the_echo() -> None:
    # The contact ends before a wave returns from the edge, so the edge condition has no effect.
    actual = [
        simulate(read({
            "sphere": {"radius": 0.005, "material": "steel"},
            "plate": {"radius": 1.0, "thickness": 0.02, "material": "steel",
                      "yield_stress": 4e8, "edge": edge},
            "impact": {"speed": 2.0},
        }))
        for edge in ("paper", "clamped", "simply-supported")
    ]  # fmt: skip
    for other in actual[1:]:
        assert other.restitution == pytest.approx(actual[0].restitution, rel=2e-4)
        assert other.dent == pytest.approx(actual[0].dent, rel=2e-4)


def test_energy_balance_of_a_viscoplastic_contact_with_inertia() -> None:
    result = simulate(read(drop(retardation_time=2e-6)))
    assert result.dynamics is not None
    balance = result.dynamics.energy_balance
    assert balance.plastic_loss > 0.0
    assert balance.viscous_loss > 0.0
    assert abs(balance.residual) < 1e-9


def test_plasticity_is_omitted_only_below_the_onset() -> None:
    fast = simulate(read(drop({"inertia": False})))
    slow = simulate(read(drop({"inertia": False}) | {"impact": {"speed": 1e-4}}))
    assert "plasticity" in fast.effects.law.effects
    assert "plasticity" not in slow.effects.law.effects
    [row] = [row for row in slow.effects.rows if row.name == "plasticity"]
    assert row.bound == 0.0
    assert row.parameter_value < 1.0


@pytest.mark.parametrize("seed", range(6))
def test_stated_bounds_hold_with_plasticity(seed: int) -> None:
    rng = np.random.default_rng(seed)
    R = 10 ** rng.uniform(-3, -1.3)
    h = R * 10 ** rng.uniform(-0.5, 1.5)
    E = 10 ** rng.uniform(9, 11.3)
    scene = {
        "sphere": {"radius": R, "material": "steel"},
        "plate": {
            "radius": h * 10 ** rng.uniform(0.5, 1.5), "thickness": h, "youngs_modulus": E,
            "poissons_ratio": rng.uniform(0, 0.45), "yield_stress": E * 10 ** rng.uniform(-3.3, -2),
        },
        "impact": {"speed": 10 ** rng.uniform(-2, 0.5)},
        "effects": {"inertia": False},
    }  # fmt: skip
    loose, tight = (simulate(read(scene), rtol=rtol) for rtol in (0.05, 1e-9))
    assert "plasticity" in tight.effects.law.effects
    allowed = loose.accuracy.bound + tight.accuracy.bound
    for name in OUTPUTS:
        assert abs(getattr(loose, name) / getattr(tight, name) - 1.0) <= allowed


@pytest.mark.parametrize("ratio", [1.15, 1.3])
def test_bounds_hold_with_plate_inertia(ratio: float) -> None:
    """The bounds hold where Hertz's pressure is slightly larger than the pressure limit."""
    scene = drop({"non_hertzian_pressure": False}, edge="paper", thickness=0.05)
    elastic = simulate(read(scene | {"effects": scene["effects"] | {"plasticity": False}}),
                       rtol=0.02)  # fmt: skip
    [row] = [row for row in elastic.effects.rows if row.name == "plasticity"]
    stress = 240e6 * row.parameter_value / ratio
    scene |= {"plate": scene["plate"] | {"yield_stress": stress}}
    actual = [
        simulate(read(scene | {"effects": scene["effects"] | wanted}), rtol=rtol)
        for wanted, rtol in (({"plasticity": False}, 0.02), ({}, 0.5), ({"plasticity": True}, 0.02))
    ]
    without, loose, tight = actual
    [row] = [row for row in without.effects.rows if row.name == "plasticity"]
    bounds = loose.accuracy.bound, row.bound + without.accuracy.bound
    for other, bound in zip((loose, without), bounds, strict=True):
        for name in OUTPUTS:
            change = abs(getattr(other, name) / getattr(tight, name) - 1.0)
            assert change <= bound + tight.accuracy.bound
    assert math.isfinite(row.bound)
    assert tight.dent > 0.0


def test_static_plastic_contact_is_consistent_on_loading() -> None:
    scene = read(drop())
    [small] = indent(scene, force=1.0)
    [elastic] = indent(read(drop({"plasticity": False})), force=1.0)
    assert small == elastic
    [large] = indent(scene, force=5000.0)
    [again] = indent(scene, indentation=large.indentation)
    [once] = indent(scene, contact_radius=large.contact_radius)
    for other in (again, once):
        assert other.force == pytest.approx(5000.0, rel=1e-13)
    step = 1e-4
    [more] = indent(scene, indentation=large.indentation * (1 + step))
    [less] = indent(scene, indentation=large.indentation * (1 - step))
    slope = (more.force - less.force) / (2 * step * large.indentation)
    assert large.stiffness == pytest.approx(slope, rel=1e-7)
    # The mean pressure approaches the pressure limit from below.
    mean = 5000.0 / (math.pi * large.contact_radius**2)
    assert 2 / 3 * large.max_pressure < mean < large.max_pressure == 1.6 * 240e6


@pytest.mark.parametrize("thickness", [1e-2, 1e-3, 2e-4])
def test_static_contacts_of_thin_plates_are_the_same_from_radius_force_and_depth(
    thickness: float,
) -> None:
    plate = DROP["plate"] | {"thickness": thickness, "yield_stress": 30e6}
    scene = read(DROP | {"plate": plate, "effects": {"stretching": False}})
    radii = np.geomspace(0.05, 1.4, 9) * thickness
    by_radius = indent(scene, contact_radius=radii)
    by_force = indent(scene, force=[one.force for one in by_radius])
    by_depth = indent(scene, indentation=[one.indentation for one in by_radius])
    assert all(np.diff([one.force for one in by_radius]) > 0.0)
    for force, depth, radius in zip(by_force, by_depth, radii, strict=True):
        assert force.contact_radius == pytest.approx(radius, rel=1e-10)
        assert depth.contact_radius == pytest.approx(radius, rel=1e-9)


def test_parameter_is_the_pressure_relative_to_its_limit() -> None:
    law = ContactLaw(BALL, frozenset({"hertz"}))
    a = 1e-4
    actual = BY_NAME["plasticity"].value(BALL, a)
    assert actual == pytest.approx(law.max_pressure(a) / (1.6 * BALL.yield_stress), rel=1e-14)


def test_code_of_a_plastic_contact_is_rejected_with_a_remedy() -> None:
    with pytest.raises(SceneError, match=r"^effects\.plasticity: "):
        scene_code(read(drop({"inertia": False})))
