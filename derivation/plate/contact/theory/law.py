"""Step 9: deflection under the sphere -> K_j and the contact law (6).

The indentation is delta = -w(0, +h) = sum K_j s(a phi_j), s(y) = sin y - y cos y: K_j includes the
prefactor of A_j.
"""

from functools import cache

from derivation.engine.formula.proof import prove
from derivation.plate.contact.theory.hertz import SINE_MINUS, pressure_coefficient
from derivation.plate.modes.theory.face_conditions import loaded
from derivation.plate.modes.theory.influence import influence_coefficients
from derivation.plate.modes.theory.mode_shapes import mode_shapes
from derivation.plate.vocabulary import A_j, Formula, h, z


@cache
def contact_law() -> tuple[Formula, ...]:
    """Return K_j on the contact face and on the back face, and one mode's term of delta."""
    top, bottom, _ = influence_coefficients()
    coefficient = pressure_coefficient().expression
    prefactor = -coefficient / SINE_MINUS
    faces = {
        name: face.expression * prefactor for name, face in (("K_j", top), ("K_j_bottom", bottom))
    }
    mode_term = -loaded(mode_shapes()[0].expression).subs(A_j, coefficient)
    terms = (*faces.values(), faces["K_j"] * SINE_MINUS)
    proof = prove(
        "Contact law",
        r"$K_j s(a \phi_j)$ equals $-f_j(\pm h)$ with the constants of the face conditions and "
        "the coefficients of Hertz pressure.",
        lambda K_j, K_j_bottom, delta: {
            "contact face": K_j * SINE_MINUS - mode_term.subs(z, h),
            "back face": K_j_bottom * SINE_MINUS - mode_term.subs(z, -h),
            "indentation": delta - mode_term.subs(z, h),
        },
        *terms,
    )
    return (
        Formula(
            "K_j",
            "K_j",
            r"factor of $s(a \phi_j)$ in the indentation, on the contact face $z = +h$",
            faces["K_j"],
            "m",
            "6",
            ("C_top", "A_j"),
            proof,
        ),
        Formula(
            "K_j_bottom",
            r"K_j^{-}",
            r"factor of $s(a \phi_j)$ in the deflection of the back face $z = -h$",
            faces["K_j_bottom"],
            "m",
            "6",
            ("C_bottom", "A_j"),
            proof,
        ),
        Formula(
            "delta",
            r"\delta",
            "indentation, plate deflection included",
            terms[2],
            "m",
            "6",
            ("K_j",),
            proof,
            summed=True,
        ),
    )
