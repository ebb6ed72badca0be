"""The force by the reversed series, proved: eps^2 = A^2 (1 + F), P = C sqrt(R) delta^(3/2) (..)."""

import sympy as sp

from derivation.engine.emit.modules import Routines
from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Let
from derivation.engine.formula.proof import prove
from derivation.engine.rewrite.form import TIMES
from derivation.plate.contact.kernels.law import MODULUS, root, without_scaling
from derivation.plate.contact.theory.reversion import (
    LAST_P,
    force_coefficients,
    force_formulas,
    plate_law,
    power_series,
)
from derivation.plate.contact.theory.split import contact_split
from derivation.plate.vocabulary import R, a, a_ratio, delta, h, mu

n, radius, modulus, bracket, circle = sp.symbols("n radius modulus bracket circle", positive=True)
F, indentation_ratio = sp.symbols("F indentation_ratio", complex=True)


@named_routine
def eps_over() -> Claims:
    """Return sqrt(R delta)/h over a radius of convergence."""
    eps = sp.Symbol("eps", positive=True)
    return Claims(
        (delta, R, h, radius),
        (root(eps, 2, (delta, R), h, h),),
        (eps / radius,),
        (sp.sqrt(R * delta) / h / radius,),
        {},
    )


@named_routine
def size_of_eps() -> Claims:
    """Return |sqrt(R delta)/h| for A on a circle; F may be complex."""
    depth = contact_split()[0].expression.subs(a, a_ratio * h) * (1 + F)
    return Claims(
        (circle, F),
        (Let(indentation_ratio, 1 + F),),
        (circle * sp.sqrt(sp.Abs(indentation_ratio)),),
        (sp.sqrt(sp.Abs(R * depth)) / h,),
        {circle: a_ratio},
    )


@named_routine
def lagrange() -> Claims:
    """Return the power of 1 + F whose coefficient of A^n gives p_n, and the factor."""
    exponent, factor = -(n + 3) / 2, 3 / (n + 3)
    prove(
        "Coefficients of the reversed series",
        "The power and the factor of each n give p_n of the theory.",
        {
            f"p_{k}": factor.subs(n, k)
            * power_series(plate_law(LAST_P), exponent.subs(n, k), k + 1)[k]
            - p
            for k, p in enumerate(force_coefficients())
        },
    )
    return Claims((n,), (), (exponent, factor), (exponent, factor), {})


@named_routine
def force_of_bracket() -> Claims:
    """Return Hertz's force times the bracket; `modulus` is (4/3) E*/mu."""
    hertz = {f.name: f.expression for f in force_formulas()}["P_half"]
    length = sp.Symbol("length", positive=True)
    return Claims(
        (delta, R, mu, modulus, bracket),
        (root(length, 2, (R, delta)),),
        (TIMES(modulus, mu, 1, length, 1, delta, 1, bracket, 1),),
        (hertz * bracket,),
        {modulus: MODULUS},
        without_scaling,
    )


ROUTINES = eps_over, size_of_eps, lagrange, force_of_bracket


def reversed_kernels() -> Routines:
    """Return the routines of the reversed series, printed from proved expressions."""
    title = "Force over indentation by the reversed series."
    made = tuple(make() for make in ROUTINES)
    return Routines("reversed_kernels", title, made, {"ranges": ("root", "times")})
