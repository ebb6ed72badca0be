"""The doubles beside a place, and how families of hard cases are written."""

from collections.abc import Sequence

from derivation.engine.formula.ulp import from_ordinal, ordinal
from derivation.engine.measure.case import HardCase

OFFSETS = (-32, -1, 0, 1, 32)
"""How many doubles from a seam its cases lie."""

Inputs = dict[str, tuple[str, ...]]


def beside(place: float, offset: int) -> float:
    """The double so many places away."""
    return from_ordinal(ordinal(place) + offset)


def around(place: float) -> tuple[float, ...]:
    """The doubles at all offsets from a place."""
    return tuple(beside(place, offset) for offset in OFFSETS)


def exactly(**values: float | Sequence[float]) -> Inputs:
    """Arguments as hexadecimal doubles."""
    return {
        name: (value.hex(),) if isinstance(value, float) else tuple(x.hex() for x in value)
        for name, value in values.items()
    }


def about(group: str, kernel: str, why: str, given: Inputs, modes: int | None = None) -> HardCase:
    """A case of the doubles about a place, as an array."""
    return HardCase(
        group, kernel, f"0, 1 and 32 ULP to either side of {why}.", given, "array", modes
    )
