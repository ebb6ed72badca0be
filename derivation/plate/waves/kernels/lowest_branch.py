"""The lowest branch A0: its equation, its residue, and its static fraction.

With S = P + Q, P = p/x, Q = q/x, xi = kap/x^2 and `left` = 1 - xi = Q^2.
"""

from functools import partial

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Facts, Let, Routine, Several, routine
from derivation.plate.vocabulary import gam, kap, x_h
from derivation.plate.waves.kernels.any_frequency import reduce_exponentials, scaled_shc
from derivation.plate.waves.kernels.entire import (
    at_zero,
    by_log_kap,
    reduce,
    rest,
    square,
    steepness_anywhere,
    stiffness,
    x,
)
from derivation.plate.waves.theory.bending_branch import differences, quotient, steepness
from derivation.plate.waves.theory.dynamic_modes import in_p_and_q, p, q, shc, with_roots

nu = sp.Symbol("nu", real=True)
slope, xi, left, P, Q, S, d = sp.symbols("slope xi left P Q S d", positive=True)
own_p, own_q, steep = sp.symbols("p_ q_ steep", positive=True)
fading_p, fading_q = sp.symbols("fading_p fading_q", positive=True)
WAVE: Facts = {
    x: x_h,
    slope: kap / x_h**4,
    xi: kap / x_h**2,
    left: q**2 / x_h**2,
    P: p / x_h,
    Q: q / x_h,
    rest: 1 - gam,
}


@named_routine
def shallow() -> Claims:
    """Return the quotient of both terms of Ba minus 1, and its slope."""
    fall, growth, F, change, ratio, other = sp.symbols("fall growth F change ratio other")
    rates = gam / P, 1 / Q
    in_squares = square * S * S, square * d * d, fall, growth
    by_squares = differences(), by_log_kap(differences())
    turned = own_p / sp.tanh(own_p) - 1
    statements = (
        Let(own_p, x * P),
        Let(own_q, x * Q),
        Let(S, P + Q),
        Let(square, x * x),
        Let(d, rest * xi / S, "P - Q", means=(p - q) / x_h),
        Let(
            fall,
            -square * xi * S * (rates[0] + rates[1]),
            "of x^2 S^2",
            means=by_log_kap((p + q) ** 2),
        ),
        Let(
            growth,
            square * xi * d * (rates[1] - rates[0]),
            "of x^2 d^2",
            means=by_log_kap((p - q) ** 2),
        ),
        Several((F, change), "differences", in_squares, by_squares),
        Let(ratio, 8 * left * rest * F / (slope * shc(own_p) * sp.cosh(own_q))),
        Let(other, gam * turned / (P * P) + square * (sp.tanh(own_q) / own_q)),
    )
    return Claims(
        (x, gam, rest, slope, xi, left, P, Q),
        statements,
        (ratio - 1, 1 - left * (change / F + xi * other / 2)),
        (quotient() - 1, steepness_anywhere()),
        WAVE,
        reduce,
    )


@named_routine
def deep_steepness() -> Claims:
    """Return the slope of the quotient, accurate where the quotient is 1."""
    plus, faded_p, faded_q, less, fading = sp.symbols("plus faded_p faded_q less fading")
    loss = fading_q / (1 + fading_q) ** 2 - fading_p / (1 + fading_p) ** 2
    statements = (
        Let(own_p, x * P),
        Let(own_q, x * Q),
        Let(fading_p, sp.exp(-2 * own_p)),
        Let(fading_q, sp.exp(-2 * own_q)),
        Let(plus, (1 + left) ** 2),
        Let(
            faded_p,
            4 * own_p * fading_p / -expm1(-4 * own_p),
            "2 p/sinh(2 p)",
            means=2 * p / sp.sinh(2 * p),
        ),
        Let(faded_q, 4 * own_q * fading_q / -expm1(-4 * own_q), means=2 * q / sp.sinh(2 * q)),
        Let(less, 4 * loss, means=sp.tanh(p) ** 2 - sp.tanh(q) ** 2),
        Let(
            fading,
            plus / 2 * (faded_q - faded_p * gam * left / (P * P))
            - 8 * left * left / plus * less / sp.tanh(own_p) ** 2 / xi,
        ),
    )
    return Claims(
        (x, gam, xi, left, P, Q),
        statements,
        (sp.Rational(1, 2) + (left * (1 - 2 / plus) + fading / xi),),
        (steepness(sp.tanh(p), sp.tanh(q)),),
        WAVE,
        reduce_exponentials,
    )


@named_routine
def less_than_one() -> Claims:
    """Return E - 1, E = (sinh S - S shc d)/(cosh S + cosh d)."""
    shc_d = sp.Symbol("shc_d", positive=True)
    exact = (sp.sinh(p + q) - (p + q) * shc(p - q)) / (sp.cosh(p + q) + sp.cosh(p - q))
    statements = (
        Let(S, x * (P + Q)),
        Let(d, x * (rest * xi / (P + Q)), means=p - q),
        Let(fading_p, sp.exp(-2 * x * P)),
        Let(fading_q, sp.exp(-2 * x * Q)),
        Several((shc_d,), "shc", (d,), (scaled_shc(p - q),)),
    )
    above = fading_p + fading_q * (1 + 2 * fading_p + 2 * S * shc_d)
    return Claims(
        (x, rest, xi, P, Q),
        statements,
        (-above / ((1 + fading_p) * (1 + fading_q)),),
        (exact - 1,),
        WAVE,
        reduce_exponentials,
    )


def residue(is_shallow: bool) -> Routine:
    """Return -1/B_a' at A0, in terms of the steepness."""
    root = sp.Symbol("root", positive=True)
    own = P if is_shallow else Q
    turned = root / sp.tanh(root)
    value = left * turned / (2 * steep) if is_shallow else (1 + left) ** 2 * turned / (8 * steep)
    return routine(
        "shallow_residue" if is_shallow else "deep_residue",
        (x, left, own, steep),
        (Let(root, x * own),),
        (value,),
        (-1 / sp.diff(with_roots(stiffness(True)), kap),),
        "Return -1/Ba' at A0.",
        {**WAVE, steep: steepness_anywhere()},
        lambda e: at_zero(e, True),
    )


@named_routine
def deep_excess() -> Claims:
    """Return the quotient of both terms minus 1 for short waves, from their difference."""
    first, second, difference, excess, deficit = sp.symbols(
        "first second difference excess deficit"
    )
    E = (sp.sinh(p + q) - (p + q) * shc(p - q)) / (sp.cosh(p + q) + sp.cosh(p - q))
    short = 2 * q / x_h, kap * (p + q) / (2 * (1 - gam) * x_h**3)
    meaning = {first: short[0], second: short[1], difference: short[0] - short[1], excess: E - 1}
    statements = (
        Let(fading_p, sp.exp(-2 * x * P)),
        Let(deficit, 2 * fading_p / (1 + fading_p), "1 - tanh p", means=1 - sp.tanh(p)),
    )
    above = difference + first * excess + second * deficit
    return Claims(
        (x, P, first, second, difference, excess),
        statements,
        (above / (second * (1 - deficit)),),
        (quotient() - 1,),
        {**WAVE, **meaning},
        reduce_exponentials,
    )


@named_routine
def material() -> Claims:
    """Return gam = mu/(lam + 2 mu), and 1 - gam."""
    return Claims(
        (nu,),
        (),
        ((sp.Rational(1, 2) - nu) / (1 - nu), 1 / (2 * (1 - nu))),
        (gam, 1 - gam),
        {nu: (1 - 2 * gam) / (2 * (1 - gam))},
    )


@named_routine
def wave_ratios() -> Claims:
    """Return xi = kap/x^2, 1 - xi, p/x and q/x."""
    return Claims(
        (x, gam, slope),
        (Let(xi, slope * x * x), Let(left, 1 - xi)),
        (xi, left, sp.sqrt(1 - gam * xi), sp.sqrt(left)),
        tuple(WAVE[part] for part in (xi, left, P, Q)),
        WAVE,
        in_p_and_q,
    )


ROUTINES = (
    material,
    wave_ratios,
    shallow,
    deep_steepness,
    less_than_one,
    deep_excess,
    partial(residue, True),
    partial(residue, False),
)
