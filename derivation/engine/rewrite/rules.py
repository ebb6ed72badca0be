"""The rewriting rules in the order of application, each with name, cause and condition.

The first five transform an expression, and the others the decomposition that `decay` yields. A
rule yields nothing if its condition is not met. Every rule is exact, except for `series`, whose
truncation error is bounded.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import TypeAlias

import sympy as sp
from sympy.codegen.cfunctions import expm1, log1p

from derivation.engine.formula.differences import HYPERBOLIC, TRIGONOMETRIC, in_products
from derivation.engine.rewrite.series import leading_power, truncated_taylor
from derivation.engine.rewrite.shape import Factor, Shape, assembled_form, square
from derivation.engine.rewrite.terms import (
    ENTIRE,
    RISING,
    Key,
    Terms,
    UnreachableError,
    expression_of,
    monomial,
    taylor,
    terms_of,
)

Rewritten: TypeAlias = sp.Expr | Shape

SWITCHES = tuple(sp.Rational(n, 4) for n in (1, 2, 4, 8, 16))
"""Possible switch points of a truncated series; the first with sufficient accuracy is used. They
are powers of two, so that a power of x can be constant there without rounding."""


QUOTIENTS: Mapping[type[sp.Function], Callable[[sp.Expr], sp.Expr]] = {
    sp.tan: lambda u: sp.sin(u) / sp.cos(u),
    sp.tanh: lambda u: sp.sinh(u) / sp.cosh(u),
    sp.coth: lambda u: sp.cosh(u) / sp.sinh(u),
}


INSIDE = (*SWITCHES[:2], sp.Rational(3, 4))
"""Possible switch points of series that converge below 1 only."""


@dataclass(frozen=True)
class Rule:
    """A named rule.

    Parameters
    ----------
    name
        Name of the rule in reports.
    cause
        The inaccuracy that it removes: cancellation, overflow or absorption.
    apply
        Function from the variable and an expression to the possible results of the rule.
    """

    name: str
    cause: str
    apply: Callable[[sp.Symbol, Rewritten], Iterator[Rewritten]]


def conjugate(_: sp.Symbol, given: Rewritten) -> Iterator[Rewritten]:
    """Write p - q, where p or q contains a square root, as (p^2 - q^2)/(p + q)."""
    if isinstance(given, Shape):
        return

    def is_difference(node: sp.Basic) -> bool:
        if not (isinstance(node, sp.Add) and len(node.args) == 2):
            return False
        signs = [part.could_extract_minus_sign() for part in node.args]
        return sum(signs) == 1 and any(_is_root(part) for part in node.args)

    def corrected(node: sp.Expr) -> sp.Expr:
        p, q = sorted(node.args, key=lambda part: part.could_extract_minus_sign())
        return sp.expand(p**2 - q**2) / (p - q)

    replaced = given.replace(is_difference, corrected)
    if replaced != given:
        yield replaced


def _is_root(term: sp.Expr) -> bool:
    return any(f.is_Pow and abs(f.exp) == sp.Rational(1, 2) for f in sp.Mul.make_args(term))


def logarithm(x: sp.Symbol, given: Rewritten) -> Iterator[Rewritten]:
    """Write log(1 + u) as log1p(u), which does not absorb a small u."""
    if isinstance(given, Shape):
        return

    def is_near_one(node: sp.Basic) -> bool:
        if not isinstance(node, sp.log):
            return False
        return 1 in sp.Add.make_args(node.args[0]) or sp.expand(node.args[0] - 1).subs(x, 0) == 0

    replaced = given.replace(
        is_near_one,
        lambda node: log1p(sp.expand(node.args[0] - 1)),
    )
    if replaced != given:
        yield replaced


def fraction(x: sp.Symbol, given: Rewritten) -> Iterator[Rewritten]:
    """Write a sum of quotients as one quotient of products of sums, with common factors removed."""
    if isinstance(given, Shape):
        return
    for function, quotient in QUOTIENTS.items():
        given = given.replace(function, quotient)
    whole = sp.together(given)
    above, below = (_split(part, x) for part in sp.fraction(whole))
    if above / below != given:
        yield above / below


def _split(expression: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """Factor sums of x alone; with other variables, signs of brackets would be lost."""
    parts = sp.Mul.make_args(expression)
    return sp.Mul(
        *(sp.factor(sp.expand(p)) if p.free_symbols == {x} and p.is_Add else p for p in parts)
    )


def half_angle(_: sp.Symbol, given: Rewritten) -> Iterator[Rewritten]:
    """Write 1 - cos u as 2 sin(u/2)^2, and similar sums of two functions as products."""
    if isinstance(given, Shape):
        return
    found = given.replace(lambda node: node.is_Add, lambda node: in_products(node, _ANGLES))
    if found != given:
        yield found


_ANGLES = *TRIGONOMETRIC, *HYPERBOLIC


def decay(x: sp.Symbol, given: Rewritten) -> Iterator[Rewritten]:
    """Write hyperbolic functions as decaying exponentials, the largest of each sum factored out."""
    if isinstance(given, Shape):
        return
    front, power, rate = sp.Integer(1), 0, sp.Integer(0)
    factors: list[Factor] = []
    for base, exponent in _powers(given):
        if not base.has(x):
            front *= base**exponent
            continue
        if not exponent.is_Integer:
            factors.append(Factor(base**exponent, 1))
            continue
        try:
            shift, size, rest = _scaled(terms_of(base, x))
        except UnreachableError:
            factors.append(Factor(base, int(exponent)))
            continue
        rate += shift * exponent
        front *= size**exponent
        if len(rest) == 1 and not next(iter(rest)).wave:
            power += next(iter(rest)).power * int(exponent)
        else:
            factors.append(Factor(expression_of(rest, x), int(exponent)))
    yield Shape(x, front, power, rate, tuple(factors))


def _powers(expression: sp.Expr) -> Iterator[tuple[sp.Expr, sp.Expr]]:
    for part in sp.Mul.make_args(expression):
        yield part.as_base_exp() if not isinstance(part, sp.exp) else (part, sp.Integer(1))


def _scaled(terms: Terms) -> tuple[sp.Rational, sp.Expr, dict[Key, sp.Expr]]:
    """Return the largest rate, its coefficient, and the terms divided by both."""
    if not terms:
        raise UnreachableError("a sum is 0")
    rate = max(key.rate for key in terms)
    leading = min((key for key in terms if key.rate == rate), key=lambda key: key[2:] + key[:2])
    size = terms[leading]
    if size.free_symbols:
        size = sp.Integer(1)  # brackets of other variables are unchanged
    elif _rises(terms) == size.is_negative:
        size = -size  # the sum is positive near 0, which is easier to read
    return rate, size, {k._replace(rate=k.rate - rate): v / size for k, v in terms.items()}


def _rises(terms: Terms) -> bool:
    """Return whether the sum is known to be positive next to 0."""
    return bool(next(islice(taylor(terms), leading_power(terms), None)).is_positive)


def _base(coefficient: sp.Expr) -> sp.Expr:
    """Return the coefficient without its rational factor and sign."""
    _, rest = coefficient.as_content_primitive()
    return -rest if rest.could_extract_minus_sign() else rest


def difference(x: sp.Symbol, given: Rewritten) -> Iterator[Rewritten]:
    """Write c - c e^(-m x) + ... as -c expm1(-m x) + ..., with constants cancelled exactly."""
    if not isinstance(given, Shape):
        return
    factors = [
        replace(f, value=sp.Add(*(part for part, _ in parts_of(terms, x)))) if terms else f
        for f in given.factors
        for terms in [_terms(f.value, x)]
    ]
    if factors != list(given.factors):
        yield given.with_factors(factors)


def _terms(value: sp.Expr, x: sp.Symbol) -> dict[Key, sp.Expr]:
    """Return the normal form of a sum; empty if it has no such form."""
    try:
        return terms_of(value, x)
    except UnreachableError:
        return {}


def parts_of(terms: Terms, x: sp.Symbol) -> list[tuple[sp.Expr, int]]:
    """Return the parts of a sum with constants cancelled, each with its lowest power of x."""
    grouped: dict[tuple[sp.Expr, int, str, sp.Rational], dict[Key, sp.Expr]] = {}
    for key, value in terms.items():
        base = _base(value)
        grouped.setdefault((base, key.power, key.wave, key.scale), {})[key] = sp.cancel(
            value / base
        )
    divisors: list[tuple[sp.Expr, int]] = []
    for (base, power, _, _), group in grouped.items():
        head = base * monomial(next(iter(group))._replace(rate=sp.Integer(0)), x)
        if len(group) > 1 and sp.Add(*group.values()) == 0:
            inner = sp.Add(*(value * expm1(key.rate * x) for key, value in group.items()))
            divisors.append((head * inner, power + 1))
        else:
            inner = sp.Add(*(value * sp.exp(key.rate * x) for key, value in group.items()))
            divisors.append((head * inner, leading_power(group)))
    return divisors


def balance(x: sp.Symbol, given: Rewritten) -> Iterator[Rewritten]:
    """Factor the largest power of x out of a sum that is divided by a power of x."""
    if not isinstance(given, Shape):
        return
    factors = []
    for factor in given.factors:
        keys, parts = _terms(factor.value, x), sp.Add.make_args(factor.value)
        top = max((k.power for k in keys if k.rate == 0 and k.wave not in RISING), default=0)
        top = top if given.power * factor.exponent < 0 else 0
        far = sp.Add(*(part / x**top for part in parts))
        factors.append(factor if far == factor.value else replace(factor, far=far, top=top))
    if factors != list(given.factors):
        yield given.with_factors(factors)


def series(x: sp.Symbol, given: Rewritten) -> Iterator[Rewritten]:
    """Replace sums that cancel at 0, below a switch point, by series times a power of x."""
    if not isinstance(given, Shape) or given.switch is not None:
        return
    waves = {key.wave for factor in given.factors for key in _terms(factor.value, x)}
    for switch in SWITCHES if waves <= ENTIRE else INSIDE:
        try:
            yield replace(
                given,
                switch=switch,
                factors=tuple(with_series(f, x, switch) for f in given.factors),
            )
        except UnreachableError:
            continue


def with_series(
    factor: Factor, x: sp.Symbol, switch: sp.Rational, *, both_signs: bool = False
) -> Factor:
    """Return the factor with its leading power, and a truncated series if its parts cancel.

    The series holds for negative x too if `both_signs`.

    Raises
    ------
    UnreachableError
        If no series reaches the switch point.
    """
    terms = terms_of(factor.value, x)
    lead = leading_power(terms)
    if lead == min(power for _, power in parts_of(terms, x)):
        return replace(factor, lead=lead)
    # About the middle of its rates a sum of hyperbolic functions is even or odd.
    rates = [key.rate for key in terms]
    shift = (max(rates) + min(rates)) / 2
    series = truncated_taylor(
        {k._replace(rate=k.rate - shift): v for k, v in terms.items()},
        switch,
        both_signs=both_signs,
    )
    near = series.polynomial(square if series.stride == 2 else x)
    return replace(factor, near=near, lead=lead, rate=shift, truncation=series.bound)


def reuse(x: sp.Symbol, given: Rewritten) -> Iterator[Rewritten]:
    """Compute e^(-x) once for both sides of a switch point, and e^(-2x) as its square."""
    if isinstance(given, Shape) and given.switch is not None:
        _, switch = assembled_form(given)
        sides = [
            sp.Add(*(s.expression for s in b.steps), b.value) for b in (switch.below, switch.above)
        ]
        if all(side.has(sp.exp(-x)) for side in sides):
            yield replace(given, shared=True)


RULES: Sequence[Rule] = (
    Rule("conjugate", "cancellation", conjugate),
    Rule("logarithm", "absorption", logarithm),
    Rule("fraction", "cancellation", fraction),
    Rule("half angle", "cancellation", half_angle),
    Rule("decay", "overflow", decay),
    Rule("difference", "cancellation", difference),
    Rule("balance", "overflow", balance),
    Rule("series", "cancellation", series),
)
"""Rules in the order of application."""

REUSE = Rule("reuse", "time", reuse)
"""The last rule, which saves an exponential; the loss of accuracy is negligible."""
