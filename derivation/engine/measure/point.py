"""A point at which a function is measured."""

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Point:
    """Arguments by name, and the number of modes for a modal sum."""

    values: Mapping[str, float]
    modes: int | None = None
