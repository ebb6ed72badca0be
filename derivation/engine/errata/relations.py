"""Dependent symbols of a paper, which a comparison of formulas takes into account."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

from derivation.engine.formula.record import Record

Formulas = Mapping[str, Record]
Symbols = set[sp.Symbol]
Meanings = dict[sp.Symbol, sp.Expr]
Point = dict[str, tuple[str, Fraction]]
"""The literal as typed, and its exact value, by symbol name."""


@dataclass(frozen=True)
class Relations:
    """The dependent symbols of a paper; by default there are none.

    Parameters
    ----------
    between
        Function that returns the dependent symbols of a comparison and their expressions, from the
        name of the compared formula, the symbols of the given and of the derived formula, and all
        formulas. It is called only if the two formulas have different symbols.
    point
        Function that converts a point with additional symbols to the vocabulary's symbols.
    """

    between: Callable[[str, Symbols, Symbols, Formulas], Meanings] = lambda *_: {}
    point: Callable[[Point], Point] = lambda point: point
