"""Stable forms of one mode's displacements and stresses through the thickness.

Notation: x = phi h, T = 2x, t = phi z, u = phi (h + z), v = phi (h - z), so that u + v = T.
With D = sinh^2 T - T^2, every field is a multiple of

    deflection  [sinh T (ratio cosh u + v sinh u) + T (ratio cosh v + u sinh v)]/D
    S_zz        [sinh T (v (cosh u - 1) + sinh u - u) + T (sinh v (cosh u - 1)
                + cosh v (sinh u - u))]/D
    S_rz        [sinh T v sinh u + T u sinh v]/D
    in plane    [sinh T (c sinh u - d v cosh u) - T (c sinh v - d u cosh v)]/D

The terms of the first three are of one sign. In plane they are not: near the middle of
the plate the shares of both faces cancel, and bending and stretching are added instead.
Far from it, and in thick plates, those would cancel. Thick plates take decaying
exponentials, e^(-v) in front and e^(-2u) for what comes by way of the far face; thin ones
Taylor sections. What may be very large or small is left to `times`.
"""

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.formula.symbols import A_j, T, h, lam, mu, phi, z
from derivation.rewrite.automatic import ratio
from derivation.rewrite.blocks import blocks
from derivation.rewrite.form import TIMES, Branch, Seam, Step
from derivation.rewrite.sections import sections

x, t, u, v = sp.symbols("x t u v", real=True)
odd_u, odd_v, odd_T, far_u, far_v, decay = sp.symbols(
    "odd_u odd_v odd_T far_u far_v decay", real=True
)
near, depth, slip, beyond, fade, tail = sp.symbols("near depth slip beyond fade tail", real=True)
alpha, beta, zeta = sp.symbols("alpha beta zeta", real=True)
sum_u, sum_v, less_u, less_v = sp.symbols("sum_u sum_v less_u less_v", real=True)
head, over, core = sp.symbols("head over core", real=True)
versine, cubic, minus, plus, reach = sp.symbols("versine cubic minus plus reach", real=True)
c, c_less_1, modulus = sp.symbols("c c_less_1 modulus", real=True)
sinh_x, sinh_t, cosh_x, cosh_t = sp.symbols("sinh_x sinh_t cosh_x cosh_t", real=True)
bending, stretching = sp.symbols("bending stretching", real=True)
small_x, small_t, lift, gain, growth = sp.symbols("small_x small_t lift gain growth", real=True)

Shape = tuple[tuple[Step, ...], sp.Expr | Seam]

THIN = sp.Rational(5, 2)
"""Below this T, S_zz, S_rz and S_tt are computed by Taylor sections."""

MIDST = sp.Rational(7, 2)
"""Below this T, bending and stretching are added up where |t| is below a tenth of it."""

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
FADED = (fade, 1, tail, 1)
FAR_U = Step(far_u, sp.exp(-2 * u), "decay on the way to the far face and back")
FAR_V = Step(far_v, sp.exp(-2 * v))
ODD_U = Step(odd_u, -expm1(-2 * u), "2 e^(-u) sinh u")
ODD_V = Step(odd_v, -expm1(-2 * v), "2 e^(-v) sinh v")
ODD_T = Step(odd_T, -expm1(-2 * T), "2 e^(-T) sinh T")
DECAY = Step(decay, sp.exp(-2 * T))


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
    return steps, TIMES(core / 2, *FADED, A_j, 1, mu, -1, phi, -1, near, -3)


def _axial() -> Shape:
    """S_zz; in plates of no thickness alpha^2 (1 + 2 beta), to which the rest is added."""
    known = sections()
    square_of, cubic_of = known["cosh_square"], known["sinh_cubic"]
    quartic_of, quintic_of = known["cosh_quartic"], known["sinh_quintic"]
    both, fifth, third, first = sp.symbols("both fifth third first", real=True)
    thin = Branch(
        (
            Step(both, 2 + T**2 * cubic_of(T), "(sinh T + T)/T"),
            Step(fifth, T**2 * quintic_of(T)),
            Step(
                third,
                u**2 * quartic_of(u) + v**2 * square_of(u) * cubic_of(v) / both - 3 * fifth,
                "what the faces of a plate of no thickness leave of the term in beta",
            ),
            Step(
                first,
                u**2 * quintic_of(u) + v**2 * cubic_of(u) * square_of(v) / both - fifth,
                "and of the term in alpha",
            ),
            Step(over, (beta * third + alpha * first) / cubic_of(T)),
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
            Step(plus, 1 + T**2 * cubic_of(T), "sinh T/T"),
            Step(
                over,
                (plus * u**2 * cubic_of(u) + v**2 * cubic_of(v)) / (1 + plus),
                "small beside 1",
            ),
            Step(core, alpha * beta * (1 + over) / cubic_of(T)),
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


MIDDLE = (
    Step(x, phi * h),
    Step(t, phi * z),
    Step(zeta, z / (2 * h), "t/T"),
    Step(reach, sp.Max(10 * sp.Abs(t), T), "small in thin plates and in the middle of others"),
)
GUARDS = {T: sp.Integer(1), x: sp.Rational(1, 2), t: sp.Integer(0), zeta: sp.Integer(0)}


def _of_middle(*unused: sp.Symbol) -> tuple[Step, ...]:
    """What bending and stretching are made of, each over its power, but for what is unused."""
    square_of, cubic_of = sections()["cosh_square"], sections()["sinh_cubic"]
    steps = (
        Step(small_x, x**2 * cubic_of(x), "sinh x/x - 1"),
        Step(small_t, t**2 * cubic_of(t), "sinh t/t - 1"),
        Step(versine, t**2 * square_of(t), "cosh t - 1"),
        Step(sinh_x, 1 + small_x),
        Step(sinh_t, 1 + small_t),
        Step(cosh_x, sp.cosh(x)),
        Step(cosh_t, 1 + versine),
        Step(lift, small_x * cosh_t + versine, "sinh x cosh t/x - 1"),
        Step(cubic, cubic_of(T)),
        Step(minus, T**2 * cubic, "(sinh T - T)/T"),
        Step(plus, 4 + 2 * minus, "2 (sinh T + T)/T"),
    )
    return tuple(step for step in steps if step.symbol not in unused)


def _growth() -> Step:
    """What bending in a plate of no thickness, 6 zeta, is to be multiplied by, less 1."""
    square_of, quintic_of = sections()["cosh_square"], sections()["sinh_quintic"]
    return Step(
        growth,
        (cosh_x * small_t + x**2 * square_of(x) - 6 * T**2 * quintic_of(T)) / (6 * cubic),
        "cosh x sinh t/(6 t cubic) exceeds 1 by",
    )


def _gap() -> sp.Expr:
    """What stretching has but for Poisson's ratio."""
    return t**2 * sinh_t * sinh_x - x**2 * sections()["cosh_cubic"](x) * cosh_t


def _faces(halves: int, scale: tuple[sp.Basic | int, ...], const: sp.Expr) -> Branch:
    """Half so many times `scale` times the sum in plane, d = 1 and c = const, from both faces."""
    pair = blocks()["sinh_pair"]
    return Branch(
        (
            ODD_T,
            FAR_U,
            FAR_V,
            *FADES,
            Step(near, pair.near(T)),
            Step(less_v, const - v),
            Step(less_u, const - u),
            Step(sum_u, less_v - far_u * (const + v), "2 e^(-u) (c sinh u - v cosh u)"),
            Step(sum_v, less_u - far_v * (const + u), "the same with u for v"),
            Step(over, odd_T * sum_u - 2 * T * far_u * sum_v),
            Step(core, over / pair(T)),
        ),
        TIMES(sp.Rational(halves, 2) * core, *FADED, *scale, near, -4),
        {},
    )


def _radial_displacement() -> Shape:
    """Half the sum in plane, c = 1 - 2 nu."""
    scale = (A_j, 1, mu, -1, phi, -2)
    middle = Branch(
        (
            *_of_middle(),
            Step(
                bending,
                zeta * (sinh_t * (c * cosh_x - x**2 * sinh_x) + cosh_t * cosh_x),
                "odd in z",
            ),
            Step(stretching, _gap(), "even in z"),
            Step(over, c_less_1 * lift + stretching, "small in thin plates"),
            Step(core, (c_less_1 + over) / plus + bending / minus),
        ),
        TIMES(core / 2, *scale),
        GUARDS,
    )
    elastic = (
        Step(modulus, lam + mu),
        Step(c, mu / modulus, "1 - 2 nu"),
        Step(c_less_1, -lam / modulus, "-2 nu"),
    )
    return (*DEPTHS, *elastic, *MIDDLE), Seam(reach, MIDST, middle, _faces(1, scale, c))


def _radial() -> Shape:
    """The sum in plane with c = 1; in thin plates twice `_hoop`'s with lam = modulus, nearly."""
    middle = Branch(
        (
            *_of_middle(lift),
            _growth(),
            Step(
                bending,
                12 * growth + (cosh_x * (versine - small_t) - x**2 * sinh_t * sinh_x) / cubic,
                "what 12 grows by, odd in z",
            ),
            Step(stretching, _gap(), "even in z"),
            Step(core, (12 * zeta + zeta * bending) / T**2 + stretching / plus),
        ),
        TIMES(core, A_j, 1),
        GUARDS,
    )
    return (*DEPTHS, *MIDDLE), Seam(reach, MIDST, middle, _faces(2, (A_j, 1), sp.Integer(1)))


def _hoop() -> Shape:
    """lam times the dilatation: the sum in plane with c = 1 and d = 0."""
    pair = blocks()["sinh_pair"]
    scale = (A_j, 1, lam, 1, modulus, -1)
    middle = Branch(
        (
            *_of_middle(sinh_x, sinh_t),
            _growth(),
            Step(gain, (4 * lift - 2 * minus) / plus, "4 (1 + lift)/plus - 1"),
            Step(over, 6 * zeta * growth + x**2 * gain),
            Step(core, 6 * zeta + x**2 + over),
        ),
        TIMES(core / 4, *scale, x, -2),
        GUARDS,
    )
    faces = Branch(
        (
            ODD_T,
            ODD_U,
            ODD_V,
            FAR_U,
            *FADES,
            Step(near, pair.near(T)),
            Step(over, odd_T * odd_u - 2 * T * far_u * odd_v),
            Step(core, over / pair(T)),
        ),
        TIMES(core, *FADED, *scale, near, -4),
        {},
    )
    steps = (*DEPTHS, Step(modulus, lam + mu), *MIDDLE[:-1])
    return steps, Seam(T, THIN, middle, faces)
