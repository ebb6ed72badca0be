"""Step 10: the whole interior: displacements and stresses at any (r, z) as modal sums."""

from functools import cache

import sympy as sp

from derivation.engine.formula.proof import lower_bessel, prove
from derivation.plate.modes.theory.equilibrium import BESSEL_J0, BESSEL_J1, force_balance, hooke
from derivation.plate.modes.theory.mode_shapes import mode_shapes
from derivation.plate.modes.theory.stresses import modal_stresses
from derivation.plate.vocabulary import J1, Formula, b, mu, phi, r

_MEANING = {
    "u": ("u(r,z)", "radial displacement", "m"),
    "w": ("w(r,z)", "axial displacement", "m"),
    "sigma_rr": (r"\sigma_{rr}(r,z)", "radial stress", "Pa"),
    "sigma_tt": (r"\sigma_{\theta\theta}(r,z)", "hoop stress", "Pa"),
    "sigma_zz": (r"\sigma_{zz}(r,z)", "axial stress", "Pa"),
    "sigma_rz": (r"\sigma_{rz}(r,z)", "shear stress", "Pa"),
}


@cache
def interior_fields() -> tuple[Formula, ...]:
    """Return one term of u, w and the four stresses, in the constants C1 ... C4 = A_j Omega_k."""
    f_j, g_j = (formula.expression for formula in mode_shapes())
    shape = {formula.name: formula.expression for formula in modal_stresses()}
    names = (*shape, "f_j", "g_j")
    S_zz, S_rz, S_rr, S_tt, f, g = (sp.Symbol(name) for name in names)
    stated = {
        "u": g * phi * BESSEL_J1,
        "w": f * BESSEL_J0,
        "sigma_rr": S_rr * BESSEL_J0 - 2 * mu * g * phi * BESSEL_J1 / r,
        "sigma_tt": S_tt * BESSEL_J0 + 2 * mu * g * phi * BESSEL_J1 / r,
        "sigma_zz": S_zz * BESSEL_J0,
        "sigma_rz": S_rz * BESSEL_J1,
    }
    written_out = {sp.Symbol("f_j"): f_j, sp.Symbol("g_j"): g_j} | {
        sp.Symbol(name): value for name, value in shape.items()
    }
    fields = {name: value.subs(written_out) for name, value in stated.items()}
    stress = hooke(fields["u"], fields["w"])
    radial, axial = force_balance(stress)

    def residuals(*claims: sp.Expr) -> dict[str, sp.Expr]:
        given, texts = claims[: len(fields)], claims[len(fields) :]
        u, w, *stresses = given
        return {
            "sigma_rr": stress.rr - stresses[0],
            "sigma_tt": stress.tt - stresses[1],
            "sigma_zz": stress.zz - stresses[2],
            "sigma_rz": stress.rz - stresses[3],
            "radial balance": radial,
            "axial balance": axial,
            "edge": _on_edge(sp.diff(u, r) + u / r),
            "edge deflection": _on_edge(w),
        } | {
            f"{name} in step 3": text.subs(written_out) - value
            for name, text, value in zip(fields, texts, given, strict=True)
        }

    proof = prove(
        "Interior fields",
        "The stresses follow from the displacements by Hooke's law and are in equilibrium; $w$ "
        r"and $u/r + du/dr$ vanish on the edge, where $J_0(b \phi) = 0$.",
        residuals,
        *(*fields.values(), *stated.values()),
    )
    return tuple(
        Formula(
            name,
            latex,
            meaning,
            fields[name],
            unit,
            "1",
            ("f_j", "g_j", "S_rr", "S_tt", "S_zz", "S_rz"),
            proof,
            summed=True,
            stated=stated[name],
        )
        for name, (latex, meaning, unit) in _MEANING.items()
    )


def _on_edge(expression: sp.Expr) -> sp.Expr:
    """Return an expression at r = b, where J0(b phi) = 0 and J1(b phi) is the symbol J1."""
    lowered = sp.expand(lower_bessel(expression).subs(r, b))
    return lowered.subs({sp.besselj(0, b * phi): 0, sp.besselj(1, b * phi): J1})
