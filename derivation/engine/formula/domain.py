"""Conditions on symbols, written as comparisons in Python syntax, evaluated at exact points."""

import operator
import re
from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from functools import cache
from math import prod

import sympy as sp

from derivation.engine.formula.parse import parse
from derivation.engine.formula.vocabulary import NOTHING, symbols_of

_COMPARISON = re.compile(r"(.+?)(<=|>=|!=|<|>)(.+)")
_OPERATORS = {
    "<=": operator.le,
    ">=": operator.ge,
    "!=": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
}


def holds(condition: str, values: Mapping[sp.Symbol, Fraction]) -> bool:
    """Return whether a condition is true at an exact point.

    Parameters
    ----------
    condition
        One comparison of rational expressions, such as ``3 * lam > -2 * mu``.
    values
        Exact values of all its symbols, in SI units.

    Raises
    ------
    ValueError
        If the condition is not a comparison, or a symbol has no value.
    """
    _, compare = comparison(condition)
    return bool(compare(excess(condition, values), 0))


def excess(condition: str, values: Mapping[sp.Symbol, Fraction]) -> Fraction:
    """Return the left side of a condition minus the right side, at an exact point; see `holds`."""
    difference, _ = comparison(condition)
    known = {symbol.name: value for symbol, value in values.items()}
    if missing := symbols_of(condition) - known.keys():
        names = ", ".join(sorted(missing))
        raise ValueError(f"{condition}: expected a value for each symbol, got none of {names}")
    return _exactly(difference, known)


@cache
def comparison(condition: str) -> tuple[sp.Expr, Callable[[Fraction, int], bool]]:
    """Return the expression that a condition compares with 0, and the comparison."""
    left, sign, right = sides(condition)
    return left - right, _OPERATORS[sign]


def sides(condition: str) -> tuple[sp.Expr, str, sp.Expr]:
    """Return the left side of a condition, its sign, and the right side."""
    match = _COMPARISON.fullmatch(condition)
    if match is None:
        raise ValueError(f"expected a comparison like 'a < b', got {condition!r}")
    left, sign, right = match.groups()
    symbols = {name: sp.Symbol(name) for name in symbols_of(condition)}
    return parse(left, NOTHING, symbols), sign, parse(right, NOTHING, symbols)


def _exactly(node: sp.Basic, values: Mapping[str, Fraction]) -> Fraction:
    """Return the value of a rational expression at a point, by Python's fast fractions."""
    if isinstance(node, sp.Symbol):
        return values[node.name]
    if isinstance(node, sp.Rational):
        return Fraction(int(node.p), int(node.q))
    parts = [_exactly(part, values) for part in node.args]
    if isinstance(node, sp.Add):
        return sum(parts, Fraction(0))
    if isinstance(node, sp.Mul):
        return prod(parts, start=Fraction(1))
    if isinstance(node, sp.Pow) and parts[1].denominator == 1:
        return Fraction(parts[0] ** int(parts[1]))
    if isinstance(node, sp.Abs):
        return abs(parts[0])
    raise ValueError(f"expected a rational expression in a condition, got {node}")


def violated_conditions(
    conditions: Iterable[str], values: Mapping[sp.Symbol, Fraction]
) -> list[str]:
    """Return the false conditions at an exact point, without those that contain other symbols."""
    names = {symbol.name for symbol in values}
    return [c for c in conditions if symbols_of(c) <= names and not holds(c, values)]
