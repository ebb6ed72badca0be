"""Stable forms of the paper's formulas, each proved equal to the derived one.

Notation: x = phi h, T = 2x, t = phi z, u = phi (h + z), v = phi (h - z), so
that u + v = T; products of hyperbolic functions are written with decaying
exponentials only, and with terms of one sign wherever the value has one.
"""

from collections.abc import Mapping

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.formula.record import Formula
from derivation.formula.symbols import J1, A_j, P, R, T, a, b, h, lam, mu, phi, r, z
from derivation.rewrite.blocks import blocks
from derivation.rewrite.form import Branch, Form, Seam, Step, form

x, y, u, v, t = sp.symbols("x y u v t", real=True)
odd, even, odd_u, even_u, odd_v, even_v, odd_T = sp.symbols(
    "odd even odd_u even_u odd_v even_v odd_T", real=True
)
minus, plus, bending, stretching, top, bottom = sp.symbols(
    "minus plus bending stretching top bottom", real=True
)
modulus, factor, shape, ratio, versine, cubic, edge = sp.symbols(
    "modulus plate_factor shape ratio versine cubic edge", real=True
)
alpha, beta, over_T, over_T2 = sp.symbols("alpha beta over_T over_T2", real=True)
fade, fade_near, fade_far, near_share, far_share = sp.symbols(
    "fade fade_near fade_far near_share far_share", real=True
)

STEP_X = Step(x, phi * h)
STEP_T = Step(T, 2 * phi * h)
HALF_SPACE = (lam + 2 * mu) / (2 * mu * (lam + mu) * phi)


def stable_forms(formulas: Mapping[str, Formula]) -> tuple[Form, ...]:
    """The stable form of every formula that is generated, in module order.

    Raises
    ------
    ProofError
        Naming the form that is not its formula.
    """
    known = blocks()
    return tuple(
        form(name, module, formulas[name].expression, steps, value, known)
        for module, group in (
            ("omega", _omegas()),
            ("influence", _influence()),
            ("pressure", _pressure()),
            ("mode_shapes", _modes()),
        )
        for name, (steps, value) in group.items()
    )


_Shape = tuple[tuple[Step, ...], sp.Expr | Seam]


def _omegas() -> dict[str, _Shape]:
    """Omega_k as e^(-x) times a scaled form; T = 2x."""
    sinh_minus, sinh_plus = blocks()["sinh_minus"](T), blocks()["sinh_plus"](T)
    parity = (
        STEP_X,
        STEP_T,
        Step(odd, -expm1(-T), "2 e^(-x) sinh x"),
        Step(even, 1 + sp.exp(-T), "2 e^(-x) cosh x"),
    )
    odd_part, even_part = (STEP_T, parity[2]), (STEP_T, parity[3])
    elastic = 2 * mu * (lam + mu) * phi
    bending, stretching = T**3 * sinh_minus, T * sinh_plus
    scaled: dict[str, _Shape] = {
        "Omega_1": (parity, ((lam + mu) * x * odd + (lam + 2 * mu) * even) / (elastic * bending)),
        "Omega_2": (
            parity,
            ((lam + mu) * x * even + (lam + 2 * mu) * odd) / (elastic * stretching),
        ),
        "Omega_3": (odd_part, -odd / (2 * mu * stretching)),
        "Omega_4": (even_part, -even / (2 * mu * bending)),
    }
    halves = Step(fade, sp.exp(-x / 2), "half of the decay, twice: e^(-x) alone may underflow")
    plain: dict[str, _Shape] = {
        name: (
            (STEP_X, *(s for s in steps if s != STEP_X), halves, Step(shape, fade * value)),
            fade * shape,
        )
        for name, (steps, value) in scaled.items()
    }
    return plain | {f"{name}_scaled": shape for name, shape in scaled.items()}


def _influence() -> dict[str, _Shape]:
    """Plate factors, influence coefficients and K_j; T = 2 phi h.

    The denominator sinh^2 T - T^2 is T^4 times two blocks; T^3 is divided by
    last, so that nothing underflows before the value overflows.
    """
    product = blocks()["sinh_minus"](T) * blocks()["sinh_plus"](T)
    loaded = (4 * sp.exp(-2 * T) - expm1(-4 * T) / T) / product
    far = 2 * (1 + sp.exp(-2 * T) - expm1(-2 * T) / T) / product
    beyond = 4 * (1 + T - expm1(-2 * T) / (2 * T)) / product
    G: _Shape = (Step(shape, loaded),), shape / T**3
    G_m, G_minus_1 = _fading(far, T), _fading(beyond, 2 * T)
    steps = {
        face: (STEP_T, *inner, Step(factor, value, "plate factor"))
        for face, (inner, value) in (("top", G), ("bottom", G_m))
    }
    at_edge = Step(edge, b * phi, "the zero j_n of J0")
    indentation = 8 * factor / (sp.pi * R * (edge * phi * J1) ** 2)
    return {
        "G": G,
        "G_m": G_m,
        "G_minus_1": G_minus_1,
        "C_top": (steps["top"], factor * HALF_SPACE),
        "C_bottom": (steps["bottom"], factor * HALF_SPACE),
        "K_j": ((*steps["top"], at_edge), indentation),
        "K_j_bottom": ((*steps["bottom"], at_edge), indentation),
    }


def _fading(value: sp.Expr, exponent: sp.Expr) -> _Shape:
    """Shape e^(-exponent) value/T^3, the exponential in two halves: neither underflows alone."""
    steps = (Step(fade, sp.exp(-exponent / 2), "half of the decay"), Step(shape, fade * value))
    return steps, fade * (shape / T**3)


def _pressure() -> dict[str, _Shape]:
    """Hertz pressure and its coefficients."""
    transform = Step(shape, blocks()["hertz_shape"](a * phi), "1 for a phi -> 0")
    pressure_scale = Step(modulus, 16 * mu * (lam + mu) / (3 * (lam + 2 * mu)), "(4/3) E*")
    return {
        "p": ((), -3 * P * sp.sqrt(a - r) * sp.sqrt(a + r) / (2 * sp.pi * a**3)),
        "P": ((pressure_scale,), modulus * a**3 / R),
        "sonine": ((transform,), a**2 * shape / 3),
        "A_j": ((transform, pressure_scale), -modulus * a**3 * shape / (sp.pi * R * (b * J1) ** 2)),
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
    kappa = Step(ratio, (lam + 2 * mu) / (lam + mu), "2 (1 - nu)")
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
        "mode_f": (_steps(deflection, kappa), WHOLE / T**3),
        "mode_g": _in_plane(mu / (lam + mu), 1, -lam / (lam + mu), A_j / (2 * mu * phi**2)),
        "mode_zz": (_steps(axial, versine_step, cubic_step), WHOLE),
        "mode_rz": (_steps(shear), WHOLE / T),
        "mode_rr": _in_plane(sp.Integer(1), 1, sp.Integer(0), A_j),
        "mode_tt": _in_plane(sp.Integer(1), 0, sp.Integer(1), A_j * lam / (lam + mu)),
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


def _in_plane(c: sp.Expr, d: int, c_minus_d: sp.Expr, scale: sp.Expr) -> _Shape:
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
    return (*DEPTHS, STEP_X, Step(t, phi * z)), Seam(T, sp.Integer(2), thin, thick)
