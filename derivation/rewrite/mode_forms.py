"""Stable forms of one mode's displacements and stresses through the thickness.

Notation: x = phi h, T = 2x, t = phi z, u = phi (h + z), v = phi (h - z), so that u + v = T.
With D = sinh^2 T - T^2, every field is a multiple of

    deflection  [sinh T (ratio cosh u + v sinh u) + T (ratio cosh v + u sinh v)]/D
    S_zz        [sinh T (v (cosh u - 1) + sinh u - u) + T (sinh v (cosh u - 1)
                + cosh v (sinh u - u))]/D
    S_rz        [sinh T v sinh u + T u sinh v]/D
    in plane    [sinh T (c sinh u - d v cosh u) - T (c sinh v - d u cosh v)]/D

The terms of the first three are of one sign. In plane they are not: in thin plates the
shares of both faces cancel, and bending and stretching are added instead. In thick ones
those would cancel. Thick plates take decaying exponentials, e^(-v) in front and e^(-2u)
for what comes by way of the far face; thin ones Taylor sections. What may be very large or
small is left to `times`, or to `times_closely` where its roundings are most of what the
budget allows.
"""

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.formula.symbols import A_j, T, h, lam, mu, phi, z
from derivation.rewrite.automatic import ratio
from derivation.rewrite.blocks import blocks
from derivation.rewrite.form import CLOSELY, LOST, ONCE, SUM, TAIL, TIMES, Branch, Seam, Step
from derivation.rewrite.sections import sections

t, u, v, x = sp.symbols("t u v x", real=True)
square_T, square_x, square_t = sp.symbols("square_T square_x square_t", real=True)
rise, sag, narrow, zeta = sp.symbols("rise sag narrow zeta", real=True)
odd_u, odd_v, odd_T, far_u, far_v, decay = sp.symbols(
    "odd_u odd_v odd_T far_u far_v decay", real=True
)
depth, slip, fade, rest = sp.symbols("depth slip fade rest", real=True)
dist, height, rest_u, gap = sp.symbols("dist height rest_u gap", real=True)
square_u, square_v, near = sp.symbols("square_u square_v near", real=True)
excess, share, others, both = sp.symbols("excess share others both", real=True)
alpha, beta, level = sp.symbols("alpha beta level", real=True)
by_v, whole, tip, lack = sp.symbols("by_v whole tip lack", real=True)
head, over, core = sp.symbols("head over core", real=True)
versine, cubic, minus, plus = sp.symbols("versine cubic minus plus", real=True)
c, c_less_1, modulus = sp.symbols("c c_less_1 modulus", real=True)
sinh_x, sinh_t, cosh_x, cosh_t = sp.symbols("sinh_x sinh_t cosh_x cosh_t", real=True)
bending, stretching = sp.symbols("bending stretching", real=True)
small_x, small_t, lift, gain, lean = sp.symbols("small_x small_t lift gain lean", real=True)

Steps = tuple[Step, ...]
Shape = tuple[Steps, sp.Expr | Seam]
ONE = sp.Integer(1)

THIN = sp.Rational(9, 4)
"""Below this T, deflection and stresses are computed by Taylor sections. S_rr and S_tt change
over together: their sum is small where Poisson's ratio is almost -1, and their roundings are to
cancel there."""

CROSSING = sp.Integer(3)
"""The same for the radial displacement."""

WHOLE_T = (Step(x, phi * h), Step(T, 2 * x))
DEPTHS = (
    Step(u, phi * (h + z), "from the far face"),
    Step(v, phi * (h - z), "from the loaded face"),
)
ELASTIC = (
    Step(excess, 1 / (1 + lam / mu), "1 - 2 nu"),
    Step(ratio, 1 + excess, "2 (1 - nu)"),
)
FADE = Step(fade, sp.exp(-sp.Min(v, ONCE)), "decay from the loaded face")
FADED = (fade, 1, TAIL(v), 1)
TO_FAR = (Step(dist, h + z), Step(height, dist - h))
REST_U = Step(rest_u, phi * (z - height), "what rounding h + z takes from u")
EXACT_U = (*TO_FAR, Step(rest_u, REST_U.expression + LOST(phi, dist), "what rounding takes from u"))
EXACT_V = (
    Step(depth, h - z),
    Step(slip, phi * (h - depth - z) + LOST(phi, depth), "what rounding takes from v"),
)
FAR_U = Step(far_u, sp.exp(-2 * u), "decay on the way to the far face and back")
FAR_V = Step(far_v, sp.exp(-2 * v))
ODD_U = Step(odd_u, -expm1(-2 * u), "2 e^(-u) sinh u")
ODD_V = Step(odd_v, -expm1(-2 * v), "2 e^(-v) sinh v")
ODD_T = Step(odd_T, -expm1(-2 * T), "2 e^(-T) sinh T")
DECAY = Step(decay, sp.exp(-2 * T))
LACK = Step(lack, decay * (4 * T**2 + 2 - decay), "what 4 e^(-2T) D lacks of 1")


def mode_forms() -> dict[str, Shape]:
    """Steps and value of every field of a mode."""
    return {
        "mode_f": _deflection(),
        "mode_g": _radial_displacement(),
        "mode_zz": _axial(),
        "mode_rz": _shear(),
        "mode_rr": _radial(),
        "mode_tt": _hoop(),
    }


def _deflection() -> Shape:
    """A sum of terms of one sign; what stands beside 1 is added up first."""
    cubic_of = sections()["sinh_cubic"]
    fields = (
        *DEPTHS,
        *ELASTIC,
        FAR_U,
        FAR_V,
        ODD_U,
        ODD_V,
        Step(depth, h - z),
        Step(slip, phi * (h - depth - z), "what rounding h - z takes from v, exactly"),
        Step(rest, excess + (v * odd_u + far_u * ratio), "in thick plates the half-space's less 1"),
    )
    by_far = 2 * T * (ratio * (1 + far_v) + u * odd_v)
    scale = (A_j, 1, mu, -1, phi, -1)

    def lacking(main: sp.Expr) -> Step:
        return Step(others, others - slip * (main + others), "with what e^(-v) lacks")

    thin = Branch(
        (
            *fields,
            ODD_T,
            Step(fade, sp.exp(-v), FADE.comment),
            Step(square_T, T**2),
            Step(cubic, cubic_of(square_T)),
            Step(both, 2 + square_T * cubic, "(sinh T + T)/T"),
            Step(share, (odd_T + 4 * square_T) * (1 + rest), "what e^(2T) sinh^2 T exceeds D by"),
            Step(over, by_far / far_v),
            Step(head, square_T * T),
            Step(others, head * rest + (share + over) / (4 * T * cubic * both)),
            lacking(head),
            Step(core, head + others),
        ),
        CLOSELY(core / 2, fade, 1, *scale, T, -3),
    )
    thick = Branch(
        (
            *fields,
            FADE,
            Step(decay, far_u * far_v),
            Step(odd_T, 1 - decay, ODD_T.comment),
            LACK,
            Step(share, decay * (odd_T + 4 * T**2) * (1 + rest), "what sinh^2 T exceeds D by"),
            Step(over, by_far * far_u),
            Step(others, rest + (share + over) / (1 - lack)),
            lacking(ONE),
            Step(core, 1 + others),
        ),
        CLOSELY(core / 2, *FADED, *scale),
    )
    return WHOLE_T, Seam(T, THIN, thin, thick)


def _axial() -> Shape:
    """S_zz; in plates of no thickness alpha^2 (1 + 2 beta), to which the rest is added."""
    known = sections()
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
                "what the faces of a plate of no thickness leave of the term in beta",
            ),
            Step(
                first,
                square_u * quintic_of(square_u)
                + square_v * cubic_of(square_u) * square_of(square_v) / both
                - fifth,
                "and of the term in alpha",
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
    return WHOLE_T, Seam(T, THIN, thin, thick)


FRACTIONS = (
    Step(rise, (h + z) / h),
    Step(sag, (h - z) / h),
    Step(alpha, rise / 2, "u/T"),
    Step(beta, sag / 2, "v/T"),
)


def _shear() -> Shape:
    """S_rz, which vanishes on both faces."""
    cubic_of = sections()["sinh_cubic"]
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
                "small beside 1",
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
    return WHOLE_T, Seam(T, THIN, thin, thick)


MIDDLE = (Step(t, phi * z), Step(zeta, z / h, "t/x"))


def _of_middle(*unused: sp.Symbol) -> Steps:
    """What bending and stretching are made of, each over its power, but for what is unused."""
    square_of, cubic_of = sections()["cosh_square"], sections()["sinh_cubic"]
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
        Step(level, 3 * zeta / square_T, "bending in a plate of no thickness"),
    )
    return tuple(step for step in steps if step.symbol not in unused)


def _growth() -> Steps:
    """What `level` grows by, the same for both stresses."""
    quintic_of = sections()["sinh_quintic"]
    growth = (cosh_x * small_t + rise - 6 * square_T * quintic_of(square_T)) / (6 * cubic)
    return (
        Step(gain, growth, "cosh x sinh t/(6 t cubic) exceeds 1 by"),
        Step(lean, level * gain),
    )


def _from_faces(main: tuple[sp.Expr, ...], far: sp.Expr, less: sp.Expr) -> Steps:
    """Both faces' shares in plane over 4 e^(-2T) D, divided by as little as possible.

    The main terms, less `far_u` times what comes by way of the far face, and less the rest.
    """
    return (
        LACK,
        Step(tip, far_u * far, "by way of the far face"),
        Step(over, less - 2 * rest_u * tip),
        Step(whole, sum(main) - (tip + over)),
        Step(rest, whole * (lack / (1 - lack) - slip) - over, "with what e^(-v) lacks"),
        Step(core, SUM(*main, -tip, rest)),
    )


def _radial_displacement() -> Shape:
    """Half the sum in plane, c = 1 - 2 nu.

    Where c is small, cosh x cosh t and x sinh x sinh t in bending cancel: it is
    1 - (x^2 - t^2)/2 and what is small beside that. Three terms may each be all there is, or
    cancel the others: they are added closely, what rounding takes from x and v with them.
    """
    quartic_of = sections()["cosh_quartic"]
    above_x, above_t, mixed = sp.symbols("above_x above_t mixed", real=True)
    bent = sp.Symbol("bent", real=True)
    base, shift = sp.symbols("base shift", real=True)
    scale = (A_j, 1, mu, -1, phi, -2)
    elastic = (
        Step(modulus, lam + mu),
        Step(c, mu / modulus, "1 - 2 nu"),
        Step(base, sp.Heaviside(mu - lam, 1), "what c is closer to"),
        Step(shift, (mu * (1 - base) - base * lam) / modulus, "what it is off by"),
    )
    made = {step.symbol: step for step in _of_middle()}
    middle = Branch(
        (
            *elastic,
            Step(t, phi * z),
            Step(c_less_1, -lam / modulus, "-2 nu"),
            Step(gap, 2 * x * LOST(phi, h) + LOST(x, x), "what rounding takes from x^2"),
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
            Step(bent, c * (rise * sinh_t + small_t) - sag),
            Step(bent, 1 + (c + bent), "cosh x cosh t + (c cosh x - x sinh x) sinh t/t"),
            Step(bending, CLOSELY(bent / 2, plus, 1, minus, -1, z, 1, h, -1), "odd in z"),
            Step(gap, square_x**2 * sections()["cosh_quintic"](square_x)),
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
            *_from_faces((base, -v, shift), plus + 2 * T * (c - u), slip + decay * by_v),
        ),
        TIMES(core / 2, *FADED, *scale),
    )
    return WHOLE_T, Seam(T, CROSSING, middle, faces)


def _radial() -> Shape:
    """The sum in plane with c = 1; in thin plates twice `_hoop`'s with lam = modulus, nearly."""
    middle = Branch(
        (
            *MIDDLE,
            *_of_middle(lift, cosh_t),
            *_growth(),
            Step(
                bending,
                (cosh_x * (versine - small_t) - square_x * sinh_t * sinh_x) / (6 * cubic),
                "what `level` times it makes the whole of bending of twice `_hoop`'s",
            ),
            Step(gap, square_x * sections()["cosh_quintic"](square_x)),
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
            *_from_faces((ONE, -v), plus + 2 * T * (1 - u), slip + decay * by_v),
        ),
        TIMES(core, *FADED, A_j, 1),
    )
    return WHOLE_T, Seam(T, THIN, middle, faces)


def _hoop() -> Shape:
    """lam times the dilatation: the sum in plane with c = 1 and d = 0."""
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
    return WHOLE_T, Seam(T, THIN, middle, faces)
