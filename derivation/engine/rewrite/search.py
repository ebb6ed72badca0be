"""Search for the stable form of an expression by rules, compositions and switch points."""

import contextlib
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import permutations

import sympy as sp

from derivation.engine.rewrite.accuracy_test import ExactPoint, accuracy_test, assembled
from derivation.engine.rewrite.compositions import MOST_OPERATIONS, Composition, compositions
from derivation.engine.rewrite.form import Branch, Step, Switch
from derivation.engine.rewrite.near_points import about_point, cancelling_points
from derivation.engine.rewrite.rules import RULES, SWITCHES
from derivation.engine.rewrite.stabilise import (
    Applied,
    FormErrors,
    Stable,
    apply_rules,
    decayed,
    failure,
    operations_of,
    stabilise,
)
from derivation.engine.rewrite.substitutions import Substitution, substitutions
from derivation.engine.rewrite.terms import UnreachableError
from derivation.engine.rewrite.useful_range import (
    ENDS,
    ENOUGH,
    LEAST_RATIO,
    range_size,
    useful_range,
)

_LEAST = 1e-300
"""Smallest power of x, and inverse of the largest, for which forms are searched."""
USUAL = 1e9
"""Largest of the usual numbers, and the inverse of the smallest."""
FACTORS, ABOUT = "factors", "series about a point"
"""Names of the rules that write x - p as a factor for each zero p, and that of `near_points`."""
CLEARLY = 0.5 * ENOUGH
"""Error [ULP] up to which the first form is taken, because the code is tested at more points."""


def stabilised(
    expression: sp.Expr, x: sp.Symbol, ends: tuple[float, float] = ENDS, depth: int = 2
) -> Stable:
    """Return the stable form of an expression in the largest range in which there is one.

    The rules are applied to the expression, then to inner functions of compositions and to the
    expression in another variable, up to the given depth, then in a part of the range. If no form
    is clearly accurate everywhere, two are joined at a switch point.

    Raises
    ------
    UnreachableError
        If there is no form in any useful range; the message states the first reason.
    """
    reasons: list[UnreachableError] = []
    forms: list[_Found] = []
    for search, loss, rule in _searches(expression, x, ends, depth):
        try:
            forms.append(_tested(search(), ends, loss, rule))
        except UnreachableError as error:
            if rule not in (FACTORS, ABOUT):  # few formulas need these
                reasons.append(error)
            continue
        wide = rule == FACTORS and forms[-1].size[0] >= range_size((1 / USUAL, USUAL))[0]
        if forms[-1].worst <= CLEARLY or wide:
            return _with_account(forms[-1], ends)
    if depth:
        with contextlib.suppress(UnreachableError):
            for direct in (_direct(expression, x, expression), without_series(expression, x, ends)):
                forms.append(_tested(direct, ends, 1.0))
        forms += _joined(forms, ends)
    best = max(forms, key=lambda one: (one.size, -one.worst), default=None)
    if depth and ends == ENDS and (best is None or best.size[0] < 0):
        best = _usual(forms)
    if best is None or best.size[0] < 0:
        raise reasons[0] if reasons else UnreachableError(f"{expression} is ill-conditioned")
    return _with_account(best, ends)


@dataclass(frozen=True)
class _Found:
    """A form with its errors in a range, and the size of the part in which it is accurate.

    `rule` is the name of the rule that led to the form of another function, empty if there is none.
    """

    stable: Stable
    errors: tuple[tuple[ExactPoint, float], ...]
    size: tuple[float, float]
    rule: str = ""

    @property
    def worst(self) -> float:
        """The largest error at any point [ULP]."""
        return max(error for _, error in self.errors)


def _usual(forms: Sequence[_Found]) -> _Found | None:
    """Return the form that is accurate in the largest range, if that contains all usual numbers.

    It is less accurate elsewhere, as a root of a huge number by a rounded exponent is.
    """
    ranges = [(_accurate(form.errors, ENDS), form) for form in forms]
    wide = [
        replace(form, size=range_size((low, high)))
        for (low, high), form in ranges
        if low <= 1 / USUAL and high >= USUAL
    ]
    return max(wide, key=lambda one: (one.size, -one.worst), default=None)


def _tested(stable: Stable, ends: tuple[float, float], loss: float, rule: str = "") -> _Found:
    test = accuracy_test(stable.expression, stable.variable, ends, stable.equal)
    errors = tuple(test.errors(stable.steps, stable.value))
    return _Found(stable, errors, range_size(_well_conditioned(errors, ends, loss)), rule)


def _with_account(form: _Found, ends: tuple[float, float]) -> Stable:
    """Return the form, with an account of the rule that led to the form of another function."""
    stable, given = form.stable, form.stable.expression
    if not form.rule:
        return stable
    low, high = _accurate(form.errors, ends)
    test = accuracy_test(given, stable.variable, ends, stable.equal)
    worst, left = (
        max((error for at, error in errors if low <= at.x <= high), default=math.inf)
        for errors in (test.errors((), given), form.errors)
    )
    count = max(operations_of(stable.steps, stable.value))
    row = Applied(form.rule, "cancellation", (given.count_ops(), count), (worst, left))
    return replace(stable, applied=(row, *stable.applied))


def _direct(expression: sp.Expr, x: sp.Symbol, written: sp.Expr) -> Stable:
    """Return an expression that is equal to the given one as a form."""
    zero = sp.Integer(0)
    return Stable(expression, x, (), written, (), math.inf, zero, decayed(expression, x))


def _with_zeros_as_factors(expression: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """Return a rational function with a factor x - p for each positive rational zero p."""
    if not expression.is_rational_function(x) or expression.free_symbols != {x}:
        return expression
    if expression.count_ops() > MOST_OPERATIONS:
        return expression
    above, below = (sp.Poly(part, x) for part in sp.fraction(sp.cancel(expression)))
    if not (above.degree() > 1 and any(root > 0 for root in above.ground_roots())):
        return expression
    return sp.factor(above.as_expr()) / sp.factor(below.as_expr())


def without_series(expression: sp.Expr, x: sp.Symbol, ends: tuple[float, float]) -> Stable:
    """Return the form by all rules but the last, accurate or not."""
    equal = decayed(expression, x)
    at = FormErrors(accuracy_test(expression, x, ends, equal))
    form, worst = apply_rules(RULES[:-1], x, expression, at)
    steps, value = assembled(form)
    return Stable(expression, x, steps, value, (), worst, sp.Integer(0), equal)


def _joined(forms: Sequence[_Found], ends: tuple[float, float]) -> Iterator[_Found]:
    """Yield forms that use one of the given forms below a switch point, and another one above."""
    for low, high in permutations(forms, 2):
        below, above = low.stable.value, high.stable.value
        if isinstance(above, Switch):
            continue
        points, inner = SWITCHES, Branch(low.stable.steps, below)
        if isinstance(below, Switch):
            if below.variable != low.stable.variable:
                continue
            points, inner = (below.at,), below.below
            inner = replace(inner, steps=(*low.stable.steps, *inner.steps))
        known = {point.x: error for point, error in low.errors}
        for at in points:
            end = float(at)  # comparisons with numbers of SymPy take long
            errors = tuple(
                (point, known.get(point.x, math.inf) if point.x < end else error)
                for point, error in high.errors
            )
            outer = Branch(high.stable.steps, above)
            value = Switch(low.stable.variable, at, inner, outer)
            both = (*high.stable.applied, *low.stable.applied)
            applied = tuple({row.rule: row for row in both}.values())
            roundings = (*low.stable.roundings, *high.stable.roundings)
            stable = replace(
                low.stable, steps=(), value=value, applied=applied, roundings=roundings
            )
            size = range_size(_well_conditioned(errors, ends))
            yield _Found(stable, errors, size, low.rule or high.rule)


def _searches(
    expression: sp.Expr, x: sp.Symbol, ends: tuple[float, float], depth: int
) -> Iterator[tuple[Callable[[], Stable], float, str]]:
    """Yield functions that search for a form in one way, each with its loss by rounding and a rule.

    The loss is the largest error [ULP] by the rounding of u = c x^r, in addition to half the
    condition number, divided by the latter: 2/|r| - 1, because the relative error of a rounded
    number is up to one ULP of another one.
    """
    if depth and (factored := _with_zeros_as_factors(expression, x)) != expression:
        yield partial(_direct, expression, x, factored), 1.0, FACTORS
    for point in cancelling_points(expression, x) if depth else ():
        yield partial(about_point, expression, x, point), 1.0, ABOUT
    yield partial(stabilise, expression, x, ends), 1.0, ""
    for row in compositions(expression, x) if depth else ():
        _, rate = row.argument.as_independent(x)[1].as_base_exp()
        loss = max(1.0, 2 / abs(float(rate)) - 1)
        yield partial(_composed, row, expression, x, ends, depth), loss, "composition"
    for other in substitutions(expression, x) if depth else ():
        yield partial(_substituted, other, expression, x, ends, depth), 1.0, "substitution"
    yield partial(_in_part, expression, x, ends), 1.0, ""


def _composed(
    row: Composition, expression: sp.Expr, x: sp.Symbol, ends: tuple[float, float], depth: int
) -> Stable:
    """Return the form of a composition by the form of its inner function."""
    low, high = sorted(float(row.argument.subs(x, sp.Float(end))) for end in ends)
    inner = max(low, _LEAST), min(high, 1 / _LEAST)
    form = stabilised(row.expression, row.variable, inner, depth - 1).mapped(row.outer)
    first = () if row.variable == x else (Step(row.variable, row.argument),)
    steps, inner_value, u = (*first, *form.steps), sp.Dummy(), {row.variable: row.argument}
    slope = row.outer(inner_value).diff(inner_value).xreplace({inner_value: form.equal})
    effects = [(at, slope * effect) for at, effect in form.roundings]
    if first:
        effects.append((row.variable, slope * form.equal.diff(row.variable) * row.variable))
    return replace(
        form,
        expression=expression,
        variable=x,
        steps=steps,
        equal=row.outer(form.equal).xreplace(u),
        roundings=tuple((at.xreplace(u), effect.xreplace(u)) for at, effect in effects),
    )


def _substituted(
    row: Substitution, expression: sp.Expr, x: sp.Symbol, ends: tuple[float, float], depth: int
) -> Stable:
    """Return the form of a formula by that in another variable; switch points become those in x."""
    known: dict[sp.Symbol, sp.Expr] = {}
    for step in row.steps:
        known[step.symbol] = step.expression.xreplace(known)
    argument, last = known[row.variable], min(ends[1], float(row.end))
    low, high = (float(argument.subs(x, sp.Float(end))) for end in (ends[0], last))
    inner = max(low, _LEAST), min(high, 1 / _LEAST)
    form = stabilised(row.expression, row.variable, inner, depth - 1).mapped(
        lambda v: row.front * v
    )
    steps, value, u = (*row.steps, *form.steps), form.value, {row.variable: argument}
    if isinstance(value, Switch) and value.variable == row.variable:
        at = row.inverse.subs(row.variable, value.at)
        below, above = (Branch((*steps, *s.steps), s.value) for s in (value.below, value.above))
        steps, value = (), Switch(x, at, below, above)
    return replace(
        form,
        expression=expression,
        variable=x,
        steps=steps,
        value=value,
        equal=row.front * form.equal.xreplace(u),
        roundings=tuple(
            (at.xreplace(u), row.front * effect.xreplace(u)) for at, effect in form.roundings
        ),
    )


def _in_part(expression: sp.Expr, x: sp.Symbol, ends: tuple[float, float]) -> Stable:
    """Return the stable form of an expression by its errors in the largest part of a range."""
    test = accuracy_test(expression, x, ends, decayed(expression, x))
    whole, worst = apply_rules(RULES, x, expression, FormErrors(test, partial=True))
    for form in dict.fromkeys((whole, expression)):
        low, high = _well_conditioned(test.errors(*assembled(form)), ends)
        if low < high:
            with contextlib.suppress(UnreachableError):
                return stabilise(expression, x, (low, high))
    raise UnreachableError(failure(expression, x, worst))


def _accurate(
    errors: Sequence[tuple[ExactPoint, float]], ends: tuple[float, float]
) -> tuple[float, float]:
    """Return the largest range in which a form is accurate."""
    return useful_range([(point.x, error) for point, error in errors], ends)


def _well_conditioned(
    errors: Sequence[tuple[ExactPoint, float]], ends: tuple[float, float], loss: float = 1.0
) -> tuple[float, float]:
    """Return the largest range in which a form is accurate.

    It is empty if it is too short, or excludes points at which the form neither overflows nor is
    the value ill-conditioned.
    """
    low, high = _accurate(errors, ends)
    avoidable = (
        ENOUGH < error < math.inf and at.slack * loss < ENOUGH
        for at, error in errors
        if not low <= at.x <= high
    )
    return (1.0, 0.0) if low * LEAST_RATIO > high or any(avoidable) else (low, high)
