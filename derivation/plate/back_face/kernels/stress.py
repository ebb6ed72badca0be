"""The stress on the back face: modal terms, series for wide contacts, and edge correction."""

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Choice, Let, Several
from derivation.engine.rewrite.form import TIMES, substitute_steps
from derivation.engine.rewrite.series import POLYNOMIAL
from derivation.plate.back_face.kernels.tables import TERMS
from derivation.plate.back_face.theory import (
    SCALE,
    back_face_clamp,
    back_face_edge,
    back_face_stress,
    thin_plate_stress,
    wide_contact_stress,
)
from derivation.plate.blocks import blocks
from derivation.plate.edge.kernels.supported import (
    bending_part,
    extension_part,
    in_ratio,
    n,
    one_mode,
    support,
)
from derivation.plate.edge.theory.clamped import HERTZ_MEAN, indentation_loss, turn
from derivation.plate.edge.theory.sums import indentation_kernel
from derivation.plate.edge.theory.supported import RATIO, support_ratio
from derivation.plate.vocabulary import J1, P, T, a_ratio, alpha, eta, h, j_n, lam, mu

A, j, kernel, thick, unit = sp.symbols("A j kernel thick unit", positive=True)
total, stiff = sp.symbols("total stiff", real=True)
THIN = sp.Symbol("THIN", positive=True)
_sum = sp.Symbol("S", real=True)


@named_routine
def back_face_modes() -> Claims:
    """Return 4 eta^2 k B(2 eta j)/J1^2 of modes; `kernel` is k."""
    names = "low pair square low_square"
    low, pair, square, low_square = sp.symbols(names, positive=True)
    block = blocks()["sinh_pair"]
    (_, mode) = back_face_stress()
    cubed = T * square / low_square**2
    return Claims(
        (eta, j, J1, kernel),
        (
            Let(T, 2 * eta * j),
            Let(low, sp.Min(T, block.value.at)),
            Let(low_square, low * low),
            Let(square, T * T),
            Several((pair,), "sinh_pair", (T,), (block.definition(T),)),
        ),
        (-4 * kernel * cubed * sp.exp(-T) * expm1(-2 * T) / (pair * (j * J1) ** 2),),
        (mode.expression,),
        {j: j_n, kernel: indentation_kernel(alpha * j_n)},
        in_ratio,
    )


@named_routine
def summed_plate() -> Claims:
    """Return a/b and h/b of the plate whose sum is computed."""
    width = sp.Symbol("width", positive=True)
    is_thin = sp.Lt(eta, THIN)
    limited = sp.Max(eta, THIN)
    return Claims(
        (alpha, eta, A),
        (Choice(width, is_thin, A * THIN, alpha, if_yes={limited: THIN}, if_no={limited: eta}),),
        (width, limited),
        (a_ratio * limited, None),
        {alpha: a_ratio * eta, A: a_ratio},
    )


@named_routine
def of_thin_plate() -> Claims:
    """Return S from that of a thicker plate with the same a/h."""
    stated = thin_plate_stress()[0].expression
    return Claims(
        (total, thick, eta),
        (),
        (total + 3 * sp.log(thick / eta),),
        (stated,),
        {total: stated.subs(eta, thick)},
        lambda e: sp.expand(sp.expand_log(sp.expand(e))),
    )


@named_routine
def under_narrow_contact() -> Claims:
    """Return S of a narrow contact; `moment0`, ... are sums of modes times j^(2k), k = 0, ..."""
    y, square = sp.symbols("y square", positive=True)
    moments = sp.symbols(f"moment:{TERMS}", positive=True)
    series = sp.Poly(sp.series(indentation_kernel(y), y, 0, 2 * TERMS).removeO(), y)
    stated = sp.Add(
        *(series.coeff_monomial(y ** (2 * k)) * alpha ** (2 * k) * m for k, m in enumerate(moments))
    )
    # The coefficients of (sin y - y cos y)/y^3 are (-1)^k (1/(2k + 2)! - 1/(2k + 3)!).
    factors = [
        3 * (-1) ** k * (1 / sp.factorial(2 * k + 2) - 1 / sp.factorial(2 * k + 3))
        for k in range(TERMS)
    ]
    terms = [factor * moment for factor, moment in zip(factors, moments, strict=True)]
    return Claims(
        (alpha, *moments),
        (Let(square, alpha**2),),
        (POLYNOMIAL(square, *terms),),
        (stated,),
        {},
        without_polynomials,
    )


def without_polynomials(expression: sp.Expr) -> sp.Expr:
    """Return the expression with polynomials written as sums of powers."""
    summed_terms = expression.replace(
        POLYNOMIAL, lambda x, *c: sp.Add(*(part * x**k for k, part in enumerate(c)))
    )
    return sp.expand(sp.expand_log(summed_terms))


@named_routine
def under_wide_contact() -> Claims:
    """Return S where the contact is wide compared with the thickness."""
    square = sp.Symbol("square", positive=True)
    stated = wide_contact_stress().expression
    powers = sp.Poly(
        stated.subs(alpha, sp.Rational(1, 2)).subs(a_ratio, 2 / sp.sqrt(square)), square
    )
    coefficients = [powers.coeff_monomial(square**k) for k in range(1, powers.degree() + 1)]

    return Claims(
        (alpha, A),
        (Let(square, (2 / A) ** 2),),
        (4 - 3 * sp.log(2 * alpha) + square * POLYNOMIAL(square, *coefficients),),
        (stated,),
        {A: a_ratio},
        without_polynomials,
    )


@named_routine
def with_support() -> Claims:
    """Return S plus the correction for a simple support, from both sums over the modes."""
    return Claims(
        (total, eta, n, support, bending_part, extension_part),
        (),
        (total + support * (12 * bending_part + 8 * n * eta * extension_part),),
        (_sum + support_ratio().expression * back_face_edge().expression,),
        {**one_mode(indentation_kernel), total: _sum},
        in_ratio,
    )


@named_routine
def with_clamp() -> Claims:
    """Return S plus the correction for a clamped edge."""
    chi, loss, wide, moment = sp.symbols("chi loss wide moment", real=True)
    return Claims(
        (total, alpha, eta, n),
        (
            Several((chi,), "turn_of_clamp", (n,), (turn(),)),
            Several((loss,), "indentation_loss", (eta, n), (indentation_loss() / eta,)),
            Let(wide, 1 - HERTZ_MEAN * alpha**2),
            Let(moment, wide * (1 + 2 * chi * eta) - eta * loss),
        ),
        (total - sp.Rational(3, 2) * moment - 2 * n * eta**2,),
        (_sum - back_face_clamp().expression,),
        {n: RATIO, total: _sum},
        in_ratio,
    )


@named_routine
def stress_of_sum() -> Claims:
    """Return (1 + nu) P/(2 pi H^2) S, with lam and mu over any common scale."""
    return Claims(
        (total, P, h, lam, mu),
        (Let(stiff, (3 * lam + 2 * mu) / (16 * sp.pi * (lam + mu))),),
        (TIMES(total, stiff, 1, P, 1, h, -2),),
        (SCALE * _sum,),
        {lam: lam / unit, mu: mu / unit, total: _sum},
        lambda e: substitute_steps(e, (), {}),
    )


ROUTINES = (
    back_face_modes, summed_plate, of_thin_plate, under_narrow_contact,
    under_wide_contact, with_support, with_clamp, stress_of_sum,
)  # fmt: skip
