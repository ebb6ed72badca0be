"""Dimension check of a formula as it stands, before any other comparison."""

from fractions import Fraction

import sympy as sp

from derivation.formula.dimension import UNITS, Dimension, DimensionError, dimension
from derivation.formula.symbols import BY_NAME

_KNOWN = {argument.symbol: UNITS[argument.unit] for argument in BY_NAME.values()}
_NAMES = {value: unit for unit, value in UNITS.items()}


def dimension_note(expression: sp.Expr, unit: str) -> str | None:
    """What is wrong with the dimension of an expression that should have a unit, or None."""
    try:
        found = dimension(expression, _KNOWN)
    except DimensionError as error:
        return str(error)
    expected = UNITS[unit]
    if found == expected:
        return None
    excess = unit_name(found / expected)
    return f"[{unit}] expected, [{unit_name(found)}] found: a factor of [{excess}] too much"


def unit_name(value: Dimension) -> str:
    """The unit of a dimension, in metres and pascals where mass and time allow it."""
    if value in _NAMES:
        return _NAMES[value]
    if value.time != -2 * value.mass:
        return str(value)
    powers = (("m", value.length + value.mass), ("Pa", value.mass))
    above = " ".join(_power(unit, k) for unit, k in powers if k > 0) or "1"
    below = [_power(unit, -k) for unit, k in powers if k < 0]
    if not below:
        return above
    return f"{above}/{below[0]}" if len(below) == 1 else f"{above}/({' '.join(below)})"


def _power(unit: str, exponent: Fraction) -> str:
    return unit if exponent == 1 else f"{unit}^{exponent}"
