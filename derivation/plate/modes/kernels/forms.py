"""Stable forms of one mode's displacements and stresses through the thickness.

Deflection, S_zz and S_rz, whose terms have one sign, are written here; the in-plane fields, whose
terms do not, are in `in_plane`; `steps` contains the notation and common steps.
"""

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.engine.rewrite.form import CLOSELY, TIMES, Branch, Step, Switch
from derivation.engine.rewrite.truncated_series import truncated_series
from derivation.plate.blocks import blocks
from derivation.plate.modes.kernels.in_plane import in_plane
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
    decay,
    deficit,
    exponential,
    far_u,
    far_v,
    ratio,
    rounding,
    u,
    v,
)
from derivation.plate.vocabulary import A_j, T, h, lam, mu, phi, z

odd_u, odd_v, odd_T = sp.symbols("odd_u odd_v odd_T", real=True)
square_T, square_u, square_v = sp.symbols("square_T square_u square_v", real=True)
rise, sag, alpha, beta = sp.symbols("rise sag alpha beta", real=True)
depth, near, both, surplus = sp.symbols("depth near both surplus", real=True)
excess, rest, others = sp.symbols("excess rest others", real=True)
head, over, core = sp.symbols("head over core", real=True)
versine, cubic, plus = sp.symbols("versine cubic plus", real=True)

ELASTIC = (
    Step(excess, 1 / (1 + lam / mu), "1 - 2 nu"),
    Step(ratio, 1 + excess, "2 (1 - nu)"),
)
FRACTIONS = (
    Step(rise, (h + z) / h),
    Step(sag, (h - z) / h),
    Step(alpha, rise / 2, "u/T"),
    Step(beta, sag / 2, "v/T"),
)
ODD_U = Step(odd_u, -expm1(-2 * u), "2 e^(-u) sinh u")
ODD_V = Step(odd_v, -expm1(-2 * v), "2 e^(-v) sinh v")
ODD_T = Step(odd_T, -expm1(-2 * T), "2 e^(-T) sinh T")


def mode_forms() -> dict[str, Shape]:
    """Return steps and value of every field of a mode."""
    plane = in_plane()
    return {
        "mode_f": _deflection(),
        "mode_g": plane["mode_g"],
        "mode_zz": _axial(),
        "mode_rz": _shear(),
        "mode_rr": plane["mode_rr"],
        "mode_tt": plane["mode_tt"],
    }


def _deflection() -> Shape:
    """Return a sum of terms of one sign; the terms added to 1 are summed first."""
    cubic_of = truncated_series()["sinh_cubic"]
    fields = (
        *DEPTHS,
        *ELASTIC,
        FAR_U,
        FAR_V,
        ODD_U,
        ODD_V,
        Step(depth, h - z),
        Step(rounding, phi * (h - depth - z), "exact correction of v for rounding of h - z"),
        Step(rest, excess + (v * odd_u + far_u * ratio), "half-space value - 1 in thick plates"),
    )
    by_far = 2 * T * (ratio * (1 + far_v) + u * odd_v)
    scale = (A_j, 1, mu, -1, phi, -1)

    def lacking(main: sp.Expr) -> Step:
        return Step(others, others - rounding * (main + others), "with the correction of e^(-v)")

    thin = Branch(
        (
            *fields,
            ODD_T,
            Step(exponential, sp.exp(-v), FADE.comment),
            Step(square_T, T**2),
            Step(cubic, cubic_of(square_T)),
            Step(both, 2 + square_T * cubic, "(sinh T + T)/T"),
            Step(surplus, (odd_T + 4 * square_T) * (1 + rest), "what e^(2T) sinh^2 T exceeds D by"),
            Step(over, by_far / far_v),
            Step(head, square_T * T),
            Step(others, head * rest + (surplus + over) / (4 * T * cubic * both)),
            lacking(head),
            Step(core, head + others),
        ),
        CLOSELY(core / 2, exponential, 1, *scale, T, -3),
    )
    thick = Branch(
        (
            *fields,
            FADE,
            Step(decay, far_u * far_v),
            Step(odd_T, 1 - decay, ODD_T.comment),
            LACK,
            Step(surplus, decay * (odd_T + 4 * T**2) * (1 + rest), "excess of sinh^2 T over D"),
            Step(over, by_far * far_u),
            Step(others, rest + (surplus + over) / (1 - deficit)),
            lacking(ONE),
            Step(core, 1 + others),
        ),
        CLOSELY(core / 2, *FADED, *scale),
    )
    return WHOLE_T, Switch(T, THIN, thin, thick)


def _axial() -> Shape:
    """Return S_zz: for zero thickness alpha^2 (1 + 2 beta), to which a correction is added."""
    known = truncated_series()
    square_of, cubic_of = known["cosh_square"], known["sinh_cubic"]
    quartic_of, quintic_of = known["cosh_quartic"], known["sinh_quintic"]
    fifth, third, first = sp.symbols("fifth third first", real=True)
    thin = Branch(
        (
            *DEPTHS,
            *FRACTIONS,
            Step(square_T, T**2),
            Step(square_u, u**2),
            Step(square_v, v**2),
            Step(cubic, cubic_of(square_T)),
            Step(both, 2 + square_T * cubic, "(sinh T + T)/T"),
            Step(fifth, square_T * quintic_of(square_T)),
            Step(
                third,
                square_u * quartic_of(square_u)
                + square_v * square_of(square_u) * cubic_of(square_v) / both
                - 3 * fifth,
                "remainder of the term in beta, which cancels for zero thickness",
            ),
            Step(
                first,
                square_u * quintic_of(square_u)
                + square_v * cubic_of(square_u) * square_of(square_v) / both
                - fifth,
                "remainder of the term in alpha",
            ),
            Step(over, (beta * third + alpha * first) / cubic),
            Step(core, alpha**2 * (1 + (2 * beta + over))),
        ),
        TIMES(core, A_j, 1),
    )
    minus = blocks()["sinh_minus"]
    thick = Branch(
        (
            *DEPTHS,
            DECAY,
            Step(odd_T, 1 - decay, ODD_T.comment),
            ODD_V,
            FAR_V,
            FADE,
            Step(versine, expm1(-u) ** 2, "2 e^(-u) (cosh u - 1)"),
            Step(near, minus.near(u)),
            Step(square_u, near**2),
            Step(cubic, minus(u) * square_u * near, "2 e^(-u) (sinh u - u)"),
            Step(head, odd_T * (v * versine + cubic)),
            Step(over, T * sp.exp(-u) * (odd_v * versine + (1 + far_v) * cubic)),
            Step(core, (head + over) / (1 - decay * (4 * T**2 + 2 - decay))),
        ),
        TIMES(core, *FADED, A_j, 1),
    )
    return WHOLE_T, Switch(T, THIN, thin, thick)


def _shear() -> Shape:
    """Return S_rz, which vanishes on both faces."""
    cubic_of = truncated_series()["sinh_cubic"]
    thin = Branch(
        (
            *DEPTHS,
            *FRACTIONS,
            Step(square_T, T**2),
            Step(square_u, u**2),
            Step(square_v, v**2),
            Step(cubic, cubic_of(square_T)),
            Step(plus, 1 + square_T * cubic, "sinh T/T"),
            Step(
                over,
                (plus * square_u * cubic_of(square_u) + square_v * cubic_of(square_v)) / (1 + plus),
                "small compared with 1",
            ),
            Step(core, alpha * beta * (1 + over) / cubic),
        ),
        -TIMES(core, A_j, 1, T, -1),
    )
    thick = Branch(
        (
            *DEPTHS,
            DECAY,
            Step(odd_T, 1 - decay, ODD_T.comment),
            ODD_U,
            ODD_V,
            FAR_U,
            FADE,
            Step(over, odd_T * v * odd_u + 2 * T * far_u * u * odd_v),
            Step(core, over / (1 - decay * (4 * T**2 + 2 - decay))),
        ),
        -TIMES(core, *FADED, A_j, 1),
    )
    return WHOLE_T, Switch(T, THIN, thin, thick)
