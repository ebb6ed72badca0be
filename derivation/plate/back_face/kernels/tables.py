"""Constants for the generated code of the back face: limits of each method."""

import sympy as sp

from derivation.engine.emit.package import Numbers
from derivation.engine.emit.tables import Constant

THIN = sp.Rational(1, 20)
"""h/b below which the sum for this h/b is used: exp(-4.212/THIN (1 - alpha/2)) < 1e-18."""
WIDE = 1 / THIN
"""a/h above which the series of a wide contact is used; below, a/b < 1 where h/b is THIN."""
FADED = 46
"""T minus T of the first mode, above which modes are omitted: T^3 e^(-T) is below 1e-15."""


def numbers() -> Numbers:
    """Return the limits of the sum over the modes."""
    return Numbers(
        "back_face_numbers",
        "Constants of the back face: limits of the methods for its stress.",
        (
            Constant("THIN", float(THIN), "h/b below which the sum for this h/b is used."),
            Constant("WIDE", float(WIDE), "a/h above which a series in (2 h/a)^2 is used."),
            Constant(
                "FADED",
                float(FADED),
                "T minus T of the first mode, beyond which modes are omitted.",
            ),
        ),
    )
