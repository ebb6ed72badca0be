"""Formulas by name, and expressions that contain their names."""

from collections.abc import Mapping
from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.ball import enclosable, enclose, to_ball
from derivation.engine.formula.integral import HINT
from derivation.engine.formula.parse import FormulaError
from derivation.engine.formula.proof import sample_points
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.nearest import did_you_mean, one_of

_POINTS, _BITS = 6, 40


def comparable(formulas: Mapping[str, Record]) -> list[str]:
    """Return the names of formulas whose operations all exist in ball arithmetic."""
    return [name for name, formula in formulas.items() if enclosable(formula.expression)]


def known_formula(name: str, formulas: Mapping[str, Record]) -> Record:
    """Return the derived formula with a name.

    Raises
    ------
    FormulaError
        If there is no such formula, or it cannot be evaluated; the message suggests other names.
    """
    names = comparable(formulas)
    if name in formulas and name not in names:
        raise FormulaError(
            f"{name} is an equation, or is defined by an infinite sum or unknown functions, and "
            f"cannot be compared: expected one of {one_of(names)}"
        )
    if name not in names:
        hint = did_you_mean(name, names, most=3)
        raise FormulaError(
            f"no formula {name!r:.60}: {hint}expected one of {one_of(names)}; "
            "`platecontact derive` lists all formulas"
        )
    expression = formulas[name].expression
    if expression.has(sp.Integral) and not has_value(expression):
        raise FormulaError(
            f"{name} is defined by an integral whose error has no proved bound, and cannot be "
            f"compared: {HINT}"
        )
    return formulas[name]


@cache
def has_value(expression: sp.Expr) -> bool:
    """Return whether an expression has a finite ball at one of some random points."""
    with flint.ctx.workprec(_BITS):
        return any(
            enclose(expression, {s: to_ball(v) for s, v in point.items()}).is_finite()
            for point in sample_points(expression.free_symbols, _POINTS)
        )


def resolve(given: sp.Expr, formulas: Mapping[str, Record], vocabulary: Vocabulary) -> sp.Expr:
    """Return an expression with names of formulas replaced by their expressions.

    Raises
    ------
    FormulaError
        If a symbol is neither one of the paper's nor the name of a formula.
    """
    known = {*vocabulary.by_name, *vocabulary.guest_names}
    names = {s: s.name for s in given.free_symbols if s.name not in known}
    unknown = sorted(name for name in names.values() if name not in comparable(formulas))
    if unknown:
        own = ", ".join(vocabulary.by_name)
        raise FormulaError(f"unknown symbols {', '.join(unknown)}: expected some of {own}")
    return given.subs({symbol: formulas[name].expression for symbol, name in names.items()})
