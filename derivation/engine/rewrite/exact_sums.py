"""Differences of two sines or cosines as products, with the rounding errors of their arguments.

cos u - cos v is -2 sin((u + v)/2) sin((u - v)/2). If one argument is large, the rounding error of
u + v changes the sine by more than the rounding of u and v explains. The error e of a rounded sum
or product is a double itself, and sin((s + e)/2) follows from the sines and cosines of s/2 and e/2.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import count

import sympy as sp

from derivation.engine.formula.differences import TRIGONOMETRIC, in_products
from derivation.engine.rewrite.form import ROUNDING_ERROR, Step
from derivation.engine.rewrite.products import ProductForm

NAMES = "total_{}", "second_{}", "first_{}", "error_{}", "rest_{}", "lost_{}"
"""Names of the steps of a sum, with its number; a product has the first and the last one."""
Pair = tuple[sp.Expr, sp.Expr]
"""A rounded number and its rounding error."""


def by_exact_sums(expression: sp.Expr) -> Iterator[ProductForm]:
    """Yield the form of an expression with differences of functions of sums and products, if any.

    The arguments are sums of products of symbols.
    """
    written = expression.replace(
        lambda node: node.is_Add, lambda *terms: in_products(sp.Add(*terms), TRIGONOMETRIC)
    )
    functions = written.atoms(*TRIGONOMETRIC) - expression.atoms(*TRIGONOMETRIC)
    exact = _ExactArithmetic({str(symbol) for symbol in expression.free_symbols})
    for function in sorted(functions, key=str):
        factor, total = function.args[0].as_content_primitive()
        if total.could_extract_minus_sign():
            factor, total = -factor, -total
        pair = exact.pair(total)
        if pair is not None and pair[1] != 0:
            rounded, lost = pair
            value = sp.expand_trig(function.func(factor * rounded + factor * lost))
            written = written.xreplace({function: value})
    if exact.pairs:
        steps = tuple(step for steps, _ in exact.pairs.values() for step in steps)
        yield ProductForm(steps, written)


@dataclass
class _ExactArithmetic:
    """Writes sums and products of symbols as rounded numbers with their errors.

    Parameters
    ----------
    taken
        Names that steps must not have.
    pairs
        The steps of each sum or product, and its pair.
    """

    taken: set[str]
    pairs: dict[sp.Expr, tuple[tuple[Step, ...], Pair]] = field(default_factory=dict)

    def pair(self, node: sp.Expr) -> Pair | None:
        """Return an expression as a pair; None if it is no sum or product of symbols."""
        size, rest = node.as_coeff_Mul()
        if abs(size) != 1:
            inner = self.pair(rest) if _is_power_of_two(size) else None
            return None if inner is None else (size * inner[0], size * inner[1])
        if rest.is_Symbol:
            return node, sp.Integer(0)
        if rest not in self.pairs:
            if not (rest.is_Add or rest.is_Mul):
                return None
            first, *others = rest.args
            one, other = self.pair(first), self.pair(rest.func(*others))
            if one is None or other is None:
                return None
            self.pairs[rest] = (self._sum if rest.is_Add else self._product)(one, other)
        high, low = self.pairs[rest][1]
        return size * high, size * low

    def _names(self) -> list[sp.Symbol]:
        """Return symbols for the steps of the next sum or product."""
        names = next(
            own
            for n in count(len(self.pairs) + 1)
            if not set(own := [name.format(n) for name in NAMES]) & self.taken
        )
        self.taken |= set(names)
        return [sp.Symbol(name, real=True) for name in names]

    def _sum(self, one: Pair, other: Pair) -> tuple[tuple[Step, ...], Pair]:
        """Return the steps of a rounded sum; the last one is its rounding error (Knuth)."""
        total, second, first, error, rest, lost = self._names()
        steps = (
            Step(total, one[0] + other[0]),
            Step(second, total - one[0]),
            Step(first, total - second),
            Step(error, one[0] - first),
            Step(rest, other[0] - second),
            Step(lost, error + rest, "the rounding error of the sum"),
        )
        return steps, (total, lost + one[1] + other[1])

    def _product(self, one: Pair, other: Pair) -> tuple[tuple[Step, ...], Pair]:
        """Return the steps of a rounded product; the last one is its rounding error."""
        total, *_, lost = self._names()
        error = ROUNDING_ERROR(one[0], other[0])
        steps = (
            Step(total, one[0] * other[0]),
            Step(lost, error, "the rounding error of the product"),
        )
        return steps, (total, lost + one[1] * other[0] + one[0] * other[1])


def _is_power_of_two(number: sp.Expr) -> bool:
    return bool(abs(number).is_Rational and sp.log(abs(number), 2).is_Integer)
