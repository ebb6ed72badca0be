"""Sums with e^p, cosh p or cos p by their differences from 1, in formulas of several variables.

The constants then cancel before anything is rounded: e^a + e^b - 2 is expm1 a + expm1 b.
"""

from collections.abc import Callable, Iterator, Mapping

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.engine.formula.differences import TRIGONOMETRIC, in_products

DIFFERENCES: Mapping[type[sp.Function], Callable[[sp.Expr], sp.Expr]] = {
    sp.exp: expm1,
    sp.cosh: lambda p: 2 * sp.sinh(p / 2) ** 2,
    sp.cos: lambda p: -2 * sp.sin(p / 2) ** 2,
}
SMALL = sp.Rational(1, 10**6)
"""Size of the arguments at which terms that cancel are recognised."""
LEFT = sp.Rational(1, 10**3)
"""Part of the terms that remains of a sum that does not cancel."""
DIGITS = 30


def by_differences_from_one(expression: sp.Expr) -> Iterator[sp.Expr]:
    """Yield the expression with sums that cancel for small arguments by differences, if any.

    The second one keeps sines and cosines, whose differences become products:
    cos p - e^q cos r is (cos p - cos r) - cos r expm1 q.
    """
    found = expression.replace(_cancels, _by_differences)
    if found != expression:
        yield found
    if expression.has(sp.exp) and expression.has(*TRIGONOMETRIC):
        yield expression.replace(_cancels, _by_products)


def _cancels(node: sp.Basic) -> bool:
    if not (isinstance(node, sp.Add) and len(node.free_symbols) > 1 and node.has(*DIFFERENCES)):
        return False
    symbols = sorted(node.free_symbols, key=str)
    at = {
        symbol: SMALL * number for symbol, number in zip(symbols, sp.primerange(999), strict=False)
    }
    terms = [sp.N(term.subs(at), DIGITS) for term in sp.expand_mul(node).args]
    if not all(term.is_Number for term in terms):
        return False
    return bool(abs(sum(terms)) < LEFT * sum(abs(term) for term in terms))


def _by_products(node: sp.Expr) -> sp.Expr:
    node = sp.expand_mul(node.replace(sp.exp, lambda p: 1 + expm1(p)))
    return in_products(node, TRIGONOMETRIC) if node.is_Add else node


def _by_differences(node: sp.Expr) -> sp.Expr:
    for function, difference in DIFFERENCES.items():
        node = node.replace(function, lambda p, of=difference: 1 + of(p))
    return sp.expand_mul(node)
