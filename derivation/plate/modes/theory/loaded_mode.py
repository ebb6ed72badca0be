"""Step 5: the loaded mode: f_j, g_j and the stresses with C_k = A_j Omega_k."""

from functools import cache

from derivation.engine.formula.proof import prove
from derivation.plate.modes.theory.face_conditions import loaded
from derivation.plate.modes.theory.mode_shapes import mode_shapes, substitute
from derivation.plate.modes.theory.stresses import modal_stresses
from derivation.plate.vocabulary import A_j, Formula, h, z


@cache
def loaded_mode() -> tuple[Formula, ...]:
    """Return mode_f, mode_g, mode_zz, mode_rz, mode_rr, mode_tt: the response to A_j."""
    general = (*mode_shapes(), *modal_stresses())
    shapes = {formula.name: loaded(formula.expression) for formula in general}
    radial, axial = substitute(shapes["f_j"], shapes["g_j"])
    stated = [formula.expression for formula in general]
    proof = prove(
        "Loaded mode",
        "$f_j$ and $g_j$ under load satisfy both ODEs; with their stresses both faces are free of "
        "shear, the back face is free of pressure, and the contact face carries $A_j$.",
        lambda *claims: (
            {
                f"constants in {formula.name}": loaded(text) - value
                for formula, value, text in zip(general, claims[:6], claims[6:], strict=True)
            }
            | {
                "radial ODE": radial,
                "axial ODE": axial,
                "shear above": shapes["S_rz"].subs(z, h),
                "shear below": shapes["S_rz"].subs(z, -h),
                "pressure above": shapes["S_zz"].subs(z, h) - A_j,
                "pressure below": shapes["S_zz"].subs(z, -h),
            }
        ),
        *(*shapes.values(), *stated),
    )
    omegas = ("Omega_1", "Omega_2", "Omega_3", "Omega_4")
    return tuple(
        Formula(
            f"mode_{formula.name.strip('_j').removeprefix('S_')}",
            formula.latex,
            f"{formula.meaning}, under $A_j$",
            shapes[formula.name],
            formula.unit,
            formula.equation,
            (formula.name, *omegas),
            proof,
            stated=formula.expression,
        )
        for formula in general
    )
