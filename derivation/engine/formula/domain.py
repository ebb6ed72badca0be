"""Conditions on symbols, written as comparisons in Python's notation, tested at exact points."""

import operator
import re
from collections.abc import Iterable, Mapping
from fractions import Fraction

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
    """Whether a condition is true at an exact point.

    Parameters
    ----------
    condition
        One comparison of rational expressions, for instance ``3 * lam > -2 * mu``.
    values
        Exact values of all its symbols, in SI units.

    Raises
    ------
    ValueError
        If the condition is no comparison, or a symbol has no value.
    """
    match = _COMPARISON.fullmatch(condition)
    if match is None:
        raise ValueError(f"expected a comparison like 'a < b', got {condition!r}")
    left, sign, right = match.groups()
    known = {symbol.name: symbol for symbol in values}
    if missing := symbols_of(condition) - set(known):
        names = ", ".join(sorted(missing))
        raise ValueError(f"{condition}: expected a value for each symbol, got none of {names}")
    exact = {s: sp.Rational(value.numerator, value.denominator) for s, value in values.items()}
    difference = (parse(left, NOTHING, known) - parse(right, NOTHING, known)).subs(exact)
    return bool(_OPERATORS[sign](difference, 0))


def broken(conditions: Iterable[str], values: Mapping[sp.Symbol, Fraction]) -> list[str]:
    """The conditions that are false at an exact point; those with further symbols do not count."""
    names = {symbol.name for symbol in values}
    return [c for c in conditions if symbols_of(c) <= names and not holds(c, values)]
