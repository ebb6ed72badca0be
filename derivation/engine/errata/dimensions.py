"""Dimension check of a given formula, before any other comparison."""

from fractions import Fraction

import sympy as sp

from derivation.engine.formula.dimension import Dimension, DimensionError, dimension
from derivation.engine.formula.dimension import unit as dimension_of
from derivation.engine.formula.vocabulary import Vocabulary

_COMMON = (
    *("1", "m", "m^2", "m^3", "1/m", "1/m^2", "kg", "kg/m^3", "s", "1/s", "m/s", "m/s^2"),
    *("m^2/s^2", "N", "J", "W", "Pa", "Pa/m", "m/Pa", "1/Pa"),
    *(f"m/N^({n}/3)" for n in (5, 7, 11)),
    *("m/N", "m/N^3", "N/m", "N/m^3"),
    *(f"N/m^({n}/3)" for n in (5, 7, 11)),
)
_NAMES = {dimension_of(unit): unit for unit in _COMMON}
"""Units in which dimensions are shown."""


def dimension_note(expression: sp.Expr, unit: str, vocabulary: Vocabulary) -> str | None:
    """Return a description of a wrong dimension; None if the expression has the given unit."""
    try:
        note = dimension(expression, vocabulary.dimensions)
    except DimensionError as error:
        return str(error)
    expected = dimension_of(unit)
    if note == expected:
        return None
    excess = unit_name(note / expected)
    return f"[{unit}] expected, [{unit_name(note)}] found: a factor of [{excess}] too much"


def unit_name(value: Dimension) -> str:
    """Return the unit of a dimension, in metres and pascals if possible."""
    if value in _NAMES:
        return _NAMES[value]
    if value != Dimension(value.length, value.mass, -2 * value.mass):
        return str(value)
    powers = (("m", value.length + value.mass), ("Pa", value.mass))
    above = " ".join(_power(unit, k) for unit, k in powers if k > 0) or "1"
    below = [_power(unit, -k) for unit, k in powers if k < 0]
    if not below:
        return above
    return f"{above}/{below[0]}" if len(below) == 1 else f"{above}/({' '.join(below)})"


def _power(unit: str, exponent: Fraction) -> str:
    return unit if exponent == 1 else f"{unit}^{exponent}"
