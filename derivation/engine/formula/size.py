"""Upper estimates of the size of an expression before anything is expanded."""

import math

import sympy as sp

MANY = 16_000_000
"""Value at which estimates stop increasing."""
_MOST_FACTORS = 1000


def terms_when_expanded(expression: sp.Expr) -> int:
    """Return an upper estimate of the number of terms in an expansion over a common denominator."""
    return _terms(expression, {})


def _terms(expression: sp.Expr, memo: dict[sp.Basic, int]) -> int:
    if expression not in memo:
        memo[expression] = _estimate(expression, memo)
    return memo[expression]


def _estimate(expression: sp.Expr, memo: dict[sp.Basic, int]) -> int:
    if isinstance(expression, sp.Add):
        return _estimate_sum(expression, memo)
    if isinstance(expression, sp.Mul):
        product = 1
        for factor in expression.args:
            product = min(product * _terms(factor, memo), MANY)
        return product
    if isinstance(expression, sp.Pow) and isinstance(expression.exp, sp.Integer):
        base, factors = _terms(expression.base, memo), min(abs(int(expression.exp)), _MOST_FACTORS)
        return min(math.comb(base + factors - 1, factors), MANY)
    return 2 if isinstance(expression, sp.sinh | sp.cosh | sp.tanh | sp.coth) else 1


def _estimate_sum(expression: sp.Add, memo: dict[sp.Basic, int]) -> int:
    """Return the estimate for a sum: every numerator is multiplied by the other denominators."""
    total = 0
    below: set[sp.Expr] = set()
    for term in expression.args:
        above, under = sp.fraction(term)
        total += _terms(above, memo)
        below.update(f for f in sp.Mul.make_args(under) if not f.is_number)
    product = 1
    for factor in below:
        product = min(product * _terms(factor, memo), MANY)
    return min(total * product, MANY)


def degree(expression: sp.Basic, memo: dict[sp.Basic, float]) -> float:
    """Return the largest product of nested exponents, functions of powers included.

    Parameters
    ----------
    expression
        The expression; the degree of ``((x + 1)**9 + 1)**9`` is 81.
    memo
        Degrees of known expressions, to which new ones are added.
    """
    if expression not in memo:
        inner = [degree(argument, memo) for argument in expression.args]
        if isinstance(expression, sp.Pow) and expression.exp.is_Rational:
            memo[expression] = inner[0] * max(1.0, abs(float(expression.exp)))
        elif isinstance(expression, sp.Mul):
            memo[expression] = max(1.0, sum(d for d in inner if d > 1.0)) if inner else 1.0
        else:
            memo[expression] = max(inner, default=1.0)
    return memo[expression]
