"""How the symbols of a paper depend on one another, beyond its derivation: what comparison asks."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

from derivation.engine.formula.record import Record

Formulas = Mapping[str, Record]
Symbols = set[sp.Symbol]
Meanings = dict[sp.Symbol, sp.Expr]
Point = dict[str, tuple[str, Fraction]]
"""The literal as typed and the exact value, by symbol name."""


@dataclass(frozen=True)
class Relations:
    """The dependent symbols of a paper; by default there are none.

    Parameters
    ----------
    between
        The symbols that follow from others in a comparison, from the compared formula's name,
        the symbols of the given and of the derived formula, and all formulas. Asked only where
        the two are not in the same symbols.
    point
        A point with values of guests, in the vocabulary's own symbols.
    """

    between: Callable[[str, Symbols, Symbols, Formulas], Meanings] = lambda *_: {}
    point: Callable[[Point], Point] = lambda point: point
