"""Motion under a viscoelastic contact on a plate that bends."""

import numpy as np

from derivation.scene.code.runtime.acceleration import _acceleration
from derivation.scene.code.runtime.data import COMPLIANCE, RETARDATION_TIME
from derivation.scene.code.runtime.hertz_law import _law
from generated.viscosity_kernels import bent_viscous_force


def _start(v0: float, unit: float, time: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Return a^3, velocity, indentation, t^(1/3) at the onset; their units; the first step."""
    state, root = np.array([[0.0], [v0], [0.0], [0.0]]), np.cbrt(time)
    return state, np.array([[unit**3], [v0], [v0 * time], [root]]), 0.2 * float(root)


def _forces(state: np.ndarray, unit: float) -> tuple[np.ndarray, ...]:
    """Return force (may be negative), rate of a^3, indentation and radius of states."""
    cube, _, depth, _ = state
    a = np.cbrt(np.maximum(cube, (1e-20 * unit) ** 3))
    elastic, static, force_a, _ = _law(a)
    plate = np.asarray(COMPLIANCE), np.asarray(RETARDATION_TIME)
    P, elastic_rate = bent_viscous_force(elastic, depth - static, *plate)
    return P, 3.0 * a * a / force_a * elastic_rate, depth, a


def _rates(state: np.ndarray, unit: float) -> np.ndarray:
    """Return the derivatives of the state with respect to t^(1/3), in which the onset is smooth."""
    P, rate, _, _ = _forces(state, unit)
    _, v, _, root = state
    by_root = 3.0 * root * root
    return np.array([by_root * rate, by_root * _acceleration(P), by_root * v, np.ones_like(v)])


def _time(state: np.ndarray) -> float:
    """Return the time [s] of a state."""
    return float(state[3] ** 3)
