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
from derivation.rewrite.form import CLOSELY, LOST, TIMES, Branch, Seam, Step
from derivation.rewrite.sections import sections

t, u, v = sp.symbols("t u v", real=True)
square_T, square_x, square_t = sp.symbols("square_T square_x square_t", real=True)
rise, narrow, zeta = sp.symbols("rise narrow zeta", real=True)
odd_u, odd_v, odd_T, far_u, far_v, decay = sp.symbols(
    "odd_u odd_v odd_T far_u far_v decay", real=True
)
near, depth, slip, beyond, fade, tail = sp.symbols("near depth slip beyond fade tail", real=True)
dist, height, rest_u, base = sp.symbols("dist height rest_u base", real=True)
alpha, beta, level = sp.symbols("alpha beta level", real=True)
sum_u, sum_v, less_u, less_v = sp.symbols("sum_u sum_v less_u less_v", real=True)
head, over, core = sp.symbols("head over core", real=True)
versine, cubic, minus, plus = sp.symbols("versine cubic minus plus", real=True)
c, c_less_1, modulus = sp.symbols("c c_less_1 modulus", real=True)
sinh_x, sinh_t, cosh_x, cosh_t = sp.symbols("sinh_x sinh_t cosh_x cosh_t", real=True)
bending, stretching, flat = sp.symbols("bending stretching flat", real=True)
small_x, small_t, lift, gain, growth = sp.symbols("small_x small_t lift gain growth", real=True)

Shape = tuple[tuple[Step, ...], sp.Expr | Seam]

THIN = sp.Rational(5, 2)
"""Below this T, stresses are computed by Taylor sections. S_rr and S_tt change over together:
their sum is small where Poisson's ratio is almost -1, and their roundings are to cancel there."""

CROSSING = sp.Integer(3)
"""The same for the radial displacement."""

ONCE = sp.Integer(512)
"""e^(-v) is applied in one piece up to this v; e^(-745) is the smallest double."""

STEP_T = Step(T, 2 * phi * h)
DEPTHS = (
    STEP_T,
    Step(u, phi * (h + z), "from the far face"),
    Step(v, phi * (h - z), "from the loaded face"),
)
FADES = (
    Step(fade, sp.exp(-sp.Min(v, ONCE)), "decay from the loaded face"),
    Step(beyond, sp.Min(v, ONCE) - v),
    Step(tail, sp.exp(beyond), "the rest of it, lest it underflow alone"),
)
EXACT_FADES = (
    Step(depth, h - z),
    Step(slip, phi * (h - depth - z), "what rounding h - z takes from v, exactly"),
    *FADES[:-1],
    Step(tail, sp.exp(beyond - slip), FADES[-1].comment),
)
EXACT_U = (
    Step(dist, h + z),
    Step(height, dist - h),
    Step(rest_u, phi * (z - height) + LOST(phi, dist), "what rounding takes from u"),
    Step(far_u, sp.exp(-2 * u) * (1 - 2 * rest_u), "decay on the way to the far face and back"),
)
EXACT_V = (
    Step(depth, h - z),
    Step(slip, phi * (h - depth - z) + LOST(phi, depth), "what rounding takes from v"),
)
FADED = (fade, 1, tail, 1)
FAR_U = Step(far_u, sp.exp(-2 * u), "decay on the way to the far face and back")
FAR_V = Step(far_v, sp.exp(-2 * v))
ODD_U = Step(odd_u, -expm1(-2 * u), "2 e^(-u) sinh u")
ODD_V = Step(odd_v, -expm1(-2 * v), "2 e^(-v) sinh v")
ODD_T = Step(odd_T, -expm1(-2 * T), "2 e^(-T) sinh T")
DECAY = Step(decay, sp.exp(-2 * T))
SUM_U, SUM_V = "2 e^(-u) (c sinh u - v cosh u)", "the same with u for v"


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
    pair = blocks()["sinh_pair"]
    excess, rest, share, others = sp.symbols("excess rest share others", real=True)
    steps = (
        *DEPTHS,
        Step(near, pair.near(T)),
        Step(excess, 1 / (1 + lam / mu), "1 - 2 nu"),
        Step(ratio, 1 + excess, "2 (1 - nu)"),
        FAR_U,
        FAR_V,
        DECAY,
        ODD_U,
        ODD_V,
        ODD_T,
        *EXACT_FADES,
        Step(rest, excess + (v * odd_u + far_u * ratio), "in thick plates the half-space's less 1"),
        Step(share, decay * (odd_T + 4 * T**2) * (1 + rest), "what sinh^2 T/D exceeds 1 by"),
        Step(over, 2 * T * far_u * (ratio * (1 + far_v) + u * odd_v)),
        Step(others, near**3 * rest + (share + over) / near / pair(T)),
        Step(core, near**3 + others),
    )
    return steps, CLOSELY(core / 2, *FADED, A_j, 1, mu, -1, phi, -1, near, -3)


def _axial() -> Shape:
    """S_zz; in plates of no thickness alpha^2 (1 + 2 beta), to which the rest is added."""
    known = sections()
    square_of, cubic_of = known["cosh_square"], known["sinh_cubic"]
    quartic_of, quintic_of = known["cosh_quartic"], known["sinh_quintic"]
    both, fifth, third, first = sp.symbols("both fifth third first", real=True)
    thin = Branch(
        (
            Step(both, 2 + T**2 * cubic_of(T**2), "(sinh T + T)/T"),
            Step(fifth, T**2 * quintic_of(T**2)),
            Step(
                third,
                u**2 * quartic_of(u**2)
                + v**2 * square_of(u**2) * cubic_of(v**2) / both
                - 3 * fifth,
                "what the faces of a plate of no thickness leave of the term in beta",
            ),
            Step(
                first,
                u**2 * quintic_of(u**2) + v**2 * cubic_of(u**2) * square_of(v**2) / both - fifth,
                "and of the term in alpha",
            ),
            Step(over, (beta * third + alpha * first) / cubic_of(T**2)),
            Step(core, alpha**2 * (1 + (2 * beta + over))),
        ),
        TIMES(core, A_j, 1),
        {T: sp.Integer(1), u: sp.Rational(1, 2), v: sp.Rational(1, 2)},
    )
    thick = Branch(
        (
            DECAY,
            ODD_T,
            ODD_V,
            FAR_V,
            *FADES,
            Step(versine, expm1(-u) ** 2, "2 e^(-u) (cosh u - 1)"),
            Step(cubic, blocks()["sinh_minus"](u) * blocks()["sinh_minus"].near(u) ** 3),
            Step(head, odd_T * (v * versine + cubic)),
            Step(over, T * sp.exp(-u) * (odd_v * versine + (1 + far_v) * cubic)),
            Step(core, (head + over) / (1 - decay * (4 * T**2 + 2 - decay))),
        ),
        TIMES(core, *FADED, A_j, 1),
        {T: THIN, u: sp.Integer(1), v: sp.Integer(1)},
    )
    return (*DEPTHS, *FRACTIONS), Seam(T, THIN, thin, thick)


FRACTIONS = (
    Step(alpha, (h + z) / (2 * h), "u/T"),
    Step(beta, (h - z) / (2 * h), "v/T"),
)


def _shear() -> Shape:
    """S_rz, which vanishes on both faces."""
    cubic_of = sections()["sinh_cubic"]
    thin = Branch(
        (
            Step(plus, 1 + T**2 * cubic_of(T**2), "sinh T/T"),
            Step(
                over,
                (plus * u**2 * cubic_of(u**2) + v**2 * cubic_of(v**2)) / (1 + plus),
                "small beside 1",
            ),
            Step(core, alpha * beta * (1 + over) / cubic_of(T**2)),
        ),
        -TIMES(core, A_j, 1, T, -1),
        {T: sp.Integer(1), u: sp.Rational(1, 2), v: sp.Rational(1, 2)},
    )
    thick = Branch(
        (
            DECAY,
            ODD_T,
            ODD_U,
            ODD_V,
            FAR_U,
            *FADES,
            Step(over, odd_T * v * odd_u + 2 * T * far_u * u * odd_v),
            Step(core, over / (1 - decay * (4 * T**2 + 2 - decay))),
        ),
        -TIMES(core, *FADED, A_j, 1),
        {T: THIN, u: sp.Integer(1), v: sp.Integer(1)},
    )
    return (*DEPTHS, *FRACTIONS), Seam(T, THIN, thin, thick)


MIDDLE = (Step(t, phi * z), Step(zeta, z / (2 * h), "t/T"))
GUARDS = {T: sp.Integer(1), t: sp.Integer(0)}


def _of_middle(*unused: sp.Symbol) -> tuple[Step, ...]:
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
        Step(level, 6 * zeta / square_T, "bending in a plate of no thickness"),
    )
    return tuple(step for step in steps if step.symbol not in unused)


def _growth() -> Step:
    """What `level` is to be multiplied by, less 1."""
    quintic_of = sections()["sinh_quintic"]
    return Step(
        growth,
        (cosh_x * small_t + rise - 6 * square_T * quintic_of(square_T)) / (6 * cubic),
        "cosh x sinh t/(6 t cubic) exceeds 1 by",
    )


def _gap() -> tuple[Step, Step]:
    """What stretching has but for Poisson's ratio, even in z."""
    return (
        Step(narrow, square_x * sections()["cosh_cubic"](square_x), "cosh x - sinh x/x"),
        Step(stretching, (square_t * sinh_t * sinh_x - narrow * versine) - narrow, "even in z"),
    )


DETERMINANT = Step(core, over / (1 - decay * (4 * T**2 + 2 - decay)))
"""Both faces' shares over 4 e^(-2T) D."""


def _radial_displacement() -> Shape:
    """Half the sum in plane, c = 1 - 2 nu.

    Where c is small, cosh x cosh t and x sinh x sinh t in bending cancel: it is
    1 - (x^2 - t^2)/2 and what is small beside that. From the faces, c - v and e^(-2u) are what
    roundings matter in: of u and v, and of c, which is known best by its distance from 0 or 1.
    """
    quartic_of = sections()["cosh_quartic"]
    above_x, above_t, mixed, others = sp.symbols("above_x above_t mixed others", real=True)
    sag, bent, even = sp.symbols("sag bent even", real=True)
    offset, shift, tip, rest = sp.symbols("offset shift tip rest", real=True)
    scale = (A_j, 1, mu, -1, phi, -2)
    made = {step.symbol: step for step in _of_middle()}
    middle = Branch(
        (
            *(made[s] for s in (square_T, square_x, square_t, small_x, small_t, sinh_x, sinh_t)),
            Step(above_x, square_x * quartic_of(square_x), "(cosh x - 1)/x^2 - 1/2"),
            Step(above_t, square_t * quartic_of(square_t)),
            Step(rise, square_x * (sp.Rational(1, 2) + above_x), "cosh x - 1"),
            Step(versine, square_t * (sp.Rational(1, 2) + above_t), "cosh t - 1"),
            *(made[s] for s in (cosh_x, cosh_t, lift)),
            Step(minus, square_T * sections()["sinh_cubic"](square_T), made[minus].comment),
            made[plus],
            Step(mixed, rise * versine - square_x * small_t * sinh_x),
            Step(others, square_x * (above_x - small_x) + (square_t * above_t + mixed)),
            Step(sag, (square_x - square_t) / 2 - others),
            Step(bent, 1 - sag, "cosh x cosh t - x sinh x sinh t/t"),
            Step(bending, bent + c * cosh_x * sinh_t, "odd in z, but for t"),
            *_gap(),
            Step(over, c_less_1 * lift + stretching, "small in thin plates"),
            Step(even, c_less_1 + over),
            Step(core, even + plus * zeta * bending / minus),
        ),
        CLOSELY(core / 2, *scale, plus, -1),
        GUARDS,
    )
    faces = Branch(
        (
            DECAY,
            Step(odd_T, 1 - decay, ODD_T.comment),
            FAR_V,
            *EXACT_U[:2],
            Step(rest_u, phi * (z - height), "what rounding h + z takes from u"),
            EXACT_U[3],
            *EXACT_V,
            *FADES,
            Step(base, sp.Heaviside(mu - lam, 1), "what c is closer to"),
            Step(offset, base - v),
            Step(shift, (mu * (1 - base) - base * lam) / modulus - slip),
            Step(less_v, offset + shift),
            Step(less_u, c - u),
            Step(sum_u, less_v - far_u * (c + v), SUM_U),
            Step(sum_v, less_u - far_v * (c + u), SUM_V),
            Step(head, odd_T * sum_u),
            Step(tip, 2 * T * far_u * sum_v),
            Step(rest, tip + slip * (head - tip), "with what e^(-v) lacks"),
            Step(over, head - rest),
            DETERMINANT,
        ),
        TIMES(core / 2, *FADED, *scale),
        {T: CROSSING},
    )
    elastic = (
        Step(modulus, lam + mu),
        Step(c, mu / modulus, "1 - 2 nu"),
        Step(c_less_1, -lam / modulus, "-2 nu"),
    )
    return (*DEPTHS, *elastic, *MIDDLE), Seam(T, CROSSING, middle, faces)


def _radial() -> Shape:
    """The sum in plane with c = 1; in thin plates twice `_hoop`'s with lam = modulus, nearly."""
    middle = Branch(
        (
            *_of_middle(lift, cosh_t),
            _growth(),
            Step(
                bending,
                2 * growth
                + (cosh_x * (versine - small_t) - square_x * sinh_t * sinh_x) / (6 * cubic),
                "what 2 grows by that `level` times it becomes the whole of bending",
            ),
            *_gap(),
            Step(core, 2 * level + (level * bending + stretching / plus)),
        ),
        TIMES(core, A_j, 1),
        GUARDS,
    )
    faces = Branch(
        (
            DECAY,
            Step(odd_T, 1 - decay, ODD_T.comment),
            FAR_V,
            *EXACT_U,
            *EXACT_V,
            *EXACT_FADES[2:],
            Step(less_v, 1 - v),
            Step(less_u, 1 - u),
            Step(sum_u, less_v - (slip + far_u * (1 + v)), SUM_U),
            Step(sum_v, less_u - far_v * (1 + u), SUM_V),
            Step(over, odd_T * sum_u - 2 * T * far_u * sum_v),
            DETERMINANT,
        ),
        TIMES(core, *FADED, A_j, 1),
        {T: THIN},
    )
    return (*DEPTHS, *MIDDLE), Seam(T, THIN, middle, faces)


def _hoop() -> Shape:
    """lam times the dilatation: the sum in plane with c = 1 and d = 0."""
    scale = (A_j, 1, lam, 1, modulus, -1)
    middle = Branch(
        (
            *_of_middle(sinh_x, sinh_t),
            _growth(),
            Step(gain, (4 * lift - 2 * minus) / plus, "4 (1 + lift)/plus - 1"),
            Step(over, level * growth + gain / 4),
            Step(
                flat,
                level + sp.Rational(1, 4),
                "in plates of no thickness; where it is small, exact",
            ),
            Step(core, flat + over),
        ),
        TIMES(core, *scale),
        GUARDS,
    )
    faces = Branch(
        (
            DECAY,
            Step(odd_T, 1 - decay, ODD_T.comment),
            ODD_V,
            *EXACT_U,
            *EXACT_V,
            *EXACT_FADES[2:],
            Step(over, odd_T * (1 - far_u) - 2 * T * far_u * odd_v),
            DETERMINANT,
        ),
        TIMES(core, *FADED, *scale),
        {T: THIN},
    )
    steps = (*DEPTHS, Step(modulus, lam + mu), *MIDDLE)
    return steps, Seam(T, THIN, middle, faces)
