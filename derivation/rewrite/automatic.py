"""A formula in several variables -> its stable form in one dimensionless variable and blocks.

Stages, in this order:

 1 dimensionless   the one product that all functions depend on becomes x, T or y, and lam + 2 mu
                   its ratio to lam + mu
 2 rules           `fraction`, `decay` and `difference`, as for one variable
 3 blocks          sums that cancel at 0 -> building blocks, their power of x taken out
 4 front           powers of x that only undo powers of a length are undone; squares paired
 5 halves          an exponential that decays is applied in two halves around all the rest
"""

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from derivation.formula.symbols import a, h, lam, mu, phi
from derivation.rewrite.form import Block, Step
from derivation.rewrite.rules import decay, fraction, parts_of
from derivation.rewrite.series import leading_power
from derivation.rewrite.shape import Factor, Shape
from derivation.rewrite.terms import Key, UnreachableError, terms_of

x, y, T = sp.symbols("x y T", positive=True)
core, over, part, spread = sp.symbols("core over part spread", real=True)
fade, ratio = sp.symbols("fade ratio", positive=True)
RATIO = Step(ratio, (lam + 2 * mu) / (lam + mu), "2 (1 - nu)")
HALVED = "half of the decay, twice: neither factor underflows alone"
VARIABLES = {phi * h: (x, h), 2 * phi * h: (T, h), a * phi: (y, a), T: (T, T)}
"""Products that functions may depend on, the symbol each becomes, and what it replaces."""


@dataclass(frozen=True)
class Reduced:
    """A formula with its dimensionless variable: variable = product, whose length is gone."""

    expression: sp.Expr
    variable: sp.Symbol
    product: sp.Expr
    length: sp.Symbol


def dimensionless(expression: sp.Expr) -> Reduced:
    """The formula in the product that all its functions depend on.

    Raises
    ------
    UnreachableError
        If there is no one such product.
    """
    functions = expression.atoms(sp.exp, sp.sinh, sp.cosh, sp.sin, sp.cos)
    arguments = [function.args[0].as_coeff_Mul() for function in functions]
    products = {product for _, product in arguments}
    if len(products) != 1:
        raise UnreachableError(f"functions of {len(products)} products: {expression}")
    (product,) = products
    least = sp.gcd_list([factor for factor, _ in arguments])
    if least * product not in VARIABLES:
        raise UnreachableError(f"no dimensionless variable for {least * product}")
    variable, length = VARIABLES[least * product]
    replaced = expression.subs(length, variable / (least * product / length))
    elastic = replaced.subs(lam + 2 * mu, ratio * (lam + mu))
    return Reduced(sp.factor_terms(elastic), variable, least * product, length)


Automatic = tuple[tuple[Step, ...], sp.Expr]


def automatic(expression: sp.Expr, known: Mapping[str, Block]) -> Automatic:
    """Steps and value of the formula's stable form.

    Parameters
    ----------
    expression
        The derived formula, all its symbols positive where a sign matters.
    known
        Building blocks by name.

    Raises
    ------
    UnreachableError
        If the formula is out of the rules' reach, or needs a block that is not there.
    """
    reduced = dimensionless(expression)
    shape = _shape(reduced)
    steps: list[Step] = []
    if reduced.expression.has(ratio):
        steps.append(RATIO)
    if reduced.variable == T and reduced.length == h:
        steps += [Step(x, phi * h), Step(T, 2 * x)]
    elif reduced.length != reduced.variable:
        steps.append(Step(reduced.variable, reduced.product))
    power, product = shape.power, sp.Integer(1)
    for factor in shape.factors:
        value, lead = _factor(factor, shape.x, known)
        power += lead * factor.exponent
        product *= value**factor.exponent
    front, power = _undone(shape.front, power, reduced)
    pair, front = _paired(front)
    steps += pair
    if shape.rate < 0:
        half = Step(fade, sp.exp(shape.rate * shape.x / 2), HALVED)
        inner, last = _divided(front * product * fade, shape.x, power)
        return (*steps, half, *inner, Step(part, last)), fade * part
    inner, last = _divided(front * product, shape.x, power)
    return (*steps, *inner), last


def _divided(whole: sp.Expr, variable: sp.Symbol, power: int) -> tuple[tuple[Step, ...], sp.Expr]:
    """x^power times the rest; three or more divisions in two goes, as x^3 underflows early."""
    if power > -3:
        return (), whole * variable**power
    steps = Step(core, whole), Step(over, core / variable)
    return steps, over * variable ** (power + 1)


def _shape(reduced: Reduced) -> Shape:
    """The formula taken apart, constants that cancel cancelled."""
    given = reduced.expression
    if isinstance(given, sp.Add):
        given = next(fraction(reduced.variable, given), given)
    shape = next(decay(reduced.variable, given))
    if not isinstance(shape, Shape):
        raise UnreachableError(f"{given} could not be taken apart")
    return shape


def _factor(factor: Factor, variable: sp.Symbol, known: Mapping[str, Block]) -> tuple[sp.Expr, int]:
    """A factor over its lowest power of the variable, and that power."""
    terms = terms_of(factor.value, variable)
    if {variable} == factor.value.free_symbols:
        found = _block(factor.value, variable, known)
        if found is not None:
            return found
        lead, least = leading_power(terms), min(power for _, power in parts_of(terms, variable))
        if lead > least:
            raise UnreachableError(f"no building block is {factor.value}")
    lead = min(power for _, power in parts_of(terms, variable))
    return sp.Add(*(value / variable**lead for value, _ in parts_of(terms, variable))), lead


def _block(
    value: sp.Expr, variable: sp.Symbol, known: Mapping[str, Block]
) -> tuple[sp.Expr, int] | None:
    """The factor as a constant times a building block, of a multiple of the variable."""
    terms = terms_of(value, variable)
    rates = [abs(key.scale if key.wave else key.rate) for key in terms]
    least = sp.gcd_list([rate for rate in rates if rate != 0])
    for block in known.values():
        own, lead = _core(block)
        rate = max(key.rate for key in own)
        for scale in (least, least / 2):
            moved = {
                k._replace(rate=(k.rate - rate) * scale, scale=k.scale * scale): v * scale**k.power
                for k, v in own.items()
            }
            ratios = {sp.cancel(terms[key] / v) for key, v in moved.items() if key in terms}
            if moved.keys() == terms.keys() and len(ratios) == 1:
                return ratios.pop() * scale**lead * block(scale * variable), lead
    return None


def _core(block: Block) -> tuple[Mapping[Key, sp.Expr], int]:
    """A block's definition times the power of its variable that it is divided by."""
    (own,) = block.arguments
    lead = -int(block.definition.as_powers_dict()[own])
    return terms_of(sp.expand(block.definition * own**lead), own), lead


def _undone(front: sp.Expr, power: int, reduced: Reduced) -> tuple[sp.Expr, int]:
    """x^n phi^-n -> the length's n-th power."""
    below = front.as_powers_dict().get(phi, sp.Integer(0))
    if reduced.length == reduced.variable or power <= 0 or not below < 0:
        return front, power
    count = min(power, int(-below))
    return front * phi**count * (reduced.product / phi) ** count, power - count


def _paired(front: sp.Expr) -> tuple[tuple[Step, ...], sp.Expr]:
    """Two or more symbols squared in the denominator -> the square of their product."""
    powers = {b: e for b, e in front.as_powers_dict().items() if b.is_Symbol and e <= -2}
    if len(powers) < 2:
        return (), front
    below = sp.Mul(*(b ** int(-e // 2) for b, e in powers.items()))
    rest = front * below**2
    return (Step(spread, below),), rest / spread**2
