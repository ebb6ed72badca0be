"""Stable forms of the formulas, each proved equal to the derived one.

Those of one dimensionless variable are found by the rules; the fields of a mode,
which depend on the depth too, are written out here and proved like the rest.

Notation: x = phi h, T = 2x, t = phi z, u = phi (h + z), v = phi (h - z), so
that u + v = T; products of hyperbolic functions are written with decaying
exponentials only, and with terms of one sign wherever the value has one.
"""

from collections.abc import Mapping

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.formula.record import Formula
from derivation.formula.symbols import A_j, P, R, T, a, h, lam, mu, phi, r, z
from derivation.rewrite.automatic import RATIO, automatic, near, ratio
from derivation.rewrite.blocks import blocks
from derivation.rewrite.form import TIMES, Branch, Form, Seam, Step, form

x, y, u, v, t = sp.symbols("x y u v t", real=True)
odd, even, odd_u, even_u, odd_v, even_v, odd_T = sp.symbols(
    "odd even odd_u even_u odd_v even_v odd_T", real=True
)
minus, plus, bending, stretching, top, bottom = sp.symbols(
    "minus plus bending stretching top bottom", real=True
)
share, versine, cubic = sp.symbols("share versine cubic", real=True)
two_nu = sp.Symbol("two_nu", real=True)
alpha, beta, over_T, over_T2 = sp.symbols("alpha beta over_T over_T2", real=True)
fade, fade_near, fade_far, near_share, far_share = sp.symbols(
    "fade fade_near fade_far near_share far_share", real=True
)

STEP_X = Step(x, phi * h)
STEP_T = Step(T, 2 * phi * h)
TWO_NU = Step(two_nu, lam / (lam + mu), "2 nu, apart lest A_j lam overflow")


def stable_forms(formulas: Mapping[str, Formula]) -> tuple[Form, ...]:
    """The stable form of every formula that is generated, in module order.

    Raises
    ------
    ProofError
        Naming the form that is not its formula.
    UnreachableError
        Naming a formula that the rules do not reach.
    """
    known = blocks()

    def found(name: str) -> _Shape:
        return automatic(formulas[name].expression, known)

    groups: dict[str, dict[str, _Shape]] = {
        "omega": {name: found(name) for name in OMEGAS},
        "influence": {name: found(name) for name in INFLUENCE},
        "pressure": _pressure() | {name: found(name) for name in ("sonine", "A_j")},
        "mode_shapes": _modes(),
    }
    return tuple(
        form(name, module, formulas[name].expression, steps, value, known)
        for module, group in groups.items()
        for name, (steps, value) in group.items()
    )


OMEGAS = tuple(f"Omega_{k}{tail}" for tail in ("", "_scaled") for k in range(1, 5))
INFLUENCE = ("G", "G_m", "G_minus_1", "C_top", "C_bottom", "K_j", "K_j_bottom", "G_slope")
AUTOMATIC = (*OMEGAS, *INFLUENCE, "sonine", "A_j")
"""Formulas whose forms the rules find."""

_Shape = tuple[tuple[Step, ...], sp.Expr | Seam]


def _pressure() -> dict[str, _Shape]:
    """Hertz pressure and the contact force: the edge's root by its two factors."""
    fraction = Step(share, r / a)
    root = sp.sqrt((1 - share) * (1 + share))
    return {
        "p": ((fraction,), TIMES(-3 * root / (2 * sp.pi), P, 1, a, -2)),
        "P": ((RATIO,), TIMES(16 / (3 * ratio), mu, 1, a, 3, R, -1)),
    }


DEPTHS = (
    STEP_T,
    Step(near, blocks()["sinh_minus"].near(T)),
    Step(u, phi * (h + z), "from the far face"),
    Step(v, phi * (h - z), "from the loaded face"),
)
FRACTIONS = (
    Step(alpha, (h + z) / (2 * h), "u/T"),
    Step(beta, (h - z) / (2 * h), "v/T"),
)
PARITIES = (
    Step(odd_u, -expm1(-2 * u), "2 e^(-u) sinh u"),
    Step(even_u, 1 + sp.exp(-2 * u), "2 e^(-u) cosh u"),
    Step(odd_v, -expm1(-2 * v), "2 e^(-v) sinh v"),
    Step(even_v, 1 + sp.exp(-2 * v), "2 e^(-v) cosh v"),
    Step(odd_T, -expm1(-2 * T), "2 e^(-T) sinh T"),
)


def _modes() -> dict[str, _Shape]:
    """Displacements and stresses; f, S_zz and S_rz as sums of terms of one sign for every z.

    Every hyperbolic function is divided by the power of T it vanishes with, so
    that the thin plate's limit needs no more than T^3.
    """
    sinh_minus = blocks()["sinh_minus"]
    product = sinh_minus(T) * near**3 / T**3 * blocks()["sinh_plus"](T) / T
    versine_step = Step(versine, (expm1(-u) / T) ** 2, "2 e^(-u) (cosh u - 1)/T^2")
    cubic_step = Step(
        cubic,
        alpha**3 * sinh_minus(u) * sinh_minus.near(u) ** 3 / u**3,
        "2 e^(-u) (sinh u - u)/T^3",
    )
    deflection = _two_faces(
        A_j / (2 * mu * phi) / product,
        odd_T / T * (ratio * even_u + v * odd_u),
        (2 * (ratio * even_v + u * odd_v), u + T),
    )
    shear = _two_faces(
        -A_j / product,
        (odd_T / T) * (odd_u / T) * beta,
        (2 * (odd_v / T) * alpha, u + T),
    )
    axial = _two_faces(
        A_j / product,
        (odd_T / T) * (beta * versine + cubic),
        (odd_v / T * versine + even_v * cubic, T),
    )
    return {
        "mode_f": (_steps(deflection, RATIO), WHOLE / T**3),
        "mode_g": _in_plane(mu / (lam + mu), 1, -lam / (lam + mu), A_j / (2 * mu * phi**2)),
        "mode_zz": (_steps(axial, versine_step, cubic_step), WHOLE),
        "mode_rz": (_steps(shear), WHOLE / T),
        "mode_rr": _in_plane(sp.Integer(1), 1, sp.Integer(0), A_j),
        "mode_tt": _in_plane(sp.Integer(1), 0, sp.Integer(1), A_j * two_nu, TWO_NU),
    }


def _two_faces(scale: sp.Expr, near: sp.Expr, far: tuple[sp.Expr, sp.Expr]) -> tuple[Step, ...]:
    """Steps to scale (near e^(-v) + far e^(-exponent)), each exponential in two halves.

    The result may be a normal double where e^(-v) is subnormal or zero.
    """
    far_value, exponent = far
    return (
        Step(fade_near, sp.exp(-v / 2), "half of the decay from the loaded face"),
        Step(fade_far, sp.exp(-exponent / 2), "half of the decay by way of the far face"),
        Step(near_share, scale * near * fade_near),
        Step(far_share, scale * far_value * fade_far),
    )


WHOLE = fade_near * near_share + fade_far * far_share


def _steps(last: tuple[Step, ...], *between: Step) -> tuple[Step, ...]:
    """The depths, fractions and parities that `between` and `last` need, then these."""
    used: set[sp.Basic] = set()
    for step in (*between, *last):
        used |= step.expression.free_symbols
    return (*DEPTHS, *(s for s in (*FRACTIONS, *PARITIES) if s.symbol in used), *between, *last)


def _in_plane(c: sp.Expr, d: int, c_minus_d: sp.Expr, scale: sp.Expr, *before: Step) -> _Shape:
    """Scale times (B(u,v) sinh T - B(v,u) T)/(sinh^2 T - T^2), B(u,v) = c sinh u - d v cosh u.

    Bending and stretching shares are summed below T = 2, where the two terms
    cancel; `c_minus_d` is given apart because c - d would cancel too.
    """
    known = blocks()
    thin = Branch(
        (
            Step(
                bending,
                (
                    c * sp.cosh(x) * sp.sinh(t)
                    + d * (t * sp.cosh(x) * sp.cosh(t) - x * sp.sinh(x) * sp.sinh(t))
                )
                / known["sinh_minus"](T)
                * (T / known["sinh_minus"].near(T)) ** 3,
                "odd in z, times T^3",
            ),
            Step(
                stretching,
                (
                    c_minus_d * sp.sinh(x) / T * sp.cosh(t)
                    + d * t * sp.sinh(t) * sp.sinh(x) / T
                    - d
                    * sp.exp(x)
                    * x**2
                    / 4
                    * known["cosh_gap"](x)
                    * known["cosh_gap"].near(x) ** 3
                    / x**3
                    * sp.cosh(t)
                )
                / known["sinh_plus"](T)
                * T,
                "even in z",
            ),
            Step(over_T, bending / T, "divided by T one at a time: T^3 may underflow"),
            Step(over_T2, over_T / T),
        ),
        scale * 2 * sp.exp(-T) * (over_T2 / T + stretching),
        {T: sp.Integer(1), x: sp.Rational(1, 2), t: sp.Integer(0)},
    )
    # Above the seam both terms decay, and cancel only where the value crosses zero.
    denominator = near**3 * known["sinh_minus"](T) * known["sinh_plus"](T)
    decaying = _two_faces(
        scale / denominator,
        odd_T * (c * odd_u - d * v * even_u),
        (-2 * T * (c * odd_v - d * u * even_v), u + T),
    )
    thick = Branch(
        tuple(step for step in _steps(decaying) if step not in DEPTHS),
        WHOLE,
        {T: sp.Integer(2), u: sp.Integer(1), v: sp.Integer(1)},
    )
    return (*DEPTHS, *before, STEP_X, Step(t, phi * z)), Seam(T, sp.Integer(2), thin, thick)
