"""Stable forms of formulas in several variables, by one dimensionless variable and blocks.

Stages, in this order:

 1 dimensionless   the product on which all functions depend becomes a variable, and a sum of
                   constants is written as its ratio to another sum
 2 rules           `fraction`, `decay` and `difference`, as for one variable
 3 blocks          sums that cancel at 0 become building blocks times a power of x
 4 quotients       quotients that tend to 1 become 1 plus a positive term; division where possible
 5 powers          powers of the variable and of symbols, and the decay, are separated from the
                   sums; `times` multiplies the value of the sums by the powers
"""

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import sympy as sp

from derivation.engine.rewrite.form import (
    CLOSELY,
    FAR,
    LARGEST,
    ONCE,
    TAIL,
    TIMES,
    Block,
    Step,
    limited,
)
from derivation.engine.rewrite.rules import decay, fraction, parts_of
from derivation.engine.rewrite.scales import Scale, Scales
from derivation.engine.rewrite.series import leading_power
from derivation.engine.rewrite.shape import Factor, Shape
from derivation.engine.rewrite.terms import ONE, Key, UnreachableError, terms_of

exponential = sp.Symbol("exponential", positive=True)
near, reach, stretch = sp.symbols("near reach stretch", positive=True)


@dataclass(frozen=True)
class Reduced:
    """A formula in its dimensionless variable, with the length eliminated.

    The ratio is a symbol of the formula, or one that does not occur in it.
    """

    expression: sp.Expr
    scale: Scale
    ratio: sp.Expr


def dimensionless(expression: sp.Expr, scales: Scales) -> Reduced:
    """Return the formula in terms of the product on which all its functions depend.

    Raises
    ------
    UnreachableError
        If there is no single such product.
    """
    functions = expression.atoms(sp.exp, sp.sinh, sp.cosh, sp.sin, sp.cos)
    arguments = [function.args[0].as_coeff_Mul() for function in functions]
    products = {product for _, product in arguments}
    if len(products) != 1:
        raise UnreachableError(
            f"expected functions of multiples of one product of symbols in {expression}, got "
            f"{len(products)} products"
        )
    (product,) = products
    least = sp.gcd_list([factor for factor, _ in arguments])
    scale = scales.of(least * product)
    if scale is None:
        raise UnreachableError(f"no dimensionless variable for {least * product}")
    replaced = expression.subs(scale.length, scale.variable / (scale.product / scale.length))
    ratio: sp.Expr = sp.Dummy()
    if scales.ratio is not None:
        ratio = scales.ratio.step.symbol
        replaced = replaced.subs(scales.ratio.whole, ratio * scales.ratio.part)
    return Reduced(sp.factor_terms(replaced), scale, ratio)


Automatic = tuple[tuple[Step, ...], sp.Expr]


def automatic(
    expression: sp.Expr, known: Mapping[str, Block], scales: Scales, closely: bool = False
) -> Automatic:
    """Return steps and value of the formula's stable form.

    Parameters
    ----------
    expression
        The derived formula; all symbols whose sign matters are positive.
    known
        Building blocks by name.
    scales
        The dimensionless variables.
    closely
        Whether the rounding of the powers uses most of the budget.

    Raises
    ------
    UnreachableError
        If the rules do not apply to the formula, or a building block is missing.
    """
    reduced = dimensionless(expression, scales)
    shape, scale = _shape(reduced), reduced.scale
    steps: list[Step] = []
    if scales.ratio is not None and reduced.expression.has(reduced.ratio):
        steps.append(scales.ratio.step)
    most = LARGEST if reduced.expression.has(sp.sin) else FAR
    times, product = scale.product.as_coeff_Mul()  # 2 h phi must not begin with 2 h
    steps.append(Step(scale.variable, times * limited(product, most), "constant for larger values"))
    if shape.rate > 0:
        raise UnreachableError(
            f"expected an expression that stays finite, but {expression} grows as "
            f"e^({shape.rate} {shape.x})"
        )
    size, core, powers = (
        _beyond_one(shape, known)
        or _divided_sum(shape, reduced.ratio)
        or _separated_sums(shape, known)
    )
    for base, exponent in shape.front.as_powers_dict().items():
        if base.is_Symbol and base != reduced.ratio:
            powers[base] += int(exponent)
        else:
            size *= base**exponent
    core = _with_length(core, powers, scale)
    steps += _joined(powers, scale)
    if shape.rate < 0:
        decayed = -shape.rate * shape.x
        steps.append(Step(exponential, sp.exp(-sp.Min(decayed, ONCE))))
        powers[exponential] = powers[TAIL(decayed)] = 1
    core = core.xreplace({step.expression: near for step in steps if step.symbol == near})
    factors = [part for base in sorted(powers, key=str) for part in (base, powers[base])]
    value = sp.Mul(size, core, evaluate=False) if core.is_Add and size != 1 else size * core
    put = CLOSELY if closely else TIMES
    return tuple(steps), put(value, *factors) if factors else value


SeparatedSums = tuple[sp.Expr, sp.Expr, dict[sp.Expr, int]]
"""A constant, a core and bases with their powers; their product is the factor."""


def _separated_sums(shape: Shape, known: Mapping[str, Block]) -> SeparatedSums:
    """Return the constant, the core and the powers of a shape's sums."""
    size, core, powers = sp.Integer(1), sp.Integer(1), defaultdict(int, {shape.x: shape.power})
    for factor in _paired_factors(shape, known):
        content, value, taken = _factor(factor, shape.x, known)
        size *= content**factor.exponent
        if factor.exponent > 1:
            powers[value] += factor.exponent
        else:
            core *= value**factor.exponent
        for base, power in taken.items():
            powers[base] += power * factor.exponent
    return size, core, powers


def _paired_factors(shape: Shape, known: Mapping[str, Block]) -> tuple[Factor, ...]:
    """Return the factors; two are combined if there is a building block for their product."""
    for one, other in combinations(shape.factors, 2):
        if one.exponent == other.exponent and {shape.x} == (one.value * other.value).free_symbols:
            product = sp.expand(one.value * other.value)
            if _block(terms_of(product, shape.x), shape.x, known) is not None:
                others = [factor for factor in shape.factors if factor not in (one, other)]
                return Factor(product, one.exponent), *others
    return shape.factors


def _beyond_one(shape: Shape, known: Mapping[str, Block]) -> SeparatedSums | None:
    """Write a quotient that tends to 1 as 1 plus a positive term.

    The relative error of the term has little effect where it is small. Return None if the term does
    not decay, or its parts differ in sign.
    """
    own, whole = shape.x, sp.Mul(*(factor.value**factor.exponent for factor in shape.factors))
    if shape.rate != 0 or shape.power != 0 or whole.free_symbols != {own}:
        return None
    sums = (terms_of(factor.value, own) for factor in shape.factors)
    if any(terms.get(ONE) != 1 or any(k != ONE and k.rate >= 0 for k in terms) for terms in sums):
        return None
    remainder = next(decay(own, next(fraction(own, whole - 1))))
    assert isinstance(remainder, Shape)
    size, core, powers = _separated_sums(remainder, known)
    above = (factor.value for factor in remainder.factors if factor.exponent > 0)
    parts = (part for value in above for part, _ in parts_of(terms_of(value, own), own))
    size *= remainder.front
    if remainder.rate >= 0 or size < 0 or not all(_positive(part, own) for part in parts):
        return None
    held = sp.Mul(*(base**-power for base, power in powers.items()))
    return sp.Integer(1), held + size * sp.exp(remainder.rate * own) * core, powers


def _divided_sum(shape: Shape, ratio: sp.Expr) -> SeparatedSums | None:
    """Write N/(N Q + R) as 1/(Q + R/N), with Q and R/N of one sign; None without such a Q.

    Every function of the numerator is then computed once, and its error has less effect.
    """
    own, q = shape.x, sp.Dummy("q")
    exponents = {factor.exponent: terms_of(factor.value, own) for factor in shape.factors}
    if len(shape.factors) != 2 or set(exponents) != {1, -1} or shape.front.has(ratio):
        return None
    above, below = exponents[1], exponents[-1]
    free, rest = (
        {k: v for k, v in below.items() if (k.power == 0) == side} for side in (True, False)
    )
    divided, left = sp.div(*(sum(v * q**-k.rate for k, v in t.items()) for t in (free, above)), q)
    if left != 0 or any(key.power for key in above):
        return None
    numerator, bound = (sp.Add(*(v for v, _ in parts_of(t, own))) for t in (above, rest))
    parts = divided.subs(q, sp.exp(-own)), bound / numerator
    for sign in (1, -1):
        if all(_positive(sign * part, own) for part in parts):
            return sp.Integer(sign), 1 / (sign * sp.Add(*parts)), defaultdict(int)
    return None


def _positive(part: sp.Expr, own: sp.Symbol) -> bool:
    return all(part.subs(own, at).evalf() > 0 for at in (sp.Rational(1, 8), 1, 8))


def _with_length(core: sp.Expr, powers: dict[sp.Expr, int], scale: Scale) -> sp.Expr:
    """Write (ratio f + x g)/rate as ratio f/rate + length g, with fewer roundings of x and rate.

    All other parts become powers, because a large length over a small part would overflow.
    """
    own, rate = scale.variable, scale.rate
    sums = [f for f in core.as_powers_dict() if f.is_Add and f.free_symbols > {own}]
    if rate is None or not sums or powers[rate] >= 0 or scale.product / rate != scale.length:
        return core
    (whole,) = sums
    for base, exponent in (core / whole).as_powers_dict().items():
        powers[base] += exponent
    powers[rate] += 1
    apart = [
        part * scale.length / own if own in part.as_powers_dict() else part / rate
        for part in whole.args
    ]
    return sp.Add(*apart)


def _joined(powers: dict[sp.Expr, int], scale: Scale) -> list[Step]:
    """Combine powers that cancel each other, as steps; no base keeps the power 0."""
    steps, variable, rate = [], scale.variable, scale.rate
    if rate is not None and scale.joined and powers[variable] > 0 > powers[rate]:
        count = min(powers[variable], -powers[rate])
        for base, change in ((scale.length, count), (variable, -count), (rate, count)):
            powers[base] += change
    for least in [base for base in powers if isinstance(base, sp.Min)]:
        (at,) = (bound for bound in least.args if bound.is_Number)
        if rate is not None and powers[least] > 0 > powers[rate]:  # near/rate = times reach
            count, times = min(powers[least], -powers[rate]), scale.product / scale.length / rate
            most = at / times
            steps.append(Step(reach, sp.Min(scale.length, most / rate), f"at most {most}/{rate}"))
            powers[reach], powers[rate] = count, powers[rate] + count
            powers[times] += count * (times != 1)
            powers[least] -= count
        if powers[least]:
            steps.append(Step(near, least))
        if powers[least] * powers[variable] < 0:
            steps.append(Step(stretch, variable / near, f"1 below {at}"))
            powers[stretch], powers[variable] = powers[variable], 0
            powers[least] += powers[stretch]
        powers[near], powers[least] = powers[least], 0
    for base in [base for base in powers if powers[base] == 0]:
        del powers[base]
    return steps


def _shape(reduced: Reduced) -> Shape:
    """Return the formula as a shape, with constants that cancel removed."""
    given = reduced.expression
    if isinstance(given, sp.Add):
        given = next(fraction(reduced.scale.variable, given), given)
    shape = next(decay(reduced.scale.variable, given))
    assert isinstance(shape, Shape)  # `decay` always returns a shape
    return shape


def _factor(factor: Factor, variable: sp.Symbol, known: Mapping[str, Block]) -> SeparatedSums:
    """Return a factor as a constant, a sum that does not cancel at 0, and bases with powers."""
    terms = terms_of(factor.value, variable)
    if {variable} == factor.value.free_symbols:
        block = _block(terms, variable, known)
        if block is not None:
            return block
        lead, least = leading_power(terms), min(power for _, power in parts_of(terms, variable))
        if lead > least:
            raise UnreachableError(
                f"{factor.value} cancels at 0, and no building block replaces it"
            )
    content = sp.gcd_list([value.as_content_primitive()[0] for value in terms.values()])
    primitive = {key: value / content for key, value in terms.items()}
    return content, sp.Add(*(v for v, _ in parts_of(primitive, variable))), {}


def _block(
    terms: Mapping[Key, sp.Expr], variable: sp.Symbol, known: Mapping[str, Block]
) -> SeparatedSums | None:
    """Return a sum as a constant, a building block and powers; None if there is no such block."""
    rates = [abs(key.scale if key.wave else key.rate) for key in terms]
    least = sp.gcd_list([rate for rate in rates if rate != 0])
    for block in known.values():
        own = terms_of(sp.expand(block.total), block.arguments[0])
        rate = max(key.rate for key in own)
        for scale in (least, least / 2):
            moved = {
                k._replace(rate=(k.rate - rate) * scale, scale=k.scale * scale): v * scale**k.power
                for k, v in own.items()
            }
            ratios = {sp.cancel(terms[key] / v) for key, v in moved.items() if key in terms}
            if moved.keys() == terms.keys() and len(ratios) == 1:
                at = scale * variable
                taken = {
                    block.near(at): block.constant_power,
                    at: block.lead - block.constant_power,
                }
                return ratios.pop(), block(at), {b: p for b, p in taken.items() if p}
    return None
