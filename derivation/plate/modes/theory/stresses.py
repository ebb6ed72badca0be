"""Step 3: f_j, g_j -> displacements and stresses of one mode, anywhere in the plate."""

from functools import cache

from derivation.engine.formula.proof import prove
from derivation.plate.modes.theory.equilibrium import (
    BESSEL_J0,
    BESSEL_J1,
    factor_of,
    force_balance,
    hooke,
)
from derivation.plate.modes.theory.mode_shapes import by_constants, mode_shapes
from derivation.plate.vocabulary import Formula, mu, phi, r

_NAMES = {
    "S_zz": ("S_{zz}(z)", r"axial stress of mode $j$, factor of $J_0(\phi r)$"),
    "S_rz": ("S_{rz}(z)", r"shear stress of mode $j$, factor of $J_1(\phi r)$"),
    "S_rr": ("S_{rr}(z)", r"radial stress of mode $j$, factor of $J_0(\phi r)$"),
    "S_tt": ("S_{tt}(z)", r"hoop stress of mode $j$, factor of $J_0(\phi r)$"),
}


@cache
def modal_stresses() -> tuple[Formula, ...]:
    """Return the stresses through the thickness.

    sigma_zz = S_zz J0, sigma_rz = S_rz J1,
    sigma_rr = S_rr J0 - 2 mu g phi J1/r, sigma_tt = S_tt J0 + 2 mu g phi J1/r.
    """
    f_j, g_j = (formula.expression for formula in mode_shapes())
    stress = hooke(g_j * phi * BESSEL_J1, f_j * BESSEL_J0)
    ring = 2 * mu * g_j * phi * BESSEL_J1 / r
    shapes = {
        "S_zz": factor_of(stress.zz, BESSEL_J0),
        "S_rz": factor_of(stress.rz, BESSEL_J1),
        "S_rr": factor_of(stress.rr + ring, BESSEL_J0),
        "S_tt": factor_of(stress.tt - ring, BESSEL_J0),
    }
    shapes = {name: by_constants(shape) for name, shape in shapes.items()}
    radial, axial = force_balance(stress)
    proof = prove(
        "Modal stresses",
        "The separated stresses are those of the mode by Hooke's law, and they are in equilibrium.",
        lambda zz, rz, rr, tt: {
            "sigma_zz": stress.zz - zz * BESSEL_J0,
            "sigma_rz": stress.rz - rz * BESSEL_J1,
            "sigma_rr": stress.rr + ring - rr * BESSEL_J0,
            "sigma_tt": stress.tt - ring - tt * BESSEL_J0,
            "radial balance": radial,
            "axial balance": axial,
        },
        *shapes.values(),
    )
    return tuple(
        Formula(
            name,
            latex,
            meaning,
            shapes[name],
            "Pa",
            "",
            ("f_j", "g_j"),
            proof,
        )
        for name, (latex, meaning) in _NAMES.items()
    )
