"""Impacts with plate inertia compared with an independent integrator and with the static law."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic import contact_sequence, wave_problem, waves
from derivation.scene.dynamic.modal import free_modes, plate_of
from derivation.scene.dynamic.results import dynamic_impact_of
from derivation.scene.effects import WHOLE_PLATE
from derivation.scene.model import InertiaSettings, Model
from derivation.scene.quasi_static import motion
from generated.contact_law import force_of_radius
from generated.sensitivity import indentation_slope

EFFECTS = WHOLE_PLATE | {"hertz", "inertia"}
BALL = Model(R=0.02, m=0.25, v0=1.0, h=0.005, b=0.15, lam=40e9, mu=27e9, density=2700.0)
MODES = 8


def history(model: Model, n: int = 16, modes: int = MODES) -> contact_sequence.ImpactHistory:
    law = ContactLaw(model, EFFECTS | ({"gravity"} if model.gravity else frozenset()))
    if model.loss_factor:
        law = replace(law, effects=law.effects | {"damping"})
    problem = wave_problem.problem_with(law, plate_of(law, modes))
    return contact_sequence.impact_history(problem, n)


def normalised_modal_force(y: np.ndarray) -> np.ndarray:
    """Return g(y) = 3 (sin y - y cos y)/y^3, the normalised modal force."""
    large = np.maximum(y, 0.05)
    closed = 3.0 * (np.sin(large) - large * np.cos(large)) / large**3
    return np.where(y < 0.05, 1.0 - y * y / 10.0 * (1.0 - y * y / 28.0), closed)


def integrated(model: Model, end: float) -> tuple[float, float, float]:
    """Return end [s] and peak force [N] of the first contact, and the velocity [m/s], by DOP853.

    The variable s = sqrt(t) makes the onset smooth. The square of the contact radius is one of the
    unknowns; its rate follows from the derivative of the indentation with respect to the radius.
    """
    modes = free_modes(model, MODES)
    count, compliance, phi = (
        modes.omega.size,
        modes.inverse_modal_mass / modes.omega**2,
        modes.phi[modes.shape],
    )

    def force(square: float) -> float:
        return float(force_of_radius(math.sqrt(max(square, 0.0)), model.R, model.lam, model.mu))

    def slope(a: float, q: np.ndarray) -> float:
        """Return R/(2 a) times the static slope less the deviation of the modes from statics."""
        y, P = a * phi, force(a * a)
        modal_weights = np.sinc(y / np.pi)
        turned = np.cos(y) - modal_weights
        missed = (
            compliance * P * (3.0 * modal_weights**2 + turned * normalised_modal_force(y))
            - turned * q
        )
        whole = float(indentation_slope(a, model.R, model.h, model.b)) - float(np.sum(missed)) / a
        return whole * model.R / (2.0 * a)

    def rate(s: float, state: np.ndarray) -> np.ndarray:
        v, square, q, u = state[1], state[2], state[3 : count + 3], state[count + 3 :]
        a, P = math.sqrt(max(square, 0.0)), force(square)
        y = a * phi
        opened = v - float(np.sum(np.sinc(y / np.pi) * u))
        grown = model.R * opened / (slope(a, q) if a else 1.0)
        pushed = modes.inverse_modal_mass * P * normalised_modal_force(y) - modes.omega**2 * q
        pushed -= model.loss_factor * modes.omega * u
        return 2.0 * s * np.concatenate(([v, model.gravity - P / model.m, grown], u, pushed))

    def released(s: float, state: np.ndarray) -> float:  # noqa: ARG001
        return float(state[2])

    released.direction = -1  # type: ignore[attr-defined]
    start = np.zeros(2 * count + 3)
    start[1], scale = model.v0, model.v0 * end
    small = np.full(start.size, 1e-14 * model.v0)
    small[2], small[0], small[3 : count + 3] = 1e-14 * model.R * scale, 1e-14 * scale, 1e-14 * scale
    solution = solve_ivp(
        rate, (0.0, math.sqrt(1.05 * end)), start, "DOP853", events=released,
        rtol=1e-12, atol=small, dense_output=True,
    )  # fmt: skip
    s = float(solution.t_events[0][-1])
    points = np.linspace(0.2 * s, 0.9 * s, 401)
    near = points[int(np.argmax(solution.sol(points)[2]))]
    fine = np.linspace(near - 0.01 * s, near + 0.01 * s, 41)
    shape = np.polynomial.Chebyshev.fit(fine, [force(solution.sol(x)[2]) for x in fine], 8)
    peak = max(float(shape(x.real)) for x in shape.deriv().roots() if abs(x.imag) < 1e-9 * s)
    return s * s, peak, float(solution.y_events[0][-1][1])


@pytest.mark.one_version
@pytest.mark.parametrize(
    "changes",
    [
        {"h": 0.02},
        {"h": 0.01},
        {"h": 0.01, "v0": 0.02, "gravity": 9.81},
        {"h": 0.02, "inertia": InertiaSettings(branches="all")},
        {"h": 0.01, "loss_factor": 0.1},
        {"h": 0.02, "loss_factor": 1.5, "inertia": InertiaSettings(branches="all")},
    ],
    ids=["thick", "thin", "heavy", "every branch", "damped", "damped strongly"],
)
def test_an_independent_integrator_agrees(changes: dict[str, Any]) -> None:
    model = replace(BALL, **changes)
    actual = history(model)
    problem, first = actual.problem, actual.contacts[0]
    if model.gravity:
        fallen = 2.0 * model.gravity * problem.depth * first.pieces[-1].element.largest(2)
        assert fallen > 0.01 * model.v0**2
    time, peak, velocity = integrated(model, problem.T * first.end)
    assert problem.T * first.end == pytest.approx(time, rel=1e-9)
    largest = max(piece.element.largest(3) for piece in first.pieces) * problem.force
    assert largest == pytest.approx(peak, rel=1e-9)
    assert first.after.velocity == pytest.approx(velocity / model.v0, abs=1e-9)


@pytest.mark.parametrize("h", [0.02, 0.005, 0.002])
def test_results_do_not_depend_on_nodes_and_energy_balance_closes(h: float) -> None:
    """Results do not depend on the number of nodes, and bodies do not overlap between contacts."""
    model = replace(BALL, h=h)
    fine, coarse = (history(model, n) for n in (16, 14))
    assert len(fine.contacts) == len(coarse.contacts)
    for one, other in zip(fine.contacts, coarse.contacts, strict=True):
        assert one.start == pytest.approx(other.start, rel=1e-9, abs=1e-9)
        assert one.end == pytest.approx(other.end, rel=1e-9)
        assert one.after.velocity == pytest.approx(other.after.velocity, abs=1e-9)
    result = dynamic_impact_of(ContactLaw(model, EFFECTS), fine)
    assert abs(result.energy_balance.residual) <= 1e-11
    assert 0.0 < result.restitution < 1.0
    for one, two in zip(fine.contacts[:-1], fine.contacts[1:], strict=True):
        for fraction in np.linspace(0.01, 0.99, 197):
            state = fine.problem.flown(one.after, fraction * (two.start - one.end))
            assert state.approach <= 1e-12


def test_pointwise_coupling_loses_the_stated_energy() -> None:
    """The pointwise coupling loses energy, which the energy balance states."""
    model = replace(BALL, inertia=InertiaSettings(pointwise=True))
    result = dynamic_impact_of(ContactLaw(model, EFFECTS), history(model))
    assert abs(result.energy_balance.coupling_loss) > 1e-8 * result.energy_balance.initial_kinetic
    assert abs(result.energy_balance.residual) <= 1e-11
    kept = dynamic_impact_of(ContactLaw(BALL, EFFECTS), history(BALL))
    assert kept.energy_balance.coupling_loss == 0.0


def test_massless_plate_is_quasi_static() -> None:
    """The impact approaches that of the static law as the density tends to zero."""
    calm = motion.impact(ContactLaw(BALL, WHOLE_PLATE | {"hertz"}))
    errors = []
    for density in (2.7, 0.27):
        light = replace(BALL, density=density, inertia=InertiaSettings(modes=4))
        result = waves.impact(ContactLaw(light, EFFECTS))
        pairs = zip(result.numbers, calm.numbers, strict=True)
        errors.append([abs(x / y - 1.0) for x, y in pairs])
    assert all(late < 0.4 * early for early, late in zip(*errors, strict=True))
    # The force oscillates with an amplitude like sqrt(density); the displacement hardly does.
    time, way, force, radius, speed = errors[-1]
    assert force < 0.03
    assert radius < 0.01
    assert time < 2e-3
    assert way < 1e-4
    assert speed < 2e-5


def test_change_decreases_with_the_number_of_modes() -> None:
    results = [-history(BALL, 16, modes).contacts[-1].after.velocity for modes in (4, 8, 16, 32)]
    steps = np.abs(np.diff(results))
    assert steps[2] < 0.5 * steps[1] < 0.5 * steps[0]
