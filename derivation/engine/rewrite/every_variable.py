"""Accuracy test of a form in several variables, in each of them over its domain."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import flint
import sympy as sp

from derivation.engine.formula.ball import PrecisionError, evaluate, to_ball
from derivation.engine.formula.grid import domain_grid
from derivation.engine.formula.record import Record
from derivation.engine.formula.ulp import overflows, ulp_error
from derivation.engine.rewrite.doubles import run
from derivation.engine.rewrite.form import Block, Step, Switch, switch_points
from derivation.engine.rewrite.terms import UnreachableError
from derivation.engine.rewrite.useful_range import ENOUGH

DIGITS = 25
ENOUGH_POINTS = 20
"""Smallest number of points with a value for a decision."""
SMALLEST = 1e-150
"""Smallest value of an argument; products of smaller ones underflow."""
LEAST_VALUE = 1e-300
"""Smallest value that is tested; smaller ones may be subnormal and have fewer digits."""


class LargestError(NamedTuple):
    """Largest error [ULP in addition to half the condition numbers], its point, point count."""

    error: float
    at: Mapping[str, float]
    points: int


def accurate(
    formula: Record, steps: tuple[Step, ...], value: sp.Expr | Switch, blocks: Mapping[str, Block]
) -> float:
    """Return the largest error [ULP] of a form that is accurate in every variable of its formula.

    Parameters
    ----------
    formula
        The formula, whose arguments have domains.
    steps, value
        The form.
    blocks
        Building blocks of forms.

    Raises
    ------
    UnreachableError
        If it is not accurate; the message states the point with the largest error.
    """
    worst = measured_error(formula, steps, value, blocks)
    if worst.error > ENOUGH:
        where = ", ".join(f"{name} = {x!r}" for name, x in worst.at.items())
        raise UnreachableError(
            f"the form found for {formula.name} has an error of {worst.error:.2g} ULP at {where}, "
            f"expected at most {ENOUGH:g}; narrow the domains of its arguments if such values do "
            "not occur, or state a form"
        )
    return worst.error


def measured_error(
    formula: Record, steps: tuple[Step, ...], value: sp.Expr | Switch, blocks: Mapping[str, Block]
) -> LargestError:
    """Return the largest error of a form at difficult points of every variable.

    Raises
    ------
    UnreachableError
        If too few of the points have a value.
    """
    names = [argument.name for argument in formula.arguments]
    symbols = {argument.name: argument.symbol for argument in formula.arguments}
    errors = []
    for point in domain_grid(formula.name, names, formula.vocabulary, switch_points([value])):
        if all(x == 0 or abs(x) >= SMALLEST for x in point.values()):
            at = {symbols[name]: x for name, x in point.items()}
            reference = _reference(formula.expression, at)
            if reference is not None:
                got = _computed(steps, value, at, blocks)
                errors.append((_beyond(formula.expression, reference, got, at), point))
    if len(errors) < ENOUGH_POINTS:
        raise UnreachableError(
            f"{formula.name} has values at {len(errors)} test points, expected {ENOUGH_POINTS}"
        )
    error, at_worst = max(errors, key=lambda pair: pair[0])
    return LargestError(error, at_worst, len(errors))


def _reference(expression: sp.Expr, at: Mapping[sp.Symbol, float]) -> flint.arb | None:
    """Return the value; None if it has no ball, overflows, or may be subnormal."""
    try:
        value = evaluate(expression, at, DIGITS)
    except (PrecisionError, NotImplementedError):
        return None
    return None if overflows(value) or not abs(value) > LEAST_VALUE else value


def _computed(
    steps: tuple[Step, ...],
    value: sp.Expr | Switch,
    at: Mapping[sp.Symbol, float],
    blocks: Mapping[str, Block],
) -> float:
    try:
        return run(steps, value, at, blocks)
    except (OverflowError, ZeroDivisionError):
        return math.nan


def _beyond(
    expression: sp.Expr, reference: flint.arb, got: float, at: Mapping[sp.Symbol, float]
) -> float:
    """Return the error [ULP], less half the condition numbers if it is large."""
    error = ulp_error(got, reference)
    if not ENOUGH / 2 < error < math.inf:
        return error
    for symbol, x in at.items():
        try:
            slope = evaluate(expression.diff(symbol), at, 3)
        except (PrecisionError, NotImplementedError):
            continue  # then no conditioning is taken into account
        with flint.ctx.workprec(64):
            error -= float(abs(slope * to_ball(x) / reference).abs_upper()) / 2
    return max(error, 0.0)
