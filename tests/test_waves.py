"""Impacts on a plate that moves against an independent integrator, Zener's equation and a limit."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from derivation.scene import bounces, motion, waves
from derivation.scene.law import WHOLE_PLATE, Law
from derivation.scene.modal import modes_of
from derivation.scene.model import Inertia, Model
from derivation.scene.wave_plot import zener_restitution
from generated.contact_law import force_of_radius, indentation

EFFECTS = WHOLE_PLATE | {"hertz", "inertia"}
BALL = Model(R=0.02, m=0.25, v0=1.0, h=0.005, b=0.15, lam=40e9, mu=27e9, density=2700.0)
MODES = 8


def course(model: Model, n: int = 16, modes: int = MODES) -> bounces.Course:
    law = Law(model, EFFECTS)
    rest = replace(law, effects=WHOLE_PLATE | {"hertz"})
    quick = motion.impact(Law(model, frozenset({"hertz"})))
    assert quick is not None
    problem = waves._problem(law, rest, modes_of(model, modes), quick)
    return bounces.course(problem, n)


def felt(y: np.ndarray) -> np.ndarray:
    """g(y) = 3 (sin y - y cos y)/y^3."""
    large = np.maximum(y, 0.05)
    closed = 3.0 * (np.sin(large) - large * np.cos(large)) / large**3
    return np.where(y < 0.05, 1.0 - y * y / 10.0 * (1.0 - y * y / 28.0), closed)


def integrated(model: Model, end: float) -> tuple[float, float, float]:
    """First contact's end [s], its largest force [N], and the velocity after, by DOP853.

    In s = sqrt(t), in which the onset is smooth; the contact radius by bisection at every step.
    """
    modes = modes_of(model, MODES)
    compliance, top = modes.drive / modes.omega**2, 0.9 * model.b

    def force(a: float) -> float:
        return float(force_of_radius(a, model.R, model.lam, model.mu))

    def gap(a: float, z: float, q: np.ndarray) -> float:
        y = a * modes.phi
        share = np.sinc(y / np.pi)
        at_rest = float(indentation(a, model.R, model.h, model.b))
        loads = force(a) * felt(y)
        return at_rest - float(np.sum(share * (compliance * loads - q))) - z

    def radius(z: float, q: np.ndarray) -> float:
        if z - float(np.sum(q)) <= 0.0:
            return 0.0
        return float(brentq(gap, 1e-12, 0.05 * top, (z, q), xtol=1e-17, rtol=1e-15))

    def rate(s: float, state: np.ndarray) -> np.ndarray:
        z, v, q, u = state[0], state[1], state[2 : MODES + 2], state[MODES + 2 :]
        a = radius(z, q)
        P = force(a) if a else 0.0
        pushed = modes.drive * P * felt(a * modes.phi) - modes.omega**2 * q
        return 2.0 * s * np.concatenate(([v, -P / model.m], u, pushed))

    def released(s: float, state: np.ndarray) -> float:  # noqa: ARG001
        return float(state[0] - np.sum(state[2 : MODES + 2]))

    released.direction = -1  # type: ignore[attr-defined]
    start = np.zeros(2 * MODES + 2)
    start[1] = model.v0
    found = solve_ivp(
        rate, (0.0, math.sqrt(1.05 * end)), start, "DOP853", events=released,
        rtol=1e-12, atol=1e-16 * model.v0, dense_output=True,
    )  # fmt: skip
    s = float(found.t_events[0][-1])
    places = np.linspace(0.2 * s, 0.9 * s, 4001)
    states = found.sol(places)

    def load(x: float) -> float:
        state = found.sol(x)
        return force(radius(state[0], state[2 : MODES + 2]))

    rough = [force(radius(z[0], z[2 : MODES + 2])) for z in states.T[::20]]
    near = places[::20][int(np.argmax(rough))]
    fine = np.linspace(near - 0.01 * s, near + 0.01 * s, 41)
    values = [load(x) for x in fine]
    shape = np.polynomial.Chebyshev.fit(fine, values, 8)
    peak = max(float(shape(x.real)) for x in shape.deriv().roots() if abs(x.imag) < 1e-9 * s)
    return s * s, peak, float(found.y_events[0][-1][1])


@pytest.mark.parametrize("h", [0.02, 0.01])
def test_an_independent_integrator_agrees(h: float) -> None:
    model = replace(BALL, h=h)
    found = course(model)
    problem, first = found.problem, found.contacts[0]
    time, peak, velocity = integrated(model, problem.T * first.end)
    assert problem.T * first.end == pytest.approx(time, rel=1e-9)
    largest = max(piece.element.largest(3) for piece in first.pieces) * problem.force
    assert largest == pytest.approx(peak, rel=1e-9)
    assert first.after.velocity == pytest.approx(velocity / model.v0, abs=1e-9)


@pytest.mark.parametrize("h", [0.02, 0.005, 0.002])
def test_nodes_do_not_matter_and_the_ledger_closes(h: float) -> None:
    """Several contacts where the plate is thin; the sphere never lies below the free face."""
    model = replace(BALL, h=h)
    fine, coarse = (course(model, n) for n in (16, 14))
    assert len(fine.contacts) == len(coarse.contacts)
    for one, other in zip(fine.contacts, coarse.contacts, strict=True):
        assert one.start == pytest.approx(other.start, rel=1e-9, abs=1e-9)
        assert one.end == pytest.approx(other.end, rel=1e-9)
        assert one.after.velocity == pytest.approx(other.after.velocity, abs=1e-9)
    found = waves._motion(Law(model, EFFECTS), fine)
    assert abs(found.ledger.closure) <= 1e-11
    assert 0.0 < found.restitution < 1.0
    for one, two in zip(fine.contacts[:-1], fine.contacts[1:], strict=True):
        for share in np.linspace(0.01, 0.99, 197):
            state = fine.problem.flown(one.after, share * (two.start - one.end))
            assert state.into <= 1e-12


def test_the_axis_leaks_what_it_is_said_to() -> None:
    """With the indentation at the axis energy is lost to nothing, and the ledger names it."""
    model = replace(BALL, inertia=Inertia(pointwise=True))
    found = waves._motion(Law(model, EFFECTS), course(model))
    assert abs(found.ledger.leak) > 1e-8 * found.ledger.brought
    assert abs(found.ledger.closure) <= 1e-11
    kept = waves._motion(Law(BALL, EFFECTS), course(BALL))
    assert kept.ledger.leak == 0.0


def test_a_plate_without_mass_is_at_rest() -> None:
    """As the density falls the impact tends to that on the static law, restitution to 1."""
    calm = motion.impact(Law(BALL, WHOLE_PLATE | {"hertz"}))
    assert calm is not None
    errors = []
    for density in (2.7, 0.27):
        light = replace(BALL, density=density, inertia=Inertia(modes=4))
        found = waves.impact(Law(light, EFFECTS))
        assert found is not None
        pairs = zip(found.numbers, calm.numbers, strict=True)
        errors.append([abs(x / y - 1.0) for x, y in pairs])
    assert all(late < 0.4 * early for early, late in zip(*errors, strict=True))
    # The force rings with the square root of the density, what it moves hardly.
    time, way, force, radius, speed = errors[-1]
    assert force < 0.03
    assert radius < 0.01
    assert time < 2e-3
    assert way < 1e-4
    assert speed < 2e-5


@pytest.mark.parametrize("number", [0.02, 0.3, 2.0])
def test_an_endless_plate_is_zeners(number: float) -> None:
    """m z'' = -P, z = P^(2/3) + w, w' = lambda P, in s = sqrt(t) by another integrator."""

    def rate(s: float, state: np.ndarray) -> Any:
        depth = max(state[0] - state[2], 0.0)
        P = depth**1.5
        return 2.0 * s * np.array([state[1], -P, number * P])

    def released(s: float, state: np.ndarray) -> float:  # noqa: ARG001
        return float(state[0] - state[2])

    released.direction = -1  # type: ignore[attr-defined]
    released.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(rate, (1e-8, 40.0), [1e-16, 1.0, 0.0], "DOP853", events=released,
                      rtol=1e-13, atol=1e-15)  # fmt: skip
    assert zener_restitution(number) == pytest.approx(-found.y_events[0][-1][1], abs=1e-9)


def test_more_modes_change_less() -> None:
    results = [-course(BALL, 16, modes).contacts[-1].after.velocity for modes in (4, 8, 16, 32)]
    steps = np.abs(np.diff(results))
    assert steps[2] < 0.5 * steps[1] < 0.5 * steps[0]
