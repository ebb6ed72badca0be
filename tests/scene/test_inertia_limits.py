"""Impacts with plate inertia: limiting cases, conservation laws and convergence of the modes."""

import math
import tracemalloc
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.special import j1, jn_zeros

from derivation.scene import SceneError, read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import (
    contact_sequence,
    modal,
    mode_count,
    next_element,
    wave_problem,
    waves,
)
from derivation.scene.dynamic.contact_tables import contact_of
from derivation.scene.dynamic.infinite_plate_impact import infinite_plate_impact
from derivation.scene.dynamic.modal import ModalPlate, Modes, free_modes
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.effects import WHOLE_PLATE
from derivation.scene.model import InertiaSettings, Model
from derivation.scene.numerics import chebyshev
from derivation.scene.scales import zener_number

pytestmark = pytest.mark.one_version

REST = WHOLE_PLATE | {"hertz"}

BALL = Model(R=0.02, m=0.25, v0=1.0, h=0.02, b=0.15, lam=40e9, mu=27e9, density=2700.0)


# --- an infinite plate


def zener(number: float) -> tuple[float, float]:
    """Return the restitution and the normalised contact time of Zener's equation.

    The dimensionless equations are z'' = -P, z = P^(2/3) + w, w' = lambda P."""

    def rate(s: float, state: np.ndarray) -> Any:
        P = max(state[0] - state[2], 0.0) ** 1.5
        return 2.0 * s * np.array([state[1], -P, number * P])

    def released(s: float, state: np.ndarray) -> float:  # noqa: ARG001
        return float(state[0] - state[2])

    released.direction = -1  # type: ignore[attr-defined]
    released.terminal = True  # type: ignore[attr-defined]
    solution = solve_ivp(rate, (1e-8, 40.0), [1e-16, 1.0, 0.0], "DOP853", events=released,
                      rtol=1e-13, atol=1e-15)  # fmt: skip
    return -float(solution.y_events[0][-1][1]), float(solution.t_events[0][-1]) ** 2


def thin_plate(number: float, count: int, phase: float) -> tuple[float, float]:
    """Return the restitution for Kirchhoff's modes J_0(j_n r/b), and a phi_M (contact radius a).

    `phase` is omega_M That for the highest mode M. The period of the first mode is proportional to
    count^2/phase; if it is long, the plate behaves as an infinite one. Zener's number determines
    the contact radius.
    """
    j, h = jn_zeros(0, count), 1e-5
    plate = Model(R=1.0, m=1.0, v0=1.0, h=h, b=1.0, lam=1.0, mu=1.0, density=1.0)
    bending, mass = plate.modulus * (2.0 * h) ** 3 / 12.0, 2.0 * h
    That = phase / j[-1] ** 2 * math.sqrt(mass / bending)
    # lambda = m/(8 That sqrt(D rho H)) and m = K sqrt(v0) That^(5/2) give the contact radius.
    a = number * 8.0 * math.sqrt(bending * mass) / That / (4.0 / 3.0 * plate.modulus)
    speed = a * a / That
    model = replace(plate, v0=speed, m=4.0 / 3.0 * plate.modulus * math.sqrt(speed) * That**2.5)
    assert zener_number(model) == pytest.approx(number, rel=1e-9)
    drive = 1.0 / (math.pi * j1(j) ** 2 * mass)
    bends = np.ones(count, dtype=bool)
    modes = Modes(j, j**2 * math.sqrt(bending / mass), drive, np.arange(count), bends)
    law = ContactLaw(model, frozenset({"hertz", "bending"}))
    contact = contact_of(law, ModalPlate(modes, modes, None), 1.5 * a, pointwise=False)
    problem = DynamicProblem(contact, a, That, model.m, speed)
    actual = contact_sequence.contact(problem, 16, problem.begin(), 0.0, 0.0)
    return -actual.after.velocity, a * j[-1]


@pytest.mark.parametrize("number", [0.02, 0.3, 1.0, 2.0, 10.0])
def test_infinite_plate_satisfies_the_equation_of_zener(number: float) -> None:
    restitution, time = zener(number)
    assert infinite_plate_impact(number) == pytest.approx((time, restitution), rel=1e-7, abs=1e-9)


def test_failed_integration_is_not_reported_as_an_endless_contact(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    failed = SimpleNamespace(status=-1, message="too many steps")
    monkeypatch.setattr("scipy.integrate.solve_ivp", lambda *_, **__: failed)
    with pytest.raises(SceneError, match="time can be computed"):
        infinite_plate_impact(0.123, 1e-3, 1e3)


def test_heavy_sphere_that_stays_on_an_infinite_plate_is_rejected() -> None:
    """A small weight only changes the contact; a sphere that does not rebound is rejected."""
    assert infinite_plate_impact(1.0, 1e-5) == pytest.approx(infinite_plate_impact(1.0), rel=1e-3)
    assert infinite_plate_impact(5.0, 1e-2, 1e6) == (math.inf, 0.0)
    scene = {
        "sphere": {"radius": 0.0125, "material": "ice"},
        "plate": {"radius": 0.5, "thickness": 0.0007, "material": "steel"},
        "impact": {"speed": 14.0, "gravity": 9.81},
        "inertia": {"extent": "infinite"},
    }
    with pytest.raises(SceneError, match=r"^inertia\.extent: .* remove extent = .infinite."):
        simulate(read(scene))


@pytest.mark.parametrize("number", [0.02, 0.3, 1.0, 2.0])
def test_wide_plate_agrees_with_zener(number: float) -> None:
    """With 200 modes and omega_M That = 200, no wave returns from the edge during contact."""
    exact, _ = zener(number)
    actual, reach = thin_plate(number, 200, 200.0)
    assert reach < 1e-6  # much smaller than the shortest wavelength of the modes
    assert actual == pytest.approx(exact, abs=2e-7)


def test_error_of_quasi_static_modes_decreases_with_cubed_frequency() -> None:
    exact, _ = zener(1.0)
    errors = [abs(thin_plate(1.0, 100, phase)[0] - exact) for phase in (25.0, 50.0, 100.0)]
    for early, late in pairwise(errors):
        assert 6.0 < early / late < 10.0


def test_narrow_plate_returns_energy() -> None:
    """Waves return from the edge during contact if the first mode's period is the contact time."""
    exact, lasts = zener(1.0)
    first, last = jn_zeros(0, 20)[[0, -1]]
    actual, _ = thin_plate(1.0, 20, 2.0 * math.pi / lasts * (last / first) ** 2)
    assert actual > exact + 0.05


# --- modes


def history(
    model: Model, modes: Modes, n: int = 16, tolerance: float = contact_sequence.TOLERANCE
) -> contact_sequence.ImpactHistory:
    law = ContactLaw(model, REST | {"inertia"})
    problem = wave_problem.problem_with(law, ModalPlate(modes, modes, None))
    return contact_sequence.impact_history(problem, n, tolerance)


def restitution(actual: contact_sequence.ImpactHistory) -> float:
    return -actual.contacts[-1].after.velocity


def test_results_converge_with_the_modes_of_all_branches() -> None:
    """The restitution converges as the number of modes grows, with all Lamb-wave branches."""
    every = replace(BALL, inertia=InertiaSettings(branches="all"))
    actual = [restitution(history(every, free_modes(every, count))) for count in (4, 8, 16, 32)]
    steps = np.abs(np.diff(actual))
    assert steps[2] < 0.6 * steps[1] < 0.6 * steps[0]
    assert steps[2] < 1e-5
    # The limit differs from that of the lowest branch alone.
    first = restitution(history(BALL, free_modes(BALL, 32)))
    assert abs(first - actual[-1]) > 2.0 * steps[2]


def test_results_converge_with_the_branches() -> None:
    """The restitution converges as branches up to higher frequencies are added."""
    lowest, actual = modal._free(BALL, 12), []
    for times in (1.0, 2.0, 4.0, 8.0):
        highest = times * float(lowest.root[-1])
        shapes = modal._branches(lowest, modal._higher(BALL, lowest, highest), highest)
        modes = modal._modes(BALL, shapes)
        actual.append((modes.omega.size, restitution(history(BALL, modes))))
    counts, values = zip(*actual, strict=True)
    assert all(more > 1.5 * few for few, more in pairwise(counts))
    steps = np.abs(np.diff(values))
    assert all(late < 0.5 * early for early, late in pairwise(steps))


@pytest.mark.parametrize(
    ("changes", "contacts"),
    [({"h": 0.003, "b": 0.25, "m": 0.95, "v0": 0.5}, 8), ({"h": 0.004, "b": 0.4, "m": 2.0}, 6)],
)
def test_many_contacts_do_not_depend_on_the_resolution(
    changes: dict[str, Any], contacts: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Results do not depend on nodes, element length and tolerance (lambda = 8 to 10)."""
    model = replace(BALL, R=0.04, **changes)
    assert 8.0 < zener_number(model) < 10.0
    modes = free_modes(model, 8)
    runs = [history(model, modes), history(model, modes, 13)]
    monkeypatch.setattr(next_element, "PHASE", 0.3)
    fine = history(model, modes, 18, 1e-12)
    assert len(fine.contacts) == contacts
    for other in runs:
        assert len(other.contacts) == len(fine.contacts)
        for one, two in zip(other.contacts, fine.contacts, strict=True):
            assert one.start == pytest.approx(two.start, rel=1e-9, abs=1e-9)
            assert one.end == pytest.approx(two.end, rel=1e-9)
            assert one.after.velocity == pytest.approx(two.after.velocity, abs=1e-9)


# --- conservation laws


@settings(max_examples=25)
@given(
    eta=st.floats(-2.2, -0.3), size=st.floats(-1.8, -0.3), heavy=st.floats(-1.0, 1.5),
    speed=st.floats(-1.5, 0.7), nu=st.floats(-0.4, 0.48), gravity=st.sampled_from([0.0, 9.81]),
    pointwise=st.booleans(), edge=st.sampled_from(["paper", "clamped", "simply-supported"]),
)  # fmt: skip
def test_energy_and_momentum_are_conserved(
    eta: float, size: float, heavy: float, speed: float, nu: float, gravity: float,
    pointwise: bool, edge: str,
) -> None:  # fmt: skip
    """Random scenes conserve energy and momentum, and their contacts follow each other in time."""
    b, mu, density = 0.2, 5e9, 2000.0
    R = b * 10**size
    model = Model(
        R=R, m=4.0 / 3.0 * math.pi * R**3 * density * 10**heavy, v0=10**speed, h=b * 10**eta, b=b,
        lam=2.0 * mu * nu / (1.0 - 2.0 * nu), mu=mu, density=density, gravity=gravity, edge=edge,
        inertia=InertiaSettings(pointwise=pointwise),
    )  # fmt: skip
    assume(zener_number(model) < 2.0)
    law = ContactLaw(model, REST | {"inertia"} | ({"gravity"} if gravity else set()) | {"edge"})
    assume(mode_count.count_of(law) <= 12)
    try:
        result = waves.impact(law, math.inf)
    except SceneError:  # the sphere does not rebound, or the plate is too curved
        assume(False)
    contacts = result.inertia.contacts
    assert abs(result.energy_balance.residual) <= 1e-11
    if not gravity and not pointwise:
        assert 0.0 <= result.restitution <= 1.0
    times = [time for touch in contacts for time in (touch.start, touch.end)]
    assert times[0] == 0.0
    assert all(early < late for early, late in pairwise(times))
    fallen = model.gravity * result.inertia.total_time
    impulse = sum(touch.impulse for touch in contacts)
    given_up = model.v0 * (1.0 + result.restitution) + fallen
    assert impulse == pytest.approx(model.m * given_up, rel=1e-10)


# --- memory and tables


def test_time_element_stores_only_its_final_state() -> None:
    modes = free_modes(BALL, 400)
    tracemalloc.start()
    try:
        motion = history(BALL, modes)
        kept, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    elements = sum(len(touching.pieces) for touching in motion.contacts)
    state = 2 * 400 * 8
    assert kept < 3 * elements * state + 2e6


def test_tables_of_a_wide_contact_are_exact_and_small() -> None:
    tracemalloc.start()
    try:
        x, analysis, mean = chebyshev.knots(200)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 2e7
    for power in (0, 1, 7, 40):
        expected = x**power / (power + 3.0)  # int_0^1 t^2 (x t)^power dt
        assert mean @ (analysis @ x**power) == pytest.approx(expected, abs=1e-14)
