"""Differences of two sines or cosines as products, with the rounding errors of the arguments' sums.

cos u - cos v is -2 sin((u + v)/2) sin((u - v)/2). If one argument is large, the rounding error of
u + v changes the sine by more than the rounding of u and v explains. The error e of a rounded sum
is a double itself, and sin((s + e)/2) follows from the sines and cosines of s/2 and e/2.
"""

from collections.abc import Iterator, Sequence
from itertools import count

import sympy as sp

from derivation.engine.formula.differences import TRIGONOMETRIC, in_products
from derivation.engine.rewrite.form import Step
from derivation.engine.rewrite.products import ProductForm


def by_exact_sums(expression: sp.Expr) -> Iterator[ProductForm]:
    """Yield the form of an expression with differences of functions of two symbols, if any."""
    written = expression.replace(
        lambda node: node.is_Add, lambda *terms: in_products(sp.Add(*terms), TRIGONOMETRIC)
    )
    functions = written.atoms(*TRIGONOMETRIC) - expression.atoms(*TRIGONOMETRIC)
    taken = {str(symbol) for symbol in expression.free_symbols}
    names = (own for n in count(1) if not set(own := [name.format(n) for name in NAMES]) & taken)
    sums: dict[sp.Expr, tuple[Step, ...]] = {}
    for function in sorted(functions, key=str):
        factor, total = function.args[0].as_content_primitive()
        if total.could_extract_minus_sign():
            factor, total = -factor, -total
        terms = sp.Add.make_args(total)
        if len(terms) == 2 and all(term.is_Symbol or (-term).is_Symbol for term in terms):
            if total not in sums:
                sums[total] = _exact_sum(terms[0], terms[1], next(names))
            rounded, lost = sums[total][0].symbol, sums[total][-1].symbol
            exact = sp.expand_trig(function.func(factor * rounded + factor * lost))
            written = written.xreplace({function: exact})
    if sums:
        yield ProductForm(tuple(step for steps in sums.values() for step in steps), written)


NAMES = "total_{}", "second_{}", "first_{}", "error_{}", "rest_{}", "lost_{}"
"""Names of the steps of a sum, with its number."""


def _exact_sum(one: sp.Expr, other: sp.Expr, names: Sequence[str]) -> tuple[Step, ...]:
    """Return the steps of a rounded sum; the last one is its rounding error (Knuth)."""
    total, second, first, error, rest, lost = (sp.Symbol(name, real=True) for name in names)
    return (
        Step(total, one + other),
        Step(second, total - one),
        Step(first, total - second),
        Step(error, one - first),
        Step(rest, other - second),
        Step(lost, error + rest, "the rounding error of the sum"),
    )
