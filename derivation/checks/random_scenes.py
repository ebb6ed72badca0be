"""What checks by random scenes share: tables of keys, numbers spread over decades, differences."""

import math
from collections.abc import Callable, Mapping, Sequence
from random import Random
from typing import Any

from derivation.scene.scene import OUTPUTS

Scene = Mapping[str, Mapping[str, Any]]
"""Tables of keys, as a scene file holds them."""


def spreading(generator: Random) -> Callable[[float, float], float]:
    """A function that draws a number between two, every decade with its share."""
    return lambda low, high: 10 ** generator.uniform(math.log10(low), math.log10(high))


def largest_change(values: Sequence[float], truth: Sequence[float]) -> tuple[float, str]:
    """Largest relative difference of results, infinite for one that is no number; and of which."""
    changes = [abs(value / x - 1.0) for value, x in zip(values, truth, strict=True)]
    changes = [change if math.isfinite(change) else math.inf for change in changes]
    return max(changes), OUTPUTS[changes.index(max(changes))]
