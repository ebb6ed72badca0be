"""What checks by random scenes share: results, tables of keys, numbers spread over decades."""

import math
from collections.abc import Callable, Mapping
from random import Random
from typing import Any

OUTPUTS = ("contact_time", "max_indentation", "max_force", "max_contact_radius", "restitution")

Scene = Mapping[str, Mapping[str, Any]]
"""Tables of keys, as a scene file holds them."""
Tell = Callable[[str, int, int], None]
"""Is told what is looked at, which of them, and how many there are."""


def spreading(generator: Random) -> Callable[[float, float], float]:
    """A function that draws a number between two, every decade with its share."""
    return lambda low, high: 10 ** generator.uniform(math.log10(low), math.log10(high))
