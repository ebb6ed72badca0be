"""Motion under a viscoelastic contact on a plate that does not bend."""

import numpy as np

from derivation.scene.code.runtime.acceleration import _acceleration
from derivation.scene.code.runtime.data import RETARDATION_TIME
from derivation.scene.code.runtime.hertz_law import _law
from generated.viscosity_kernels import viscous_force


def _start(v0: float, unit: float, time: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Return radius, velocity and time at the onset, their units, the first step of int dt/a."""
    state = np.array([[0.0], [v0], [0.0]])
    return state, np.array([[unit], [v0], [time]]), 0.2 * time / unit


def _forces(state: np.ndarray, unit: float) -> tuple[np.ndarray, ...]:
    """Return force (may be negative), a times its rate, indentation and radius of states."""
    a, v, _ = state
    a = np.maximum(a, 1e-20 * unit)
    P, depth, force_a, depth_a = _law(a)
    delayed = viscous_force(P, force_a / depth_a, v, np.asarray(RETARDATION_TIME))
    return delayed, a / depth_a * v, depth, a


def _rates(state: np.ndarray, unit: float) -> np.ndarray:
    """Return derivatives of the state with respect to int dt/a, in which the onset is smooth."""
    P, rate, _, a = _forces(state, unit)
    return np.array([rate, a * _acceleration(P), a])


def _time(state: np.ndarray) -> float:
    """Return the time [s] of a state."""
    return float(state[2])
