"""Taylor sections: hyperbolic sums that cancel at 0, over the power they vanish with, up to END.

All are even, and take the square of their variable: it may be known better than the variable.

Where a mode's fields are computed in bending and stretching, no argument is larger; the
exponentials that blocks are scaled by would cost accuracy there and gain nothing.
"""

from functools import cache

import sympy as sp

from derivation.engine.rewrite.form import Block
from derivation.engine.rewrite.series import POLYNOMIAL, UNIT_ROUNDOFF

y = sp.Symbol("y", real=True)
square = sp.Symbol("square", nonnegative=True)
END = sp.Rational(9, 4)

DEFINITIONS: tuple[tuple[str, sp.Expr, int], ...] = (
    ("cosh_square", sp.cosh(y) - 1, 2),
    ("sinh_cubic", sp.sinh(y) - y, 3),
    ("cosh_quartic", sp.cosh(y) - 1 - y**2 / 2, 4),
    ("sinh_quintic", sp.sinh(y) - y - y**3 / 6, 5),
    ("cosh_quintic", y * sp.cosh(y) - sp.sinh(y) - y**3 / 3, 5),
)
"""Name, the sum in y, and the power of y that it is divided by."""

_MOST = 60


@cache
def sections() -> dict[str, Block]:
    """Every section by name."""
    return {name: _section(name, total, power) for name, total, power in DEFINITIONS}


def _section(name: str, total: sp.Expr, power: int) -> Block:
    coefficients, bound = _coefficients(total, power)
    return Block(
        name,
        (square,),
        (total / y**power).subs(y, sp.sqrt(square)),
        0,
        0,
        (f"0 <= square <= {END**2}",),
        f"({sp.sstr(total)})/y^{power} of the square of y, {coefficients[0]} at y = 0.",
        (),
        POLYNOMIAL(square, *coefficients),
        f"series cut off at a relative error of {float(bound):.1e}",
    )


def _coefficients(total: sp.Expr, power: int) -> tuple[tuple[sp.Rational, ...], sp.Rational]:
    """Taylor's coefficients in y^2, and the relative error of leaving out all others.

    They are positive, so that the sum is at least the first of them, and each term is
    smaller than the one before by more than the last ratio.
    """
    series = sp.Poly(total.series(y, 0, _MOST).removeO(), y)
    found = [series.coeff_monomial(y ** (power + 2 * k)) for k in range((_MOST - power) // 2)]
    sizes = [c * END ** (2 * k) for k, c in enumerate(found)]
    for count in range(2, len(sizes) - 1):
        ratio = sizes[count + 1] / sizes[count]
        rest = sizes[count] / (1 - ratio) / sum(sizes[:count]) if 0 < ratio < 1 else sp.oo
        if rest < UNIT_ROUNDOFF / 4:
            return tuple(found[:count]), rest
    raise ValueError(f"{total} takes more terms than {_MOST // 2} up to {END}")
