"""Evaluation of expressions in double precision, with equal results on all machines.

Sums and products are computed by Python. Elementary functions are rounded correctly from ball
arithmetic, so that the selection of a form does not depend on a processor or library.
"""

import math
import sys
from collections.abc import Callable, Mapping
from fractions import Fraction
from functools import lru_cache, partial
from math import prod

import flint
import sympy as sp

from derivation.engine.formula.operations import FUNCTIONS
from derivation.engine.rewrite.form import (
    CLOSELY,
    ONCE,
    ROUNDING_ERROR,
    TAIL,
    TIMES,
    Block,
    Branch,
    Step,
    Switch,
)
from derivation.engine.rewrite.series import POLYNOMIAL

SMALL_INTEGER = 1000
"""Largest denominator of a coefficient by which the code divides; else 1/n becomes a double."""
_BITS = 160
_LIMIT = sys.float_info.max
_EXP = FUNCTIONS[sp.exp][0]
Operation = Callable[..., float]
Values = Mapping[sp.Basic, float]
Blocks = Mapping[str, Block]
NO_BLOCKS: Blocks = {}


def rounded_value(expression: sp.Expr, values: Values, blocks: Blocks = NO_BLOCKS) -> float:
    """Evaluate an expression node by node in doubles; NaN if a node has no value.

    Raises
    ------
    NotImplementedError
        For a function that cannot be evaluated.
    """
    slots = list(values.values())
    for function, reads in _steps(expression, tuple(values), frozenset(blocks)):
        operands = [slots[i] for i in reads]
        if isinstance(function, str):
            block = blocks[function]
            own = {block.arguments[0]: operands[0]}
            slots.append(run(block.steps, block.value, own, blocks))
        else:
            slots.append(function(*operands))
    return slots[-1]


@lru_cache(maxsize=4096)
def _steps(
    expression: sp.Expr, inputs: tuple[sp.Basic, ...], blocks: frozenset[str]
) -> tuple[tuple[Operation | str, tuple[int, ...]], ...]:
    """Return the operations in order, each with the slots of its operands; a block by its name."""
    slots: dict[sp.Basic, int] = {symbol: i for i, symbol in enumerate(inputs)}
    steps: list[tuple[Operation | str, tuple[int, ...]]] = []

    def visit(node: sp.Basic) -> int:
        if node not in slots:
            name = node.func.__name__
            function, operands = (name, node.args[:1]) if name in blocks else _operation(node)
            step = function, tuple(visit(operand) for operand in operands)
            slots[node] = len(inputs) + len(steps)
            steps.append(step)
        return slots[node]

    if visit(expression) < len(inputs):  # a bare input: the result must be the last slot
        return ((lambda x: x, (slots[expression],)),)
    return tuple(steps)


def _operation(node: sp.Basic) -> tuple[Operation, tuple[sp.Basic, ...]]:
    """Return the operation at a node, and its operands."""
    if isinstance(node, sp.Number | sp.NumberSymbol):
        value = float(node)
        return lambda: value, ()
    if isinstance(node, sp.Add):
        number, rest = node.as_coeff_Add()  # the number is added last, as in the printed code
        return partial(_sum, float(number)), rest.args if rest.is_Add else (rest,)
    if isinstance(node, sp.Mul):
        return _product(node)
    if isinstance(node, sp.Pow) and not node.exp.is_number:
        return _variable_power, node.args
    if isinstance(node, sp.Pow):
        return _power(node.exp), (node.base,)
    if node.func == POLYNOMIAL:
        return _horner, node.args
    if isinstance(node, sp.Min | sp.Max):
        return (min if isinstance(node, sp.Min) else max), node.args
    if node.func in (TIMES, CLOSELY):
        return _scaled_product, node.args
    if node.func == ROUNDING_ERROR:
        return _rounding_error, node.args
    if node.func == TAIL:
        return _tail, node.args
    if node.func in FUNCTIONS:
        return partial(_function, FUNCTIONS[node.func][0]), node.args[:1]
    raise NotImplementedError(f"no double precision for {node.func.__name__}")


def _sum(number: float, first: float, *terms: float) -> float:
    for term in terms:
        first += term
    return first + number


def _horner(variable: float, *coefficients: float) -> float:
    value = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        value = value * variable + coefficient
    return value


def _product(node: sp.Mul) -> tuple[Operation, tuple[sp.Basic, ...]]:
    """Return numerator over denominator, in the order of the generated code."""
    coefficient, rest = node.as_coeff_Mul()
    above, below = list[sp.Expr](), list[sp.Expr]()
    if isinstance(coefficient, sp.Rational) and coefficient.q <= SMALL_INTEGER:
        above += [sp.Integer(coefficient.p)] * (coefficient.p != 1)
        below += [sp.Integer(coefficient.q)] * (coefficient.q != 1)
    else:
        above.append(coefficient)
    for factor in rest.as_ordered_factors():
        base, exponent = factor.as_base_exp()
        inverse = exponent.is_Rational and exponent < 0
        (below if inverse else above).append(base**-exponent if inverse else factor)
    count = len(above)

    def quotient(*values: float) -> float:
        numerator, denominator = prod(values[:count]), prod(values[count:])
        if denominator == 0.0:
            return math.nan if numerator == 0.0 else math.copysign(math.inf, numerator)
        return numerator / denominator

    return quotient, (*above, *below)


def _scaled_product(value: float, *powers: float) -> float:
    """Return a value times powers of bases, with exponents of 2 separate, like `ranges.times`."""
    total, exponent = math.frexp(value)
    for base, power in zip(powers[::2], powers[1::2], strict=True):
        mantissa, shift = math.frexp(base)
        for _ in range(abs(int(power))):
            total = total * mantissa if power > 0 else total / mantissa
        exponent += int(power) * shift
    return math.ldexp(total, exponent)


def _rounding_error(one: float, other: float) -> float:
    """Return the rounding error of a product; NaN if that is not finite."""
    product = one * other
    if not math.isfinite(product):
        return math.nan
    return float(Fraction(one) * Fraction(other) - Fraction(product))


def _tail(v: float) -> float:
    return math.exp(min(v, float(ONCE)) - v)


def _power(exponent: sp.Expr) -> Callable[[float], float]:
    """Return the function that raises a double to a power."""
    number, of_finite = float(exponent), _power_of_finite(exponent)
    return lambda base: of_finite(base) if math.isfinite(base) else float(base**number)


def _power_of_finite(exponent: sp.Expr) -> Callable[[float], float]:
    if exponent == sp.Rational(1, 2):
        return lambda base: math.sqrt(base) if base >= 0 else math.nan
    if exponent < 0:
        inverse = _power_of_finite(-exponent)
        return lambda base: 1.0 / above if (above := inverse(base)) else math.inf
    if exponent.is_Integer:
        n = int(exponent)
        return partial(_function, lambda x: x**n)
    if exponent.q == 3:  # printed as a cube root
        root = partial(_function, lambda x: x ** (flint.arb(1) / 3))
        power = _power_of_finite(sp.Integer(exponent.p))
        return lambda base: power(root(base)) if base else 0.0
    number = float(exponent)
    of_positive = partial(_function, lambda x: x ** flint.arb(number))
    return lambda base: of_positive(base) if base else 0.0


def _variable_power(base: float, exponent: float) -> float:
    """Return a power with an exponent that is no number."""
    if not (base > 0 and math.isfinite(base) and math.isfinite(exponent)):
        return math.nan
    return _function(lambda x: x ** flint.arb(exponent), base)


def _function(function: Callable[[flint.arb], flint.arb], argument: float) -> float:
    """Return a function's value, rounded from 160 bits, which in practice is correct rounding."""
    if not math.isfinite(argument):
        if function is _EXP and not math.isnan(argument):
            return 0.0 if argument < 0 else math.inf
        return math.nan
    with flint.ctx.workprec(_BITS):
        value = function(flint.arb(argument))
        if not value.is_finite():
            return math.inf if function is _EXP and argument > 0 else math.nan
        nearest = float(value.mid())
    return nearest if abs(nearest) <= _LIMIT else math.copysign(math.inf, nearest)


def run(
    steps: tuple[Step, ...],
    value: sp.Expr | Switch,
    values: Values,
    blocks: Blocks = NO_BLOCKS,
) -> float:
    """Evaluate a form at a point: its steps in order, then the branch for the point."""
    known = dict(values)
    for step in steps:
        known[step.symbol] = rounded_value(step.expression, known, blocks)
    if not isinstance(value, Switch):
        return rounded_value(value, known, blocks)
    below = known[value.variable] < float(value.at)
    branch: Branch = value.below if below else value.above
    return run(branch.steps, branch.value, known, blocks)
