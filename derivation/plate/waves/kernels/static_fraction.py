"""Fraction of A0 in the deflection under a static load: (rho h r/kap) over mu C/h."""

import sympy as sp

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import GUARDED, Let, Routine, Several, routine
from derivation.plate.vocabulary import gam, kap, x_h
from derivation.plate.waves.kernels.any_frequency import reduce_exponentials
from derivation.plate.waves.kernels.entire import at_zero, rest, square, x
from derivation.plate.waves.kernels.lowest_branch import WAVE, P, Q, S, d, left, steep, xi
from derivation.plate.waves.theory.bending_branch import bending_fraction, differences
from derivation.plate.waves.theory.dynamic_modes import in_p_and_q, p, q, shc, slow_stiffness

T, limited, lower, upper = sp.symbols("T limited lower upper", positive=True)
unlike, product, excess = sp.symbols("unlike product excess", positive=True)
TWO = 2 * x_h


def _static(expression: sp.Expr) -> sp.Expr:
    """Evaluate at kap = 0, where p = q = x and shc(p - q) = 1."""
    still: sp.Expr = expression.subs(kap, 0).subs(shc(p - q), 1).subs({p: x_h, q: x_h})
    return still


def _fraction() -> sp.Expr:
    """Return the derived fraction in terms of its steepness and static B_a/B_s."""
    names = {"s": steep, "beta": unlike}
    stated: sp.Expr = bending_fraction().stated
    return stated.subs({k: names[k.name] for k in stated.free_symbols if k.name in names})


def ratio_at_rest() -> Routine:
    """Return B_a/B_s at kap = 0."""
    bending_part, extension_part = (_static(form) for form in slow_stiffness())
    fading = 2 * sp.exp(-TWO)
    statements = (
        Let(T, 2 * x),
        Let(limited, GUARDED(T, sp.Integer(2)), opaque=True),
        Several((lower,), "sinh_minus", (T,), (fading * (sp.sinh(TWO) - TWO) / limited**3,)),
        Several((upper,), "sinh_plus", (T,), (fading * (sp.sinh(TWO) + TWO),)),
    )
    return routine(
        "unlike",
        (x,),
        statements,
        (sp.tanh(x) ** 2 * lower * limited**3 / upper,),
        (bending_part / extension_part,),
        "Return Ba/Bs at kap = 0.",
        {x: x_h},
        reduce_exponentials,
    )


@named_routine
def fraction_beyond() -> Claims:
    """Return the static fraction of A0 for x >= 1; `excess` is E - 1, `product` is 4 P Q."""
    scaled = 2 * sp.exp(-TWO) * (sp.sinh(TWO) - TWO) / 2**3
    statements = (
        Let(T, 2 * x),
        Several((lower,), "sinh_minus", (T,), (scaled,)),
        Let(upper, 4 * Q * steep * (1 + excess) * (1 + sp.exp(-T)) ** 2),
    )
    E = (sp.sinh(p + q) - (p + q) * shc(p - q)) / (sp.cosh(p + q) + sp.cosh(p - q))
    return Claims(
        (x, left, Q, steep, unlike, excess, product),
        statements,
        (product * (product + 4 * left) * lower / (upper * (1 + unlike)),),
        (_fraction(),),
        {**WAVE, excess: E - 1, product: 4 * p * q / x_h**2},
        reduce_exponentials,
    )


@named_routine
def deep_product() -> Claims:
    """Return 4 P Q at A0."""
    return Claims(
        (x, left, P, Q),
        (),
        ((1 + left) ** 2 * sp.tanh(x * P) / sp.tanh(x * Q),),
        (4 * p * q / x_h**2,),
        WAVE,
        lambda e: at_zero(e, True),
    )


@named_routine
def fraction_near_one() -> Claims:
    """Return the static fraction of A0 for small x, as 1 minus a small difference."""
    near, F, less, first, second = sp.symbols("near F less first second")
    steeper, below = sp.symbols("steeper below")
    static_F = (shc(TWO) - 1) / TWO**2
    gap = sp.sinh(x * d / 2) ** 2 - sp.sinh(x + x * S / 2) * sp.sinh(x * near / 2)
    statements = (
        Let(S, P + Q),
        Let(square, x * x),
        Let(d, rest * xi / S, "P - Q", means=(p - q) / x_h),
        Let(near, xi * (gam / (1 + P) + 1 / (1 + Q)), "2 - S", means=2 - (p + q) / x_h),
        Several(
            (F, less),
            "compared",
            (square * S * S, square * d * d, square * near * (2 + S)),
            (differences(), static_F - differences()),
        ),
        Let(first, less / F),
        Let(
            second,
            gap / sp.cosh(x) ** 2,
            means=sp.cosh(p) * sp.cosh(q) / sp.cosh(x_h) ** 2 - 1,
        ),
        Let(steeper, steep - 1),
        Let(below, steeper + unlike + steeper * unlike),
    )
    return Claims(
        (x, gam, rest, xi, P, Q, steep, unlike),
        statements,
        (1 - (below - first - second - first * second) / (1 + below),),
        (_fraction(),),
        WAVE,
        in_p_and_q,
    )


ROUTINES = (ratio_at_rest, fraction_beyond, deep_product, fraction_near_one)
