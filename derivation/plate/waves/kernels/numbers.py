"""Constants for the generated code of the waves."""

import sympy as sp

from derivation.engine.emit.modules import Numbers
from derivation.engine.emit.tables import Constant
from derivation.engine.rewrite.series import UNIT_ROUNDOFF
from derivation.plate.vocabulary import gam, xi_R
from derivation.plate.waves.theory.bending_branch import rayleigh

SHALLOW = sp.Rational(9, 4)
"""x below which F of A0 is a power series: S^2 = (p + q)^2 <= 4 x^2."""
SMALL = sp.Rational(19, 10)
"""x below which the fraction of A0 is computed as 1 minus a small difference."""
NEAR = 3
"""S below which F is a power series for any given kap."""
CLOSE = sp.Rational(1, 4)
"""p^2 below which differences of hyperbolic functions of p are power series."""
STEPS = 5
"""Newton steps from a starting error of 10 % to below rounding, for any x and nu (measured)."""
PLACES = (sp.Integer(0), sp.Rational(1, 4), sp.Rational(1, 2), sp.Rational(3, 4))
"""Range of gam, from nu = 1/2 to nu = -1."""
_MOST = 40


def numbers() -> Numbers:
    """Return limits of the methods, starting values of Newton's method, and coefficients of F."""
    factorials = tuple(sp.Rational(1, sp.factorial(2 * n + 3)) for n in range(terms(2 * SHALLOW)))
    return Numbers(
        "wave_numbers",
        "Constants of the waves: limits of the series, and their coefficients.",
        (
            Constant("SHALLOW", float(SHALLOW), "x below which F of A0 is a power series."),
            Constant("SMALL", float(SMALL), "x below which the fraction is 1 minus a difference."),
            Constant("NEAR", float(NEAR), "S below which F is a power series, for kap <= x^2."),
            Constant("CLOSE", float(CLOSE), "p^2 below which differences are power series."),
            Constant("STEPS", STEPS, "Newton steps from a starting error of 10 %."),
            Constant("RAYLEIGH", rayleigh_polynomial(), "Rayleigh's xi as a polynomial in gam."),
            Constant("FACTORIALS", factorials, "1/(2n + 3)!: coefficients of F in S^2 and d^2."),
        ),
    )


def terms(largest: sp.Rational) -> int:
    """Return the number of terms of F = sum h_n/(2n + 3)! for S up to a largest value.

    h_n = sum S^(2i) d^(2n-2i) <= (n + 1) S^(2n), all positive; the first is 1/6.
    """
    for count in range(2, _MOST):
        size = sp.Rational((count + 1) * largest ** (2 * count), sp.factorial(2 * count + 3))
        growth = (2 * count + 4) * (2 * count + 5)
        ratio = sp.Rational((count + 2) * largest**2, (count + 1) * growth)
        if ratio < 1 and 6 * size / (1 - ratio) < UNIT_ROUNDOFF / 4:
            return count
    raise ValueError(f"F needs more than {_MOST} terms up to S = {largest}")


def rayleigh_polynomial() -> tuple[float, ...]:
    """Return a cubic in gam through four of Rayleigh's xi: the start of Newton's method."""
    cubic = rayleigh()[0].expression
    places = [(place, _below_one(cubic.subs(gam, place))) for place in PLACES]
    polynomial = sp.Poly(sp.interpolate(places, gam), gam)
    return tuple(round(float(c), 4) for c in reversed(polynomial.all_coeffs()))


def _below_one(cubic: sp.Expr) -> sp.Rational:
    roots = (root for root in sp.Poly(cubic, xi_R).nroots() if root.is_real and 0 < root < 1)
    (root,) = (sp.Rational(root) for root in roots)
    return root
