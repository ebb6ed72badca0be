"""Decomposition of a product of sums in x: front x^power e^(rate x) times factors."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import sympy as sp

from derivation.engine.rewrite.form import Branch, Step, Switch

square, decay = sp.symbols("square decay", positive=True)
ZERO = sp.Integer(0)


@dataclass(frozen=True)
class Factor:
    """A power of a sum in x, with its forms near 0 and far from 0.

    Parameters
    ----------
    value, exponent
        The sum and its exponent.
    near, lead, rate
        Below the switch point the sum is x^lead e^(rate x) near; near is None without a series.
    truncation
        Bound of the relative truncation error.
    far, top
        Above the switch point, or everywhere, it is x^top far; far is None for the sum itself.
    """

    value: sp.Expr
    exponent: int
    near: sp.Expr | None = None
    lead: int = 0
    rate: sp.Rational = ZERO
    truncation: sp.Rational = ZERO
    far: sp.Expr | None = None
    top: int = 0


@dataclass(frozen=True)
class Shape:
    """A product: front x^power e^(rate x) times factors.

    Parameters
    ----------
    x
        The variable.
    front
        The part that does not contain x.
    power, rate
        Exponents of x and of the exponential.
    factors
        Sums in x and their exponents.
    switch
        Switch point below which the factors' series are used.
    shared
        Whether exponentials are computed once for both sides of the switch point, and squared.
    lead
        Power of x by which the expression is divided, and that is constant above the switch point.
    """

    x: sp.Symbol
    front: sp.Expr
    power: int
    rate: sp.Rational
    factors: tuple[Factor, ...]
    switch: sp.Rational | None = None
    shared: bool = False
    lead: int = 0

    def with_factors(self, factors: Iterable[Factor]) -> "Shape":
        """Return the shape with other factors."""
        return replace(self, factors=tuple(factors))


def assembled_form(shape: Shape) -> tuple[tuple[Step, ...], sp.Expr | Switch]:
    """Return steps and value of a shape; the value has a switch point if there are series."""
    x = shape.x
    beyond = [(f.far, f.top, 0) for f in shape.factors]
    if shape.switch is None:
        high = _side(shape, shape.power, shape.rate, beyond)
        return high.steps, high.value
    held = replace(shape, front=shape.front / shape.switch**shape.lead)
    high = _side(held, shape.power + shape.lead, shape.rate, beyond)
    sides = [
        (f.value / x**f.lead if f.near is None else f.near, f.lead, f.rate) for f in shape.factors
    ]
    low = _side(shape, shape.power, shape.rate, sides)
    if not shape.shared:
        return (), Switch(x, shape.switch, low, high)
    low, high = (_with_decay(side, x) for side in (low, high))
    return (Step(decay, sp.exp(-x)),), Switch(x, shape.switch, low, high)


def _with_decay(side: Branch, x: sp.Symbol) -> Branch:
    """Replace e^(-x) and e^(-2x) in a branch by a step before the switch point, and its square."""
    steps = tuple(replace(s, expression=_decayed(s.expression, x)) for s in side.steps)
    return replace(side, steps=steps, value=_decayed(side.value, x))


def _decayed(expression: sp.Expr, x: sp.Symbol) -> sp.Expr:
    return expression.xreplace({sp.exp(-x): decay, sp.exp(-2 * x): decay**2})


def _side(
    shape: Shape,
    power: int,
    rate: sp.Rational,
    sides: Iterable[tuple[sp.Expr | None, int, sp.Rational]],
) -> Branch:
    """Return one branch, with every factor as a step, so that powers of x are not merged."""
    steps: list[Step] = []
    product, x = sp.Integer(1), shape.x
    names = _names(shape.factors)
    for name, factor, (written, taken, further) in zip(names, shape.factors, sides, strict=True):
        value = factor.value if written is None else written
        power += taken * factor.exponent
        rate += further * factor.exponent
        steps.append(Step(name, value))
        product *= name**factor.exponent
    if any(step.expression.has(square) for step in steps):
        steps.insert(0, Step(square, x**2))
    value = shape.front * x**power * product * sp.exp(rate * x)
    if steps and value == steps[-1].symbol:
        value = steps.pop().expression
    return Branch(tuple(steps), value)


def _names(factors: Iterable[Factor]) -> list[sp.Symbol]:
    """Return symbols for the factors: numerator, denominator, numerator_2, ..."""
    symbols: list[sp.Symbol] = []
    counts = {"numerator": 0, "denominator": 0}
    for factor in factors:
        kind = "numerator" if factor.exponent > 0 else "denominator"
        counts[kind] += 1
        tail = f"_{counts[kind]}" if counts[kind] > 1 else ""
        symbols.append(sp.Symbol(kind + tail, real=True))
    return symbols
