"""Test a viscoelastic contact that yields: another integrator, energy balance and limits."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from derivation.scene import read, simulate
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.model import Model
from derivation.scene.quasi_static.motion import Motion
from derivation.scene.scene import OUTPUTS
from derivation.scene.selection.method_selection import moved
from generated.plasticity import yield_radius

BALL = Model(
    R=0.005, m=4.1e-3, v0=1.0, h=0.5, b=1.0, lam=121.15e9, mu=80.77e9, yield_stress=5e8,
    retardation_time=2e-6,
)  # fmt: skip
HALF_SPACE = frozenset({"hertz", "plasticity", "viscosity"})
DROP = {
    "sphere": {"radius": 0.025, "material": "steel"},
    "plate": {
        "radius": 0.2, "thickness": 0.02, "material": "aluminium", "edge": "clamped",
        "yield_stress": 240e6, "retardation_time": 1e-5,
    },
    "impact": {"speed": 1.98},
}  # fmt: skip


def drop(effects: dict[str, Any] | None = None, **plate: Any) -> dict[str, Any]:
    """Return the ball-drop scene; plate inertia is off unless `effects` includes it."""
    wanted = {"inertia": False, "viscosity": True, "plasticity": True} | (effects or {})
    return DROP | {"plate": DROP["plate"] | plate, "effects": wanted}


def integrated(model: Model) -> list[float]:
    """Return force, restitution, dent and time on a half-space, by a Runge-Kutta method."""
    modulus, R, m, lag = model.modulus, model.R, model.m, model.retardation_time
    onset = float(yield_radius(R, model.lam, model.mu, model.yield_stress))
    unit = 4.0 / 3.0 * modulus / R

    def loading(z: float) -> tuple[float, float]:
        if z * R < onset**2:
            return unit * (z * R) ** 1.5, 1.5 * unit * R * math.sqrt(z * R)
        return unit * onset * (3.0 * z * R - onset**2) / 2.0, 1.5 * unit * onset * R

    def run(law: Any, start: list[float], ends: Any) -> Any:
        def rate(_: float, y: np.ndarray) -> list[float]:
            force, slope = law(max(y[0], 0.0))
            return [y[1], -(force + lag * slope * y[1]) / m]

        ends.terminal = True
        return solve_ivp(rate, (0, 1), start, "DOP853", events=ends, rtol=1e-11, atol=1e-16,
                         max_step=1e-6, dense_output=True)  # fmt: skip

    down = run(loading, [0.0, model.v0], lambda _, y: y[1])
    top = float(down.y[0, -1])
    u = (loading(top)[0] / unit) ** (1.0 / 3.0)
    flat = u / math.sqrt(top * R)
    dent = top * (1.0 - flat**3)

    def unloading(z: float) -> tuple[float, float]:
        above = max(z - dent, 0.0)
        return unit * (above * R / flat) ** 1.5, 1.5 * unit * R / flat * math.sqrt(above * R / flat)

    def contact_force(_: float, y: np.ndarray) -> float:
        force, slope = unloading(float(y[0]))
        return force + lag * slope * y[1]

    up = run(unloading, [top, 0.0], contact_force)
    times = np.linspace(0.0, down.t[-1], 20001)
    forces = [f + lag * s * v for (f, s), v in
              ((loading(max(z, 0.0)), v) for z, v in down.sol(times).T)]  # fmt: skip
    return [max(forces), -float(up.y[1, -1]) / model.v0, dent, down.t[-1] + up.t[-1]]


@pytest.mark.parametrize("speed", [0.01, 0.3, 10.0])
def test_half_space_agrees_with_another_integrator(speed: float) -> None:
    model = replace(BALL, v0=speed)
    result, expected = moved(ContactLaw(model, HALF_SPACE)), integrated(model)
    got = [result.max_force, result.restitution, result.dent, result.contact_time]
    assert got == pytest.approx(expected, rel=2e-7)
    assert result.dent > 0.0


@pytest.mark.parametrize("gravity", [0.0, 9.81])
def test_energy_balance_closes_on_a_bending_plate(gravity: float) -> None:
    scene = drop() | {"impact": {"speed": 1.98, "gravity": gravity}}
    balance = simulate(read(scene)).energy_balance
    assert balance is not None
    assert min(balance.plastic_loss, balance.viscous_loss) > 0.05 * balance.initial_kinetic
    assert abs(balance.residual) < 1e-12


def test_plate_with_high_yield_stress_gives_the_viscoelastic_results() -> None:
    hard = simulate(read(drop(yield_stress=1e12)))
    never = simulate(read(drop({"plasticity": False})))
    assert numbers(hard) == pytest.approx(numbers(never), rel=1e-11)


def test_plastic_results_are_the_limit_without_viscosity() -> None:
    """The change of the results is proportional to a short retardation time."""
    calm = numbers(simulate(read(drop({"viscosity": False}))))
    off = []
    for time in (1e-7, 1e-8):
        actual = numbers(simulate(read(drop(retardation_time=time))))
        off.append(max(abs(x / y - 1.0) for x, y in zip(actual, calm, strict=True)))
    assert off[0] < 1e-3
    assert off[1] == pytest.approx(off[0] / 10.0, rel=0.02)


def test_results_converge_with_the_nodes() -> None:
    for model in (BALL, replace(BALL, retardation_time=1e-4, v0=5.0)):
        motion: Motion = moved(ContactLaw(model, HALF_SPACE))
        assert motion.quadrature < 1e-9


def test_history_shows_the_widened_contact() -> None:
    result = simulate(read(drop()))
    radii = result.history(400).contact_radius
    assert max(radii) == pytest.approx(result.max_contact_radius, rel=1e-4)


def numbers(result: Any) -> list[float]:
    return [getattr(result, name) for name in OUTPUTS]
