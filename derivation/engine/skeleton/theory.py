"""Derivation: a film that is bonded to its base or slides on it, under the pressure J0(k r).

The displacements are u = U(z) J1(k r) and w = W(z) J0(k r).
"""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import prove

from .vocabulary import Formula, G, H, T, k, s, z

E1, E2, E3, E4 = CONSTANTS = sp.symbols("E1:5", real=True)
LAME = G * (1 - s) / s


def stresses(U: sp.Expr, W: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return sigma_zz over J0(k r) and sigma_rz over J1(k r), by Hooke's law."""
    dilatation = sp.diff(W, z) + k * U
    return LAME * dilatation + 2 * G * sp.diff(W, z), G * (sp.diff(U, z) - k * W)


def balance(U: sp.Expr, W: sp.Expr) -> dict[str, sp.Expr]:
    """Return the residuals of Navier's axial and radial equations."""
    dilatation = sp.diff(W, z) + k * U
    return {
        "axial": G * (sp.diff(W, z, 2) - k**2 * W) + (LAME + G) * sp.diff(dilatation, z),
        "radial": G * (sp.diff(U, z, 2) - k**2 * U) - (LAME + G) * k * dilatation,
    }


@cache
def shapes() -> tuple[sp.Expr, sp.Expr]:
    """Return the general solution U, W with four constants."""
    cosh, sinh = sp.cosh(k * z), sp.sinh(k * z)
    W = (E1 + E2 * z) * cosh + (E3 + E4 * z) * sinh
    a, b, c, d = unknown = sp.symbols("a b c d", real=True)
    U = (a + b * z) * cosh + (c + d * z) * sinh
    S, C = sp.symbols("S C")
    equations = [
        coefficient
        for left in balance(U, W).values()
        for coefficient in sp.Poly(
            sp.numer(sp.together(sp.expand(left.doit()).subs({sinh: S, cosh: C}))), S, C, z
        ).coeffs()
    ]
    (constants,) = sp.solve(equations, unknown, dict=True)
    return U.subs(constants), W


def closed_forms() -> dict[str, sp.Expr]:
    """Return the deflection over that of a half-space, for each condition at the base."""
    kappa = 1 + 2 * s
    bonded = (2 * kappa * sp.sinh(T) - 2 * T) / (2 * kappa * sp.cosh(T) + 1 + kappa**2 + T**2)
    return {"bonded": bonded, "slipping": (sp.cosh(T) - 1) / (sp.sinh(T) + T)}


@cache
def film() -> tuple[Formula, ...]:
    """Return the influence coefficients of the film, bonded and slipping."""
    U, W = shapes()
    normal, shear = stresses(U, W)
    held = {"bonded": ("U at the base", U), "slipping": ("shear at the base", shear)}
    return tuple(
        formula
        for name, (label, base) in held.items()
        for formula in _influence(
            name,
            {
                "W at the base": W.subs(z, 0),
                label: base.subs(z, 0),
                "shear on top": shear.subs(z, H),
                "pressure on top": normal.subs(z, H) + 1,
            },
        )
    )


def _influence(name: str, conditions: dict[str, sp.Expr]) -> tuple[Formula, Formula]:
    """Return the deflection per pressure, and the deflection over that of a half-space."""
    U, W = shapes()
    e = sp.Symbol("e", positive=True)  # e^(k H), which makes the equations rational
    plain = {sp.cosh(k * H): (e + 1 / e) / 2, sp.sinh(k * H): (e - 1 / e) / 2}
    (solution,) = sp.linsolve([left.subs(plain) for left in conditions.values()], *CONSTANTS)
    back = {c: v.subs(e, sp.exp(k * H)) for c, v in zip(CONSTANTS, solution, strict=True)}
    shape = closed_forms()[name]
    deflection = (1 + s) / (2 * G * k) * shape.subs(T, 2 * k * H)
    proof = prove(
        f"Film, {name}",
        "Navier's equations are satisfied, the constants satisfy the four conditions, and the "
        "closed form is the deflection of the top.",
        balance(U, W)
        | {label: left.subs(back) for label, left in conditions.items()}
        | {"closed form": deflection + W.subs(z, H).subs(back)},
    )
    letter, said = name[0], f"of a film, {name}"
    return (
        Formula(
            f"C_{name}", f"C_{letter}", f"deflection per pressure {said}", deflection, "m/Pa",
            {"bonded": "1", "slipping": "2"}[name], (), proof,
        ),
        Formula(
            f"F_{name}", f"F_{letter}", f"deflection over a half-space's {said}", shape, "1",
            {"bonded": "3", "slipping": "4"}[name], (f"C_{name}",), proof,
        ),
    )  # fmt: skip
