"""Contact law and contact force as the code computes them, proved equal to those of the theory.

With F the correction of the contact law and A = a/h::

    delta = (a^2/R) (1 + F(A)),   P = C a^3/R

In the code F, A F'(A) and C over mu are `F`, `slope` and `modulus`.
"""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Facts, Let, Several
from derivation.engine.formula.functions import unspecified_function
from derivation.engine.rewrite.form import TIMES
from derivation.plate.contact.theory.hertz import contact_radius, pressure
from derivation.plate.contact.theory.split import contact_split
from derivation.plate.vocabulary import P, R, a, delta, eps, h, lam, mu, r

F, S, slope, rise, radius_ratio, indentation_ratio = sp.symbols(
    "F S slope rise radius_ratio indentation_ratio", positive=True
)
modulus, first, second, scale, A, inverse_R = sp.symbols(
    "modulus first second scale A inverse_R", positive=True
)
square, ratio, radius, residual, exponent, flat = sp.symbols(
    "square ratio radius residual exponent flat", positive=True
)


CorrectionCurve = unspecified_function("CorrectionCurve")
"""F'' as a function of A."""
CorrectionSlopeByThickness = unspecified_function("CorrectionSlopeByThickness")
"""Derivative of F' with respect to log(h/b)."""
CorrectionByThickness = unspecified_function("CorrectionByThickness", CorrectionSlopeByThickness)
"""Derivative of F with respect to log(h/b) at fixed A."""
CorrectionSlope = unspecified_function(
    "CorrectionSlope", CorrectionCurve, CorrectionSlopeByThickness
)
"""F' as a function of A."""
Correction = unspecified_function("Correction", CorrectionSlope, CorrectionByThickness)
"""F as a function of A = a/h and log(h/b)."""
log_eta = sp.Symbol("log_eta", real=True)
CORRECTION = Correction(a / h, log_eta)
FORCE = contact_radius().expression
"""P as a function of the contact radius."""
DEPTH = contact_split()[0].expression * (1 + CORRECTION)
"""Indentation as a function of the contact radius."""
MODULUS = FORCE * R / a**3 / mu
"""(4/3) E* over mu."""
LAW: Facts = {
    modulus: MODULUS,
    F: CORRECTION,
    slope: a * sp.diff(CORRECTION, a),
    rise: R / a * sp.diff(DEPTH, a),
    radius_ratio: a / sp.sqrt(R * DEPTH),
    delta: DEPTH,
    A: a / h,
    inverse_R: 1 / R,
}
"""Meaning of the arguments."""


def reduce(expression: sp.Expr) -> sp.Expr:
    """Simplify an expression; products written with `TIMES` are multiplied out first."""
    return sp.simplify(sp.powdenest(without_scaling(expression), force=True))


def without_scaling(expression: sp.Expr) -> sp.Expr:
    """Return the expression with range-safe products replaced by plain ones."""

    def product(first: sp.Expr, *powers: sp.Expr) -> sp.Expr:
        pairs = zip(powers[::2], powers[1::2], strict=True)
        return first * sp.Mul(*(base**power for base, power in pairs))

    return expression.replace(TIMES, product)


def root(
    symbol: sp.Symbol, degree: int, factors: tuple[sp.Expr, ...], *divisors: sp.Expr
) -> Several:
    """Return ``symbol = root(degree, factors, divisors)``, which stays in the range of doubles."""
    exact = (sp.Mul(*factors) / sp.Mul(*divisors)) ** sp.Rational(1, degree)
    below = (sp.Tuple(*divisors),) if divisors else ()
    return Several((symbol,), "root", (sp.Integer(degree), sp.Tuple(*factors), *below), (exact,))


@named_routine
def modulus_over_mu() -> Claims:
    """Return (4/3) E* over mu; `first` and `second` are lam and mu over any common factor."""
    return Claims(
        (first, second),
        (),
        (MODULUS.subs({lam: first, mu: second}),),
        (MODULUS,),
        {first: lam / scale, second: mu / scale},
        sp.cancel,
    )


@named_routine
def hertz_force() -> Claims:
    """Return P, the contact force."""
    return Claims(
        (a, R, mu, modulus), (), (TIMES(modulus, mu, 1, a, 3, R, -1),), (FORCE,), LAW, reduce
    )


@named_routine
def hertz_radius() -> Claims:
    """Return a, the contact radius."""
    return Claims(
        (P, R, mu, modulus),
        (root(radius, 3, (P, R), mu, modulus),),
        (radius,),
        (a,),
        {**LAW, P: FORCE},
        reduce,
    )


@named_routine
def largest_pressure() -> Claims:
    """Return p_0, the largest contact pressure."""
    return Claims(
        (a, R, mu, modulus),
        (),
        (TIMES(3 * modulus / (2 * sp.pi), mu, 1, a, 1, R, -1),),
        (-pressure().expression.subs({r: 0, P: FORCE}),),
        LAW,
        reduce,
    )


@named_routine
def indentation_of() -> Claims:
    """Return delta, the indentation, for any lengths."""
    return Claims(
        (a, R, F),
        (Let(indentation_ratio, 1 + F),),
        (TIMES(indentation_ratio, a, 2, R, -1),),
        (DEPTH,),
        LAW,
        reduce,
    )


@named_routine
def indentation_in_range() -> Claims:
    """Return delta for lengths whose products neither overflow nor underflow."""
    return Claims(
        (a, inverse_R, F),
        (Let(indentation_ratio, 1 + F), Let(flat, inverse_R * a)),
        (indentation_ratio * a * flat,),
        (DEPTH,),
        LAW,
        reduce,
    )


@named_routine
def depth_coefficients() -> Claims:
    """Return the factor of a^2 in the indentation, and that of a^3 from the factor of A in F."""
    hertz = DEPTH.subs(CORRECTION, 0)
    return Claims(
        (S, R, h),
        (Let(inverse_R, 1 / R),),
        (inverse_R, S * inverse_R / h),
        (hertz / a**2, (DEPTH - hertz) / a**3),
        {S: CORRECTION * h / a},
        reduce,
    )


@named_routine
def relative_rise() -> Claims:
    """Return (R/a) d delta/da."""
    return Claims(
        (F, slope),
        (Let(indentation_ratio, 1 + F),),
        (2 * indentation_ratio + slope,),
        (R / a * sp.diff(DEPTH, a),),
        LAW,
        reduce,
    )


@named_routine
def slope_of_indentation() -> Claims:
    """Return d delta/da."""
    return Claims(
        (a, R, F, slope),
        (
            Let(ratio, a / R),
            Let(indentation_ratio, 1 + F),
            Let(rise, 2 * indentation_ratio + slope),
        ),
        (ratio * rise,),
        (sp.diff(DEPTH, a),),
        LAW,
        reduce,
    )


@named_routine
def contact_stiffness() -> Claims:
    """Return dP/d delta, the contact stiffness; `rise` is (R/a) d delta/da."""
    return Claims(
        (a, rise, mu, modulus),
        (),
        (TIMES(3 * modulus, mu, 1, a, 1, rise, -1),),
        (sp.diff(FORCE, a) / sp.diff(DEPTH, a),),
        LAW,
        reduce,
    )


@named_routine
def depth_ratio() -> Claims:
    """Return sqrt(R delta)/h, Hertz's contact radius over h."""
    return Claims(
        (delta, R, h),
        (root(radius, 2, (delta, R), h, h),),
        (radius,),
        (sp.sqrt(R * DEPTH) / h,),
        LAW,
        reduce,
    )


@named_routine
def depth_ratio_at() -> Claims:
    """Return sqrt(R delta)/h in terms of A and F."""
    return Claims(
        (A, F),
        (Let(indentation_ratio, 1 + F),),
        (A * sp.sqrt(indentation_ratio),),
        (sp.sqrt(R * DEPTH) / h,),
        LAW,
        reduce,
    )


@named_routine
def radius_of_ratio() -> Claims:
    """Return a from its ratio to Hertz's radius sqrt(R delta)."""
    return Claims(
        (radius_ratio, delta, R),
        (root(radius, 2, (delta, R)),),
        (radius_ratio * radius,),
        (a,),
        LAW,
        reduce,
    )


@named_routine
def force_of_ratio() -> Claims:
    """Return P from delta, a and a/sqrt(R delta), because a^3 would triple the error of a."""
    return Claims(
        (radius_ratio, delta, a, mu, modulus),
        (),
        (TIMES(modulus, mu, 1, radius_ratio, 2, delta, 1, a, 1),),
        (FORCE,),
        LAW,
        reduce,
    )


@named_routine
def depth_ratio_in_range() -> Claims:
    """Return sqrt(R delta)/h for lengths whose products neither overflow nor underflow."""
    return Claims(
        (delta, R, h), (), (sp.sqrt(R * delta) / h,), (sp.sqrt(R * DEPTH) / h,), LAW, reduce
    )


@named_routine
def radius_in_range() -> Claims:
    """Return a from its ratio to Hertz's radius, for products without overflow or underflow."""
    return Claims(
        (radius_ratio, delta, R), (), (radius_ratio * sp.sqrt(R * delta),), (a,), LAW, reduce
    )


@named_routine
def force_in_range() -> Claims:
    """Return P from delta, a and a over Hertz's radius, if no product over- or underflows."""
    return Claims(
        (radius_ratio, delta, a, mu, modulus),
        (),
        (mu * modulus * radius_ratio**2 * delta * a,),
        (FORCE,),
        LAW,
        reduce,
    )


@named_routine
def stiffness_in_range() -> Claims:
    """Return dP/d delta if products neither overflow nor underflow; `rise` is (R/a) d delta/da."""
    return Claims(
        (a, rise, mu, modulus),
        (),
        (3 * mu * modulus * a / rise,),
        (sp.diff(FORCE, a) / sp.diff(DEPTH, a),),
        LAW,
        reduce,
    )


@named_routine
def newton_step() -> Claims:
    """Return R delta/h^2 over its value at A, minus 1, and the relative increase of A."""
    goal = (h * eps) ** 2 / (R * DEPTH) - 1
    power = 1 / (a * sp.diff(sp.log(R * DEPTH), a))
    step = sp.series((1 + residual) ** exponent - 1, residual, 0, 3).removeO()
    bend = residual * (exponent / 2 - sp.Rational(1, 2))
    return Claims(
        (radius_ratio, F, slope),
        (
            Let(indentation_ratio, 1 + F),
            Let(square, radius_ratio**2),
            Let(residual, (1 / square - indentation_ratio) / indentation_ratio),
            Let(exponent, indentation_ratio / (2 * indentation_ratio + slope)),
        ),
        (residual, exponent * residual * (1 + bend)),
        (goal, step.subs({residual: goal, exponent: power})),
        {radius_ratio: a / (h * eps), F: CORRECTION, slope: a * sp.diff(CORRECTION, a)},
        sp.simplify,
    )


ROUTINES = (
    modulus_over_mu,
    hertz_force,
    hertz_radius,
    largest_pressure,
    indentation_of,
    indentation_in_range,
    depth_coefficients,
    relative_rise,
    slope_of_indentation,
    contact_stiffness,
    depth_ratio,
    depth_ratio_at,
    radius_of_ratio,
    force_of_ratio,
    newton_step,
)
"""Routines for arrays."""
POINT_ROUTINES = (
    modulus_over_mu,
    indentation_in_range,
    relative_rise,
    depth_ratio_at,
    depth_ratio_in_range,
    radius_in_range,
    force_in_range,
    stiffness_in_range,
    newton_step,
)
"""Routines for single numbers whose products neither overflow nor underflow."""
