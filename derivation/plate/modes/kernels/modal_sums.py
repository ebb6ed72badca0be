"""Rows of the plate's modal sums, and what all its functions say and test."""

import sympy as sp

from derivation.engine.emit.budgets import Budget
from derivation.engine.emit.kernels import EmittedKernel, Style, kernel, lines
from derivation.engine.emit.printer import to_numpy
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.form import Form
from derivation.plate.vocabulary import ARGUMENTS, C1, C3

MODAL_SUMS = {
    "u": "mode_g(z, phi, h, lam, mu, A * phi) * bessel_j1(phi * r)",  # g * phi may be normal, not g
    "w": "mode_f(z, phi, h, lam, mu, A) * bessel_j0(phi * r)",
    # Their sum is small where Poisson's ratio is almost -1: it is rounded as little as can be.
    "sigma_rr": "((radial + hoop) * chord + radial * twist) * (A / unit)",
    "sigma_tt": "((radial + hoop) * chord + hoop * twist) * (A / unit)",
    "sigma_zz": "mode_zz(z, phi, h, lam, mu, A) * bessel_j0(phi * r)",
    "sigma_rz": "mode_rz(z, phi, h, lam, mu, A) * bessel_j1(phi * r)",
}
"""One mode's share of each sum that is put in terms of the other kernels."""

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

    One mode's share has a stable form of its own, or is one of `MODAL_SUMS`.
    """
    expression = formula.expression
    parts: tuple[Record, ...] = (formula,)
    if any(str(symbol).startswith("C") for symbol in expression.free_symbols):
        parts += (coefficient, factor)
    names = {x.name for part in parts for x in part.arguments}
    names -= {"phi", "J1", "A_j", "C1", "C2", "C3", "C4"}
    arguments = tuple(x for x in ARGUMENTS if x.name in names)
    steps = () if share is None else lines(share.steps)
    value = MODAL_SUMS[formula.name] if share is None else to_numpy(share.value)
    return kernel(
        formula, arguments, "modal_sum", budget, STYLE, steps=steps, value=value, modes=True
    )
