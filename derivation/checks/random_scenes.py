"""Functions shared by the checks on random scenes: random numbers, differences."""

import math
from collections.abc import Callable, Mapping, Sequence
from random import Random
from typing import Any

from derivation.scene.scene import OUTPUTS

Scene = Mapping[str, Mapping[str, Any]]
"""The tables of a scene file."""


def log_uniform_draw(generator: Random) -> Callable[[float, float], float]:
    """Return a function that draws log-uniform numbers between two limits."""
    return lambda low, high: 10 ** generator.uniform(math.log10(low), math.log10(high))


def largest_change(values: Sequence[float], reference: Sequence[float]) -> tuple[float, str]:
    """Return the largest relative difference (infinite for NaN), and the name of its result."""
    changes = [abs(value / x - 1.0) for value, x in zip(values, reference, strict=True)]
    changes = [change if math.isfinite(change) else math.inf for change in changes]
    return max(changes), OUTPUTS[changes.index(max(changes))]
