"""Products and roots of factors, for generated code and for proofs.

Intermediate values may leave the range of doubles: `root_factors` returns a root as three factors,
and `product` multiplies as if only the result were rounded.
"""

import sympy as sp

from derivation.engine.emit.routine import Let, Several
from derivation.plate.vocabulary import lam, mu

PRODUCT = sp.Function("product")
"""The product of a tuple of factors, divided by that of a second one."""
_first, _second, _scale = sp.symbols("first second scale", positive=True)
_modulus_ratio = sp.Symbol("modulus_ratio", positive=True)
MODERATE = (
    Several((_first, _second), "moderate", (lam, mu), (lam / _scale, mu / _scale)),
    Let(_modulus_ratio, (_first + _second) / (_first + 2 * _second)),
)
"""Statements that YOUNG needs: the Lame constants divided by a power of two."""
YOUNG = 4, mu, _modulus_ratio
"""E* as factors."""


def root(name: str, degree: int, factors: tuple[sp.Expr, ...], *below: sp.Expr) -> Several:
    """Return the three factors of a root."""
    parts = sp.symbols(f"{name}_0 {name}_1 {name}_2", positive=True)
    whole = (sp.Mul(*factors) / sp.Mul(*below)) ** sp.Rational(1, degree)
    given = (sp.Integer(degree), sp.Tuple(*factors), *([sp.Tuple(*below)] if below else []))
    return Several(parts, "root_factors", given, (whole / (parts[1] * parts[2]), *parts[1:]))


def multiplied(expression: sp.Expr) -> sp.Expr:
    """Return the logarithm of the quotient of two products, which is zero if they are equal."""
    product = expression.replace(
        PRODUCT, lambda above, *below: sp.Mul(*above) / sp.Mul(*(x for row in below for x in row))
    )
    first, second = sp.Add.make_args(product)
    quotient = sp.log(-first / second)
    return sp.expand(sp.expand_log(quotient.replace(sp.Add, _one_fraction), force=True))


def _one_fraction(*terms: sp.Expr) -> sp.Expr:
    return sp.factor(sp.Add(*terms))
