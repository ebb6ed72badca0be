"""Routines of J0 and J1 at large arguments, and J1 at zeros of J0, proved from Hankel's form."""

import sympy as sp

from derivation.engine.emit.modules import Routines
from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import Let, Routine, routine
from derivation.mathematics.bessel.theory.functions import SHIFT, P, hankel, nu, x
from derivation.mathematics.bessel.theory.zeros import slope_at_zero

HALF_PI, INVERSE_ROOT_PI, EIGHT_OVER_PI2 = sp.symbols(
    "HALF_PI INVERSE_ROOT_PI EIGHT_OVER_PI2", positive=True
)
NUMBERS = {
    HALF_PI: sp.pi / 2,
    INVERSE_ROOT_PI: 1 / sp.sqrt(sp.pi),
    EIGHT_OVER_PI2: 8 / sp.pi**2,
}
turned, rest = sp.symbols("turned rest", real=True)
_turns = sp.Symbol("k", integer=True)


def _by_sines(expression: sp.Expr) -> sp.Expr:
    return sp.simplify(sp.expand_trig(expression.replace(sp.cos, lambda v: sp.cos(sp.expand(v)))))


@named_routine
def wave() -> Claims:
    """Return (-1)^k J where turned + rest is the multiple (4 k + 2 nu - 1) of pi/4."""
    ratio, near, small = sp.symbols("ratio near small", real=True)
    half_turns = (4 * _turns + 2 * nu - 1) * sp.pi / 4
    return Claims(
        (x, P, SHIFT, turned, rest),
        (
            Let(ratio, P / (HALF_PI * x), within=True),
            Let(near, x - turned, within=True),
            Let(small, SHIFT - rest, within=True),
        ),
        (sp.sqrt(ratio) * sp.sin(near + small),),
        ((-1) ** _turns * hankel(nu),),
        {turned: half_turns - rest, HALF_PI: sp.pi / 2},
        _by_sines,
    )


def far(order: int) -> Routine:
    """Return the routine of J_order with the modulus series 1 and the phase shift 0."""
    sign = 1 - 2 * order
    return routine(
        f"far_{order}",
        (x,),
        (),
        (INVERSE_ROOT_PI * (sp.sin(x) + sign * sp.cos(x)) / sp.sqrt(x),),
        (hankel(order).subs({P: 1, SHIFT: 0}),),
        f"Return J{order} for x so large that 1 + 1/x rounds to 1.",
        NUMBERS,
        _by_sines,
    )


@named_routine
def slope() -> Claims:
    """Return |J1| at the zero of J0 near quarters pi/4; excess is SLOPE_EXCESS there."""
    quarters, excess = sp.symbols("quarters excess", positive=True)
    square = sp.Symbol("square", real=True)
    return Claims(
        (quarters, excess),
        (Let(square, EIGHT_OVER_PI2 * (1 + excess) / quarters, within=True),),
        (sp.sqrt(square),),
        (slope_at_zero(quarters * sp.pi / 4, 1 + excess),),
        NUMBERS,
        sp.simplify,
    )


def bessel_kernels() -> Routines:
    """Return the module of all routines."""
    title = "J0 and J1 at large arguments, and J1 at the zeros of J0, proved from Hankel's form."
    made = wave(), far(0), far(1), slope()
    return Routines("bessel_kernels", title, made, {"bessel_numbers": tuple(map(str, NUMBERS))})
