"""The numbers that the generated code of the waves needs."""

import sympy as sp

from derivation.engine.emit.package import Numbers
from derivation.engine.emit.tables import Constant
from derivation.engine.rewrite.series import UNIT_ROUNDOFF
from derivation.plate.vocabulary import gam, xi_R
from derivation.plate.waves.theory.bending_branch import rayleigh

SHALLOW = sp.Rational(9, 4)
"""x up to which F of A0 is a power series: S^2 = (p + q)^2 <= 4 x^2."""
SMALL = sp.Rational(19, 10)
"""x up to which the share of A0 is 1 less what it lacks; beyond that is not small."""
NEAR = 3
"""S up to which F is a power series where kap is given."""
CLOSE = sp.Rational(1, 4)
"""p^2 up to which differences of hyperbolic functions of p are power series."""
STEPS = 5
"""Newton's: from a start right to 10 % to below a rounding, for any x and nu (measured)."""
PLACES = (sp.Integer(0), sp.Rational(1, 4), sp.Rational(1, 2), sp.Rational(3, 4))
"""gam from nu = 1/2 to nu = -1."""
_MOST = 40


def numbers() -> Numbers:
    """Where each way to compute ends, where Newton's method begins, and F's coefficients."""
    factorials = tuple(sp.Rational(1, sp.factorial(2 * n + 3)) for n in range(terms(2 * SHALLOW)))
    return Numbers(
        "wave_numbers",
        "Numbers of the waves: limits of the series, and their coefficients.",
        (
            Constant("SHALLOW", float(SHALLOW), "x up to which F of A0 is a power series."),
            Constant("SMALL", float(SMALL), "x up to which the share is 1 less what A0 lacks."),
            Constant("NEAR", float(NEAR), "S up to which F is a power series for any kap <= x^2."),
            Constant("CLOSE", float(CLOSE), "p^2 up to which differences are power series."),
            Constant("STEPS", STEPS, "Steps of Newton's method, from a start right to a tenth."),
            Constant("RAYLEIGH", rayleigh_polynomial(), "Rayleigh's xi as a polynomial in gam."),
            Constant("FACTORIALS", factorials, "1/(2n + 3)!: of F in powers of S^2 and d^2."),
        ),
    )


def terms(largest: sp.Rational) -> int:
    """How many terms of F = sum h_n/(2n + 3)! serve for S up to a largest one.

    h_n = sum S^(2i) d^(2n-2i) <= (n + 1) S^(2n), all positive; the first is 1/6.
    """
    for count in range(2, _MOST):
        size = sp.Rational((count + 1) * largest ** (2 * count), sp.factorial(2 * count + 3))
        growth = (2 * count + 4) * (2 * count + 5)
        ratio = sp.Rational((count + 2) * largest**2, (count + 1) * growth)
        if ratio < 1 and 6 * size / (1 - ratio) < UNIT_ROUNDOFF / 4:
            return count
    raise ValueError(f"F takes more than {_MOST} terms up to S = {largest}")


def rayleigh_polynomial() -> tuple[float, ...]:
    """A cubic in gam through four of Rayleigh's xi: where Newton's method begins."""
    cubic = rayleigh()[0].expression
    places = [(place, _below_one(cubic.subs(gam, place))) for place in PLACES]
    polynomial = sp.Poly(sp.interpolate(places, gam), gam)
    return tuple(round(float(c), 4) for c in reversed(polynomial.all_coeffs()))


def _below_one(cubic: sp.Expr) -> sp.Rational:
    roots = (root for root in sp.Poly(cubic, xi_R).nroots() if root.is_real and 0 < root < 1)
    (root,) = (sp.Rational(root) for root in roots)
    return root
