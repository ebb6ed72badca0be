"""A point at which a function is measured."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Point:
    """Arguments by name, and the number of modes for a modal sum."""

    values: Mapping[str, float]
    modes: int | None = None


def in_both_forms(exact: str) -> str:
    """Return a hexadecimal double in decimal, with the hexadecimal in parentheses.

    Examples
    --------
    >>> in_both_forms("0x1.8000000000000p-1")
    '0.75 (0x1.8000000000000p-1)'
    """
    return f"{float.fromhex(exact)!r} ({exact})"


def to_single(point: Point) -> Point | None:
    """Return the point rounded to single precision; None if the rounding changes its kind.

    This happens if a number overflows or becomes zero, or if two different numbers become equal:
    a point next to the end of a domain would then lie on it.
    """
    with np.errstate(over="ignore"):
        values = {key: float(np.float32(value)) for key, value in point.values.items()}
    in_range = all(
        math.isfinite(single) and (single == 0.0) == (point.values[key] == 0.0)
        for key, single in values.items()
    )
    distinct = len(set(values.values())) == len(set(point.values.values()))
    return Point(values, point.modes) if in_range and distinct else None
