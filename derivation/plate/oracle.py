"""Arb references of the plate: formulas, Bessel functions, constants by index."""

from collections.abc import Mapping

import flint
import sympy as sp

from derivation.engine.formula.record import Record
from derivation.engine.oracle.oracle import Balls, Terms
from derivation.mathematics.bessel.oracle import j0_zero, j1_at_zero, j1_zero
from derivation.plate import vocabulary as symbols
from derivation.plate.chain import derive
from derivation.plate.contact.oracle import moments
from derivation.plate.derived import formulas
from derivation.plate.modes.theory.equilibrium import BESSEL_J1
from derivation.plate.modes.theory.face_conditions import loaded

_x = sp.Symbol("x", real=True)


def _mode(j: int, values: Mapping[str, flint.arb], bits: int) -> dict[str, flint.arb]:
    return {"phi": j0_zero(j, bits) / values["b"], "J1": j1_at_zero(j, bits)}


def _loaded_term(formula: Record) -> sp.Expr:
    """Return one term of a modal sum, with the constants that the load determines."""
    coefficient, _ = ORACLE.stated("A_j")
    return loaded(formula.expression).subs(symbols.A_j, coefficient.expression)


def _limit_on_axis(expression: sp.Expr) -> sp.Expr | None:
    """Return the value at r = 0 of an expression that contains J1(phi r)/r, with limit phi/2.

    J1(y) = y/2 + O(y^3), and r occurs in denominators as 1/r only, so the leading term
    determines the limit. If the result is not finite, ball arithmetic raises an error.
    """
    powers = expression.atoms(sp.Pow)
    if not any(power.base == symbols.r and power.exp < 0 for power in powers):
        return None
    return expression.xreplace({BESSEL_J1: symbols.phi * symbols.r / 2}).subs(symbols.r, 0)


ORACLE = Balls(
    symbols.PLATE,
    derive,
    formulas,
    functions={"bessel_j0": (_x, sp.besselj(0, _x)), "bessel_j1": (_x, sp.besselj(1, _x))},
    numbers={
        "bessel_j0_zeros": ("count", j0_zero),
        "bessel_j1_zeros": ("count", j1_zero),
        "bessel_j1_at_j0_zeros": ("count", j1_at_zero),
        "kappa": ("n", moments.kappa),
        "kappa_ratio": ("n", moments.kappa_ratio),
        "finite_part": ("k", moments.finite_part),
        "finite_part_ratio": ("k", moments.finite_part_ratio),
    },
    # b also acts through phi = j_n/b; phi and J1 stand for j_n and J1(j_n) from a table.
    terms=Terms((symbols.phi, symbols.J1), _mode, {"phi": ("b", -1)}, _loaded_term),
    limit=("r", _limit_on_axis),
)
certified_value, reference, stated = ORACLE.value, ORACLE.reference, ORACLE.stated
names, arguments, is_summed = ORACLE.names, ORACLE.arguments, ORACLE.is_summed
