"""Step 6: w on the faces per unit pressure coefficient, and its limit for a half-space.

C_top and C_bottom are the influence coefficients w_j(+h)/A_j and w_j(-h)/A_j;
with T = 2 phi h they are 2 G(T)/(E* phi) and 2 G_m(T)/(E* phi).
"""

import sympy as sp

from derivation.engine.cache import in_file
from derivation.engine.formula.hyperbolic import to_hyperbolic
from derivation.engine.formula.proof import Proof, prove
from derivation.plate.modes.theory.face_conditions import SOURCES, loaded
from derivation.plate.modes.theory.mode_shapes import mode_shapes
from derivation.plate.vocabulary import A_j, Formula, h, lam, mu, phi, z

PLANE_STRAIN_MODULUS = 4 * mu * (lam + mu) / (lam + 2 * mu)
"""E*, the modulus E/(1 - nu^2) of the half-space, in Lame's constants."""


@in_file(SOURCES, Formula, Proof)  # modules of kernels need them when they are imported
def influence_coefficients() -> tuple[Formula, Formula, Formula]:
    """Return C_top, C_bottom and their common limit C_half for phi h -> oo on the contact face."""
    deflection = loaded(mode_shapes()[0].expression) / A_j
    faces = {"top": deflection.subs(z, h), "bottom": deflection.subs(z, -h)}
    closed = {face: to_hyperbolic(value, phi * h) for face, value in faces.items()}
    half = sp.factor(sp.limit(closed["top"].rewrite(sp.exp), h, sp.oo))
    proof = prove(
        "Influence coefficients",
        r"The closed forms equal $f_j(\pm h)/A_j$ with the constants of the face conditions; the "
        r"half-space's is $2/(E^* \phi)$.",
        lambda top, bottom, half: {
            "top": top - deflection.subs(z, h),
            "bottom": bottom - deflection.subs(z, -h),
            "half-space": half - 2 / (PLANE_STRAIN_MODULUS * phi),
        },
        *(*closed.values(), half),
    )
    sources = ("f_j", "Omega_1", "Omega_2", "Omega_3", "Omega_4")
    return (
        Formula(
            "C_top",
            r"C(\phi_j, +h)",
            "deflection of the contact face per pressure coefficient",
            closed["top"],
            "m/Pa",
            "6",
            sources,
            proof,
        ),
        Formula(
            "C_bottom",
            r"C(\phi_j, -h)",
            "deflection of the back face per pressure coefficient",
            closed["bottom"],
            "m/Pa",
            "6",
            sources,
            proof,
        ),
        Formula(
            "C_half",
            r"C_\infty(\phi_j)",
            "deflection of a half-space per pressure coefficient",
            half,
            "m/Pa",
            "",
            ("C_top",),
            proof,
        ),
    )
