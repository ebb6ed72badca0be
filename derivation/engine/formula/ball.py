"""Exact expression -> Arb ball: rigorous evaluation, the precision raised until it suffices."""

from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import cache

import flint
import sympy as sp
from sympy.codegen.cfunctions import expm1, log1p

Exact = int | float | Fraction
"""A number taken as it is: a double stands for the binary fraction it holds."""

LOG2_10 = 3.3219280948873626
MAX_BITS = 1 << 16
SPARE_BITS = 24


class PrecisionError(ArithmeticError):
    """A ball did not become small enough: the value is zero, singular or out of reach."""


_FUNCTIONS: dict[type[sp.Basic], Callable[[flint.arb], flint.arb]] = {
    sp.sin: lambda x: x.sin(),
    sp.cos: lambda x: x.cos(),
    sp.tan: lambda x: x.tan(),
    sp.sinh: lambda x: x.sinh(),
    sp.cosh: lambda x: x.cosh(),
    sp.tanh: lambda x: x.tanh(),
    sp.coth: lambda x: x.coth(),
    sp.log: lambda x: x.log(),
    log1p: lambda x: x.log1p(),
    expm1: lambda x: x.expm1(),
    sp.exp: lambda x: x.exp(),
    sp.asin: lambda x: x.asin(),
    sp.Abs: abs,
    sp.gamma: lambda x: x.gamma(),
}


def to_ball(number: Exact) -> flint.arb:
    """Ball around an exact number at the current precision (a point for a double)."""
    if isinstance(number, int | float):
        return flint.arb(number)
    numerator, denominator = number.as_integer_ratio()
    return flint.arb(flint.fmpq(int(numerator), int(denominator)))


def enclose(expression: sp.Basic, values: Mapping[sp.Basic, flint.arb]) -> flint.arb:
    """Ball that contains the expression's value, at the precision now set.

    Raises
    ------
    NotImplementedError
        For a SymPy function without a rigorous counterpart.
    """
    memo: dict[sp.Basic, flint.arb] = dict(values)

    def visit(node: sp.Basic) -> flint.arb:
        if node not in memo:
            memo[node] = _node(node, visit)
        return memo[node]

    return visit(expression)


@cache
def enclosable(expression: sp.Basic) -> bool:
    """Whether `enclose` knows every function in the expression."""
    with flint.ctx.workprec(32):
        try:
            enclose(expression, {symbol: flint.arb(0.5) for symbol in expression.free_symbols})
        except NotImplementedError:
            return False
    return True


def _node(node: sp.Basic, visit: Callable[[sp.Basic], flint.arb]) -> flint.arb:
    if isinstance(node, sp.Rational):
        return flint.arb(flint.fmpq(int(node.p), int(node.q)))
    if node is sp.pi:
        return flint.arb.pi()
    if node is sp.E:
        return flint.arb.const_e()
    if node is sp.EulerGamma:
        return flint.arb.const_euler()
    if isinstance(node, sp.Add):
        return sum((visit(term) for term in node.args), flint.arb(0))
    if isinstance(node, sp.Mul):
        product = flint.arb(1)
        for factor in node.args:
            product *= visit(factor)
        return product
    if isinstance(node, sp.Pow):
        return _power(visit(node.base), node.exp, visit)
    if isinstance(node, sp.besselj):
        return visit(node.args[1]).bessel_j(visit(node.args[0]))
    if isinstance(node, sp.besseli):
        return visit(node.args[1]).bessel_i(visit(node.args[0]))
    if isinstance(node, sp.beta):
        x, y = (visit(argument) for argument in node.args)
        return x.gamma() * y.gamma() / (x + y).gamma()
    if node.func in _FUNCTIONS:
        return _FUNCTIONS[node.func](visit(node.args[0]))
    raise NotImplementedError(f"no ball arithmetic for {node.func.__name__} in {node}")


def _power(
    base: flint.arb, exponent: sp.Basic, visit: Callable[[sp.Basic], flint.arb]
) -> flint.arb:
    if isinstance(exponent, sp.Integer):
        return base ** int(exponent)
    if exponent == sp.Rational(1, 2):
        return base.sqrt()
    return base ** visit(exponent)


def evaluate(
    expression: sp.Basic, values: Mapping[sp.Symbol, Exact], digits: int = 50
) -> flint.arb:
    """Ball around the value of an expression, its relative radius below 10^-digits.

    Parameters
    ----------
    expression
        Exact SymPy expression.
    values
        Exact numbers for its free symbols; doubles are taken as the binary
        fractions they are.
    digits
        Decimal digits the ball's radius must warrant.

    Raises
    ------
    PrecisionError
        If 65536 bits do not suffice, which for these formulas means a value
        that is exactly zero or a singular point.
    """
    return refine(
        lambda: enclose(expression, {key: to_ball(value) for key, value in values.items()}),
        digits,
        expression,
    )


def refine(
    compute: Callable[[], flint.arb], digits: int, what: object, most: int = MAX_BITS
) -> flint.arb:
    """Repeat `compute` at doubled precision, up to `most` bits, until its ball is small enough.

    An exact zero (a point ball) is accepted as it is.
    """
    target = int(digits * LOG2_10) + 1
    bits = target + SPARE_BITS
    while bits <= most:
        with flint.ctx.workprec(bits):
            ball = compute()
        if ball.is_finite() and (ball.is_exact() or ball.rel_accuracy_bits() >= target):
            return ball
        bits *= 2
    raise PrecisionError(f"no {digits} digits of {what!s:.200} within {most} bits")
