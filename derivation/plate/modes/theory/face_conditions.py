"""Step 4: tractions on both faces (3) -> Omega_1 ... Omega_4, the paper's equation (5)."""

from collections.abc import Mapping
from functools import cache

import sympy as sp

from derivation.engine.cache import in_file
from derivation.engine.formula.hyperbolic import to_hyperbolic
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.modes.theory.mode_shapes import CONSTANTS
from derivation.plate.modes.theory.stresses import modal_stresses
from derivation.plate.vocabulary import A_j, Formula, h, phi, z

SOURCES = ("engine/cache.py", "engine/formula", "plate/vocabulary.py", "plate/modes/theory")
"""Sources on which the constants depend."""


def tractions() -> dict[str, sp.Expr]:
    """Return the expressions that vanish on the faces: shear, S_zz at -h, S_zz - A_j at +h."""
    stress = {formula.name: formula.expression for formula in modal_stresses()}
    return {
        "sigma_rz at z = +h": stress["S_rz"].subs(z, h),
        "sigma_rz at z = -h": stress["S_rz"].subs(z, -h),
        "sigma_zz at z = -h": stress["S_zz"].subs(z, -h),
        "sigma_zz at z = +h": stress["S_zz"].subs(z, h) - A_j,
    }


@in_file(SOURCES, Formula, Proof)  # modules of kernels need them when they are imported
def omegas() -> tuple[Formula, ...]:
    """Return Omega_k = C_k / A_j, from the four traction conditions."""
    conditions = tractions()
    (solution,) = sp.linsolve(list(conditions.values()), *CONSTANTS)
    expressions = [to_hyperbolic(sp.cancel(value / A_j), phi * h) for value in solution]
    proof = prove(
        "Face conditions",
        r"$C_k = A_j \Omega_k$ is inserted into both stresses on both faces.",
        lambda *omegas: {
            where: traction.subs({c: A_j * x for c, x in zip(CONSTANTS, omegas, strict=True)})
            for where, traction in conditions.items()
        },
        *expressions,
    )
    return tuple(
        Formula(
            f"Omega_{k}",
            rf"\Omega_{k}",
            f"integration constant $C_{k}$ divided by the pressure coefficient $A_j$",
            expression,
            "m/Pa" if k < 3 else "1/Pa",
            "5",
            ("S_zz", "S_rz"),
            proof,
        )
        for k, expression in enumerate(expressions, start=1)
    )


@cache
def scaled_omegas() -> tuple[Formula, ...]:
    """Return e^(phi h) Omega_k, of order 1 where Omega_k itself underflows (phi h > 708)."""
    scaled = {omega: sp.exp(phi * h) * omega.expression for omega in omegas()}
    proof = prove(
        "Scaled constants",
        r"Each scaled constant is the constant times $e^{\phi h}$ by definition.",
        lambda *scaled: {
            omega.name: value * sp.exp(-phi * h) - omega.expression
            for omega, value in zip(omegas(), scaled, strict=True)
        },
        *scaled.values(),
    )
    return tuple(
        Formula(
            f"{omega.name}_scaled",
            rf"e^{{\phi_j h}}{omega.latex}",
            rf"$\{omega.name}$ times $e^{{\phi h}}$",
            value,
            omega.unit,
            "5",
            (omega.name,),
            proof,
        )
        for omega, value in scaled.items()
    )


def loaded(expression: sp.Expr) -> sp.Expr:
    """Return an expression in C1 ... C4 with the constants from the face conditions."""
    values: Mapping[sp.Symbol, sp.Expr] = {
        c: A_j * omega.expression for c, omega in zip(CONSTANTS, omegas(), strict=True)
    }
    return expression.subs(values)
