"""Evaluation of expressions in double precision, with equal results on all machines.

Sums and products are computed by Python. Elementary functions are rounded correctly from ball
arithmetic, so that the selection of a form does not depend on a processor or library.
"""

import math
import sys
from collections.abc import Callable, Mapping

import flint
import sympy as sp

from derivation.engine.formula.operations import FUNCTIONS
from derivation.engine.rewrite.form import CLOSELY, TIMES, Block, Branch, Step, Switch
from derivation.engine.rewrite.series import POLYNOMIAL

_BITS = 160
_LIMIT = sys.float_info.max
_EXP = FUNCTIONS[sp.exp][0]
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
    memo: dict[sp.Basic, float] = dict(values)

    def visit(node: sp.Basic) -> float:
        if node not in memo:
            block = blocks.get(node.func.__name__)
            if block is None:
                memo[node] = _node(node, visit)
            else:
                own = {block.arguments[0]: visit(node.args[0])}
                memo[node] = run(block.steps, block.value, own, blocks)
        return memo[node]

    return visit(expression)


def _node(node: sp.Basic, visit: Callable[[sp.Basic], float]) -> float:
    if isinstance(node, sp.Number):
        return float(node)
    if node is sp.pi:
        return math.pi
    if isinstance(node, sp.Add):
        number, rest = node.as_coeff_Add()  # a number is last, as in the printed code
        total = visit(rest.args[0]) if rest.is_Add else visit(rest)
        for term in rest.args[1:] if rest.is_Add else ():
            total += visit(term)
        return total + float(number)
    if isinstance(node, sp.Mul):
        return _product(node, visit)
    if isinstance(node, sp.Pow):
        return _power(visit(node.base), node.exp)
    if node.func == POLYNOMIAL:
        variable, *coefficients = (visit(argument) for argument in node.args)
        value = coefficients[-1]
        for coefficient in reversed(coefficients[:-1]):
            value = value * variable + coefficient
        return value
    if isinstance(node, sp.Min | sp.Max):
        return (min if isinstance(node, sp.Min) else max)(visit(part) for part in node.args)
    if node.func in (TIMES, CLOSELY):
        return _scaled_product(*(visit(part) for part in node.args))
    if node.func in FUNCTIONS:
        return _function(FUNCTIONS[node.func][0], visit(node.args[0]))
    raise NotImplementedError(f"no double precision for {node.func.__name__}")


def _product(node: sp.Mul, visit: Callable[[sp.Basic], float]) -> float:
    """Return numerator over denominator, as in the generated code."""
    above, below = 1.0, 1.0
    for factor in node.args:
        if isinstance(factor, sp.Pow) and factor.exp.is_Rational and factor.exp < 0:
            below *= _power(visit(factor.base), -factor.exp)
        else:
            above *= visit(factor)
    if below == 0.0:
        return math.nan if above == 0.0 else math.copysign(math.inf, above)
    return above / below


def _scaled_product(value: float, *powers: float) -> float:
    """Return a value times powers of bases, with exponents of 2 separate, like `ranges.times`."""
    total, exponent = math.frexp(value)
    for base, power in zip(powers[::2], powers[1::2], strict=True):
        mantissa, shift = math.frexp(base)
        for _ in range(abs(int(power))):
            total = total * mantissa if power > 0 else total / mantissa
        exponent += int(power) * shift
    return math.ldexp(total, exponent)


def _power(base: float, exponent: sp.Expr) -> float:
    if not math.isfinite(base):
        return float(base ** float(exponent))
    if exponent == sp.Rational(1, 2):
        return math.sqrt(base) if base >= 0 else math.nan
    if exponent < 0:
        above = _power(base, -exponent)
        return 1.0 / above if above else math.inf
    if exponent.is_Integer:
        return _function(lambda x: x ** int(exponent), base)
    if base == 0.0:
        return 0.0
    if exponent.q == 3:  # printed as a cube root
        return _power(_function(lambda x: x ** (flint.arb(1) / 3), base), sp.Integer(exponent.p))
    return _function(lambda x: x ** flint.arb(float(exponent)), base)


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
