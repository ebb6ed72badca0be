"""Conversion between exponentials and hyperbolic functions."""

import sympy as sp


def in_exponentials(expression: sp.Expr) -> sp.Expr:
    """Return the expression with exponentials instead of hyperbolic functions."""
    return expression.rewrite((sp.sinh, sp.cosh, sp.tanh, sp.coth), sp.exp)


def to_hyperbolic(expression: sp.Expr, x: sp.Expr) -> sp.Expr:
    """Rewrite a rational function of e^x as factors made of sinh(n x) and cosh(n x).

    Each irreducible factor is a polynomial in Q = e^(2x). Pairing its coefficients from both ends
    gives hyperbolic functions times a power of e^x; these powers cancel in the whole expression.

    Raises
    ------
    ValueError
        If a factor contains odd and even powers of e^x, or some remain.
    """
    E, Q = sp.Symbol("E", positive=True), sp.Symbol("Q", positive=True)
    rational = expression.rewrite((sp.sinh, sp.cosh), sp.exp).replace(
        sp.exp, lambda argument: E ** sp.cancel(argument / x)
    )
    constant, result, exponent = sp.Integer(1), sp.Integer(1), 0
    for part, sign in zip(sp.fraction(sp.cancel(rational)), (1, -1), strict=True):
        odd, polynomial = _in_squares(part, E, Q)
        content, factors = sp.factor_list(polynomial)
        constant *= content**sign
        exponent += sign * odd
        for factor, power in factors:
            number, hyperbolic, shift = _pair(factor, Q, x)
            constant *= number ** (sign * power)
            result *= hyperbolic ** (sign * power)
            exponent += sign * power * shift
    if exponent != 0:
        raise ValueError(f"a factor exp({exponent}*{x}) remains of {expression}")
    return constant * result


def _in_squares(polynomial: sp.Expr, E: sp.Symbol, Q: sp.Symbol) -> tuple[int, sp.Expr]:
    """Return the odd power of E (0 or 1), and the polynomial divided by it in Q = E^2."""
    terms = sp.Poly(polynomial, E).terms()
    odd = int(terms[0][0][0]) % 2
    if any((power - odd) % 2 for (power,), _ in terms):
        raise ValueError(f"odd and even powers of {E} are mixed in {polynomial}")
    return odd, sp.Add(*(c * Q ** ((power - odd) // 2) for (power,), c in terms))


def _pair(factor: sp.Expr, Q: sp.Symbol, x: sp.Expr) -> tuple[sp.Expr, sp.Expr, int]:
    """Return a factor as a number times hyperbolic functions, and the power of e^x removed."""
    if factor == Q:
        return sp.Integer(1), sp.Integer(1), 2
    coefficients = sp.Poly(factor, Q).all_coeffs()
    degree = len(coefficients) - 1
    terms = []
    for k, (high, low) in enumerate(zip(coefficients, reversed(coefficients), strict=True)):
        n = degree - 2 * k
        if n > 0:
            terms.append(sp.factor(high + low) * sp.cosh(n * x))
            terms.append(sp.factor(high - low) * sp.sinh(n * x))
        elif n == 0:
            terms.append(sp.factor(high))
    number, total = sp.Add(*terms).as_content_primitive()
    leading = next(term for term in terms if term != 0)
    if leading.could_extract_minus_sign():
        number, total = -number, sp.expand_mul(-total, deep=False)
    return number, total, degree
