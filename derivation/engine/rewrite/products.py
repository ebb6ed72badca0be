"""Stable forms of formulas whose factors each depend on one product of powers of the symbols.

Such a factor is f = v_1^p_1 v_2^p_2 ... g(x), where x = v_1^q_1 v_2^q_2 ... Its logarithmic slopes
d log f/d log v_i = p_i + q_i d log g/d log x lie on a straight line, whose direction is q. Both
exponents follow from the slopes at some points. The form is proved afterwards, as all forms are.
"""

import math
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain, count
from typing import NamedTuple, TypeVar

import flint
import sympy as sp

from derivation.engine.formula.ball import enclose, to_ball
from derivation.engine.formula.grid import inside, plain_grid
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary
from derivation.engine.rewrite.blocks import block_of
from derivation.engine.rewrite.form import CLOSELY, TIMES, Block, Step, Switch
from derivation.engine.rewrite.search import stabilised
from derivation.engine.rewrite.series import POLYNOMIAL
from derivation.engine.rewrite.stabilise import Applied, Stable
from derivation.engine.rewrite.terms import UnreachableError
from derivation.engine.rewrite.useful_range import ENOUGH

BITS, RADIUS, ROUNDING = 400, 1e-60, Fraction(1, 10**30)
"""Precision of the slopes, their largest error, and that of numbers that follow from them."""
CHANGED = Fraction(1, 10**20)
"""Smallest change of a slope from which a direction is computed."""
LARGEST_SLOPE = 1e30
"""Largest slope from which exponents are computed."""
ENOUGH_POINTS = 5
"""Smallest number of points with slopes for a decision."""
SEVERAL_PRODUCTS = (
    "{} depends on several dimensionless products; rewrite parts that depend on one each"
)
"""Message about a factor, with the remedy."""
LARGEST_DENOMINATOR = 60
"""Largest denominator of an exponent."""
NAMES = "x", "y", "ratio", "product", "other_product"
"""Names of the products, of which those are taken that the formula does not use."""
Powers = tuple[tuple[sp.Symbol, sp.Rational], ...]
"""Symbols with their exponents, without zeros."""
Slopes = list[Fraction]
Result = TypeVar("Result")


class GivenFormula(NamedTuple):
    """A formula that is given, without a proof."""

    name: str
    expression: sp.Expr
    vocabulary: Vocabulary

    @property
    def arguments(self) -> tuple[Argument, ...]:
        """The symbols on which it depends."""
        return self.vocabulary.arguments_of(self.expression)


Stated = Record | GivenFormula


@dataclass(frozen=True)
class ProductForm:
    """A form of a formula in several variables.

    Parameters
    ----------
    steps, value
        Intermediate values, and the result.
    blocks
        Building blocks for the factors that need one.
    factors
        The product of each factor, and its stable form in that product.
    """

    steps: tuple[Step, ...]
    value: sp.Expr | Switch
    blocks: tuple[Block, ...] = ()
    factors: tuple[tuple[Powers, Stable], ...] = ()

    @property
    def applied(self) -> tuple[Applied, ...]:
        """The rules that were kept, for each factor in turn."""
        return tuple(rule for _, stable in self.factors for rule in stable.applied)


def decaying_last(made: ProductForm) -> ProductForm:
    """Return the form with e^(-x) in front as two factors e^(-x/2), which do not underflow.

    They are multiplied last, so that the result underflows only if the value does.
    """
    value = made.value
    if isinstance(value, Switch):
        return made
    inner, *powers = value.args if value.func == TIMES else (value,)
    decays = [factor for factor in sp.Mul.make_args(inner) if isinstance(factor, sp.exp)]
    rest = sp.Mul(*(factor for factor in sp.Mul.make_args(inner) if factor not in decays))
    halves = [part for decay in decays for part in (sp.exp(decay.args[0] / 2), sp.Integer(2))]
    return replace(made, value=TIMES(rest, *powers, *halves)) if decays else made


def of_products(formula: Stated, accept: Callable[[ProductForm], tuple[Result, float]]) -> Result:
    """Return what a function returns for the stable form, by each product x or by its inverse.

    The inverse is tried if x gives no form, or one that is not very accurate.

    Parameters
    ----------
    formula
        A formula whose factors each depend on one product.
    accept
        Function that tests a form and returns a result with the error [ULP], or raises
        UnreachableError.

    Raises
    ------
    UnreachableError
        If a factor depends on several such products, or no form is accurate; the message is that
        for the first form.
    """
    results: list[tuple[Result, float]] = []
    reasons: list[UnreachableError] = []
    for inverted in (False, True):
        try:
            results.append(accept(_form(formula, inverted)))
        except UnreachableError as error:
            reasons.append(error)
        if results and results[-1][1] <= ENOUGH / 2:
            break
    if not results:
        raise reasons[0]
    return min(results, key=lambda pair: pair[1])[0]


def _form(formula: Stated, inverted: bool) -> ProductForm:
    """Return the stable form of a formula whose factors each depend on one product."""
    value, front, factors = _factored(formula, inverted)
    steps: list[Step] = []
    blocks: list[Block] = []
    for product, stable in factors:
        x, core = stable.variable, stable.value
        steps += [Step(x, dimensionless_product(product))] if len(product) > 1 else []
        alone = len(factors) == 1 or not stable.steps  # otherwise names of steps could occur twice
        if alone and isinstance(core, sp.Expr) and not core.has(POLYNOMIAL):
            steps += stable.steps
            value *= core
        else:
            number = f"_{len(blocks) + 1}" if blocks else ""
            summary = f"A dimensionless factor of {formula.name}."
            blocks.append(block_of(f"{formula.name}_factor{number}", stable, summary))
            value *= blocks[-1](x)
    return ProductForm(tuple(steps), with_powers(value, front), tuple(blocks), factors)


def _factored(
    formula: Stated, inverted: bool
) -> tuple[sp.Expr, Powers, tuple[tuple[Powers, Stable], ...]]:
    """Return a constant, powers of symbols, and the other factors, stable in their products."""
    cores: dict[Powers, sp.Expr] = defaultdict(lambda: sp.Integer(1))
    front: dict[sp.Symbol, sp.Rational] = defaultdict(lambda: sp.Integer(0))
    for factor in sp.Mul.make_args(sp.factor_terms(formula.expression)):
        powers, product = _exponents(factor, formula, inverted)
        for symbol, power in powers:
            front[symbol] += power
        cores[product] *= factor
    constant = _core(cores.pop((), sp.Integer(1)), formula)
    every = chain(NAMES, (f"x_{number}" for number in count(2)))
    names = (sp.Symbol(name, positive=True) for name in every if name not in _names(formula))
    forms = []
    for product, factor in cores.items():
        own, power = _eliminated(product, formula)
        x = own if len(product) == 1 else next(names)
        forms.append((product, stabilised(_core(factor, formula, own, x ** (1 / power)), x)))
    return constant, tuple(front.items()), tuple(forms)


def _core(
    factor: sp.Expr, formula: Stated, own: sp.Symbol | None = None, value: sp.Expr | None = None
) -> sp.Expr:
    """Return a factor with a value for one symbol, and 1 for all others."""
    ones = {argument.symbol: sp.Integer(1) for argument in formula.arguments}
    return factor.subs(ones if own is None else {**ones, own: value})


def _exponents(factor: sp.Expr, formula: Stated, inverted: bool) -> tuple[Powers, Powers]:
    """Return the exponents in front of g, and those of its product; both may be empty."""
    symbols = [a.symbol for a in formula.arguments if factor.has(a.symbol)]
    if not symbols:
        return (), ()
    first, *others = _slopes(factor, formula, symbols)
    changes = [[b - a for a, b in zip(first, other, strict=True)] for other in others]
    changes = [change for change in changes if max(map(abs, change)) > CHANGED]
    if not changes:
        return _rational(factor, symbols, first), ()
    index = max(range(len(symbols)), key=lambda index: abs(changes[0][index]))
    if any(abs(change[index]) <= CHANGED for change in changes):
        raise UnreachableError(SEVERAL_PRODUCTS.format(factor))
    line, *more = ([part / change[index] for part in change] for change in changes)
    if any(abs(a - b) > ROUNDING for other in more for a, b in zip(line, other, strict=True)):
        raise UnreachableError(SEVERAL_PRODUCTS.format(factor))
    product = _oriented(_rational(factor, symbols, line), formula, inverted)
    own, power = _eliminated(product, formula)
    rate = first[symbols.index(own)] / int(power)
    rest = dict(product)
    powers = [p - rate * int(rest.get(s, 0)) for s, p in zip(symbols, first, strict=True)]
    return _rational(factor, symbols, powers), product


def _oriented(product: Powers, formula: Stated, inverted: bool) -> Powers:
    """Return a product or its inverse with integer exponents.

    Symbols that may vanish are no divisors, and a single symbol is not inverted.
    """
    unit = sp.Integer(math.lcm(*(power.q for _, power in product)))
    zeros = [power for symbol, power in product if symbol in may_vanish(formula)]
    sign = sp.sign((*zeros, product[0][1])[0])
    if inverted and len(product) > 1 and not zeros:
        sign = -sign
    return tuple((symbol, sign * unit * power) for symbol, power in product)


def _eliminated(product: Powers, formula: Stated) -> tuple[sp.Symbol, sp.Rational]:
    """Return the symbol that a product replaces, with its exponent.

    It is one that may vanish if there is one, because all others may become divisors.
    """
    zeros = may_vanish(formula)
    return min(product, key=lambda pair: (pair[0] not in zeros, abs(pair[1]), str(pair[0])))


def _names(formula: Stated) -> list[str]:
    """Return the names of the arguments."""
    return [argument.name for argument in formula.arguments]


def may_vanish(formula: Stated) -> list[sp.Symbol]:
    """Return the arguments that may be zero."""
    pairs = ((argument.symbol, argument.name) for argument in formula.arguments)
    return [symbol for symbol, name in pairs if inside(formula.vocabulary, {name: 0.0})]


def _slopes(factor: sp.Expr, formula: Stated, symbols: Sequence[sp.Symbol]) -> list[Slopes]:
    """Return the logarithmic slopes at difficult points of the domain."""
    expressions = [symbol * factor.diff(symbol) / factor for symbol in symbols]
    names, slopes = _names(formula), []
    for point in plain_grid(formula.name, tuple(names), formula.vocabulary):
        with flint.ctx.workprec(BITS):
            at = {a.symbol: to_ball(point[a.name]) for a in formula.arguments}
            try:
                balls = [enclose(expression, at) for expression in expressions]
            except NotImplementedError as error:
                raise UnreachableError(f"{factor} cannot be evaluated: {error}") from None
        if all(ball.rad() < RADIUS and abs(ball) < LARGEST_SLOPE for ball in balls):
            slopes.append([_middle(ball) for ball in balls])
    if len(slopes) < ENOUGH_POINTS:
        raise UnreachableError(
            f"expected derivatives of {factor} at {ENOUGH_POINTS} test points or more, got "
            f"{len(slopes)}; narrow the domains of its arguments"
        )
    return slopes


def _middle(ball: flint.arb) -> Fraction:
    """Return the middle of a ball; 0 if it is so small that its fraction would be huge."""
    if abs(ball) < RADIUS:
        return Fraction(0)
    mantissa, exponent = ball.mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def _rational(factor: sp.Expr, symbols: Sequence[sp.Symbol], values: Slopes) -> Powers:
    """Return values as rational exponents of the symbols."""
    exponents = [value.limit_denominator(LARGEST_DENOMINATOR) for value in values]
    if any(abs(a - b) > ROUNDING for a, b in zip(exponents, values, strict=True)):
        raise UnreachableError(f"{factor} is not a function of a product of rational powers")
    pairs = zip(symbols, exponents, strict=True)
    return tuple((symbol, sp.Rational(p.numerator, p.denominator)) for symbol, p in pairs if p)


def dimensionless_product(powers: Powers) -> sp.Expr:
    """Return the product of powers, rounded once."""
    if sum(abs(power) for _, power in powers) == 2:
        return sp.Mul(*(symbol**power for symbol, power in powers))
    return CLOSELY(1, *(part for pair in powers for part in pair))


def with_powers(value: sp.Expr, powers: Powers) -> sp.Expr:
    """Return a value times powers; those of integer exponents neither overflow nor underflow."""
    pairs = sorted(((s, p) for s, p in powers if p), key=lambda pair: str(pair[0]))
    value *= sp.Mul(*(symbol**power for symbol, power in pairs if not power.is_Integer))
    whole = [part for symbol, power in pairs if power.is_Integer for part in (symbol, power)]
    return TIMES(value, *whole) if whole else value
