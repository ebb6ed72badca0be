"""Formulas that depend on a power of their variable: f(x) = x^p g(u), where u = c x^r.

The exponents of x in a formula are multiples of r, apart from a power of x in front of it. If the
arguments of all functions contain the same constant, such as pi, it is c.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class OfPower:
    """A formula f(x) = x^power g(u).

    Parameters
    ----------
    expression, variable
        g, and the symbol u.
    argument
        u as an expression in x.
    power
        The exponent of x, of smaller magnitude than the one in u.
    """

    expression: sp.Expr
    variable: sp.Symbol
    argument: sp.Expr
    power: sp.Expr


Exponents = tuple[sp.Expr, frozenset[sp.Expr]]
"""The power of x in front of an expression, and the exponents in the rest."""


def powers(expression: sp.Expr, x: sp.Symbol) -> Iterator[OfPower]:
    """Yield the formula as a function of c x^r and of c x^-r, other than x itself.

    The power whose sign occurs more often comes first, the other one only if its sign occurs.
    """
    front, exponents = _exponents(expression, x)
    steps = exponents - {sp.Integer(0)}
    if not steps or not all(step.is_Rational for step in steps):
        return
    least = sp.gcd_list([abs(step) for step in steps])
    constant = _constant(expression, x, least)
    for sign in sorted((1, -1), key=lambda sign: -sum((step * sign).is_positive for step in steps)):
        rate = sign * least
        if (rate, constant) != (1, 1) and any((step * sign).is_positive for step in steps):
            symbol = sp.Symbol(f"power_of_{x}", positive=True)
            unit = symbol / constant  # x^rate
            whole = sp.Integer(int(front / rate))  # rounded towards 0
            value = unit**whole * _core(expression, x, unit ** (1 / rate))
            yield OfPower(value, symbol, constant * x**rate, front - whole * rate)


def _exponents(node: sp.Expr, x: sp.Symbol) -> Exponents:
    if not node.has(x):
        return sp.Integer(0), frozenset()
    if node == x:
        return sp.Integer(1), frozenset()
    parts = [_exponents(part, x) for part in node.args]
    inner = frozenset[sp.Expr]().union(*(exponents for _, exponents in parts))
    if node.is_Mul:
        return sp.Add(*(power for power, _ in parts)), inner
    if node.is_Pow and node.exp.is_Rational:
        return parts[0][0] * node.exp, inner
    if node.is_Add:
        first = _first([power for power, _ in parts])
        return first, inner | {power - first for power, _ in parts}
    return sp.Integer(0), inner | {power for power, _ in parts}


def _first(fronts: list[sp.Expr]) -> sp.Expr:
    """Return the power that is factored out of a sum: none if one of its terms has none."""
    return sp.Integer(0) if 0 in fronts else fronts[0]


def _core(node: sp.Expr, x: sp.Symbol, root: sp.Expr) -> sp.Expr:
    """Return an expression without the power of x in front of it, with x replaced by `root`."""
    if node == x:
        return sp.Integer(1)
    if node.is_Mul:
        return sp.Mul(*(_core(part, x, root) for part in node.args))
    if node.is_Pow and node.exp.is_Rational:
        return _core(node.base, x, root) ** node.exp
    if node.is_Add:
        fronts = [_exponents(part, x)[0] for part in node.args]
        first = _first(fronts)
        return sp.Add(
            *(
                _core(part, x, root) * root ** (front - first)
                for part, front in zip(node.args, fronts, strict=True)
            )
        )
    return node.xreplace({x: root})


def _constant(expression: sp.Expr, x: sp.Symbol, least: sp.Rational) -> sp.Expr:
    """Return the positive irrational factor that all functions have in front of x^(+-least)."""
    factors = set()
    for function in expression.atoms(sp.Function):
        factor, rest = function.args[-1].as_independent(x, as_Add=False)
        if rest.has(x) and rest in (x**least, x**-least):
            factors.add(abs(factor.as_content_primitive()[1]))
    return factors.pop() if len(factors) == 1 else sp.Integer(1)
