"""Rows of the modal sums, and the conditions and text common to all printed functions."""

from collections.abc import Mapping

import mpmath
import sympy as sp

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.kernels import EmittedKernel, Style, kernel, lines
from derivation.engine.emit.printer import to_numpy
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.form import Form
from derivation.plate.modes.kernels.contributions import ARGUMENTS as CONTRIBUTION_ARGUMENTS
from derivation.plate.vocabulary import ARGUMENTS, C1, C2, C3, C4, J1, PLATE, A_j, b, phi

TESTED = {
    "phi * h >= 1e-151": {"phi", "h"},
    "phi * h <= 1e150": {"phi", "h", "z"},
    "T >= 1e-151": {"T"},
    "h >= 1e-90 * b": {"h", "b", "a"},
    "h <= 1e90 * b": {"h", "b", "a"},
}
"""Conditions that limit a domain to the tested range, each with arguments of the functions that
need it.

Beyond, products of such numbers leave the range of doubles.
"""
EXAMPLE_MODES = 3
"""Number of modes that the examples sum."""


def _constants(stated: sp.Expr) -> str:
    return ", C_k = A_j*Omega_k" if stated.has(C1) or stated.has(C3) else ""


STYLE = Style(TESTED, _constants, "generated")


def kernel_of_sum(
    formula: Record, formulas: Mapping[str, Record], budget: Budget, term: Form | None
) -> EmittedKernel:
    """Return the row of a modal sum: its arguments are those of its parts without phi and J1.

    The contribution of one mode has a stable form of its own, or is a routine of `contributions`.
    """
    expression, coefficient = formula.expression, formulas["A_j"]
    parts: tuple[Record, ...] = (formula,)
    if any(str(symbol).startswith("C") for symbol in expression.free_symbols):
        parts += (coefficient, formulas["Omega_1"])
    names = {x.name for part in parts for x in part.arguments}
    names -= {"phi", "J1", "A_j", "C1", "C2", "C3", "C4"}
    arguments = tuple(x for x in ARGUMENTS if x.name in names)
    under = f"{coefficient.name}({', '.join(x.name for x in coefficient.arguments)})"
    steps = () if term is None else lines(term.steps)
    given = ", ".join(under if x == A_j else str(x) for x in CONTRIBUTION_ARGUMENTS)
    value = f"{formula.name}_of_mode({given})" if term is None else to_numpy(term.value)
    result = _of_modes(expression, formulas)
    return kernel(
        formula, arguments, "modal_sum", budget, STYLE,
        steps=steps, value=value, modes=EXAMPLE_MODES, result=result,
    )  # fmt: skip


def _of_modes(term: sp.Expr, formulas: Mapping[str, Record]) -> sp.Expr:
    """Return the sum over the first modes at the vocabulary's sample values."""
    for k, constant in enumerate((C1, C2, C3, C4), start=1):
        term = term.xreplace({constant: A_j * formulas[f"Omega_{k}"].expression})
    term = term.xreplace({A_j: formulas["A_j"].expression})
    with mpmath.workdps(40):
        zeros = [mpmath.besseljzero(0, n + 1) for n in range(EXAMPLE_MODES)]
        samples = {x.symbol: sp.Float(PLATE.values[x.name], 40) for x in PLATE.arguments
                   if x.name in PLATE.values}  # fmt: skip
        of_mode = (
            {phi: sp.Float(j, 40) / samples[b], J1: sp.Float(mpmath.besselj(1, j), 40)}
            for j in zeros
        )
        return sp.Add(*(term.xreplace(samples | mode) for mode in of_mode))
