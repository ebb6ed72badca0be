"""Step 7: the plate factors G(T) and G_m(T), T = 2 phi h: influence relative to a half-space."""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.plate.modes.theory.influence import influence_coefficients
from derivation.plate.vocabulary import Formula, T, h, phi


@cache
def plate_factors() -> tuple[Formula, ...]:
    """Return G = C_top/C_half, G_m = C_bottom/C_half, and G - 1, which decays like e^(-2T)."""
    top, bottom, half = (formula.expression for formula in influence_coefficients())
    G, G_m = ((face / half).subs(phi, T / (2 * h)) for face in (top, bottom))
    proof = prove(
        "Plate factors",
        r"The ratio of each influence coefficient to the half-space's depends on $\phi h$ alone.",
        lambda G, G_m, excess: {
            "contact face": G.subs(T, 2 * phi * h) * half - top,
            "back face": G_m.subs(T, 2 * phi * h) * half - bottom,
            "increase": (1 + excess.subs(T, 2 * phi * h)) * half - top,
        },
        *(G, G_m, G - 1),
    )
    return (
        Formula("G", "G(T)", "plate factor of the contact face", G, "1", "6", ("C_top",), proof),
        Formula(
            "G_m", "G_m(T)", "plate factor of the back face", G_m, "1", "6", ("C_bottom",), proof
        ),
        Formula(
            "G_minus_1",
            "G(T) - 1",
            "relative increase of the deflection by the finite thickness, $G - 1$",
            G - 1,
            "1",
            "6",
            ("G",),
            proof,
        ),
    )


@cache
def plate_factor_slope() -> Formula:
    """Return T dG/dT = -2 T^3 sinh^2 T/(sinh^2 T - T^2)^2: one product, of one sign."""
    G = plate_factors()[0].expression
    value = -2 * T**3 * sp.sinh(T) ** 2 / ((sp.sinh(T) - T) * (sp.sinh(T) + T)) ** 2
    proof = prove(
        "Slope of the plate factor",
        r"$G$ is differentiated; the numerator reduces to $4 T^2 \sinh^2 T$.",
        lambda value: {"derivative": T * sp.diff(G, T) - value},
        value,
    )
    return Formula(
        "G_slope",
        r"T\,G'(T)",
        r"derivative of the plate factor of the contact face with respect to $\log T$",
        value,
        "1",
        "6",
        ("G",),
        proof,
    )
