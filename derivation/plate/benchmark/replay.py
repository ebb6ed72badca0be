"""A solver's steps taken again in long doubles: the same truncated method almost without rounding.

The steps that SciPy's solver accepted are its own choice; what it does in each of them, its
stages, its continuous output and the search of the turning point in that, is repeated. Two
things come out sharper than SciPy has them, and count as its rounding: the turning point, which
it seeks to 4 units of double precision of a second, not of the time; and the equations of an
implicit method's stages, which it leaves where its Newton iteration meets a tolerance.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from derivation.plate.benchmark.arithmetic import LONG, Array

HALVINGS = 70
"""Of the last step, to find where the sphere stops."""

Rate = Callable[[Array], Array]
Step = Callable[[Array, Array, Any, Rate], tuple[Array, Array, Callable[[Any], Array]]]
"""State and slope where a step begins, its length, and the rates of states -> state and slope at
its end, and the state at a part of it."""


def turning_time(
    step: Step, v0: float, m: float, ends: Sequence[float], force: Callable[[Array], Any]
) -> Any:
    """When a sphere of mass m [kg] and speed v0 [m/s] stops, in the last of the steps; or NaN.

    Parameters
    ----------
    step
        A step of the method.
    v0, m
        Speed [m/s] and mass [kg].
    ends
        Times [s] where the steps begin and end.
    force
        Force [N] at an indentation [m], in long doubles.
    """
    times, mass = LONG.array(list(ends)), LONG.array(m)

    def rate(state: Array) -> Array:
        pressed = state[0] > 0
        load = 0 * state[0]
        if pressed.any():
            load = np.where(pressed, force(np.where(pressed, state[0], state[0].max())), load)
        return np.array([state[1], -load / mass])

    state = LONG.array([0.0, v0])
    slope = rate(state)
    for begin, end in pairwise(times[:-1]):
        state, slope, _ = step(state, slope, end - begin, rate)
    length = times[-1] - times[-2]
    _, _, output = step(state, slope, length, rate)
    low, high = LONG.array(0.0), LONG.array(1.0)
    if not output(low)[1] > 0 > output(high)[1]:
        return LONG.array(np.nan)
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if output(middle)[1] > 0 else (low, middle)
    return times[-2] + low * length


def dop853_step(
    state: Array, slope: Array, length: Any, rate: Rate
) -> tuple[Array, Array, Callable[[Any], Array]]:
    """A step by SciPy's tableau, and its continuous output."""
    from scipy.integrate import DOP853 as tableau

    stages = [slope]
    for row in tableau.A[1:]:
        stages.append(rate(state + length * _weighted(row, stages)))
    after = state + length * _weighted(tableau.B, stages)
    stages.append(rate(after))
    ended = stages[-1]

    def output(share: Any) -> Array:
        for row in tableau.A_EXTRA[len(stages) - len(tableau.B) - 1 :]:
            stages.append(rate(state + length * _weighted(row, stages)))
        rise = after - state
        parts = [rise, length * slope - rise, 2 * rise - length * (ended + slope)]
        parts += [length * _weighted(row, stages) for row in tableau.D]
        value = 0 * state
        for k, part in enumerate(reversed(parts)):
            value = (value + part) * (1 - share if k % 2 else share)
        return state + value

    return after, ended, output


def _weighted(row: Array, stages: Sequence[Array]) -> Array:
    total = 0 * stages[0]
    for weight, stage in zip(row, stages, strict=False):
        if weight:
            total = total + LONG.array(weight) * stage
    return total
