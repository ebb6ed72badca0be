"""Stable forms of one mode's in-plane fields: radial displacement, S_rr and S_tt.

In thin plates the contributions of both faces cancel, so that bending and extension are added
instead. In thick plates those would cancel.
"""

import sympy as sp

from derivation.engine.rewrite.form import CLOSELY, ROUNDING_ERROR, SUM, TIMES, Branch, Step, Switch
from derivation.engine.rewrite.truncated_series import truncated_series
from derivation.plate.modes.kernels.steps import (
    DECAY,
    DEPTHS,
    FADE,
    FADED,
    FAR_U,
    FAR_V,
    LACK,
    ONE,
    THIN,
    WHOLE_T,
    Shape,
    Steps,
    decay,
    deficit,
    far_u,
    far_v,
    rounding,
    u,
    v,
    x,
)
from derivation.plate.vocabulary import A_j, T, h, lam, mu, phi, z

t, zeta, narrow, gap = sp.symbols("t zeta narrow gap", real=True)
square_T, square_x, square_t = sp.symbols("square_T square_x square_t", real=True)
depth, distance, height, rest_u = sp.symbols("depth distance height rest_u", real=True)
rise, sag, excess, others = sp.symbols("rise sag excess others", real=True)
by_v, dominant, tip, rest = sp.symbols("by_v dominant tip rest", real=True)
over, core, level = sp.symbols("over core level", real=True)
versine, cubic, minus, plus = sp.symbols("versine cubic minus plus", real=True)
c, c_less_1, modulus = sp.symbols("c c_less_1 modulus", real=True)
sinh_x, sinh_t, cosh_x, cosh_t = sp.symbols("sinh_x sinh_t cosh_x cosh_t", real=True)
bending, stretching = sp.symbols("bending stretching", real=True)
small_x, small_t, lift, gain, lean = sp.symbols("small_x small_t lift gain lean", real=True)

CROSSING = sp.Integer(3)
"""Switch point of the radial displacement, like `THIN`."""

TO_FAR = (Step(distance, h + z), Step(height, distance - h))
REST_U = Step(rest_u, phi * (z - height), "correction of u for rounding of h + z")
EXACT_U = (
    *TO_FAR,
    Step(rest_u, REST_U.expression + ROUNDING_ERROR(phi, distance), "rounding correction of u"),
)
EXACT_V = (
    Step(depth, h - z),
    Step(
        rounding, phi * (h - depth - z) + ROUNDING_ERROR(phi, depth), "correction of v for rounding"
    ),
)
MIDDLE = (Step(t, phi * z), Step(zeta, z / h, "t/x"))


def in_plane() -> dict[str, Shape]:
    """Return steps and value of each of these fields."""
    return {"mode_g": _radial_displacement(), "mode_rr": _radial(), "mode_tt": _hoop()}


def _of_middle(*unused: sp.Symbol) -> Steps:
    """Return the factors of bending and extension, each divided by its power."""
    square_of, cubic_of = truncated_series()["cosh_square"], truncated_series()["sinh_cubic"]
    steps = (
        Step(square_T, T**2),
        Step(square_x, square_T / 4),
        Step(square_t, t**2),
        Step(small_x, square_x * cubic_of(square_x), "sinh x/x - 1"),
        Step(small_t, square_t * cubic_of(square_t), "sinh t/t - 1"),
        Step(sinh_x, 1 + small_x),
        Step(sinh_t, 1 + small_t),
        Step(rise, square_x * square_of(square_x), "cosh x - 1"),
        Step(versine, square_t * square_of(square_t), "cosh t - 1"),
        Step(cosh_x, 1 + rise),
        Step(cosh_t, 1 + versine),
        Step(lift, small_x * cosh_t + versine, "sinh x cosh t/x - 1"),
        Step(cubic, cubic_of(square_T)),
        Step(minus, square_T * cubic, "(sinh T - T)/T"),
        Step(plus, 4 + 2 * minus, "2 (sinh T + T)/T"),
        Step(level, 3 * zeta / square_T, "bending at zero thickness"),
    )
    return tuple(step for step in steps if step.symbol not in unused)


def _growth() -> Steps:
    """Return the growth of `level`, which both stresses share."""
    quintic_of = truncated_series()["sinh_quintic"]
    growth = (cosh_x * small_t + rise - 6 * square_T * quintic_of(square_T)) / (6 * cubic)
    return (
        Step(gain, growth, "cosh x sinh t/(6 t cubic) exceeds 1 by"),
        Step(lean, level * gain),
    )


def _from_faces(main: tuple[sp.Expr, ...], far: sp.Expr, less: sp.Expr) -> Steps:
    """Return both faces' in-plane terms over 4 e^(-2T) D, with the smallest possible divisor.

    They are the main terms, minus `far_u` times the back face's terms, minus the remainder.
    """
    return (
        LACK,
        Step(tip, far_u * far, "contribution of the back face"),
        Step(over, less - 2 * rest_u * tip),
        Step(dominant, sum(main) - (tip + over)),
        Step(
            rest,
            dominant * (deficit / (1 - deficit) - rounding) - over,
            "with the correction of e^(-v)",
        ),
        Step(core, SUM(*main, -tip, rest)),
    )


def _radial_displacement() -> Shape:
    """Return half the in-plane sum, c = 1 - 2 nu.

    Where c is small, cosh x cosh t and x sinh x sinh t in bending cancel to
    1 - (x^2 - t^2)/2 and smaller terms. Any one of three terms may dominate, or cancel the others:
    they are added with compensation, rounding errors of x and v included.
    """
    quartic_of = truncated_series()["cosh_quartic"]
    above_x, above_t, mixed = sp.symbols("above_x above_t mixed", real=True)
    bending_part = sp.Symbol("bending_part", real=True)
    base, shift = sp.symbols("base shift", real=True)
    scale = (A_j, 1, mu, -1, phi, -2)
    elastic = (
        Step(modulus, lam + mu),
        Step(c, mu / modulus, "1 - 2 nu"),
        Step(base, sp.Heaviside(mu - lam, 1), "the number 0 or 1 that is closer to c"),
        Step(shift, (mu * (1 - base) - base * lam) / modulus, "difference of c and that number"),
    )
    made = {step.symbol: step for step in _of_middle()}
    middle = Branch(
        (
            *elastic,
            Step(t, phi * z),
            Step(c_less_1, -lam / modulus, "-2 nu"),
            Step(
                gap,
                2 * x * ROUNDING_ERROR(phi, h) + ROUNDING_ERROR(x, x),
                "correction of x^2 for rounding",
            ),
            Step(square_x, x**2 + gap),
            *(made[s] for s in (square_t, small_x, small_t, sinh_x, sinh_t)),
            Step(above_x, square_x * quartic_of(square_x), "(cosh x - 1)/x^2 - 1/2"),
            Step(above_t, square_t * quartic_of(square_t)),
            Step(rise, square_x * (sp.Rational(1, 2) + above_x), "cosh x - 1"),
            Step(versine, square_t * (sp.Rational(1, 2) + above_t), "cosh t - 1"),
            *(made[s] for s in (cosh_x, cosh_t, lift)),
            Step(minus, small_x * cosh_x + rise, "(sinh T - T)/T"),
            made[plus],
            Step(mixed, rise * versine - square_x * small_t * sinh_x),
            Step(others, square_x * (above_x - small_x) + (square_t * above_t + mixed)),
            Step(sag, (square_x - square_t) / 2 - others),
            Step(bending_part, c * (rise * sinh_t + small_t) - sag),
            Step(
                bending_part,
                1 + (c + bending_part),
                "cosh x cosh t + (c cosh x - x sinh x) sinh t/t",
            ),
            Step(bending, CLOSELY(bending_part / 2, plus, 1, minus, -1, z, 1, h, -1), "odd in z"),
            Step(gap, square_x**2 * truncated_series()["cosh_quintic"](square_x)),
            Step(narrow, square_x / 3 + gap, "cosh x - sinh x/x"),
            Step(stretching, square_t * sinh_t * sinh_x - narrow * versine - gap),
            Step(rest, c_less_1 * lift + stretching, "small in thin plates"),
            Step(core, SUM(bending, base - 1, shift, -square_x / 3, rest)),
        ),
        CLOSELY(core / 2, *scale, plus, -1),
    )
    faces = Branch(
        (
            *DEPTHS,
            *elastic,
            FAR_U,
            FAR_V,
            Step(decay, far_u * far_v),
            *TO_FAR,
            REST_U,
            *EXACT_V,
            FADE,
            Step(plus, c + v),
            Step(by_v, c - v - (2 * T * (c + u) + far_u * plus)),
            *_from_faces((base, -v, shift), plus + 2 * T * (c - u), rounding + decay * by_v),
        ),
        TIMES(core / 2, *FADED, *scale),
    )
    return WHOLE_T, Switch(T, CROSSING, middle, faces)


def _radial() -> Shape:
    """Return the in-plane sum for c = 1; in thin plates nearly twice `_hoop` for lam = modulus."""
    middle = Branch(
        (
            *MIDDLE,
            *_of_middle(lift, cosh_t),
            *_growth(),
            Step(
                bending,
                (cosh_x * (versine - small_t) - square_x * sinh_t * sinh_x) / (6 * cubic),
                "factor of `level` that gives the bending part of twice mode_tt",
            ),
            Step(gap, square_x * truncated_series()["cosh_quintic"](square_x)),
            Step(narrow, square_x * (sp.Rational(1, 3) + gap), "cosh x - sinh x/x"),
            Step(stretching, (square_t * sinh_t * sinh_x - narrow * versine) - narrow, "even in z"),
            Step(core, SUM(2 * level, 2 * lean, level * bending + stretching / plus)),
        ),
        TIMES(core, A_j, 1),
    )
    faces = Branch(
        (
            *DEPTHS,
            DECAY,
            FAR_U,
            *EXACT_U,
            *EXACT_V,
            FADE,
            Step(plus, 1 + v),
            Step(by_v, 1 - v - (2 * T * (1 + u) + far_u * plus)),
            *_from_faces((ONE, -v), plus + 2 * T * (1 - u), rounding + decay * by_v),
        ),
        TIMES(core, *FADED, A_j, 1),
    )
    return WHOLE_T, Switch(T, THIN, middle, faces)


def _hoop() -> Shape:
    """Return lam times the dilatation: the in-plane sum for c = 1 and d = 0."""
    scale = (A_j, 1, lam, 1, modulus, -1)
    elastic = Step(modulus, lam + mu)
    middle = Branch(
        (
            elastic,
            *MIDDLE,
            *_of_middle(sinh_x, sinh_t),
            *_growth(),
            Step(excess, (4 * lift - 2 * minus) / plus, "4 (1 + lift)/plus - 1"),
            Step(core, SUM(level, sp.Rational(1, 4), lean, excess / 4)),
        ),
        CLOSELY(core, *scale),
    )
    faces = Branch(
        (
            *DEPTHS,
            elastic,
            DECAY,
            FAR_U,
            *EXACT_U,
            *EXACT_V,
            FADE,
            *_from_faces((ONE,), 1 + 2 * T, decay * (1 - (2 * T + far_u))),
        ),
        TIMES(core, *FADED, *scale),
    )
    return WHOLE_T, Switch(T, THIN, middle, faces)
