"""The generated functions, and their stable forms."""

from collections.abc import Mapping
from pathlib import Path

import sympy as sp
from sympy.codegen.cfunctions import expm1

from derivation.engine.emit.package import FormulaModule, PackageSettings, Shape
from derivation.engine.rewrite.form import FAR, Block, Step, limited

from .vocabulary import T, s

x = sp.Symbol("x", positive=True)
REWRITTEN = ("F_slipping", "C_slipping")
"""Formulas whose forms are found by the rewriting rules."""


def stated(known: Mapping[str, Block]) -> dict[str, Shape]:
    """Return the form of the bonded film: 2 (kappa sinh T - T) is a sum of two positive parts.

    kappa is 1 + 2 s. For small s, a nearly incompressible film, the form that the rules find is
    less accurate.
    """
    difference, kappa = known["sinh_minus"], 1 + 2 * s
    above = difference.near(x) ** 3 * difference(x) - 2 * s * expm1(-2 * x)
    below = kappa * (1 + sp.exp(-2 * x)) + sp.exp(-x) * (1 + kappa**2 + x**2)
    return {
        "F_bonded": ((Step(x, limited(T, FAR), "constant for larger values"),), above / below),
    }


FILM = "F_bonded", "F_slipping", "C_slipping"
MODULES = [
    FormulaModule("film", "Influence coefficients of a film.", FILM),
]
PACKAGE = PackageSettings(
    summary="Influence coefficients of an elastic film: functions that need only NumPy.",
    citation="A film on a rigid base",
    parts=tuple(MODULES),
    budgets=Path(__file__).with_name("budgets.toml"),
    stated=stated,
)
