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
from derivation.rewrite.automatic import RATIO, automatic, core, ratio
from derivation.rewrite.blocks import blocks
from derivation.rewrite.form import Branch, Form, Seam, Step, form

x, y, u, v, t = sp.symbols("x y u v t", real=True)
odd, even, odd_u, even_u, odd_v, even_v, odd_T = sp.symbols(
    "odd even odd_u even_u odd_v even_v odd_T", real=True
)
minus, plus, bending, stretching, top, bottom = sp.symbols(
    "minus plus bending stretching top bottom", real=True
)
modulus, shape, slender, versine, cubic = sp.symbols(
    "modulus shape slender versine cubic", real=True
)
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
        "influence": {name: found(name) for name in INFLUENCE} | {"G_slope": _factor_slope()},
        "pressure": _pressure() | {name: found(name) for name in ("sonine", "A_j")},
        "mode_shapes": _modes(),
    }
    return tuple(
        form(name, module, formulas[name].expression, steps, value, known)
        for module, group in groups.items()
        for name, (steps, value) in group.items()
    )


OMEGAS = tuple(f"Omega_{k}{tail}" for tail in ("", "_scaled") for k in range(1, 5))
INFLUENCE = ("G", "G_m", "G_minus_1", "C_top", "C_bottom", "K_j", "K_j_bottom")
AUTOMATIC = (*OMEGAS, *INFLUENCE, "sonine", "A_j")
"""Formulas whose forms the rules find."""

_Shape = tuple[tuple[Step, ...], sp.Expr | Seam]


def _factor_slope() -> _Shape:
    """T dG/dT; the rules leave T^5 below, which underflows where the value is finite."""
    known = blocks()
    product = known["sinh_minus"](T) * known["sinh_plus"](T)
    steps = (
        Step(fade, sp.exp(-T), "half of the decay, twice: neither factor underflows alone"),
        Step(odd, -expm1(-2 * T) / T, "2 e^(-T) sinh T/T"),
        Step(near_share, fade * (odd / product) ** 2),
    )
    return steps, -8 * fade * (near_share / T**3)


def _pressure() -> dict[str, _Shape]:
    """Hertz pressure and the contact force: the edge's root by its two factors."""
    edge_root = Step(shape, sp.sqrt(a - r) * sp.sqrt(a + r) / a, "1 in the centre, 0 at the edge")
    return {
        "p": ((edge_root, Step(core, P / a**2)), -3 * core * shape / (2 * sp.pi)),
        "P": (
            (RATIO, Step(modulus, 16 * mu / (3 * ratio), "(4/3) E*"), Step(slender, a / R)),
            modulus * a**2 * slender,
        ),
    }


DEPTHS = (
    STEP_T,
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
    product = sinh_minus(T) * blocks()["sinh_plus"](T)
    versine_step = Step(versine, (expm1(-u) / T) ** 2, "2 e^(-u) (cosh u - 1)/T^2")
    cubic_step = Step(cubic, alpha**3 * sinh_minus(u), "2 e^(-u) (sinh u - u)/T^3")
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
                / known["sinh_minus"](T),
                "odd in z, times T^3",
            ),
            Step(
                stretching,
                (
                    c_minus_d * sp.sinh(x) / T * sp.cosh(t)
                    + d * t * sp.sinh(t) * sp.sinh(x) / T
                    - d * sp.exp(x) * x**2 / 4 * known["cosh_gap"](x) * sp.cosh(t)
                )
                / known["sinh_plus"](T),
                "even in z",
            ),
            Step(over_T, bending / T, "divided by T one at a time: T^3 may underflow"),
            Step(over_T2, over_T / T),
        ),
        scale * 2 * sp.exp(-T) * (over_T2 / T + stretching),
        {T: sp.Integer(1), x: sp.Rational(1, 2), t: sp.Integer(0)},
    )
    # Above the seam both terms decay, and cancel only where the value crosses zero.
    denominator = T**4 * known["sinh_minus"](T) * known["sinh_plus"](T)
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
