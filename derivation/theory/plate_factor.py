"""Link 7: the plate factors G(T) and G_m(T), T = 2 phi h: influence over the half-space's."""

from functools import cache

from derivation.formula.proof import prove
from derivation.formula.record import Formula
from derivation.formula.symbols import T, h, phi
from derivation.theory.influence import influence_coefficients


@cache
def plate_factors() -> tuple[Formula, ...]:
    """G = C_top/C_half, G_m = C_bottom/C_half, and G - 1, which dies like e^(-2T)."""
    top, bottom, half = (formula.expression for formula in influence_coefficients())
    G, G_m = ((face / half).subs(phi, T / (2 * h)) for face in (top, bottom))
    proof = prove(
        "Plate factors",
        "The ratio of each influence coefficient to the half-space's depends on phi h alone.",
        {
            "loaded face": G.subs(T, 2 * phi * h) * half - top,
            "far face": G_m.subs(T, 2 * phi * h) * half - bottom,
        },
    )
    return (
        Formula("G", "G(T)", "plate factor of the loaded face", G, "1", "6", ("C_top",), proof),
        Formula(
            "G_m", "G_m(T)", "plate factor of the far face", G_m, "1", "6", ("C_bottom",), proof
        ),
        Formula(
            "G_minus_1",
            "G(T) - 1",
            "what the finite thickness adds to the half-space",
            G - 1,
            "1",
            "6",
            ("G",),
            proof,
        ),
    )
