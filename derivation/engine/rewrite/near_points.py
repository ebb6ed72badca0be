"""Formulas in which terms cancel at a point other than 0, or on both sides of 0: series about it.

Near the point p the formula is a function of u = x - p, which is not rounded there. The logarithm
of a linear expression, which is 1 at p, is 2 atanh t, where t = b u/(2 + b u), and its series
converges faster than that in u. Sums that cancel are replaced by truncated series for both signs of
u or t; elsewhere the formula itself is used.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import sympy as sp

from derivation.engine.rewrite.form import Branch, Step, Switch
from derivation.engine.rewrite.rules import decay, fraction, half_angle, logarithm, with_series
from derivation.engine.rewrite.shape import Factor, Shape, assembled_form
from derivation.engine.rewrite.stabilise import Stable
from derivation.engine.rewrite.terms import UnreachableError

DISTANCES = tuple(sp.Rational(n, 4) for n in (8, 4, 3, 2, 1))
"""Possible distances up to which series are used; the largest that they reach is taken."""


def cancelling_points(expression: sp.Expr, x: sp.Symbol) -> Iterator[sp.Rational]:
    """Yield the positive rational points at which a logarithm, or another argument, is zero."""
    points: dict[sp.Rational, None] = {}
    for function in expression.atoms(sp.Function):
        zeros = sp.numer(sp.together(function.args[0] - int(isinstance(function, sp.log))))
        if zeros.has(x) and zeros.is_polynomial(x):
            roots = sp.Poly(zeros, x).ground_roots()
            points |= dict.fromkeys(root for root in sorted(roots) if root > 0)
    yield from points


def about_point(expression: sp.Expr, x: sp.Symbol, point: sp.Rational) -> Stable:
    """Return the form by series about a point, and the formula itself elsewhere; not tested.

    Raises
    ------
    UnreachableError
        If no sum has a series about the point, or none cancels there.
    """
    own, plain = sp.Dummy(positive=True), expression  # the rules hold for both signs
    expression = expression.replace(_is_log_of_power, _times_exponent)
    change, ratio, distance = (
        sp.Symbol(f"{name}_of_{x}", real=True) for name in ("change", "ratio", "distance")
    )
    change = change if point else x
    steps: tuple[Step, ...] = (Step(change, x - point),) if point else ()
    of_ratio = _by_inverse_tangent(expression, x, own)
    if of_ratio is None:
        given, near = expression.xreplace({x: point + own}), change
    else:
        given, base, near = *of_ratio, ratio
        steps = *steps, Step(ratio, base.diff(x) * change / (base + 1))
    for rule in (logarithm, fraction, half_angle, decay):
        given = next(rule(own, given), given)
    assert isinstance(given, Shape)  # `decay` always returns a shape
    # Where x is near 0, a factor x would be p + u, which cancels.
    most = point if point and of_ratio is None else sp.oo
    factors, at = _with_series(given.factors, own, [at for at in DISTANCES if at < most])
    if all(factor.near is None for factor in factors):
        raise UnreachableError(f"no terms of {expression} cancel at {x} = {point}")
    _, switch = assembled_form(replace(given, factors=factors, switch=at))
    assert isinstance(switch, Switch)  # because the shape has a switch point
    rows = (replace(s, expression=s.expression.xreplace({own: near})) for s in switch.below.steps)
    below = Branch(tuple(rows), switch.below.value.xreplace({own: near}))
    steps = *steps, Step(distance, sp.Abs(near))
    value = Switch(distance, at, below, Branch((), plain))
    truncation = sp.Add(*(factor.truncation for factor in factors))
    return Stable(plain, x, steps, value, (), math.inf, truncation, plain)


def _is_log_of_power(node: sp.Basic) -> bool:
    return isinstance(node, sp.log) and node.args[0].is_Pow and node.args[0].exp.is_Rational


def _times_exponent(logarithm: sp.Expr) -> sp.Expr:
    base, exponent = logarithm.args[0].as_base_exp()
    return exponent * sp.log(base)


def _by_inverse_tangent(
    expression: sp.Expr, x: sp.Symbol, t: sp.Symbol
) -> tuple[sp.Expr, sp.Expr] | None:
    """Return a rational function of x and log(a + b x) in t, and a + b x; None for others."""
    logarithms = expression.atoms(sp.log)
    if len(logarithms) != 1:
        return None
    (function,), value = logarithms, sp.Dummy()
    base, rational = function.args[0], expression.xreplace({function: value})
    if not (base.is_polynomial(x) and sp.degree(base, x) == 1):
        return None
    if not rational.is_rational_function(x, value):
        return None
    inverse = ((1 + t) / (1 - t) - base.subs(x, 0)) / base.diff(x)
    return sp.cancel(rational.xreplace({x: inverse})).xreplace({value: 2 * sp.atanh(t)}), base


def _with_series(
    factors: tuple[Factor, ...], own: sp.Symbol, distances: Sequence[sp.Rational]
) -> tuple[tuple[Factor, ...], sp.Rational]:
    """Return the factors with series for both signs, and the distance that they reach."""
    reasons = [UnreachableError("the point is too close to 0")]
    for at in distances:
        try:
            rows = [with_series(factor, own, at, both_signs=True) for factor in factors]
        except UnreachableError as error:
            reasons.append(error)
        else:  # a sum that does not cancel is not divided by its leading power, which may be zero
            return tuple(row if row.near is not None else replace(row, lead=0) for row in rows), at
    raise reasons[-1]
