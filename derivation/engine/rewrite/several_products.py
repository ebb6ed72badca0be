"""Candidates for the stable form of a formula that depends on several dimensionless products.

The formula is reduced to a function of these products. A part of it that depends on one product is
written by the rules for one variable, and a sum that depends on several is ordered by the powers of
all but one of them: 2 (1 + 2 s) sinh T - 2 T is 2 (sinh T - T) + 4 s sinh T, a sum of two positive
parts. Next to the end of a domain, the distance to the end is the better variable: 1/2 - nu for
Poisson's ratio, or (a - r)/a for r < a. All candidates are tested afterwards in every variable.
"""

import operator
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import chain, count, islice

import sympy as sp
from sympy.codegen.cfunctions import log1p

from derivation.engine.formula.domain import comparison
from derivation.engine.rewrite.accuracy_test import KNOWN, accuracy_test
from derivation.engine.rewrite.blocks import block_of
from derivation.engine.rewrite.differences_from_one import by_differences_from_one
from derivation.engine.rewrite.dimensionless import Product, reduced
from derivation.engine.rewrite.exact_sums import by_exact_sums
from derivation.engine.rewrite.form import Block, Step, Switch
from derivation.engine.rewrite.identities import by_identities
from derivation.engine.rewrite.near_points import about_point
from derivation.engine.rewrite.products import (
    NAMES,
    Powers,
    ProductForm,
    Stated,
    dimensionless_product,
    may_vanish,
    with_powers,
)
from derivation.engine.rewrite.rules import decay, fraction, logarithm
from derivation.engine.rewrite.search import stabilised
from derivation.engine.rewrite.series import POLYNOMIAL
from derivation.engine.rewrite.shape import Shape
from derivation.engine.rewrite.stabilise import Stable
from derivation.engine.rewrite.terms import (
    Key,
    UnreachableError,
    expression_of,
    monomial,
    terms_of,
)
from derivation.engine.rewrite.useful_range import ENDS

ACCURATE = 3.0
"""Largest error [ULP] of a part of one variable that is left as it is."""
MOST_SHIFTS = 6
"""Largest number of choices of ends of domains whose distances become variables."""
LOWER, UPPER = 0, 1
"""Indices of the ends of an interval."""
ELSEWHERE = sp.Rational(7, 19)
"""Factor of an end that gives a number at which no terms cancel."""
NEAR_ZERO, FAR = 1e-6, 1e6
"""Ends of domains of magnitudes outside of this range are not used."""
Interval = tuple[sp.Rational | None, sp.Rational | None]


def several_products(formula: Stated) -> Iterator[ProductForm]:
    """Yield forms of a formula that are equal, but not tested; the simplest first.

    Raises
    ------
    UnreachableError
        If the formula contains a function without code.
    """
    unknown = {f.func.__name__ for f in formula.expression.atoms(sp.Function)} - KNOWN
    if unknown:
        raise UnreachableError(
            f"no code is generated for the function {', '.join(sorted(unknown))}; remove the "
            "formula from the module, and generate its other parts as formulas of their own"
        )
    yield from _distinct(_candidates(formula))


def _distinct(forms: Iterator[ProductForm]) -> Iterator[ProductForm]:
    seen = set()
    for made in forms:
        blocks = tuple((block.name, block.total) for block in made.blocks)
        key = made.steps, made.value, blocks
        if key not in seen:
            seen.add(key)
            yield made


def _candidates(formula: Stated) -> Iterator[ProductForm]:
    expression = formula.expression
    for plain in (expression, sp.factor(expression), *by_identities(expression)):
        if not plain.has(sp.Min, sp.Max):
            yield ProductForm((), plain)
    yield from by_exact_sums(expression)
    taken = {argument.name for argument in formula.arguments}
    names = (name for name in _every_name() if name not in taken)
    zeros = may_vanish(formula)
    lower = reduced(expression, zeros, names)
    domains = {p.variable: _interval(p, formula) for p in lower.products}
    for ends in islice(_shifts(lower.expression, lower.products, domains), MOST_SHIFTS):
        yield from _written(formula, lower.expression, lower.front, lower.products, domains, ends)


def _every_name() -> Iterator[str]:
    return chain(NAMES, (f"x_{number}" for number in count(2)))


def _shifts(
    expression: sp.Expr, products: Sequence[Product], domains: Mapping[sp.Symbol, Interval]
) -> Iterator[dict[sp.Symbol, sp.Rational]]:
    """Yield choices of variables with an end of their domains: none, several, each one.

    Ends at which terms cancel come first.
    """
    yield {}
    sides = [
        {p.variable: end for p in products if (end := domains[p.variable][side]) is not None}
        for side in (UPPER, LOWER)
    ]
    parts = sp.fraction(sp.together(expression))
    for useful in (True, False):
        upper, lower = (
            {x: end for x, end in ends.items() if _cancels(parts, x, end) == useful}
            for ends in sides
        )
        several = ({**lower, **upper}, {**upper, **lower}, upper, lower)
        yield from (ends for ends in several if len(ends) > 1)
        yield from ({x: end} for ends in (upper, lower) for x, end in ends.items())


def _cancels(parts: Sequence[sp.Expr], x: sp.Symbol, end: sp.Rational) -> bool:
    """Return whether terms cancel, or have no value, where a variable is at an end."""
    there, elsewhere = ([part.subs(x, at) for part in parts] for at in (end, end * ELSEWHERE))
    if any(part.has(sp.zoo, sp.nan, sp.oo) for part in there):
        return True
    counts = [sum(len(_terms(part)) for part in values) for values in (there, elsewhere)]
    return counts[0] < counts[1]


def _terms(expression: sp.Expr) -> tuple[sp.Expr, ...]:
    return sp.Add.make_args(sp.expand(expression)) if expression != 0 else ()


def _interval(product: Product, formula: Stated) -> Interval:
    """Return the ends of a product's domain that its conditions state, without ends at 0."""
    ends: list[sp.Rational | None] = [None, None]
    x = product.variable
    symbols = {argument.name: argument.symbol for argument in formula.arguments}
    own, power = min(product.powers, key=lambda pair: (abs(pair[1]), str(pair[0])))
    rest = sp.Mul(*(symbol**p for symbol, p in product.powers if symbol != own))
    replaced = own if product.is_symbol else (x / rest) ** (1 / power)
    for condition in {c for argument in formula.arguments for c in argument.domain}:
        difference, compare = comparison(condition)
        if not {symbol.name for symbol in difference.free_symbols} <= set(symbols):
            continue
        named = {symbol: symbols[symbol.name] for symbol in difference.free_symbols}
        whole = sp.factor(sp.nsimplify(difference.xreplace(named), rational=True))
        parts = sp.Mul.make_args(sp.factor(sp.powdenest(whole.subs(own, replaced), force=True)))
        inner = [part for part in parts if part.free_symbols == {x} and part.is_polynomial(x)]
        others = [part for part in parts if part not in inner]
        linear = [part for part in inner if part.is_Add and sp.degree(part, x) == 1]
        linear = linear or [part for part in inner if part == x and len(inner) == 1]
        if len(linear) != 1 or not all(part.is_positive or part.is_Number for part in others):
            continue
        sign = -1 if sp.Mul(*(part for part in others if part.is_Number)) < 0 else 1
        slope, start = sp.Poly(linear[0], x).all_coeffs()
        is_upper = (compare in (operator.lt, operator.le)) == (sign * slope > 0)
        if compare is not operator.ne and NEAR_ZERO < abs(start / slope) < FAR:
            ends[is_upper] = sp.Rational(-start / slope)
    return ends[0], ends[1]


def _written(
    formula: Stated,
    expression: sp.Expr,
    front: Powers,
    products: Sequence[Product],
    domains: Mapping[sp.Symbol, Interval],
    shifts: Mapping[sp.Symbol, sp.Rational],
) -> Iterator[ProductForm]:
    """Yield the forms in given variables, products or distances to ends of their domains."""
    taken = {argument.name for argument in formula.arguments}
    gaps = (name for number in count(1) if (name := f"distance_{number}") not in taken)
    steps, variables, changed = [], {}, {}
    for product in products:
        x, (low, high) = product.variable, domains[product.variable]
        if not product.is_symbol:
            steps.append(Step(x, dimensionless_product(product.powers)))
        if x not in shifts:
            if x.is_positive:
                variables[x] = _range(low, high)
            continue
        end, gap = shifts[x], sp.Symbol(next(gaps), positive=True)
        sign = -1 if end == high else 1
        steps.append(Step(gap, _distance(product, end, sign)))
        changed[x] = end + sign * gap
        width = float(high - low) if low is not None and high is not None else ENDS[1]
        variables[gap] = (ENDS[0], width)
    whole = expression.subs(changed, simultaneous=True)
    symbols = [gap for gap in variables if whole.has(gap)]
    symbols.sort(key=lambda v: (not _in_function(whole, v), str(v)))
    ways = [(whole, None), *((part, None) for part in by_differences_from_one(whole))]
    for part, v in (*ways, *((whole, v) for v in symbols)):
        writer = _Writer(formula.name, variables)
        try:
            value = writer.write(part) if v is None else writer.separated(part, v)
        except UnreachableError:
            continue
        kept = tuple(step for step in steps if _is_used(step.symbol, steps, value))
        blocks = tuple(writer.used.values())
        yield ProductForm(kept, with_powers(value, front), blocks, tuple(writer.found))


def _is_used(symbol: sp.Symbol, steps: Sequence[Step], value: sp.Expr) -> bool:
    return value.has(symbol) or any(step.expression.has(symbol) for step in steps)


def _in_function(expression: sp.Expr, v: sp.Symbol) -> bool:
    return any(f.has(v) for f in expression.atoms(sp.Function, sp.exp))


def _range(low: sp.Rational | None, high: sp.Rational | None) -> tuple[float, float]:
    first = ENDS[0] if low is None or low <= 0 else float(low)
    return first, ENDS[1] if high is None else float(high)


def _distance(product: Product, end: sp.Rational, sign: int) -> sp.Expr:
    """Return the distance of a product to an end, as a difference of symbols over a divisor."""
    above = sp.Mul(*(s**p for s, p in product.powers if p > 0))
    below = sp.Mul(*(s**-p for s, p in product.powers if p < 0))
    return sign * (above - end * below) / below


@dataclass
class _Writer:
    """Writes parts that depend on one variable in their stable forms.

    Parameters
    ----------
    name
        Name of the formula.
    ranges
        Positive variables with the ranges in which their parts are to be accurate.
    """

    name: str
    ranges: Mapping[sp.Symbol, tuple[float, float]]
    used: dict[sp.Expr, Block] = field(default_factory=dict)
    found: list[tuple[Powers, Stable]] = field(default_factory=list)

    def write(self, node: sp.Expr) -> sp.Expr:
        """Return an expression whose parts of one variable have stable forms."""
        symbols = node.free_symbols
        if len(symbols) <= 1:
            return self._alone(node, *symbols) if symbols else node
        if node.is_Add or node.is_Mul:
            return node.func(*(self.write(part) for part in _grouped(node)))
        if isinstance(node, sp.log) and 1 in sp.Add.make_args(node.args[0]):
            return log1p(self.write(node.args[0] - 1))
        return node.func(*(self.write(part) for part in node.args))

    def separated(self, expression: sp.Expr, x: sp.Symbol) -> sp.Expr:
        """Return a quotient of products of sums, each ordered by functions of x.

        Raises
        ------
        UnreachableError
            If a sum contains functions that no rule divides into terms.
        """
        given = expression
        for rule in (logarithm, fraction, decay):
            given = next(rule(x, given), given)
        assert isinstance(given, Shape)  # `decay` always returns a shape
        value = self.write(given.front) if given.front.free_symbols else given.front
        value *= self._alone(x**given.power * sp.exp(given.rate * x), x)
        for factor in given.factors:
            value *= self._sum(factor.value, x) ** factor.exponent
        return value

    def _sum(self, value: sp.Expr, x: sp.Symbol) -> sp.Expr:
        groups: dict[sp.Expr, dict[Key, sp.Expr]] = defaultdict(dict)
        for key, size in terms_of(value, x).items():
            for term in sp.Add.make_args(sp.expand(size)):
                number, part = term.as_independent(*term.free_symbols, as_Add=False)
                groups[part][key] = number
        total = sp.Integer(0)
        for part, terms in groups.items():
            inner = expression_of(terms, x) if len(terms) > 1 else _term(terms, x)
            total += self.write(part) * (self._alone(inner, x) if inner.has(x) else inner)
        return total

    def _alone(self, part: sp.Expr, x: sp.Symbol) -> sp.Expr:
        """Return a part of one variable in its stable form, as a block if it has several steps."""
        known = part.is_Symbol or (part.is_Pow and part.base == x)
        if known or (x not in self.ranges and part.is_rational_function(x)):
            return sp.factor(part) if part.is_rational_function(x) else part
        stable = _stable(part, x, self.ranges[x]) if x in self.ranges else _about_zero(part, x)
        if stable is None:
            return part
        self.found.append((((x, sp.Integer(1)),), stable))
        value = stable.value
        if not stable.steps and not isinstance(value, Switch) and not value.has(POLYNOMIAL):
            return value
        if part not in self.used:
            name = f"{self.name}_factor_{len(self.used) + 1}"
            self.used[part] = block_of(name, stable, f"A dimensionless part of {self.name}.")
        return self.used[part](x)


def _term(terms: Mapping[Key, sp.Expr], x: sp.Symbol) -> sp.Expr:
    ((key, size),) = terms.items()
    return size * monomial(key, x)


@lru_cache(maxsize=1024)
def _stable(part: sp.Expr, x: sp.Symbol, ends: tuple[float, float]) -> Stable | None:
    """Return the stable form of a part of one variable; None if the part itself is taken."""
    try:
        test = accuracy_test(part, x, ends, part)
        if test.worst(part) <= ACCURATE:
            return None
        return stabilised(part, x, ends)
    except UnreachableError:
        return None


@lru_cache(maxsize=1024)
def _about_zero(part: sp.Expr, x: sp.Symbol) -> Stable | None:
    """Return the form about 0 of a part of a variable of any sign; None if nothing cancels."""
    try:
        return about_point(part, x, sp.Integer(0))
    except UnreachableError:
        return None


def _grouped(node: sp.Expr) -> Iterator[sp.Expr]:
    """Yield the parts of a sum or product, those that depend on the same one variable combined.

    A constant is added to the first part with a function, because it may cancel there.
    """
    groups: dict[frozenset[sp.Symbol], list[sp.Expr]] = defaultdict(list)
    for part in node.args:
        groups[frozenset(part.free_symbols)].append(part)
    constants = groups.pop(frozenset(), [])
    alone = [key for key in groups if len(key) == 1]
    if node.is_Add and constants and alone:
        first = next((key for key in alone if _in_function(sp.Tuple(*groups[key]), *key)), alone[0])
        groups[first] += constants
        constants = []
    yield from constants
    for key, parts in groups.items():
        yield from [node.func(*parts)] if len(key) == 1 else parts
