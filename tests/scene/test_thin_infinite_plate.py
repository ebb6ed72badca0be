"""Plastic and viscoelastic impacts on a thin infinite plate compared with Zener's equation.

The centre of such a plate moves at P/(8 sqrt(D rho H)) (Zener 1941). The contact laws are written
here again: Thornton's (1997), with loading at the pressure 1.6 Y and elastic unloading, and that of
Kuwabara and Kono (1987), P = P_e + A_v dP_e/dt.
"""

import math
from typing import Any

import pytest
from scipy.integrate import solve_ivp

from derivation.scene import read, simulate
from derivation.scene.scene import OUTPUTS

pytestmark = pytest.mark.one_version

R, M, V0 = 0.02, 0.004, 3e-6
E, NU, RHO, H = 7e10, 0.25, 2500.0, 0.002
STAR = E / (1.0 - NU * NU)
STIFF = 4.0 / 3.0 * STAR * math.sqrt(R)
LOSS = 8.0 * math.sqrt(STAR * H**3 / 12.0 * RHO * H)
"""Force over the velocity of the plate at its centre [N s/m]."""
RETARDATION, YIELD = 2e-5, 1.5e6


def struck(**plate: float) -> dict[str, Any]:
    given = {"radius": 0.1, "thickness": H, "youngs_modulus": E, "poissons_ratio": NU}
    return {
        "sphere": {"radius": R, "mass": M},
        "plate": given | {"density": RHO} | plate,
        "impact": {"speed": V0},
        "inertia": {"extent": "infinite"},
    }


def elastic(u: float) -> float:
    return STIFF * max(u, 0.0) ** 1.5


def viscous(u: float, v: float) -> float:
    rate = RETARDATION * 1.5 * STIFF * math.sqrt(max(u, 0.0))
    return (elastic(u) + rate * v) / (1.0 + rate / LOSS)


def loaded(u: float, v: float) -> float:  # noqa: ARG001
    pressure = 1.6 * YIELD
    onset = (math.pi * pressure / (2.0 * STAR)) ** 2 * R
    return elastic(u) if u < onset else elastic(onset) + math.pi * pressure * R * (u - onset)


def motion(law: Any, start: tuple[float, ...], end: Any, begin: float = 0.0) -> Any:
    """Return displacement and velocity of the sphere and local indentation over time."""

    def rate(_: float, state: Any) -> list[float]:
        _z, v, u = state
        force = law(u, v)
        return [v, -force / M, v - force / LOSS]

    end.terminal = True
    span = (begin, begin + 1.0)
    return solve_ivp(rate, span, start, "LSODA", events=end, rtol=1e-10, atol=1e-16, max_step=1e-5)


def by_viscosity() -> list[float]:
    run = motion(viscous, (0.0, V0, 1e-16), lambda t, x: viscous(x[2], x[1]) if t > 1e-7 else 1.0)
    force = max(viscous(u, v) for v, u in run.y[1:].T)
    widest = math.sqrt(R * run.y[2].max())
    return [run.t[-1], run.y[0].max(), force, widest, -run.y[1, -1] / V0]


def by_plasticity() -> list[float]:
    rise = motion(loaded, (0.0, V0, 0.0), lambda _, x: x[1] - loaded(x[2], x[1]) / LOSS)
    deep = rise.y[2, -1]
    force, a = loaded(deep, 0.0), math.sqrt(R * deep)
    flat = R * (4.0 / 3.0 * STAR * a**3 / R) / force
    stiff = 4.0 / 3.0 * STAR * math.sqrt(flat)
    dent = deep - (force / stiff) ** (2.0 / 3.0)

    def unloading(u: float, v: float) -> float:  # noqa: ARG001
        return float(stiff * max(u - dent, 0.0) ** 1.5)

    last = tuple(rise.y[:, -1])
    fall = motion(unloading, last, lambda _, x: x[2] - dent, rise.t[-1])
    depth = max(rise.y[0].max(), fall.y[0].max())
    return [fall.t[-1], depth, force, a, -fall.y[1, -1] / V0]


@pytest.mark.parametrize(
    ("plate", "expected"),
    [
        ({"retardation_time": RETARDATION}, by_viscosity),
        ({"yield_stress": YIELD}, by_plasticity),
    ],
)
def test_impacts_on_a_thin_infinite_plate_satisfy_the_equation_of_zener(
    plate: dict[str, float], expected: Any
) -> None:
    result = simulate(read(struck(**plate)))
    for name, value in zip(OUTPUTS, expected(), strict=True):
        off = abs(value / getattr(result, name) - 1.0)
        assert off <= result.bound_of(name) + result.model_errors[name]
    balance = result.energy_balance
    assert balance is not None
    assert balance.plastic_loss + balance.viscous_loss > 0.2 * balance.initial_kinetic
