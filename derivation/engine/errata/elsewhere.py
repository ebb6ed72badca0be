"""Points of the whole domain at which two formulas that agree at usual points may differ."""

import sympy as sp

from derivation.engine.formula.ball import enclose, to_ball
from derivation.engine.formula.grid import joint_points
from derivation.engine.formula.record import Record

DECADES, COUNT = 9, 60
"""Exponent of ten of the largest magnitudes, and number of points."""


def where_nonzero(difference: sp.Expr, formula: Record) -> str:
    """Return a point of a formula's domain at which a difference is not zero; "" if none is found.

    Coordinates have every sign and magnitude that the domain allows. Integrals, which take long,
    and symbols without a domain are not evaluated.
    """
    words = formula.vocabulary.with_conditions(formula.where)
    names = sorted(str(symbol) for symbol in difference.free_symbols)
    if difference.has(sp.Integral) or not set(names) <= words.by_name.keys():
        return ""
    for point in joint_points(formula.name, names, words, DECADES, COUNT):
        at = {words.by_name[name].symbol: to_ball(value) for name, value in point.items()}
        ball = enclose(difference, at)
        if ball.is_finite() and not ball.contains(0):
            return ", ".join(f"{name} = {value:.4g}" for name, value in point.items())
    return ""
