"""Neighbouring doubles, and their use in families of hard cases."""

from collections.abc import Callable, Sequence
from fractions import Fraction

from flint import arb
from scipy.optimize import brentq

from derivation.engine.formula.ball import Exact
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


def nearest_root(function: Callable[[Exact], arb], low: float, high: float) -> float:
    """Return the double nearest to the only root, a simple one, of a function between two numbers.

    Raises
    ------
    ValueError
        If the function has the same sign at both numbers.
    """
    rising = bool(function(high) > 0)
    if bool(function(low) > 0) == rising:
        raise ValueError(f"the function has the same sign at {low} and {high}")
    close, distance = float(brentq(lambda x: float(function(x)), low, high, xtol=5e-324)), 1

    def beyond(x: Exact) -> bool:
        return bool(function(x) > 0) == rising

    low, high = close, neighbour(close, 1)
    while beyond(low):
        low, distance = neighbour(low, -distance), 2 * distance
    while not beyond(high):
        high, distance = neighbour(high, distance), 2 * distance
    while low < (middle := (low + high) / 2) < high:
        low, high = (low, middle) if beyond(middle) else (middle, high)
    return low if beyond((Fraction(low) + Fraction(high)) / 2) else high


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
