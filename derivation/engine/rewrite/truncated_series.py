"""Truncated Taylor series of hyperbolic sums that cancel at 0, divided by their leading power.

All are even functions of the square of their variable, which may be known more accurately than the
variable. They are used up to END, where the scaling by exponentials of building blocks would reduce
the accuracy without benefit.
"""

from functools import cache
from itertools import accumulate

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
"""Name, the sum in y, and the power of y by which it is divided."""

_MOST = 60


@cache
def truncated_series() -> dict[str, Block]:
    """Return all truncated series by name."""
    return {name: _truncated(name, total, power) for name, total, power in DEFINITIONS}


def _truncated(name: str, total: sp.Expr, power: int) -> Block:
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
        f"series truncated at a relative error of {float(bound):.1e}",
    )


def _coefficients(total: sp.Expr, power: int) -> tuple[tuple[sp.Rational, ...], sp.Rational]:
    """Return Taylor coefficients in y^2, and a bound of the relative truncation error.

    For the bound, the coefficients must be positive, and the ratio of successive terms decreases.
    """
    # Repeated derivatives are faster than SymPy's series.
    slopes = accumulate(range(1, _MOST), lambda slope, _: slope.diff(y), initial=total)
    series = [slope.subs(y, 0) / sp.factorial(n) for n, slope in enumerate(slopes)]
    coefficients = series[power::2]
    sizes = [c * END ** (2 * k) for k, c in enumerate(coefficients)]
    for count in range(2, len(sizes) - 1):
        ratio = sizes[count + 1] / sizes[count]
        rest = sizes[count] / (1 - ratio) / sum(sizes[:count]) if 0 < ratio < 1 else sp.oo
        if rest < UNIT_ROUNDOFF / 4:
            return tuple(coefficients[:count]), rest
    raise ValueError(f"{total} needs more than {_MOST // 2} terms up to {END}")
