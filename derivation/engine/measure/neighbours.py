"""Neighbouring doubles, and their use in families of hard cases."""

from collections.abc import Sequence

from derivation.engine.formula.ulp import from_ordinal, ordinal
from derivation.engine.measure.case import HardCase

OFFSETS = (-32, -1, 0, 1, 32)
"""Distances in doubles of the cases from a switch point."""

Inputs = dict[str, tuple[str, ...]]


def neighbour(point: float, offset: int) -> float:
    """Return the double that is `offset` doubles above a number."""
    return from_ordinal(ordinal(point) + offset)


def around(point: float) -> tuple[float, ...]:
    """Return the doubles at all `OFFSETS` from a number."""
    return tuple(neighbour(point, offset) for offset in OFFSETS)


def exact_inputs(**values: float | Sequence[float]) -> Inputs:
    """Return the arguments as hexadecimal doubles."""
    return {
        name: (value.hex(),) if isinstance(value, float) else tuple(x.hex() for x in value)
        for name, value in values.items()
    }


def case_around(
    group: str, kernel: str, why: str, given: Inputs, modes: int | None = None
) -> HardCase:
    """Return a case with an array of doubles on both sides of a number, described by `why`."""
    return HardCase(
        group, kernel, f"0, 1 and 32 ULP to either side of {why}.", given, "array", modes
    )
