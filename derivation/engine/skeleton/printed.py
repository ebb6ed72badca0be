"""The published formulas; one of them contains a misprint."""

import sympy as sp

from derivation.engine.errata.findings import Printed
from derivation.engine.errata.relations import Formulas, Meanings, Relations, Symbols

from .vocabulary import H, T, k, nu, s

PRINTED = (
    Printed(
        "F_bonded",
        "3",
        "F_b",
        r"\frac{2 (3 - 4\nu) \sinh T - 2 T}{2 (3 - 4\nu) \cosh T + 1 + (3 - 4\nu)^2 + T^2}",
        (2 * (3 - 4 * nu) * sp.sinh(T) - 2 * T)
        / (2 * (3 - 4 * nu) * sp.cosh(T) + 1 + (3 - 4 * nu) ** 2 + T**2),
    ),
    Printed(
        "F_slipping",
        "4",
        "F_s",
        r"\frac{\cosh T - 1}{\sinh T - T}",
        (sp.cosh(T) - 1) / (sp.sinh(T) - T),
    ),
)


def between(_: str, given: Symbols, derived: Symbols, __: Formulas) -> Meanings:
    """Return the dependent symbols of a comparison with their expressions: nu and T."""
    used = given | derived
    meanings = {nu: (1 - s) / 2} if nu in used else {}
    return meanings | ({T: 2 * k * H} if T in used and {k, H} & used else {})


RELATIONS = Relations(between)
