"""Rows of the plate's modal sums, and what all its functions say and test."""

import sympy as sp

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.kernels import EmittedKernel, Style, kernel, lines
from derivation.engine.emit.printer import to_numpy
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.form import Form
from derivation.plate.modes.kernels.shares import ARGUMENTS as SHARE_ARGUMENTS
from derivation.plate.vocabulary import ARGUMENTS, C1, C3, A_j

TESTED = {"phi * h >= 1e-151": {"phi", "h"}, "T >= 1e-151": {"T"}}
"""Conditions that end a domain where the tests do, with the arguments they are about.

Below, products of such numbers leave the range of doubles.
"""


def _constants(stated: sp.Expr) -> str:
    return ", C_k = A_j*Omega_k" if stated.has(C1) or stated.has(C3) else ""


STYLE = Style(TESTED, _constants)


def kernel_of_sum(
    formula: Record, coefficient: Record, factor: Record, budget: Budget, share: Form | None
) -> EmittedKernel:
    """Row of a modal sum: its arguments are those of its parts, less phi and J1.

    One mode's share has a stable form of its own, or is a routine of `shares`.
    """
    expression = formula.expression
    parts: tuple[Record, ...] = (formula,)
    if any(str(symbol).startswith("C") for symbol in expression.free_symbols):
        parts += (coefficient, factor)
    names = {x.name for part in parts for x in part.arguments}
    names -= {"phi", "J1", "A_j", "C1", "C2", "C3", "C4"}
    arguments = tuple(x for x in ARGUMENTS if x.name in names)
    under = f"{coefficient.name}({', '.join(x.name for x in coefficient.arguments)})"
    steps = () if share is None else lines(share.steps)
    given = ", ".join(under if x == A_j else str(x) for x in SHARE_ARGUMENTS)
    value = f"{formula.name}_of_mode({given})" if share is None else to_numpy(share.value)
    return kernel(
        formula, arguments, "modal_sum", budget, STYLE, steps=steps, value=value, modes=True
    )
