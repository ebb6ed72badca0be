"""Formulas f(x) = F(g(x)), whose stable form follows from that of g.

F is a function of the formula, or one that replaces a difference that cancels:

 log p - log q            log1p((p - q)/q); x counts as the logarithm of e^x, acosh p as that of
                          p + sqrt(p^2 - 1)
 log(p + sqrt(p^2 + 1))   asinh p
 exp p - exp q            e^q expm1(p - q)
 p^a - q^a                q^a expm1(a log1p((p - q)/q)) or q^a expm1(a log(p/q))
 atan p - atan q          atan((p - q)/(1 + p q))
 pi/2 - atan p            atan(1/p)
 acosh p, acos p          2 asinh and 2 asin of sqrt(|p - 1|/2)
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import sympy as sp
from sympy.codegen.cfunctions import expm1, log1p

from derivation.engine.rewrite.powers import powers

Outer = Callable[[sp.Expr], sp.Expr]
MOST_OPERATIONS = 60
"""Largest number of operations of quotients that are simplified."""


@dataclass(frozen=True)
class Composition:
    """A formula f(x) = outer(g(u)), where u = argument is a function of x.

    Parameters
    ----------
    expression, variable
        g, and the symbol u, or x if they are equal.
    argument
        u as an expression in x.
    outer
        Function from an expression for g to one for f; it may contain x.
    """

    expression: sp.Expr
    variable: sp.Symbol
    argument: sp.Expr
    outer: Outer


def compositions(expression: sp.Expr, x: sp.Symbol) -> Iterator[Composition]:
    """Yield the ways to write a formula as a composition."""
    factors = sp.Mul.make_args(expression)
    simple = [part for part in factors if _is_simple(part, x)]
    others = [part for part in factors if part not in simple]
    if len(others) == 1:
        for outer, inner in _outer(others[0], x):
            if inner.has(x):
                yield Composition(inner, x, x, _scaled(sp.Mul(*simple), outer))
    for row in powers(expression, x):
        front = x**row.power
        yield Composition(row.expression, row.variable, row.argument, _scaled(front, lambda v: v))


def _scaled(front: sp.Expr, outer: Outer) -> Outer:
    return lambda v: front * outer(v)


def _is_simple(part: sp.Expr, x: sp.Symbol) -> bool:
    """Return whether a factor is a constant or a power of x."""
    base, exponent = part.as_base_exp()
    return not part.has(x) or (base == x and exponent.is_number)


def _outer(node: sp.Expr, x: sp.Symbol) -> Iterator[tuple[Outer, sp.Expr]]:
    """Yield outer functions of a factor, each with its argument."""
    if node.is_Add:
        yield from _of_logarithms(node, x)
        if len(node.args) == 2:
            yield from _of_difference(node.args[0], node.args[1], x)
    elif node.is_Pow and node.exp.is_number and node.base != x:
        yield lambda v: v**node.exp, node.base
    elif isinstance(node, sp.log):
        yield from _inverse_sine(node.args[0])
        yield from _logarithm(sp.Integer(1), node.args[0], x)
    elif isinstance(node, sp.acosh):
        yield lambda v: 2 * sp.asinh(sp.sqrt(v)), sp.expand(node.args[0] - 1) / 2
    elif isinstance(node, sp.acos):
        yield lambda v: 2 * sp.asin(sp.sqrt(v)), sp.expand(1 - node.args[0]) / 2
    elif isinstance(node, sp.Function) and len(node.args) == 1 and node.args[0] != x:
        yield node.func, node.args[0]


def _inverse_sine(argument: sp.Expr) -> Iterator[tuple[Outer, sp.Expr]]:
    """Write log(p + sqrt(p^2 + 1)) as asinh p."""
    for root in sp.Add.make_args(argument):
        p = argument - root
        if root.is_Pow and root.exp == sp.S.Half and sp.expand(p**2 + 1 - root.base) == 0:
            yield sp.asinh, p


def _logarithm(factor: sp.Expr, argument: sp.Expr, x: sp.Symbol) -> Iterator[tuple[Outer, sp.Expr]]:
    yield lambda v: factor * log1p(v), _quotient(argument - 1, x)
    yield lambda v: factor * sp.log(v), _quotient(argument, x)
    written = sp.expand(argument.rewrite((sp.sinh, sp.cosh), sp.exp))
    rates = [part.args[0] / x for part in written.atoms(sp.exp)]
    if rates and all(rate.is_Rational for rate in rates) and max(rates) > 0:
        rest = sp.expand(written * sp.exp(-max(rates) * x)) - 1
        yield lambda v: factor * (max(rates) * x + log1p(v)), rest


def _quotient(expression: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """Return a short form of an expression: a quotient, or a sum of exponentials."""
    if expression.count_ops() > MOST_OPERATIONS:
        return expression
    if expression.is_rational_function(x):
        return sp.cancel(expression)
    written = sp.expand(expression.rewrite((sp.sinh, sp.cosh), sp.exp))
    if any(power.exp.q == 2 for power in expression.atoms(sp.Pow) if power.exp.is_Rational):
        return sp.together(expression)  # then the difference with a root is a factor
    return min((expression, written), key=sp.count_ops)


def _of_logarithms(node: sp.Add, x: sp.Symbol) -> Iterator[tuple[Outer, sp.Expr]]:
    """Write c log p - c log q + m x as c times the logarithm of a product.

    asinh p and acosh p count as the logarithm of p + sqrt(p^2 +- 1).
    """
    product, factor = sp.Integer(1), None
    if node.has(sp.log):
        node = node.replace(sp.asinh, lambda p: sp.log(p + sp.sqrt(p**2 + 1)))
        node = node.replace(sp.acosh, lambda p: sp.log(p + sp.sqrt(p**2 - 1)))
    for term in node.args:
        size, rest = term.as_independent(x, as_Add=False)
        if not isinstance(rest, sp.log) and rest != x:
            return
        if isinstance(rest, sp.log) and factor is None:
            factor = size
    if factor is None:
        return
    for term in node.args:
        size, rest = term.as_independent(x, as_Add=False)
        of = rest.args[0] if isinstance(rest, sp.log) else sp.exp(x)
        product *= of ** (size / factor)
    yield from _logarithm(factor, product, x)


def _of_difference(one: sp.Expr, other: sp.Expr, x: sp.Symbol) -> Iterator[tuple[Outer, sp.Expr]]:
    """Write the difference p - q of two terms as a function of a quotient."""
    signs = [part.could_extract_minus_sign() for part in (one, other)]
    if sum(signs) != 1:
        return
    p, q = (other, -one) if signs[0] else (one, -other)
    (size, a), (factor, b) = (part.as_independent(x, as_Add=False) for part in (p, q))
    if isinstance(a, sp.atan) and isinstance(b, sp.atan) and size == factor:
        a, b = a.args[0], b.args[0]
        if a.is_positive and b.is_positive:  # otherwise the difference may exceed pi/2
            yield lambda v: size * sp.atan(v), _quotient((a - b) / (1 + a * b), x)
        return
    for c, of, other in ((factor, b, p), (-size, a, -q)):
        if isinstance(of, sp.atan) and of.args[0].is_positive and 2 * other == sp.pi * c:
            yield _scaled(c, lambda v: sp.atan(1 / v)), of.args[0]
            return
    for sign, above, below in ((1, p, q), (-1, q, p)):
        ratio = above / below
        if isinstance(ratio, sp.exp):
            yield _scaled(sign * below, expm1), ratio.args[0]
        power = sp.gcd_list([part.as_base_exp()[1] for part in sp.Mul.make_args(ratio)])
        if power.is_Rational and power not in (0, 1):
            root = sp.Mul(*(_root(part, power) for part in sp.Mul.make_args(ratio)))
            yield _scaled(sign * below, _power_minus_one(power)), _quotient(root - 1, x)
            yield _scaled(sign * below, _exponential_minus_one(power)), _quotient(root, x)


def _power_minus_one(exponent: sp.Rational) -> Outer:
    """Return (1 + v)^exponent - 1 as a function of v."""
    return lambda v: expm1(exponent * log1p(v))


def _exponential_minus_one(exponent: sp.Rational) -> Outer:
    """Return v^exponent - 1 as a function of v."""
    return lambda v: expm1(exponent * sp.log(v))


def _root(part: sp.Expr, power: sp.Rational) -> sp.Expr:
    base, exponent = part.as_base_exp()
    return base ** (exponent / power)
