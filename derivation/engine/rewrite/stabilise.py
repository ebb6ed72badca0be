"""Search for the stable form of an expression, by rules that are kept if they improve it."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import sympy as sp

from derivation.engine.rewrite.accuracy_test import (
    AccuracyTest,
    accuracy_test,
    assembled,
    with_whole,
)
from derivation.engine.rewrite.form import Branch, Step, Switch
from derivation.engine.rewrite.rules import REUSE, RULES, Rewritten, Rule
from derivation.engine.rewrite.shape import Shape, assembled_form
from derivation.engine.rewrite.terms import UnreachableError, terms_of
from derivation.engine.rewrite.useful_range import (
    ENDS,
    ENOUGH,
)

EXACT = 0.75
"""Error in ULP below which the results of a rule count as equally accurate."""

NOTHING = 1.5
"""Error in ULP up to which forms count as equally accurate when a rule is removed."""


@dataclass(frozen=True)
class Applied:
    """A rule that was kept.

    Parameters
    ----------
    rule, cause
        Name of the rule, and the inaccuracy that it removes.
    operations, worst
        Number of operations of the form, and its largest error in ULP, without and with it.
    """

    rule: str
    cause: str
    operations: tuple[int, int]
    worst: tuple[float, float]


@dataclass(frozen=True)
class Stable:
    """A stable form, and how it was found.

    Parameters
    ----------
    expression, variable
        The original expression and its variable.
    steps, value
        Intermediate values, and the result or the switch point between two branches.
    applied
        The rules that were kept, in order.
    worst
        Largest error of the form in ULP, in addition to conditioning.
    truncation
        Bound of the relative truncation error of its series.
    equal
        The expression in decaying exponentials.
    roundings
        Powers of the variable that are rounded, and the change of the value by a relative change of
        each, divided by the latter.
    """

    expression: sp.Expr
    variable: sp.Symbol
    steps: tuple[Step, ...]
    value: sp.Expr | Switch
    applied: tuple[Applied, ...]
    worst: float
    truncation: sp.Rational
    equal: sp.Expr
    roundings: tuple[tuple[sp.Expr, sp.Expr], ...] = ()

    def mapped(
        self,
        value: Callable[[sp.Expr], sp.Expr],
        step: Callable[[sp.Expr], sp.Expr] = lambda given: given,
    ) -> "Stable":
        """Return the form with functions applied to the value of each branch, and to all steps."""

        def stepped(steps: tuple[Step, ...]) -> tuple[Step, ...]:
            return tuple(replace(s, expression=step(s.expression)) for s in steps)

        def branch(side: Branch) -> Branch:
            return Branch(stepped(side.steps), value(side.value))

        whole = self.value
        if isinstance(whole, Switch):
            whole = replace(whole, below=branch(whole.below), above=branch(whole.above))
        else:
            whole = value(whole)
        return replace(self, steps=stepped(self.steps), value=whole)


def stabilise(
    expression: sp.Expr, x: sp.Symbol, ends: tuple[float, float] = ENDS, lead: int = 0
) -> Stable:
    """Return the stable form of an expression for positive x.

    All rules are applied in turn. Then each rule is removed if the form without it is more
    accurate, or about as accurate and has no more operations.

    Parameters
    ----------
    expression, x
        The expression, and its variable.
    ends
        The interval in which the form is to be accurate.
    lead
        A power of x by which the expression is divided only to be finite at 0. Above a switch point
        s, the form is divided by s^lead instead, without rounding.

    Raises
    ------
    UnreachableError
        If the error of the form exceeds 8 ULP, or the expression cannot be tested; the message
        states the reason.
    """
    equal = decayed(expression, x)
    points = accuracy_test(expression, x, ends, equal)
    if lead:
        whole = expression * x**lead
        points = with_whole(
            points, accuracy_test(whole, x, ends, decayed(whole, x), str(expression)), lead
        )
    at = FormErrors(points)
    kept = list(RULES)
    form, worst = apply_rules(kept, x, expression, at)
    candidates = list(reversed(RULES))
    while candidates:
        rule = candidates.pop(0)
        fewer = [other for other in kept if other != rule]
        shorter, error = apply_rules(fewer, x, expression, at)
        no_longer = sum(_operations(shorter)) <= sum(_operations(form))
        if error < worst or (error <= max(worst, NOTHING) and no_longer):
            # Other rules may have been necessary only with this one, so they are tested again.
            kept, form, worst, candidates = fewer, shorter, error, list(reversed(fewer))
    if worst > ENOUGH:
        raise UnreachableError(failure(expression, x, worst))
    shared, error = apply_rules([*kept, REUSE], x, expression, at)
    if error <= worst + NOTHING / 2 and shared != form:
        kept, form, worst = [*kept, REUSE], shared, error
    steps, value = assembled(form)
    applied = tuple(_account(rule, kept, x, expression, at) for rule in kept)
    truncation = sp.Add(*(f.truncation for f in form.factors)) if isinstance(form, Shape) else 0
    return Stable(expression, x, steps, value, applied, worst, sp.sympify(truncation), equal)


class FormErrors:
    """An accuracy test that stores the error of each form."""

    def __init__(self, test: AccuracyTest, partial: bool = False) -> None:
        self.test, self.lead, self.partial = test, test.lead, partial
        self.known: dict[Rewritten, float] = {}

    def worst(self, form: Rewritten) -> float:
        """Return the largest error of a form in ULP in addition to conditioning."""
        if form not in self.known:
            self.known[form] = self.test.worst(form)
        return self.known[form]

    def failures(self, form: Rewritten) -> int:
        """Return the number of points with a larger error than allowed.

        It decides between forms of equal error if a form for a part of the range is wanted.
        """
        if not self.partial or self.worst(form) <= ENOUGH:
            return 0
        return sum(error > ENOUGH for _, error in self.test.errors(*assembled(form)))


def apply_rules(
    rules: Sequence[Rule], x: sp.Symbol, expression: sp.Expr, at: FormErrors
) -> tuple[Rewritten, float]:
    """Return the form that results from the rules, and its largest error."""
    form: Rewritten = expression
    for rule in rules:
        results = [_with_lead(result, at.lead) for result in _results(rule, x, form)]
        if len(results) > 1:
            results.sort(key=lambda result: (max(at.worst(result), EXACT), at.failures(result)))
        form = results[0] if results else form
    return form, at.worst(form)


@lru_cache(maxsize=4096)
def _results(rule: Rule, x: sp.Symbol, form: Rewritten) -> tuple[Rewritten, ...]:
    """Return the forms by one rule, none if it fails; most are requested several times."""
    try:
        return tuple(rule.apply(x, form))
    except UnreachableError:
        return ()


def _with_lead(form: Rewritten, lead: int) -> Rewritten:
    return replace(form, lead=lead) if isinstance(form, Shape) and form.switch else form


def _account(
    rule: Rule, kept: Sequence[Rule], x: sp.Symbol, expression: sp.Expr, at: FormErrors
) -> Applied:
    """Return number of operations and error of the form, without and with a rule."""
    with_it, without = list(kept), [other for other in kept if other != rule]
    pairs = [apply_rules(rules, x, expression, at) for rules in (without, with_it)]
    before, after = (operations(form) for form, _ in pairs)
    return Applied(rule.name, rule.cause, (before, after), (pairs[0][1], pairs[1][1]))


def decayed(expression: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """Return the expression in decaying exponentials, whose balls are narrow also for large x."""
    form: Rewritten = expression
    names = [rule.name for rule in RULES]
    for rule in RULES[: names.index("decay") + 1]:
        form = next(rule.apply(x, form), form)
    assert isinstance(form, Shape)  # `decay` always returns a shape
    steps, value = assembled_form(form)
    assert isinstance(value, sp.Expr)  # switch points come later
    return value.xreplace({step.symbol: step.expression for step in steps})


def operations(form: Rewritten) -> int:
    """Return the number of operations of a form, of the longer branch at a switch point."""
    return max(_operations(form))


def _operations(form: Rewritten) -> list[int]:
    """Return the number of operations of every branch."""
    return operations_of(*assembled(form))


def operations_of(steps: tuple[Step, ...], value: sp.Expr | Switch) -> list[int]:
    """Return the number of operations of every branch of steps and value."""
    sides = (value.below, value.above) if isinstance(value, Switch) else (Branch((), value),)
    return [
        int(sum(sp.count_ops(step.expression) for step in (*steps, *side.steps)))
        + int(sp.count_ops(side.value))
        for side in sides
    ]


def failure(expression: sp.Expr, x: sp.Symbol, worst: float) -> str:
    """Return the message: the remaining error, and the first rule that failed, with the reason."""
    size = "overflows or has no value" if math.isinf(worst) else f"has an error of {worst:.3g} ULP"
    form: Rewritten = expression
    for rule in RULES:
        try:
            form = next(rule.apply(x, form), form)
            if isinstance(form, Shape) and rule.name == "decay":
                for factor in form.factors:
                    terms_of(factor.value, x)
        except UnreachableError as error:
            stopped = f"; the rule `{rule.name}` fails because {error}"
            break
    else:
        stopped = "; no rule applies to the rest"
    return (
        f"the rules give a form of {expression!s:.80} that {size} for some {x} > 0{stopped}; state "
        f"the domain of {x} if such values do not occur, or rewrite parts of the formula by "
        "themselves"
    )
