"""Differences and sums of a function at two arguments as products, which do not cancel."""

from collections.abc import Callable, Collection, Iterator, Mapping
from itertools import combinations

import sympy as sp

Halves = Callable[[sp.Expr, sp.Expr], sp.Expr]
"""A function of (u + v)/2 and (u - v)/2."""

DIFFERENCES: Mapping[type[sp.Function], Halves] = {
    sp.cos: lambda s, d: -2 * sp.sin(s) * sp.sin(d),
    sp.sin: lambda s, d: 2 * sp.cos(s) * sp.sin(d),
    sp.cosh: lambda s, d: 2 * sp.sinh(s) * sp.sinh(d),
    sp.sinh: lambda s, d: 2 * sp.cosh(s) * sp.sinh(d),
    sp.exp: lambda s, d: 2 * sp.exp(s) * sp.sinh(d),
}
"""f(u) - f(v) as a product."""
SUMS: Mapping[type[sp.Function], Halves] = {
    sp.cos: lambda s, d: 2 * sp.cos(s) * sp.cos(d),
    sp.sin: lambda s, d: 2 * sp.sin(s) * sp.cos(d),
}
"""f(u) + f(v) as a product, for functions whose sum can cancel."""
_ONE_AT_ZERO = sp.cos, sp.cosh, sp.exp
TRIGONOMETRIC: Collection[type[sp.Function]] = (sp.cos, sp.sin)
HYPERBOLIC: Collection[type[sp.Function]] = (sp.cosh, sp.sinh)


def in_products(node: sp.Add, kinds: Collection[type[sp.Function]]) -> sp.Expr:
    """Return a sum with pairs of terms c f(u) and +-c f(v) written as products.

    A term c counts as c f(0) if f(0) = 1, so that 1 - cos u becomes 2 sin(u/2)^2.
    """
    for one, other in combinations(node.args, 2):
        product = _product(one, other, kinds)
        if product is not None:
            rest = sp.Add(*(part for part in node.args if part not in (one, other)))
            return (in_products(rest, kinds) if rest.is_Add else rest) + product
    return node


def _product(one: sp.Expr, other: sp.Expr, kinds: Collection[type[sp.Function]]) -> sp.Expr | None:
    """Return the sum of two terms as a product; None if there is none."""
    for kind in kinds:
        for c, u in _split(one, kind):
            for factor, v in _split(other, kind):
                table = DIFFERENCES if c == -factor else SUMS if c == factor else {}
                if kind in table and u != v:
                    halves = sp.expand((u + v) / 2), sp.expand((u - v) / 2)
                    return c * table[kind](*map(sp.factor_terms, halves))
    return None


def _split(term: sp.Expr, kind: type[sp.Function]) -> Iterator[tuple[sp.Expr, sp.Expr]]:
    """Yield the ways to write a term as c f(u), by c and u."""
    for factor in sp.Mul.make_args(term):
        if isinstance(factor, kind):
            yield term / factor, factor.args[0]
    if kind in _ONE_AT_ZERO:
        yield term, sp.Integer(0)
