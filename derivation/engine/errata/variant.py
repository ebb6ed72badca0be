"""Alternatives at a position: other functions, parentheses, faces, simple multiples.

A variant contains its value at the first sample point, so that thousands of variants can be tested
before an expression is built.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain, combinations, permutations

import flint
import sympy as sp

from derivation.engine.errata.position import BASE, FACTOR, TERMS, WHOLE, Position
from derivation.engine.errata.sample import Sample

SIGN, CONSTANT, EXPONENT, SWAP = "sign", "constant ratio", "wrong exponent", "swapped function"
STRAY, MISSING, SYMBOL = "extra factor", "missing factor", "swapped symbol"
MISSING_PARENTHESES, SUPERFLUOUS = "missing parentheses", "superfluous parentheses"
FACE, TWICE, SUM = "other face", "factor counted twice", "wrong term"
LIMIT = "wrong limit"

COST: Mapping[str, float] = {
    SIGN: 1.0,
    CONSTANT: 2.0,
    EXPONENT: 2.2,
    STRAY: 2.4,
    MISSING: 2.4,
    SWAP: 2.5,
    SYMBOL: 2.5,
    MISSING_PARENTHESES: 2.8,
    SUPERFLUOUS: 2.9,
    LIMIT: 2.6,
    FACE: 3.0,
    TWICE: 3.2,
    SUM: 5.0,
}
"""Cost of each kind of error: the lower, the more likely."""

_SHAPES: tuple[type[sp.Basic], ...] = (
    sp.sin,
    sp.cos,
    sp.sinh,
    sp.cosh,
    sp.exp,
    sp.tan,
    sp.tanh,
    sp.coth,
    sp.erf,
    sp.erfc,
)
_TRIED = sp.sin, sp.cos, sp.tan, sp.erf, sp.erfc, sp.gamma, sp.besselj, sp.besseli
"""Functions whose argument cannot be computed from their value."""
_FACES = ("z", "h")
_MAX_FACTORS = 9
_EXPONENTS = tuple(sp.Rational(k) for k in (-1, 2, -2, 3, 4)) + tuple(
    sp.Rational(*k) for k in ((1, 2), (1, 3), (2, 3), (3, 2), (4, 3), (3, 4), (5, 4), (5, 3))
)


@dataclass(frozen=True, eq=False)
class Variant:
    """An alternative for a subexpression.

    Parameters
    ----------
    kind
        The kind of error by which the given expression would result from it.
    value
        Its value at the first sample point.
    build
        Function that builds it as an expression.
    extra
        Cost in addition to that of its kind.
    shown
        Function that returns its text, if the expression alone does not show the change.
    """

    kind: str
    value: flint.acb
    build: Callable[[], sp.Expr]
    extra: float = 0.0
    shown: Callable[[], str] | None = None


@dataclass(frozen=True)
class VariantSearch:
    """Data of the search.

    Parameters
    ----------
    points
        The sample points.
    factors
        Factors of both formulas.
    terms, sums
        Terms of all sums of the derived formula, and the sums.
    """

    points: Sample
    factors: tuple[sp.Expr, ...]
    terms: tuple[sp.Expr, ...]
    sums: tuple[sp.Add, ...] = ()

    def variant(self, kind: str, new: sp.Expr, extra: float = 0.0) -> Variant:
        """Return a variant from an expression."""
        return Variant(kind, self.points.value(new, 0), lambda: new, extra)


def variants(position: Position, search: VariantSearch) -> Iterator[Variant]:
    """Yield alternatives in functions, parentheses and faces, which can only be found by trial."""
    if position.role != TERMS:
        yield from other_functions(position.node, search)
        yield from exchanged_symbols(position.node, search)
        yield from other_signs(position.node, search)
        yield from lost_parentheses(position.node, search)
        if position.role != FACTOR:
            yield from superfluous_parentheses(position.node, search)
        yield from inverted_fractions(position.node, search)
        yield from other_faces(position.node, search)


def all_variants(position: Position, search: VariantSearch) -> Iterator[Variant]:
    """Yield all variants, with simple multiples and powers, if no required value is known."""
    yield from variants(position, search)
    node, value = position.node, search.points.value(position.node, 0)
    if own_ratio(position):
        for kind, factor, extra in multipliers(search):
            times = value * search.points.value(factor, 0)
            yield Variant(kind, times, lambda f=factor: f * node, extra)  # type: ignore[misc]
    if not node.is_number and position.role not in (BASE, TERMS):
        for power in _EXPONENTS:
            raised = value ** flint.arb(flint.fmpq(int(power.p), int(power.q)))
            yield Variant(EXPONENT, raised, lambda k=power: raised_to(node, k))  # type: ignore[misc]


def raised_to(node: sp.Expr, power: sp.Rational) -> sp.Expr:
    """Return an expression to a power; powers of powers are combined, to avoid roots of squares."""
    base, exponent = node.as_base_exp()
    return base ** (exponent * power)


def own_ratio(position: Position) -> bool:
    """Return whether a ratio at a position is not one of the product or power around it."""
    if position.role == BASE:
        return bool(position.parent is not None and abs(position.parent.node.exp) != 1)
    return position.role != FACTOR


def multipliers(search: VariantSearch) -> Iterator[tuple[str, sp.Expr, float]]:
    """Yield the factors -1, small numbers, powers of symbols, and the known factors."""
    yield SIGN, sp.Integer(-1), 0.0
    for kind, factor in small_factors(search.points.symbols):
        yield kind, factor, 0.2
    for factor in search.factors:
        yield TWICE, 1 / factor, 0.0
        yield MISSING, factor, 0.8


def small_factors(symbols: Sequence[sp.Symbol]) -> Iterator[tuple[str, sp.Expr]]:
    """Yield simple factors to be tried if the ratio cannot be computed."""
    for number in (2, 3, 4, 8, 16):
        yield CONSTANT, sp.Integer(number)
        yield CONSTANT, sp.Rational(1, number)
    for above, below in ((2, 3), (3, 2), (3, 4), (4, 3)):
        yield CONSTANT, sp.Rational(above, below)
    yield CONSTANT, sp.pi
    yield CONSTANT, 1 / sp.pi
    for symbol in symbols:
        for power in (-1, 1, -2, 2):
            yield (STRAY if power < 0 else MISSING), symbol**power


def other_functions(node: sp.Expr, search: VariantSearch) -> Iterator[Variant]:
    """Yield other functions of the same argument, or the same function of a similar argument."""
    apply: Callable[[sp.Expr], sp.Expr]
    if isinstance(node, sp.besselj | sp.besseli):
        order, argument = node.args
        others = [node.func(1 - order, argument)] if order in (0, 1) else []
        others.append((sp.besseli if node.func is sp.besselj else sp.besselj)(order, argument))
        apply = lambda x: node.func(order, x)  # noqa: E731
    elif node.func in _SHAPES or node.func is sp.gamma:
        argument, apply = node.args[0], node.func
        others = [shape(argument) for shape in _SHAPES if shape is not node.func]
    else:
        return
    for new in others:
        yield search.variant(SWAP, new)
    if isinstance(node, _TRIED):
        for kind, factor in small_factors(search.points.symbols):
            yield search.variant(kind, apply(factor * argument), 0.2)
        for old, new in permutations(search.points.symbols, 2):
            if argument.has(old):
                one = f"read {new} instead of {old}"
                other = search.variant(SYMBOL, apply(argument.subs(old, new)))
                yield replace(other, shown=lambda x=one: f"{x} in {sp.sstr(node)}")  # type: ignore[misc]


def exchanged_symbols(node: sp.Expr, search: VariantSearch) -> Iterator[Variant]:
    """Yield a sum, or a power of one, in which two symbols are exchanged."""
    if not isinstance(node.as_base_exp()[0], sp.Add):
        return
    for one, other in combinations(search.points.symbols, 2):
        if node.has(one) and node.has(other):
            new = node.xreplace({one: other, other: one})
            if new != node:
                both = f"exchange {one} and {other}"
                variant = search.variant(SYMBOL, new, 0.1)
                yield replace(variant, shown=lambda x=both: f"{x} in {short(node)}")  # type: ignore[misc]


def other_signs(node: sp.Expr, search: VariantSearch) -> Iterator[Variant]:
    """Yield an even power of a sum in which a term has the other sign."""
    base, exponent = node.as_base_exp()
    if isinstance(base, sp.Add) and exponent.is_Integer and exponent % 2 == 0:
        for term in base.args:
            says = f"reverse the sign of the term {short(term)}"
            new = search.variant(SIGN, (base - 2 * term) ** exponent)
            yield replace(new, shown=lambda text=says: text)  # type: ignore[misc]


def inverted_fractions(node: sp.Expr, search: VariantSearch) -> Iterator[Variant]:
    """Yield products in which a fraction is upside down, such as (1 + e)/(1 - e).

    Fractions of symbols alone are found as exchanged symbols, or as a missing factor.
    """
    factors = [factor.as_base_exp() for factor in sp.Mul.make_args(node)]
    for (above, power), (below, other) in permutations(factors, 2):
        if power == -other and power.is_positive and (above.is_Add or below.is_Add):
            yield search.variant(EXPONENT, node * (below / above) ** (2 * power))


def other_faces(node: sp.Expr, search: VariantSearch) -> Iterator[Variant]:
    """Yield the expression with the sign of z or h reversed, if that changes it."""
    if node.is_Atom:
        return
    for symbol in sorted(node.free_symbols, key=str):
        if symbol.name in _FACES:
            new = node.subs(symbol, -symbol)
            if new != node:
                yield search.variant(FACE, new)


def lost_parentheses(node: sp.Expr, search: VariantSearch) -> Iterator[Variant]:
    """Yield c (x + y) for c x + y: the factor of one term is applied to further terms."""
    if not isinstance(node, sp.Add):
        return
    terms = node.args
    values = [search.points.value(term, 0) for term in terms]
    whole = search.points.value(node, 0)
    for index, term in enumerate(terms):
        rest = [i for i in range(len(terms)) if i != index]
        for factors, size in _partial_products(term, search):
            for group in groups(rest):
                value = whole + (size - 1) * sum(values[i] for i in group)
                grouped = _Grouped(terms, index, factors, group)
                yield Variant(MISSING_PARENTHESES, value, grouped.build, 0.0, grouped.shown)


@dataclass(frozen=True)
class _Grouped:
    """A sum in which the factor of one term is applied to a group of others."""

    terms: Sequence[sp.Expr]
    index: int
    factors: Sequence[sp.Expr]
    group: Sequence[int]

    def _parts(self) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        factor = sp.Mul(*self.factors)
        inside = self.terms[self.index] / factor + sp.Add(*(self.terms[i] for i in self.group))
        used = {self.index, *self.group}
        return factor, inside, sp.Add(*(t for i, t in enumerate(self.terms) if i not in used))

    def build(self) -> sp.Expr:
        factor, inside, kept = self._parts()
        return kept + factor * inside

    def shown(self) -> str:
        factor, inside, _ = self._parts()
        return f"{sp.sstr(factor)}*({sp.sstr(inside)})"


def superfluous_parentheses(node: sp.Expr, search: VariantSearch) -> Iterator[Variant]:
    """Yield c x + y for c (x + y): a factor of a product is applied to some terms only."""
    for factor in node.args if isinstance(node, sp.Mul) else ():
        base, exponent = factor.as_base_exp()
        if not isinstance(base, sp.Add) or abs(exponent) != 1:
            continue
        others = (node / factor) ** exponent
        others = sp.numer(others) if exponent < 0 else others
        whole, sum_value = search.points.value(node, 0), search.points.value(base, 0)
        values = [search.points.value(term, 0) for term in base.args]
        for factors, size in _partial_products(others, search):
            for group in groups(range(len(base.args))):
                if len(group) < len(base.args):
                    part = sum(values[i] for i in group)
                    ratio = (sum_value + (size - 1) * part) / (sum_value * size)
                    value = whole * ratio ** int(exponent)
                    spread = _Spread(node, base, exponent, factors, group)
                    yield Variant(SUPERFLUOUS, value, spread.build, 0.0, spread.shown)


@dataclass(frozen=True)
class _Spread:
    """A product with a sum, in which some factors are applied to a group of terms only."""

    node: sp.Expr
    base: sp.Expr
    exponent: sp.Expr
    factors: Sequence[sp.Expr]
    group: Sequence[int]

    def _sum(self) -> sp.Expr:
        inside = sp.Add(*(self.base.args[i] for i in self.group))
        return sp.Mul(*self.factors) * inside + (self.base - inside)

    def build(self) -> sp.Expr:
        taken = self.base * sp.Mul(*self.factors)
        return self.node * (self._sum() / taken) ** self.exponent

    def shown(self) -> str:
        return str(sp.sstr(self._sum()))


def _partial_products(
    term: sp.Expr, search: VariantSearch
) -> Iterator[tuple[tuple[sp.Expr, ...], flint.acb]]:
    """Yield groups of a term's factors, except for -1 alone, with the value of their product."""
    factors = sp.Mul.make_args(term)
    if len(factors) > _MAX_FACTORS:
        return
    for subset in chain.from_iterable(
        combinations(factors, size) for size in range(1, len(factors) + 1)
    ):
        if subset == (sp.S.NegativeOne,):
            continue
        value = flint.acb(1)
        for factor in subset:
            value *= search.points.value(factor, 0)
        yield subset, value
        if subset[0].is_number and subset[0].is_negative:
            yield (sp.S.NegativeOne, *subset), -value


def groups(members: Sequence[int]) -> Iterator[tuple[int, ...]]:
    """Yield non-empty groups of members; of more than five, groups of one, two and all."""
    count = len(members)
    sizes = range(1, count + 1) if count <= 5 else (1, 2, count)
    return chain.from_iterable(combinations(members, size) for size in sizes)


def name_of(position: Position) -> str:
    """Return a short description of a position."""
    shown = short(position.node)
    return "the whole expression" if position.role == WHOLE else f"the {position.role} {shown}"


def short(expression: sp.Expr) -> str:
    """Return the text of an expression, cut off if it is long."""
    text = str(sp.sstr(expression))
    return text if len(text) <= 90 else text[:87] + "..."
