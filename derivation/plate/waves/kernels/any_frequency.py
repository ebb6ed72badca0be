"""Both stiffnesses at any frequency: for their zeros, and for the deflection of the face."""

from functools import partial

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.engine.emit.named import Claims, named_routine
from derivation.engine.emit.routine import GUARDED, Choice, Let, Routine, Several, routine
from derivation.plate.vocabulary import gam, kap, x_h
from derivation.plate.waves.kernels.entire import (
    FIRST,
    MEANING,
    NAMES,
    E_p,
    E_q,
    by_kap,
    cosh_p,
    cosh_q,
    entire,
    level,
    over,
    reduce,
    rest,
    sinh_p,
    sinh_q,
    slope_p,
    slope_q,
    square,
    stiffness,
    terms,
    whole,
    x,
)
from derivation.plate.waves.theory.bending_branch import differences
from derivation.plate.waves.theory.dynamic_modes import in_p_and_q, in_sines, p, q, shc, with_roots

NEAR = sp.Symbol("NEAR")
load = sp.Symbol("kap", positive=True)


def scaled_shc(y: sp.Expr) -> sp.Expr:
    """Return the result of the package's function `shc`."""
    return sp.exp(-y) * shc(y)


def reduce_exponentials(expression: sp.Expr) -> sp.Expr:
    """Return 0 if and only if the expression vanishes, exponentials included."""
    reduced = in_p_and_q(expression).replace(expm1, lambda y: sp.exp(y) - 1)
    return in_sines(reduced.replace(sp.exp, lambda y: sp.cosh(y) + sp.sinh(y)))


def _slope(
    symbol: sp.Symbol,
    of: sp.Expr,
    parts: tuple[sp.Symbol, sp.Symbol],
    root: sp.Symbol,
    scale: sp.Symbol,
) -> Several:
    exact = scale * (sp.cosh(root) - shc(root)) / (2 * root**2)
    return Several((symbol,), "slope", (of, *parts), (exact,))


def zero_of(bends: bool) -> Routine:
    """Return -kap B/2 times a factor that makes it entire, its derivative d/dkap, and the sign."""
    value = sp.Add(*terms(bends))
    claim = -kap / 2 * stiffness(bends) * whole(bends)
    slopes = (
        _slope(slope_p, level, (cosh_p, sinh_p), p, E_p),
        _slope(slope_q, -over, (cosh_q, sinh_q), q, E_q),
    )
    return routine(
        "bending_part" if bends else "extension_part",
        (over, x, gam, rest),
        (*FIRST, slopes[0 if bends else 1]),
        (
            value.xreplace(NAMES),
            by_kap(value).xreplace(NAMES),
            sp.sign(entire(whole(bends)).xreplace(NAMES)),
        ),
        (E_p * E_q * claim, E_p * E_q * sp.diff(with_roots(claim), kap), None),
        f"Return -kap B{'a' if bends else 's'}/2 made entire, its derivative with respect to kap, "
        "and the factor's sign.",
        MEANING,
        reduce,
    )


@named_routine
def fast() -> Claims:
    """Return 1/Ba and 1/Bs for kap > x^2, where q is imaginary, and p for gam kap > x^2."""
    values = [
        (-load * entire(whole(bends)) / (2 * sp.Add(*terms(bends)))).xreplace(NAMES)
        for bends in (True, False)
    ]
    first, *others = FIRST
    return Claims(
        (x, load, gam, rest),
        (first, Let(over, load - square), *others),
        tuple(values),
        tuple(1 / stiffness(bends) for bends in (True, False)),
        {x: x_h, load: kap, rest: 1 - gam},
        reduce,
    )


total, d, low, F, small, even = sp.symbols("S d low F small even", positive=True)
alike, bending_part, bending, stretching = sp.symbols(
    "alike bending_part bending stretching", positive=True
)
shc_d, shc_S, shc_p, shc_q = sp.symbols("shc_d shc_S shc_p shc_q", positive=True)
fading_p, fading_q, tanh_p, tanh_q = sp.symbols("fading_p fading_q tanh_p tanh_q", positive=True)


def _bracket() -> tuple[Let | Several | Choice, ...]:
    """Return 2 (1 - gam) F/(cosh p cosh q) = [tanh(q)/q - tanh(p)/p]/kap without cancellation."""
    unlike, near = sp.Gt(p, 2 * q), sp.Ge(NEAR, total)
    apart = (tanh_q - tanh_p) / load
    together = -expm1(-2 * total) - 2 * total * fading_q * shc_d
    together *= rest / (p * q * total) / ((1 + fading_p) * (1 + fading_q))
    end = "guard at the end of the power series for points outside its range"
    return (
        Choice(low, near, total, NEAR, unclaimed="no", reason=end),
        Several((F,), "series", (low**2, GUARDED(d, low) ** 2), (differences(),)),
        Let(small, 2 * rest * F / (sp.cosh(GUARDED(p, low)) * sp.cosh(GUARDED(q, low)))),
        Choice(alike, unlike, apart, together, safe_yes={load: sp.Integer(1)}, safe_no={q: p}),
        Choice(bending_part, near, small, alike),
    )


@named_routine
def slow() -> Claims:
    """Return 1/Ba and 1/Bs for kap <= x^2, where p and q are real."""
    statements = (
        Let(square, x * x),
        Let(p, sp.sqrt(square - gam * load)),
        Let(q, sp.sqrt(square - load)),
        Let(total, p + q),
        Let(d, rest * load / total, "p - q", means=p - q),
        Several((shc_d,), "shc", (d,), (scaled_shc(p - q),)),
        Let(fading_p, sp.exp(-2 * p)),
        Let(fading_q, sp.exp(-2 * q)),
        Let(tanh_p, sp.tanh(p) / p),
        Several((tanh_q,), "tanhc", (q,), (sp.tanh(q) / q,)),
        *_bracket(),
        Let(bending, 4 * square * (q * q * bending_part) - load * tanh_p),
        Several((shc_S,), "shc", (total,), (scaled_shc(p + q),)),
        Several((shc_p,), "shc", (p,), (scaled_shc(p),)),
        Several((shc_q,), "shc", (q,), (scaled_shc(q),)),
        Let(even, (shc_S + fading_q * shc_d) / (shc_p * shc_q)),
        Let(stretching, 2 * square * rest * even - load / tanh_p),
    )
    return Claims(
        (x, load, gam, rest),
        statements,
        (1 / (2 * bending), p * p / (2 * stretching)),
        tuple(1 / stiffness(bends) for bends in (True, False)),
        {x: x_h, load: kap, rest: 1 - gam},
        reduce_exponentials,
    )


ROUTINES = (partial(zero_of, True), partial(zero_of, False), fast, slow)
