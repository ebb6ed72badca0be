"""A step of Radau IIA of order 5 in long doubles, its equations solved to rounding."""

from collections.abc import Callable
from typing import Any

import numpy as np

from derivation.plate.benchmark.arithmetic import LONG, Array

ITERATIONS = 60
"""Of Newton's method at most; a few are enough but for the longest steps."""

NUDGE = 1e-6
"""Relative change of an indentation that a difference quotient takes: Newton asks no more."""

_ROOT = np.sqrt(LONG.array(6.0))
PLACES = np.array([(4 - _ROOT) / 10, (4 + _ROOT) / 10, LONG.array(1.0)])
"""Of the stages in a step."""

WEIGHTS = np.array([
    [(88 - 7 * _ROOT) / 360, (296 - 169 * _ROOT) / 1800, (-2 + 3 * _ROOT) / 225],
    [(296 + 169 * _ROOT) / 1800, (88 + 7 * _ROOT) / 360, (-2 - 3 * _ROOT) / 225],
    [(16 - _ROOT) / 36, (16 + _ROOT) / 36, 1 / LONG.array(9.0)],
])  # fmt: skip
"""Butcher's tableau (Hairer and Wanner 1996, table IV.5.6)."""


def radau_step(
    state: Array, slope: Array, length: Any, rate: Callable[[Array], Array]
) -> tuple[Array, Array, Callable[[Any], Array]]:
    """State and slope at the end, and the state at a part of the step by the cubic of its stages.

    Parameters
    ----------
    state, slope
        Indentation [m] and speed [m/s] where the step begins, and their rates.
    length
        Of the step [s].
    rate
        Rates of states; shape (2, ...).

    Raises
    ------
    ArithmeticError
        If Newton's method does not settle.
    """
    rises = _stages(state, slope, length, rate)

    def output(share: Any) -> Array:
        value = state
        for k, place in enumerate(PLACES):
            others = np.delete(PLACES, k)
            weight = share / place * np.prod((share - others) / (place - others))
            value = value + weight * rises[:, k]
        return value

    after = state + rises[:, 2]
    return after, rate(after), output


def _stages(state: Array, slope: Array, length: Any, rate: Callable[[Array], Array]) -> Array:
    """Rises Z = length f(state + Z) A^T of the state at the three stages, shape (2, 3).

    Each correction comes from a linear system in doubles: that costs Newton's method an
    iteration, not accuracy. It ends where corrections stop falling, among the roundings.
    """
    eps = float(np.finfo(LONG.dtype).eps)
    # Speeds first from the slope, then indentations from these.
    speeds = length * PLACES * slope[1]
    rises = np.array([length * PLACES * (state[1] + speeds / 2), speeds])
    before = np.inf
    for _ in range(ITERATIONS):
        stages = state[:, None] + rises
        nudged = np.array([stages[0] * (1 + NUDGE), stages[1]])
        rates = rate(np.concatenate([stages, nudged], axis=1))
        miss = rises - length * (rates[:, :3] @ WEIGHTS.T)
        steepness = (rates[1, 3:] - rates[1, :3]) / (nudged[0] - stages[0])
        correction = _solved(miss, float(length), steepness.astype(np.float64))
        rises = rises - correction
        size = float((abs(correction).max(axis=1) / abs(stages).max(axis=1)).max())
        if size < eps or before <= size < 1e3 * eps:
            return rises
        before = size
    raise ArithmeticError(f"the equations of a step of {float(length):g} s were not solved")


def _solved(miss: Array, length: float, steepness: Array) -> Array:
    """The correction Z of rises with Z - length J Z A^T = miss, J = [[0, 1], [steepness, 0]].

    Indentations are eliminated: Z_x = miss_x + length A Z_v.
    """
    weights = length * WEIGHTS.astype(np.float64)
    x, v = miss.astype(np.float64)
    matrix = np.eye(3) - weights @ (steepness[:, None] * weights)
    speeds = np.linalg.solve(matrix, v + weights @ (steepness * x))
    return np.array([x + weights @ speeds, speeds])
