"""Test the viscoelastic contact against an exact ODE, a series, SciPy and the energy balance."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import beta, mp, mpf
from scipy.integrate import solve_ivp
from shared_scenes import ALL, AT_REST

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.effects import BY_NAME, WHOLE_PLATE
from derivation.scene.model import Model
from derivation.scene.quasi_static import motion, viscous
from derivation.scene.scene import OUTPUTS, SceneError
from derivation.scene.selection.effect_selection import decide
from derivation.scene.selection.method_selection import moved
from generated.viscosity import ImpactExtremes, restitution_weak, viscous_logarithms, viscous_number

HERTZ = frozenset({"hertz", "viscosity"})
PLATE = WHOLE_PLATE | HERTZ
BALL = Model(R=0.01, m=0.03, v0=0.5, h=0.01, b=0.1, lam=2e9, mu=1e9, retardation_time=2e-6)


def with_number(x: float, model: Model = BALL) -> Model:
    """Return the model with the retardation time at which the viscous parameter is x."""
    one = replace(model, retardation_time=1.0)
    return replace(model, retardation_time=x / BY_NAME["viscosity"].value(one, 0.0))


def spiral(x: float) -> tuple[float, float]:
    """Return the restitution of a Hertz contact, and its time over the elastic contact time.

    Integrate the polar form of derivation step 24 over the angle phi.
    """
    top = 0.8**0.4 * x

    def rates(u: float, state: np.ndarray) -> list[float]:
        # The substitution phi = u^5 removes the singularity of the time at phi = 0.
        phi, radius = u**5, state[0]
        epsilon = top * max(radius * math.sin(phi), 0.0) ** 0.2
        turning = 1.0 + epsilon * math.sin(phi) * math.cos(phi)
        omega = max(radius * math.sin(phi) / u**5, 1e-30) ** 0.2
        return [
            -radius * epsilon * math.cos(phi) ** 2 / turning * 5 * u**4,
            5 * u**3 / (omega * turning),
        ]

    def scaled_force(u: float, state: np.ndarray) -> float:
        phi = u**5
        return math.sin(phi) + top * max(state[0] * math.sin(phi), 0.0) ** 0.2 * math.cos(phi)

    scaled_force.terminal, scaled_force.direction = True, -1.0  # type: ignore[attr-defined]
    solution = solve_ivp(
        rates,
        (0.1**6, math.pi**0.2),
        [1.0, 0.0],
        "DOP853",
        events=scaled_force,
        rtol=1e-13,
        atol=1e-15,
    )
    [end], [state] = solution.t_events[0], solution.y_events[0]
    elastic = float(beta(mpf("0.4"), mpf("0.5")))  # int_0^pi sin^(-1/5)
    return -state[0] * math.cos(end**5), state[1] / elastic


@pytest.mark.parametrize("x", [1e-3, 0.03, 0.3, 1.0, 3.0])
def test_hertz_contact_follows_the_spiral(x: float) -> None:
    model = with_number(x)
    result, elastic = (
        moved(ContactLaw(model, HERTZ)),
        moved(ContactLaw(model, frozenset({"hertz"}))),
    )
    restitution, time = spiral(x)
    assert result.restitution == pytest.approx(restitution, rel=1e-10)
    assert result.contact_time / elastic.contact_time == pytest.approx(time, rel=1e-9)


def test_restitution_of_weak_viscosity_agrees_with_the_published_series() -> None:
    """For small x the restitution has the series of Schwager and Poeschel (2008).

    The series is 1 - 1.153449 x + 0.798267 x^2 + (4/15) x^(5/2) + ...
    """
    with mp.workdps(30):
        c = mpf("0.8") ** mpf("0.4") * beta(mpf("0.6"), mpf("1.5"))
        assert float(restitution_weak(0.25)) == pytest.approx(
            float(1 - c / 4 + c * c * mpf("0.6") / 16), rel=1e-15
        )
    assert float(1 - restitution_weak(1e-9)) / 1e-9 == pytest.approx(1.153449, abs=1e-6)
    rest = []
    for x in (1e-3, 4e-3):
        weak = float(restitution_weak(x))
        rest.append((moved(ContactLaw(with_number(x), HERTZ)).restitution - weak) / x**2.5)
    # The next term is smaller by a factor of order sqrt(x).
    assert 2 * rest[0] - rest[1] == pytest.approx(4 / 15, rel=0.01)


def test_viscous_parameter_is_that_of_the_scene() -> None:
    K = 4 / 3 * BALL.modulus * math.sqrt(BALL.R)
    expected = 1.5 * BALL.retardation_time * (K / BALL.m) ** 0.4 * BALL.v0**0.2
    actual = viscous_number(BALL.R, BALL.m, BALL.v0, BALL.lam, BALL.mu, BALL.retardation_time)
    assert float(actual) == pytest.approx(expected, rel=1e-14)
    soft = replace(BALL, sphere_modulus=BALL.modulus)
    assert BY_NAME["viscosity"].value(soft, 0.0) == pytest.approx(expected / 2**0.4, rel=1e-14)
    assert math.isnan(float(viscous_number(1.0, 1.0, 1.0, 1.0, 1.0, 0.0)))


def by_scipy(law: ContactLaw) -> tuple[float, float, float, float]:
    """Return time, indentation, force and restitution with plate bending.

    SciPy integrates an ODE for the displacement z, the speed v and the contact radius a.
    """
    model = law.model
    bent = replace(law, effects=law.effects & {"bending", "edge"})
    R, A = model.R, model.retardation_time

    def state(y: np.ndarray) -> tuple[float, float, float]:
        """Return the force, its elastic part and the derivative of the elastic part by a."""
        z, _, a = y
        shape = law.at(np.array([a]))
        elastic, depth = law.force(a, shape)[0], law.indentation(a, shape)[0]
        slope = law.stiffness(a, shape)[0] * 2 * a / R * shape.slope[0]
        # Bending is linear in the force, so w(P) - w(P_e) = z - delta_e.
        radius = np.array([1e-3 * model.h])
        compliance = (radius / R * bent.deflection(radius).depth * radius)[0]
        compliance /= 4 / 3 * law.modulus * radius[0] ** 3 / R
        return elastic + (z - depth) / compliance, elastic, slope

    def rates(_: float, y: np.ndarray) -> list[float]:
        force, elastic, slope = state(y)
        return [y[1], -force / model.m, (force - elastic) / (A * slope)]

    def contact_force(_: float, y: np.ndarray) -> float:
        return state(y)[0]

    contact_force.terminal, contact_force.direction = True, -1.0  # type: ignore[attr-defined]
    elastic = moved(replace(law, effects=law.effects - {"viscosity"}))
    first = 1e-7 * elastic.contact_time
    start = viscous.impact(law)
    depth, speed, radius, _ = (x[0] for x in start.history(law, np.array([first])))
    solution = solve_ivp(
        rates, (first, 3 * elastic.contact_time), [depth, speed, radius], "Radau", rtol=1e-10,
        atol=[1e-14 * elastic.max_indentation, 1e-12 * model.v0, 1e-9 * radius],
        events=contact_force,
    )  # fmt: skip
    forces = [state(y)[0] for y in solution.y.T]
    return (
        float(solution.t_events[0][0]),
        float(solution.y[0].max()),
        max(forces),
        -float(solution.y_events[0][0][1]) / model.v0,
    )


def test_bending_plate_agrees_with_another_integrator() -> None:
    model = replace(BALL, h=0.002, b=0.06, retardation_time=4e-5)
    law = ContactLaw(model, PLATE)
    result = moved(law)
    time, depth, force, restitution = by_scipy(law)
    assert result.contact_time == pytest.approx(time, rel=1e-7)
    assert result.restitution == pytest.approx(restitution, rel=1e-8)
    # SciPy gives the largest values at its steps only, so they are slightly too small.
    assert depth <= result.max_indentation == pytest.approx(depth, rel=1e-3)
    assert force <= result.max_force * (1 + 1e-9)
    assert result.max_force == pytest.approx(force, rel=1e-3)


@settings(max_examples=40)
@given(
    st.floats(-6, 0.5),
    st.floats(-2, 1),
    st.floats(-3, 0),
    st.sampled_from(
        [HERTZ, PLATE, HERTZ | {"spherical_profile"}, PLATE | {"edge"}, HERTZ | {"bending"}]
    ),
    st.sampled_from(["simply-supported", "clamped"]),
)
def test_energy_balance_closes(
    number: float, eta: float, speed: float, effects: frozenset[str], edge: str
) -> None:
    model = replace(BALL, h=BALL.b * 10**eta, v0=10**speed, edge=edge)
    model = with_number(10**number, model)
    try:
        motion.impact(ContactLaw(model, effects - {"viscosity"}))
    except SceneError:  # beyond the law's range
        return
    result = moved(ContactLaw(model, effects))
    assert result.energy_balance is not None
    assert abs(result.energy_balance.residual) < 1e-12
    assert result.energy_balance.viscous_loss > 0.0 < result.energy_balance.unrecovered_elastic
    assert 0.0 < result.restitution < 1.0
    assert result.restitution**2 == pytest.approx(
        result.energy_balance.rebound_kinetic / result.energy_balance.initial_kinetic
    )
    assert result.quadrature < 1e-9


def test_energy_balance_closes_with_weight_and_non_hertzian_pressure() -> None:
    model = replace(BALL, h=0.004, gravity=9.81, v0=0.3, sphere_modulus=5e9, retardation_time=2e-5)
    law = ContactLaw(
        model,
        PLATE | {"gravity", "non_hertzian_pressure", "spherical_profile", "sphere_elasticity"},
    )
    result = moved(law)
    assert result.energy_balance is not None
    assert result.energy_balance.gravity_work > 0.0
    assert abs(result.energy_balance.residual) < 1e-12
    hertz = moved(replace(law, effects=law.effects - {"non_hertzian_pressure"}))
    assert result.numbers == pytest.approx(hertz.numbers, rel=0.02)
    assert result.numbers != pytest.approx(hertz.numbers, rel=1e-5)


def test_small_viscosity_tends_to_the_elastic_limit() -> None:
    model = with_number(1e-9)
    for effects in (HERTZ, PLATE, PLATE | {"non_hertzian_pressure", "spherical_profile"}):
        law = ContactLaw(model, effects)
        elastic = moved(replace(law, effects=effects - {"viscosity"}))
        assert moved(law).numbers == pytest.approx(elastic.numbers, rel=3e-9)


def test_bending_dissipates_no_energy() -> None:
    """Only the local contact dissipates, so a more compliant plate loses less energy."""
    thin = [replace(BALL, h=h, retardation_time=1e-5) for h in (0.01, 0.004, 0.002, 0.001)]
    lost = [1.0 - moved(ContactLaw(model, PLATE)).restitution for model in thin]
    assert lost == sorted(lost, reverse=True)
    assert lost[-1] < 0.02 * lost[0]
    # If bending is omitted, its deflection is part of the viscoelastic contact law.
    thick = replace(BALL, h=1.0, retardation_time=1e-5)
    whole, local = moved(ContactLaw(thick, PLATE)), moved(ContactLaw(thick, PLATE - {"bending"}))
    assert whole.numbers == pytest.approx(local.numbers, rel=1e-2)


def test_sphere_that_stays_is_rejected() -> None:
    slow = replace(with_number(1.0), v0=1e-4, gravity=9.81)
    with pytest.raises(SceneError, match=r"^plate\.retardation_time: "):
        moved(ContactLaw(slow, HERTZ | {"gravity"}))
    assert moved(ContactLaw(slow, HERTZ)).restitution > 0.0


def test_history_agrees_with_the_results() -> None:
    law = ContactLaw(replace(BALL, retardation_time=1e-5), PLATE)
    result = moved(law)
    times = np.linspace(0.0, result.contact_time, 4001)
    depth, speed, radius, force = result.history(law, times)
    assert (depth[0], speed[0], radius[0], force[0]) == pytest.approx((0, BALL.v0, 0, 0), abs=1e-12)
    assert speed[-1] == pytest.approx(-result.restitution * BALL.v0, rel=1e-11)
    assert force[-1] == pytest.approx(0.0, abs=1e-9 * result.max_force)
    assert depth[-1] > 0.0
    peaks = result.max_indentation, result.max_force, result.max_contact_radius
    assert (depth.max(), force.max(), radius.max()) == pytest.approx(peaks, rel=1e-6)
    # Simpson's rule integrates the speed independently of the time elements.
    step = result.contact_time / 4000
    travelled = step / 3 * (speed[0] + speed[-1] + 4 * speed[1::2].sum() + 2 * speed[2:-1:2].sum())
    assert travelled == pytest.approx(depth[-1], rel=1e-7)


EXTREMES = ImpactExtremes(0.1, 1.0, 0.0, 0.2, 0.8, 0.4, 1.0)


def test_bounds_of_viscosity_hold_for_hertz() -> None:
    """The bounds of viscosity hold for a Hertz contact and are not too wide.

    There epsilon = (4/5)^(2/5) x, log Omega/log s = 1/5, delta ~ s^(4/5) and a ~ s^(2/5).
    """
    assert viscous_logarithms(EXTREMES._replace(epsilon=1.0)) == (math.inf,) * 5
    elastic = moved(ContactLaw(BALL, frozenset({"hertz"}))).numbers
    for x in (1e-4, 0.01, 0.3, 0.9):
        actual = moved(ContactLaw(with_number(x), HERTZ)).numbers
        most = viscous_logarithms(EXTREMES._replace(epsilon=0.8**0.4 * x, rise=0.2))
        changes = [abs(math.log(new / old)) for new, old in zip(actual, elastic, strict=True)]
        assert all(change <= bound for change, bound in zip(changes, most, strict=True))
        # Each bound is below 10 times the change, except for the force (change of order epsilon^2).
        wide = [bound / change for change, bound in zip(changes, most, strict=True)]
        assert max(wide[:2] + wide[3:]) < 10.0


@pytest.mark.parametrize("output", OUTPUTS)
@pytest.mark.parametrize("retardation_time", [1e-9, 1e-8, 1e-7, 1e-6])
def test_outputs_of_a_heavy_sphere_are_within_their_bounds(
    output: str, retardation_time: float
) -> None:
    """The bound covers a heavy, slow sphere, whose weight prolongs a slow rebound."""
    model = Model(
        R=0.1, m=32.9, v0=1e-3, h=10.0, b=10.0, lam=2.3e7, mu=1.54e7,
        gravity=9.81, retardation_time=retardation_time,
    )  # fmt: skip
    wanted = dict.fromkeys((*WHOLE_PLATE, "gravity", "spherical_profile"), True) | {
        "viscosity": False
    }
    selected = decide(model, AT_REST | wanted | {"non_hertzian_pressure": False}, 1.0, (output,))
    bound = {row.name: row.bound for row in selected.rows}["viscosity"]
    index = OUTPUTS.index(output)
    try:
        exact = moved(replace(selected.law, effects=selected.law.effects | {"viscosity"})).numbers[
            index
        ]
    except SceneError:  # the sphere does not rebound
        assert bound == math.inf
    else:
        assert abs(moved(selected.law).numbers[index] / exact - 1.0) <= bound


def test_bending_is_included_with_the_edge() -> None:
    """Bending is included with the edge: otherwise the edge correction would be viscoelastic.

    This would change the results more than bending itself does.
    """
    model = replace(BALL, h=0.5, edge="simply-supported", retardation_time=2e-6)
    for row in decide(model, AT_REST | {"edge": True, "viscosity": True}, 0.1).rows:
        assert row.name != "bending" or row.included
    alone = decide(model, AT_REST | {"edge": False, "viscosity": True}, 0.1)
    assert "bending" not in alone.law.effects


@pytest.mark.parametrize("edge", ["paper", "clamped"])
@pytest.mark.parametrize("gravity", [0.0, 9.81])
def test_error_is_within_the_bound_on_both_sides_of_the_threshold(
    edge: str, gravity: float
) -> None:
    model = replace(BALL, edge=edge, gravity=gravity, h=0.008, retardation_time=3e-8)
    others = dict.fromkeys(ALL - {"hertz", "viscosity"}, True)
    error_bound = {row.name: row.bound for row in decide(model, AT_REST | others, 1e-12).rows}[
        "viscosity"
    ]
    for rtol, included in ((error_bound / 2, True), (error_bound * 1.05, False)):
        selected = decide(model, AT_REST | others, rtol)
        assert ("viscosity" in selected.law.effects) is included
        whole = moved(
            ContactLaw(
                model, frozenset(n for n in ALL if not BY_NAME[n].not_applicable_reason(model))
            )
        )
        result = moved(selected.law)
        errors = [abs(x / y - 1) for x, y in zip(result.numbers, whole.numbers, strict=True)]
        assert max(errors) <= selected.error + 1e-11 <= rtol + 1e-11
    assert OUTPUTS[-1] == "restitution"
