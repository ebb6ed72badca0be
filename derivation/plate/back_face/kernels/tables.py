"""Constants for the generated code of the back face: limits of each method."""

import sympy as sp

from derivation.engine.emit.modules import Numbers
from derivation.engine.emit.tables import Constant

THIN = sp.Rational(1, 20)
"""h/b below which the sum for this h/b is used: exp(-4.212/THIN (1 - alpha/2)) < 1e-18."""
WIDE = 1 / THIN
"""a/h above which the series of a wide contact is used; below, a/b < 1 where h/b is THIN."""
NARROW = sp.Rational(1, 4)
"""a/h up to which g is its Taylor polynomial, so that sums over the modes depend on h/b alone."""
TERMS = 12
"""Number of terms of this polynomial. The remainder is below the next term, as g is a mean of
cosines: below 1e-17 of S for a/h up to `NARROW` and a/b up to 1."""
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
            Constant("NARROW", float(NARROW), "a/h up to which a polynomial in a is used."),
            Constant("TERMS", TERMS, "Number of terms of this polynomial."),
            Constant(
                "FADED",
                float(FADED),
                "T minus T of the first mode, beyond which modes are omitted.",
            ),
        ),
    )
