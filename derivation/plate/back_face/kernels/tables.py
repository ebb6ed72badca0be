"""The numbers that the generated code of the back face needs: where each way to compute ends."""

import sympy as sp

from derivation.engine.emit.package import Numbers
from derivation.engine.emit.tables import Constant

THIN = sp.Rational(1, 20)
"""h/b below which a plate's sum is that of this h/b: exp(-4.212/THIN (1 - alpha/2)) < 1e-18."""
WIDE = 1 / THIN
"""a/h from which on a wide contact's series holds; up to it a/b < 1 where h/b is THIN."""
FADED = 46
"""T beyond the first mode's from which on modes are left out: T^3 e^(-T) is below 1e-15 there."""


def numbers() -> Numbers:
    """Limits of the sum over the modes."""
    return Numbers(
        "back_face_numbers",
        "Numbers of the back face: where each way to compute its stress ends.",
        (
            Constant("THIN", float(THIN), "h/b below which another plate's sum is taken."),
            Constant("WIDE", float(WIDE), "a/h from which on a series in (2 h/a)^2 is taken."),
            Constant("FADED", float(FADED), "T beyond which modes are left out."),
        ),
    )
