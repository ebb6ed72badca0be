"""Constants of the effects: series of spherical profile and finite radius, bounds.

With t = (a/R)^2 and L = (artanh sqrt(t) - sqrt(t))/t^(3/2) = 1/3 + t/5 + t^2/7 + ... the
contact of step 21, relative to Hertz's at equal contact radius, is

    delta = 1 + t L,    P = (3/4) (1 + (1 + t) L),    S = (1 + t L + 1/(1 - t))/2.

The finite radius contributes W = -(8/pi^2) sum kappa_(2k-4) (2k-2)/(2k-1)! alpha^(2k-3) to delta;
its power n contributes 1 + n/2 times as much to S.
"""

from fractions import Fraction

import flint
import sympy as sp
from flint import arb as Ball

from derivation.engine.emit.modules import Numbers
from derivation.engine.emit.tables import Constant
from derivation.engine.formula.ball import enclose
from derivation.mathematics.bessel.kernels import nearest_double
from derivation.plate.contact.kernels.moments import BITS, kappas
from derivation.plate.contact.theory.plate_series import sine_coefficient
from derivation.plate.contact.theory.split import zero_of_j0
from derivation.plate.effects.theory import lateral_growth_ball
from derivation.plate.impact.kernels.simple import above
from derivation.plate.impact.theory.substitution import lateral_rest_ball
from derivation.plate.pressure.theory.bound import ABOVE, BELOW, EITHER, LATERAL_EXTRA
from derivation.plate.vocabulary import j_n, lam, mu
from derivation.plate.waves.theory.plate_motion import plate_motion

NEAR = Fraction(1, 4)
"""t below which L is a sum; above, its closed form is accurate to 4 roundings."""
NEGLIGIBLE = 2.0**-56
_a, _n = sp.symbols("a n", positive=True)
_STEEPER = sp.simplify(sp.diff(_a ** (_n + 2), _a) / (2 * _a ** (_n + 1)))
"""S divided by F for one power n: (R/2a) d delta/da of delta = a^2 F/R."""


def effect_numbers() -> Numbers:
    """Return the series, bounds for the finite radius, and factors of the inertia formulas."""
    with flint.ctx.workprec(BITS):
        depth, slope = lateral_rows()
        lateral_linear = above(Ball(3) / 2 * depth[0])
        rows = tuple(tuple(nearest_double(c) for c in row) for row in (depth, slope))
        factors = tuple(_factor_double(name) for name in ("zener_number", "bending_period"))
    return Numbers(
        "effect_numbers",
        "Constants of the effects: power series, bounds for the finite radius, factors.",
        (
            Constant(
                "LATERAL_DEPTH", rows[0], "-F/alpha of the finite radius in powers of alpha^2."
            ),
            Constant(
                "LATERAL_SLOPE", rows[1], "-S/alpha of the finite radius in powers of alpha^2."
            ),
            Constant("ZENER", factors[0], "Factor of Zener's parameter."),
            Constant("PERIOD", factors[1], "Factor of the bending period."),
            Constant(
                "LATERAL_LINEAR",
                lateral_linear,
                "Largest reduction of S by the finite radius: LATERAL_LINEAR alpha + "
                "LATERAL_CUBIC alpha^3.",
            ),
            Constant("LATERAL_CUBIC", above(lateral_rest_ball()), "See LATERAL_LINEAR."),
            Constant(
                "PRESSURE_LATERAL",
                float(LATERAL_EXTRA),
                "Contribution of the finite radius to theta/(a/b)^3, in the bound for Hertz "
                "pressure.",
            ),
            *(
                Constant(f"PRESSURE_{name}", float(x), text)
                for name, x, text in (
                    ("BELOW", BELOW, "Largest decrease of S by non-Hertzian pressure over theta."),
                    ("ABOVE", ABOVE, "Largest increase of S by non-Hertzian pressure over theta."),
                    ("EITHER", EITHER, "Both, where the kernel may have either sign."),
                )
            ),
            Constant(
                "LATERAL_GROWTH",
                above(lateral_growth_ball()),
                "If a grows to s a < b, S changes by at most "
                "(s^2 - 1) (K A^3 + LATERAL_GROWTH alpha^3).",
            ),
        ),
    )


def factor(name: str) -> sp.Expr:
    """Return the constant factor of a formula of step 23.

    E* is 1 for lam = 0 and mu = 1/2; j_1 of the first mode belongs to the factor.
    """
    formula = {f.name: f for f in plate_motion()}[name]
    ones = {x.symbol: 1 for x in formula.arguments if x.symbol != j_n}
    return formula.expression.subs(ones | {lam: 0, mu: sp.Rational(1, 2)})


def _factor_double(name: str) -> float:
    return nearest_double(enclose(factor(name), {j_n: zero_of_j0(1, BITS)}))


def arc_coefficients() -> list[sp.Rational]:
    """Return 1/3, 1/5, ... as far as they are not negligible compared with 1/3 at t = NEAR."""
    coefficients: list[sp.Rational] = []
    while True:
        k = len(coefficients)
        if NEAR**k / (2 * k + 3) / (1 - NEAR) < Fraction(NEGLIGIBLE) / 3:
            return coefficients
        coefficients.append(sp.Rational(1, 2 * k + 3))


def lateral_rows() -> tuple[list[Ball], list[Ball]]:
    """Return the coefficients of -W/alpha and of -S/alpha in alpha^2 that are not negligible.

    At alpha = 1 the ratio of neighbours is 1/4 at most, so that all omitted terms are below a third
    of the last one.
    """
    depth: list[Ball] = []
    slope: list[Ball] = []
    for index, kappa in enumerate(kappas()[::2]):
        k = index + 2
        depth.append(8 * kappa * enclose(abs(sine_coefficient(k)), {}) / Ball.pi() ** 2)
        slope.append(depth[-1] * enclose(_STEEPER.subs(_n, 2 * k - 3), {}))
        if float(slope[-1] / slope[0]) < NEGLIGIBLE:
            return depth, slope
    raise ArithmeticError("the series of the finite radius needs more moments kappa_n")
