"""Single edits: changes at a position in a formula that give it the required value."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import log
from typing import Any

import sympy as sp

from derivation.engine.errata.position import (
    BASE,
    TERM,
    TERMS,
    Position,
    inner_positions,
    with_required_values,
)
from derivation.engine.errata.sample import Values, agree, monomial, rational, real
from derivation.engine.errata.variant import (
    CONSTANT,
    COST,
    EXPONENT,
    MISSING,
    MISSING_PARENTHESES,
    SIGN,
    STRAY,
    SUM,
    SUPERFLUOUS,
    SYMBOL,
    TWICE,
    Variant,
    VariantSearch,
    name_of,
    own_ratio,
    raised_to,
    variants,
)

_FEW = 3
_LARGEST_DENOMINATOR = 200
"""Largest denominator of required over printed exponent, such as 111/110 of 1.11 over 1.1."""
_LONE = -2.5
"""Additional cost of a missing term if the printed formula contains only the rest of its sum."""
_POWERS = (1, -1, 2, -2, Fraction(1, 2), Fraction(-1, 2))
"""Powers of a sum in which a term is missing."""


@dataclass(frozen=True, eq=False)
class Edit:
    """One change at one position, and its cost: the lower the cost, the more likely the error."""

    kind: str
    place: Position
    new: sp.Expr
    says: str
    cost: float

    def order(self) -> tuple[float, int, str]:
        """Return the sort key: cost, then distance from the root, then text."""
        return round(self.cost, 6), self.place.depth, self.says


def single_edits(root: Position, reference: Values, search: VariantSearch) -> list[Edit]:
    """Return all edits below a position that give the correct values, the most likely first."""
    edits: list[Edit] = []
    for position, need in with_required_values(root, reference, search.points):
        edits += ratio_edits(position, need, search)
        edits += exponent_edits(position, need, search)
        edits += term_edits(position, need, search)
        edits += factored_edits(position, need, search)
        for variant in variants(position, search):
            if agree(variant.value, need[0]):
                edit = edit_of(variant, position)
                if search.points.same(edit.new, need):
                    edits.append(edit)
    return sorted(edits, key=Edit.order)


def _edit(kind: str, position: Position, new: sp.Expr, says: str, extra: float = 0.0) -> Edit:
    group = 0.5 if position.role == TERMS else 0.0
    return Edit(kind, position, new, says, COST[kind] + group + extra)


def edit_of(variant: Variant, position: Position) -> Edit:
    """Return the edit that replaces the expression at a position by a variant."""
    new = variant.build()
    if variant.kind == MISSING_PARENTHESES:
        shown = variant.shown() if variant.shown else sp.sstr(new)
        says = f"set the parentheses {shown} in {name_of(position)}"
    elif variant.kind == SUPERFLUOUS:
        shown = variant.shown() if variant.shown else sp.sstr(new)
        says = f"take the parentheses away, {shown}, in {name_of(position)}"
    elif variant.shown:
        says = variant.shown()
    elif variant.kind in (SIGN, STRAY, MISSING, CONSTANT, TWICE) and own_ratio(position):
        ratio = new / position.node
        if variant.kind in (SIGN, CONSTANT):
            ratio = sp.cancel(ratio)  # SymPy may have inserted the number into a sum
        return ratio_edit(position, ratio, variant.extra, variant.kind)
    else:
        says = f"read {_text(new)} instead of {_text(position.node)}"
    return _edit(variant.kind, position, new, says, variant.extra)


def _text(expression: sp.Expr) -> str:
    return str(sp.sstr(expression))


# Ratio: the required value is a simple multiple of the given one.


def ratio_edits(position: Position, need: Values, search: VariantSearch) -> Iterator[Edit]:
    """Yield edits of sign, constant, extra or missing factor, and a factor counted twice."""
    if not own_ratio(position):
        return
    have = search.points.values(position.node)
    ratio = [w / v for w, v in zip(need, have, strict=True)]
    simple = monomial(ratio, search.points)
    if simple is not None:
        yield ratio_edit(position, simple)
        return
    yield from _lone_terms(position, ratio, search)
    yield from _complements(position, ratio, search)
    for factor in search.factors:
        values = search.points.values(factor)
        for power in (-1, 1, -2, 2):
            left = monomial(
                [q / v**power for q, v in zip(ratio, values, strict=True)], search.points
            )
            if left is not None:
                extra = 0.3 * (abs(power) - 1) + (
                    0.0 if left == 1 else 1.0 if left.is_number else 3.0
                )
                twice = power < 0 and position.node.has(factor)
                kind = TWICE if twice else MISSING
                extra += 0.0 if twice else 1.0
                yield ratio_edit(position, left * factor**power, extra, kind)


def ratio_edit(
    position: Position, ratio: sp.Expr, extra: float = 0.0, kind: str | None = None
) -> Edit:
    """Return the multiplication of an expression by a ratio, as an edit with a description."""
    new, where = ratio * position.node, name_of(position)
    if ratio == -1:
        return _edit(SIGN, position, new, f"reverse the sign of {where}", extra)
    if ratio.is_number:
        if position.node.is_number:
            return _edit(
                CONSTANT, position, new, f"read {_text(new)} for {_text(position.node)}", extra
            )
        return _edit(CONSTANT, position, new, f"multiply {where} by {_text(ratio)}", extra)
    swapped = _symbol_swap(position, ratio)
    if swapped is not None:
        return _edit(SYMBOL, position, new, swapped, extra)
    if kind == TWICE and not _is_factor_of(ratio, position.node):
        kind = MISSING
    if kind not in (TWICE, MISSING) or ratio.as_numer_denom()[0].is_Symbol:
        kind, extra = _extra_or_missing(position, ratio), extra + _size(ratio)
    return _edit(kind, position, new, _ratio_words(where, ratio, kind), extra)


def _symbol_swap(position: Position, ratio: sp.Expr) -> str | None:
    """Return in words that one symbol is replaced by another or exchanged with it, if so."""
    powers = ratio.as_powers_dict()
    if len(powers) != 2 or sum(powers.values()) != 0 or not all(s.is_Symbol for s in powers):
        return None
    printed, where = position.node.as_powers_dict(), name_of(position)
    for old, other in (tuple(powers), tuple(powers)[::-1]):
        power, size = printed.get(old, sp.Integer(0)), abs(powers[old])
        if (power * powers[old]).is_negative and size <= abs(power):
            inside = "" if position.node == old**size else f" in {where}"
            return f"read {_text(other**size)} instead of {_text(old**size)}{inside}"
    if old in printed and other in printed and powers[old] == printed[other] - printed[old]:
        return f"exchange {_text(other)} and {_text(old)} in {where}"
    return None


def _complements(position: Position, ratio: Values, search: VariantSearch) -> Iterator[Edit]:
    """Yield edits that read 1 - x for a factor x, or x for 1 - x."""
    printed = position.node.as_powers_dict()
    for symbol in search.points.symbols:
        for old, new in ((symbol, 1 - symbol), (1 - symbol, symbol)):
            bases = {b: e for b, e in printed.items() if b.is_number is False and b.has(symbol)}
            for base, power in bases.items():
                # Most candidates differ in value; their algebra takes a hundred times as long.
                fits = search.points.same((new / old) ** power, ratio)
                if fits and sp.cancel(base / old).is_number:
                    says = f"read {_text(new)} instead of {_text(old)} in {name_of(position)}"
                    edited = position.node * (new / old) ** power
                    yield _edit(SYMBOL, position, edited, says)


def _lone_terms(position: Position, ratio: Values, search: VariantSearch) -> Iterator[Edit]:
    """Yield edits that add a missing term to a factor, which then is a sum.

    A sum x + y is then printed as x: the ratio of required to given value is a power of (x + y)/x.
    If x + y is printed with another exponent, the exponent is wrong.
    """
    printed = position.node.as_powers_dict()
    for total in search.sums:
        for term in total.args:
            rest = total - term
            value = search.points.value(total / rest, 0)
            for power in _POWERS:
                if agree(value**power, ratio[0]):
                    new = position.node * (total / rest) ** sp.Rational(power)
                    same = search.points.same(new / position.node, ratio)
                    if same and not _has_other_power(printed, total, power):
                        says = f"add the missing term {_text(term)} to {_text(rest)}"
                        inside = "" if position.parent is None else f" in {name_of(position)}"
                        yield _edit(SUM, position, new, says + inside, _LONE)


def _has_other_power(
    printed: Mapping[sp.Expr, sp.Expr], total: sp.Expr, power: int | Fraction
) -> bool:
    """Return whether a multiple of the sum is a factor, with an exponent of the other sign."""
    others = (b for b, e in printed.items() if b.is_Add and e * power < 0)
    return any((b / total).cancel().is_number for b in others)


def _extra_or_missing(position: Position, ratio: sp.Expr) -> str:
    """Return the kind of error: the ratio removes a factor of the expression, or adds one."""
    above, below = sp.fraction(ratio)
    node = position.node.function if isinstance(position.node, sp.Integral) else position.node
    numerator, denominator = sp.fraction(node)
    return STRAY if _divides(above, denominator) or _divides(below, numerator) else MISSING


def _is_factor_of(ratio: sp.Expr, node: sp.Expr) -> bool:
    """Return whether the denominator of a ratio is a factor that can be left out."""
    return _divides(sp.fraction(ratio)[1], sp.fraction(node)[0])


def _divides(factor: sp.Expr, product: sp.Expr) -> bool:
    """Return whether an expression with symbols is a factor of a product."""
    if not factor.free_symbols:
        return False
    return not sp.fraction(sp.cancel(product / factor))[1].has(*factor.free_symbols)


def _ratio_words(where: str, ratio: sp.Expr, kind: str) -> str:
    above, below = sp.fraction(ratio)
    if kind in (STRAY, TWICE) and below == 1:
        return f"leave out the factor {_text(above)} in the denominator of {where}"
    if kind in (STRAY, TWICE) and above == 1:
        return f"leave out the factor {_text(below)} in {where}"
    if above == 1:
        return f"divide {where} by the missing factor {_text(below)}"
    if below == 1:
        return f"multiply {where} by the missing factor {_text(above)}"
    return f"multiply {where} by {_text(ratio)}"


def _size(ratio: sp.Expr) -> float:
    """Return the additional cost of a monomial: further symbols make it less likely."""
    number, powers = ratio.as_coeff_Mul()
    exponents = (factor.as_base_exp()[1] for factor in sp.Mul.make_args(powers))
    degree = sum(abs(exponent) if exponent.is_number else 2 for exponent in exponents)
    return 0.6 * (float(degree) - 1) + (0.0 if number == 1 else 0.6 if number == -1 else 1.0)


# Exponent: the required value is a power of the given one.


def exponent_edits(position: Position, need: Values, search: VariantSearch) -> Iterator[Edit]:
    """Yield an edit to another power of the same base."""
    node = position.node
    if node.is_number or position.role in (BASE, TERMS):
        return
    have, want = real(search.points.value(node, 0)), real(need[0])
    if have is None or want is None or abs(abs(have) - 1) < 1e-9:
        return
    power = rational(log(abs(want)) / log(abs(have)), _LARGEST_DENOMINATOR)
    if power is None or power in (Fraction(0), Fraction(1)) or abs(power) > 12:
        return
    new = raised_to(node, sp.Rational(power.numerator, power.denominator))
    if search.points.same(new, need):
        says = f"read {_text(new)} instead of {_text(node)}"
        yield _edit(EXPONENT, position, new, says, 0.0 if node.is_Pow or node.is_Atom else 0.4)


# Terms: one is superfluous in a sum, or a simple one is missing.


def term_edits(position: Position, need: Values, search: VariantSearch) -> Iterator[Edit]:
    """Yield edits that remove or add a term."""
    if not isinstance(position.node, sp.Add) or position.role == TERMS:
        return
    have = search.points.values(position.node)
    lack = [w - v for w, v in zip(need, have, strict=True)]
    for part in inner_positions(position):
        if part.role == TERM and search.points.same(-part.node, lack):
            yield _edit(SUM, position, position.node - part.node, f"leave out {name_of(part)}")
    simple = monomial(lack, search.points)
    for term in search.terms if simple is None else (simple,):
        if term is simple or search.points.same(term, lack):
            yield _edit(
                SUM, position, position.node + term, f"add the missing term {_text(term)}", 0.5
            )


# Parentheses: a factor of one term must be applied to other terms too.


def factored_edits(position: Position, need: Values, search: VariantSearch) -> Iterator[Edit]:
    """Yield c (x + y) for c x + y, where c is the ratio of required to given value of y."""
    if position.role not in (TERM, TERMS) or position.parent is None:
        return
    have = search.points.values(position.node)
    ratio = [w / v for w, v in zip(need, have, strict=True)]
    total = position.parent.node
    for index, term in enumerate(total.args):
        if index in position.taken:
            continue
        lost = _cancelled_sums(search) if len(total.args) <= _FEW else (sp.Integer(1),)
        for product in (p * c for p in _products(term) for c in lost):
            values = search.points.values(product)
            left = monomial([q / v for q, v in zip(ratio, values, strict=True)], search.points)
            if left is not None and not (product == 1 and left.is_number):
                factor = left * product
                inside = term / factor + position.node
                if not isinstance(inside, sp.Add):
                    continue
                new = total - term - position.node + factor * inside
                says = f"set the parentheses {_text(factor)}*({_text(inside)})"
                steep = 0.6 if (term / factor).count_ops() > term.count_ops() else 0.0
                yield _edit(MISSING_PARENTHESES, position.parent, new, says, steep)


def _cancelled_sums(search: VariantSearch) -> tuple[sp.Expr, ...]:
    """Return 1 and sums that may have cancelled in the term, each with its reciprocal."""
    sums = [factor for factor in search.factors if isinstance(factor, sp.Add)]
    return (sp.Integer(1), *(1 / factor for factor in sums), *sums)


def _products(term: sp.Expr) -> Iterator[sp.Expr]:
    """Yield products of some of a term's sums and functions, including the empty one."""
    parts = [f for f in sp.Mul.make_args(term) if f.atoms(sp.Add, sp.Function)]
    for size in range(min(len(parts), 6) + 1):
        for subset in combinations(parts, size):
            yield sp.Mul(*subset)


def factor_pool(
    expressions: Sequence[sp.Expr], dependent: Iterable[sp.Symbol] = ()
) -> tuple[sp.Expr, ...]:
    """Return sums, their roots and functions that are factors in the expressions.

    Powers of dependent symbols, which are no monomials in the others, are included. The order is
    fixed.
    """
    factors: set[sp.Expr] = set()
    for expression in expressions:
        factors |= expression.atoms(sp.Function)
        for product in (expression, *expression.atoms(sp.Mul)):
            for factor in sp.Mul.make_args(product):
                base, exponent = factor.as_base_exp()
                if isinstance(base, sp.Add):
                    factors.add(base)
                if base in dependent or (isinstance(base, sp.Add) and not exponent.is_Integer):
                    factors.add(base ** abs(exponent))
    return tuple(sorted(factors, key=_order))


def _order(expression: sp.Expr) -> Any:
    """Return SymPy's key for sorting, without evaluating integrals, which takes long."""
    integrals = expression.atoms(sp.Integral)
    return sp.default_sort_key(expression.xreplace({i: sp.Symbol(str(i)) for i in integrals}))


def sum_pool(expression: sp.Expr) -> tuple[sp.Add, ...]:
    """Return all sums in an expression, in a fixed order."""
    return tuple(sorted(expression.atoms(sp.Add), key=_order))


def term_pool(expression: sp.Expr) -> tuple[sp.Expr, ...]:
    """Return terms of all sums in an expression, in a fixed order."""
    terms = {term for total in expression.atoms(sp.Add) for term in total.args}
    return tuple(sorted(terms, key=_order))
