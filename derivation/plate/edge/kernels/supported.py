"""A simple support: its modal sums, the resulting change of the law, and their bound.

With n = nu/(1 - nu), T = 2 eta j and k the weight function of the indentation or of the slope::

    sum k (1 + 3 n - n Q)/(j^3 J1) = P + n [3 P - 2 eta E + sum k (T - Q)/(j^3 J1)]
    sum k H/(j^2 J1) = E + sum k (H - 1)/(j^2 J1)
    P = sum k/(j^3 J1), a polynomial;   E = sum k/(j^2 J1), a function of alpha

Both sums on the right decay like e^(-T). For a thin plate the bracket is the small difference of
large terms. Therefore P and E are tabulated without the first mode, which is added as a whole. The
proofs use two modes, the first one and one for all others, because the sums are linear.
"""

from functools import partial

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import GUARDED, Choice, Facts, Let, Routine, Several, routine
from derivation.engine.rewrite.form import substitute_steps
from derivation.engine.rewrite.series import truncated_taylor
from derivation.engine.rewrite.terms import terms_of
from derivation.plate.blocks import blocks
from derivation.plate.edge.kernels.tables import SWITCH
from derivation.plate.edge.theory.curvature import edge_curvature
from derivation.plate.edge.theory.sums import (
    Kernel,
    closed_sums,
    edge_bound,
    indentation_kernel,
    inverse_squares,
    slope_kernel,
)
from derivation.plate.edge.theory.supported import (
    RATIO,
    bending_function,
    edge_law,
    stretching_function,
    support_ratio,
)
from derivation.plate.vocabulary import J1, T, alpha, eta, j_n, lam, mu

SMALLEST = sp.Float("1e-300")
"""Argument below which sin(y)/y is 1."""
n = sp.Symbol("n", real=True)
j, y, kernel, support = sp.symbols("j y kernel support", positive=True)
bending_part, extension_part, plain = sp.symbols("bending_part extension_part plain", real=True)
_unit, _size = sp.symbols("unit M", positive=True)
Q, H = bending_function(), stretching_function()
KERNELS = {"indentation": indentation_kernel, "slope": slope_kernel}


def in_ratio(expression: sp.Expr) -> sp.Expr:
    """Return the expression in n, without building blocks, guards and common scales."""
    written = substitute_steps(expression, (), blocks()).replace(
        lambda e: isinstance(e, sp.Max) and SMALLEST in e.args,
        lambda e: sp.Mul(*(part for part in e.args if part != SMALLEST)),
    )
    scaled = {lam + 2 * mu: _size, 3 * lam + 2 * mu: _size * (1 + 2 * n)}
    reduced: sp.Expr = written.xreplace(scaled).subs(lam, n * _size)
    return reduced


@named_routine
def elastic_ratios() -> Claims:
    """Return n = nu/(1 - nu) and (1 - nu)/(1 + nu), for lam and mu over any common scale."""
    return Claims(
        (lam, mu),
        (),
        (lam / (lam + 2 * mu), (lam + 2 * mu) / (3 * lam + 2 * mu)),
        (RATIO, support_ratio().expression),
        {lam: lam / _unit, mu: mu / _unit},
        sp.cancel,
    )


def of_indentation() -> Routine:
    """Return the weight function of the indentation; the block is divided by min(y, 2)^2."""
    at = blocks()["hertz_shape"].value.at
    high, shape = sp.symbols("high shape", positive=True)

    def without_switch(expression: sp.Expr) -> sp.Expr:
        width = alpha * j_n
        return sp.simplify(expression.xreplace({sp.Min(width, at): at * width / sp.Max(width, at)}))

    return routine(
        "indentation_kernel",
        (alpha, j),
        (
            Let(y, alpha * j),
            Let(high, sp.Max(y, at)),
            Several((shape,), "hertz_shape", (y,), (blocks()["hertz_shape"].definition(y),)),
        ),
        (3 * at**2 * shape / high**2,),
        (indentation_kernel(alpha * j_n),),
        "Return 3 (sin y - y cos y)/y^3, y = alpha j.",
        {j: j_n},
        without_switch,
    )


def of_slope() -> Routine:
    """Return the weight function of the slope."""
    return routine(
        "slope_kernel",
        (alpha, j),
        (Let(y, sp.Max(alpha * j, SMALLEST)),),
        (slope_kernel(y),),
        (slope_kernel(alpha * j_n),),
        "Return (3/2) sin(y)/y, y = alpha j.",
        {j: j_n},
        in_ratio,
    )


def thin(kind: str) -> Routine:
    """Return P, and the sums of a thin plate in closed form."""
    half = closed_sums(KERNELS[kind])
    parts = half.plain, plain - n * half.bending_part, half.extension_part
    return routine(
        f"thin_{kind}",
        (alpha, eta, n),
        (Let(plain, half.plain),),
        (plain, *parts[1:]),
        (half.plain, half.plain - RATIO * half.bending_part, half.extension_part),
        "Return sum k/(j^3 J1), and both sums of a thin plate.",
        {n: RATIO},
        in_ratio,
    )


def _bent_series(square: sp.Symbol, series: sp.Symbol) -> Several:
    """Return (T cosh T + 2 T - 3 sinh T)/T^5 in powers of T^2, truncated below rounding."""
    total = sp.expand(sp.numer(sp.together(Q - 3)))
    section = truncated_taylor(terms_of(total, T), sp.Integer(SWITCH))
    return Several(
        (series,), "polynomial", (square, *section.coefficients), (total / T**section.lead,)
    )


def _of_T() -> tuple[dict[str, sp.Symbol], tuple[Let | Several, ...]]:
    """Return the statements common to Q and H."""
    names = "fading", "decayed", "lower", "upper", "square", "series"
    s = {name: sp.Symbol(name, real=True) for name in names}
    known = blocks()
    return s, (
        Let(s["fading"], sp.exp(-T)),
        Let(s["decayed"], expm1(-T)),
        *(
            Several((s[name],), block, (T,), (known[block].definition(T),))
            for name, block in (("lower", "sinh_minus"), ("upper", "sinh_plus"))
        ),
        Let(s["square"], GUARDED(T, SWITCH) ** 2),
        _bent_series(s["square"], s["series"]),
    )


def _sides(mode: sp.Symbol) -> tuple[sp.Basic, Facts, Facts]:
    """Return the condition for the power series of Q - 3, and the block's power on either side."""
    size = 2 * eta * mode
    near = sp.Min(size, SWITCH)
    return sp.Lt(T, SWITCH), {near: size}, {near: SWITCH}


@named_routine
def later_modes() -> Claims:
    """Return k (T - Q)/(j^3 J1) and k (H - 1)/(j^2 J1) of modes; `kernel` is k."""
    s, statements = _of_T()
    fading, decayed, lower, upper, square, series = s.values()
    weight, above = sp.symbols("weight above", real=True)
    condition, near, far = _sides(j_n)
    of_series = T - 3 - 2 * fading * square * series / lower
    of_decay = -T * fading * (T + decayed) / (SWITCH**2 * lower)
    k = sp.Symbol("k", real=True)
    mode = k / (j_n**2 * J1)
    size = {T: 2 * eta * j_n}
    return Claims(
        (eta, j, J1, kernel),
        (
            Let(T, 2 * eta * j),
            *statements,
            Choice(above, condition, of_series, of_decay, if_yes=near, if_no=far),
            Let(weight, kernel / (j**2 * J1)),
        ),
        (weight * above / j, -2 * weight * fading * (T - decayed) / upper),
        (mode * (T - Q).subs(size) / j_n, mode * (H - 1).subs(size)),
        {j: j_n, kernel: k},
        in_ratio,
    )


@named_routine
def all_modes() -> Claims:
    """Return sum k (1 + 3 n - n Q)/(j^3 J1) and sum k H/(j^2 J1)."""
    s, statements = _of_T()
    fading, decayed, lower, upper, square, series = s.values()
    names = "FIRST_THIRD FIRST_SQUARE rest_third rest_square fading_third fading_square below"
    third, square_1, rest_third, rest_square, fading_third, fading_square, below = sp.symbols(
        names, real=True
    )
    decay_ratio = sp.Symbol("decay_ratio", real=True)
    j_2, J1_2, k_1, k_2 = sp.symbols("j_2 J1_2 k_1 k_2", positive=True)
    condition, near, far = _sides(j_n)
    of_series = -2 * fading * square * series / lower
    lead = sp.Symbol("lead", real=True)
    of_decay = lead - T * fading * (T + decayed) / (SWITCH**2 * lower)
    modes = ((k_1, j_n, J1), (k_2, j_2, J1_2))
    (cube_1, cube_2), (square_of_1, square_of_2) = (
        [k / (zero**power * slope) for k, zero, slope in modes] for power in (3, 2)
    )
    Q_1, Q_2, H_1, H_2 = (f.subs(T, 2 * eta * zero) for f in (Q, H) for zero in (j_n, j_2))
    meaning = {
        n: RATIO,
        j: j_n,
        kernel: k_1,
        third: cube_1 / k_1,
        square_1: square_of_1 / k_1,
        plain: cube_1 + cube_2,
        rest_third: cube_2,
        rest_square: square_of_2,
        fading_third: cube_2 * (2 * eta * j_2 - Q_2),
        fading_square: square_of_2 * (H_2 - 1),
    }
    bracket = third * kernel * below + (3 * rest_third - 2 * eta * rest_square) + fading_third
    return Claims(
        (eta, n, j, kernel, plain, rest_third, rest_square, fading_third, fading_square),
        (
            Let(T, 2 * eta * j),
            *statements,
            Let(lead, 3 - T),
            Choice(below, condition, of_series, of_decay, if_yes=near, if_no=far),
            Let(decay_ratio, decayed**2 / upper, means=H_1),
        ),
        (plain + n * bracket, square_1 * kernel * decay_ratio + rest_square + fading_square),
        (
            sum(cube * (1 + 3 * RATIO - RATIO * f) for cube, f in ((cube_1, Q_1), (cube_2, Q_2))),
            square_of_1 * H_1 + square_of_2 * H_2,
        ),
        meaning,
        in_ratio,
    )


def one_mode(kernel: Kernel) -> Facts:
    """Return both sums, with one mode in place of all."""
    at = {T: 2 * eta * j_n}
    return {
        n: RATIO,
        support: support_ratio().expression,
        bending_part: kernel(alpha * j_n) * (1 + 3 * RATIO - RATIO * Q.subs(at)) / (j_n**3 * J1),
        extension_part: kernel(alpha * j_n) * H.subs(at) / (j_n**2 * J1),
    }


def of_law() -> Routine:
    """Return the change of the indentation or of the slope by a simple support, from both sums."""
    square, stiff = sp.symbols("square stiff", positive=True)
    law, slope = edge_law()
    value = (
        support * alpha / sp.pi * (stiff * bending_part + sp.Rational(8, 3) * n**2 * extension_part)
    )
    proved = [
        routine(
            "of_support",
            (alpha, eta, n, support, bending_part, extension_part),
            (Let(square, eta * eta), Let(stiff, (1 - 2 * n * square) / (eta * square))),
            (value,),
            (support_ratio().expression * formula.expression,),
            "Return the change of the law, or of its slope, by a simple support, from both sums.",
            one_mode(kernel),
            in_ratio,
        )
        for formula, kernel in ((law, indentation_kernel), (slope, slope_kernel))
    ]
    return proved[0]


@named_routine
def support_bound() -> Claims:
    """Return a bound of the slope's change by a simple support, for all radii up to this one."""
    square, bending, large = sp.symbols("square bending large", positive=True)
    sum_of_squares = inverse_squares()
    extended = sp.Rational(1, 8) + 2 * eta * sp.Abs(n) * sum_of_squares
    value = bending * extended + sp.Rational(8, 3) * n**2 * sum_of_squares
    return Claims(
        (alpha, eta, n, support),
        (
            Let(square, eta * eta),
            Let(bending, sp.Abs(1 - 2 * n * square) / (eta * square)),
            Let(large, value),
        ),
        (3 * alpha * support * large / (2 * sp.pi),),
        (support_ratio().expression * edge_bound().expression,),
        {n: RATIO, support: support_ratio().expression},
        in_ratio,
    )


@named_routine
def kernel_of_support() -> Claims:
    """Return the coefficient of (t^2 + s^2)/h^3 in the kernel by a simple support."""
    return Claims(
        (support, bending_part),
        (),
        (-3 / sp.pi * support * bending_part,),
        (edge_curvature()[0].expression,),
        {name: sp.limit(value, alpha, 0) for name, value in one_mode(indentation_kernel).items()},
        in_ratio,
    )


ROUTINES = (
    elastic_ratios,
    of_indentation,
    of_slope,
    partial(thin, "indentation"),
    partial(thin, "slope"),
    later_modes,
    all_modes,
    of_law,
    support_bound,
    kernel_of_support,
)
