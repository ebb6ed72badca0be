"""Turns the theory of the far face into the numbers its generated code needs."""

from pathlib import Path

import sympy as sp

from derivation.plate.back_face.theory import WIDE_TERMS, far_powers, moment_of_wave
from derivation.plate.blocks import blocks
from derivation.plate.modules import FunctionRow, TemplateModule

THIN = sp.Rational(1, 20)
"""h/b below which a plate's sum is that of this h/b: exp(-4.212/THIN (1 - alpha/2)) < 1e-18."""
WIDE = 1 / THIN
"""a/h from which on the wide contact's series serves; up to it a/b < 1 where h/b is THIN."""
FADED = 46
"""T beyond the first mode's from which on modes are left out: T^3 e^(-T) is below 1e-15 there."""


def far_face_context() -> dict[str, object]:
    """What the template of the generated far face needs, numbers as text."""
    plain = float(3 * (sp.Rational(4, 3) - sp.log(2)))
    powers = far_powers()
    # By powers of (2/A)^2, from the first on.
    series = [float(powers[k] * moment_of_wave(k) / 2) for k in range(WIDE_TERMS)]
    return {
        "thin": repr(float(THIN)),
        "wide": repr(float(WIDE)),
        "faded": f"{FADED}.0",
        "plain": repr(plain),
        "series": [repr(value) for value in series],
        "seam": repr(float(blocks()["sinh_pair"].value.at)),
    }


FOLDER = Path(__file__).parent
MODULES = (
    TemplateModule(
        "back_face",
        FOLDER,
        far_face_context,
        (
            FunctionRow(
                "far_stress",
                ("P", "a", "h", "b", "lam", "mu"),
                "Pa",
                r"\sigma_{rr}(0, -h)",
                "",
                "tension of the far face under the axis",
            ),
            FunctionRow(
                "supported_far_stress",
                ("P", "a", "h", "b", "lam", "mu"),
                "Pa",
                r"\sigma_{rr}(0, -h)",
                "",
                "tension of the far face under the axis, simple support",
            ),
            FunctionRow(
                "clamped_far_stress",
                ("P", "a", "h", "b", "lam", "mu"),
                "Pa",
                r"\sigma_{rr}(0, -h)",
                "",
                "tension of the far face under the axis, clamp",
            ),
        ),
    ),
)
