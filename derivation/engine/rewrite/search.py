"""Search for the stable form of an expression by rules, compositions and switch points."""

import contextlib
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import permutations

import sympy as sp

from derivation.engine.rewrite.accuracy_test import ExactPoint, accuracy_test, assembled
from derivation.engine.rewrite.compositions import Composition, compositions
from derivation.engine.rewrite.form import Branch, Step, Switch
from derivation.engine.rewrite.rules import RULES, SWITCHES
from derivation.engine.rewrite.stabilise import (
    FormErrors,
    Stable,
    apply_rules,
    decayed,
    failure,
    stabilise,
)
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


def stabilised(
    expression: sp.Expr, x: sp.Symbol, ends: tuple[float, float] = ENDS, depth: int = 2
) -> Stable:
    """Return the stable form of an expression in the largest range in which there is one.

    The rules are applied to the expression, then to inner functions of compositions, up to the
    given depth, then to the expression in a part of the range.

    Raises
    ------
    UnreachableError
        If there is no form in any useful range; the message states the first reason.
    """
    reasons: list[UnreachableError] = []
    found: list[_Found] = []
    for search, loss in _searches(expression, x, ends, depth):
        try:
            found.append(_tested(search(), ends, loss))
        except UnreachableError as error:
            reasons.append(error)
            continue
        if all(error <= ENOUGH for _, error in found[-1].errors):
            return found[-1].stable
    if depth:
        with contextlib.suppress(UnreachableError):
            found.append(_tested(_direct(expression, x), ends, 1.0))
        found += _joined(found, ends)
    best = max(found, key=lambda one: one.size, default=None)
    if best is None or best.size[0] < 0:
        raise reasons[0] if reasons else UnreachableError(f"{expression} is ill-conditioned")
    return best.stable


@dataclass(frozen=True)
class _Found:
    """A form with its errors in a range, and the size of the part in which it is accurate."""

    stable: Stable
    errors: tuple[tuple[ExactPoint, float], ...]
    size: tuple[float, float]


def _tested(stable: Stable, ends: tuple[float, float], loss: float) -> _Found:
    test = accuracy_test(stable.expression, stable.variable, ends, stable.equal)
    errors = tuple(test.errors(stable.steps, stable.value))
    return _Found(stable, errors, range_size(_well_conditioned(errors, ends, loss)))


def _direct(expression: sp.Expr, x: sp.Symbol) -> Stable:
    """Return the expression itself as a form."""
    zero = sp.Integer(0)
    return Stable(expression, x, (), expression, (), math.inf, zero, decayed(expression, x))


def _joined(found: Sequence[_Found], ends: tuple[float, float]) -> Iterator[_Found]:
    """Yield forms that use one of the given forms below a switch point, and another one above."""
    for low, high in permutations(found, 2):
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
            errors = tuple(
                (point, known.get(point.x, math.inf) if point.x < at else error)
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
            yield _Found(stable, errors, range_size(_well_conditioned(errors, ends)))


def _searches(
    expression: sp.Expr, x: sp.Symbol, ends: tuple[float, float], depth: int
) -> Iterator[tuple[Callable[[], Stable], float]]:
    """Yield functions that search for a form in one way, each with its loss by rounding.

    The loss is the largest error [ULP] by the rounding of u = c x^r, in addition to half the
    condition number, divided by the latter: 2/|r| - 1, because the relative error of a rounded
    number is up to one ULP of another one.
    """
    yield partial(stabilise, expression, x, ends), 1.0
    for row in compositions(expression, x) if depth else ():
        _, rate = row.argument.as_independent(x)[1].as_base_exp()
        loss = max(1.0, 2 / abs(float(rate)) - 1)
        yield partial(_composed, row, expression, x, ends, depth), loss
    yield partial(_in_part, expression, x, ends), 1.0


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


def _well_conditioned(
    errors: Sequence[tuple[ExactPoint, float]], ends: tuple[float, float], loss: float = 1.0
) -> tuple[float, float]:
    """Return the largest range in which a form is accurate.

    It is empty if it is too short, or excludes points at which the form neither overflows nor is
    the value ill-conditioned.
    """
    low, high = useful_range([(point.x, error) for point, error in errors], ends)
    avoidable = (
        ENOUGH < error < math.inf and at.slack * loss < ENOUGH
        for at, error in errors
        if not low <= at.x <= high
    )
    return (1.0, 0.0) if low * LEAST_RATIO > high or any(avoidable) else (low, high)
