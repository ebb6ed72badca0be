"""Difficult arguments of a formula: zeros of its parts, overflow and underflow limits."""

import math
from collections.abc import Iterator, Sequence
from typing import TypeVar

import flint
import sympy as sp

from derivation.engine.formula.ball import enclosable, enclose
from derivation.engine.formula.tape import record_all
from derivation.engine.formula.ulp import from_ordinal, ordinal
from derivation.engine.rewrite.form import Branch, Step, Switch
from derivation.engine.rewrite.series import POLYNOMIAL
from derivation.engine.rewrite.stabilise import Stable

Number = TypeVar("Number", int, float)

BITS = 1100
"""Precision in bits, sufficient for arguments down to 1e-150 in differences and sines of 1e150."""
_LARGEST, _SMALLEST, _LEAST = 1024, -1022, -1074
_SHORT, _MOST_OPERATIONS = 60, 200
_FIRST, _SPREAD = 30, 30
"""Number of arguments that are kept: of the smallest ones, and of a selection of the others."""


def grid(low: float, high: float) -> list[float]:
    """Return points between which signs of parts are compared: logarithmic, and even up to 60."""
    ends = math.log10(low), math.log10(high)
    steps = 320
    positions = {10.0 ** (ends[0] + (ends[1] - ends[0]) * k / steps) for k in range(1, steps)}
    positions |= {10.0 ** (-6 + k / 25) for k in range(12 * 25)}
    positions |= {0.15 * k for k in range(1, 400)}
    return sorted({low, high, *(x for x in positions if low < x < high)})


def parts(stable: Stable) -> list[sp.Expr]:
    """Return the parts of formula and form, and derivatives of sums, to search for sign changes."""
    x = stable.variable
    whole = [stable.expression, *_written_out(stable)]
    if isinstance(stable.value, Switch):
        whole.append(_in_variable(stable.value.variable - stable.value.at, stable.steps))
    expressions: dict[sp.Expr, None] = {}
    for expression in whole:
        for node in sp.postorder_traversal(expression):
            if node.has(x) and node != x and not isinstance(node, sp.Tuple):
                expressions[node.replace(POLYNOMIAL, _horner)] = None
    for node in list(expressions):
        if node == stable.expression or (node.is_Add and node.count_ops() <= _SHORT):
            slope = derivative(node, x)
            if slope.has(x) and slope.count_ops() <= _MOST_OPERATIONS:
                expressions[slope] = None
    return list(expressions)


def derivative(expression: sp.Expr, x: sp.Symbol) -> sp.Expr:
    """Return the derivative, computed without assumptions on x.

    To find the sign of a function of a positive symbol, SymPy would differentiate it part by part,
    which can take hours.
    """
    plain = sp.Dummy(real=True) if expression.has(sp.Abs) else sp.Dummy()
    slope: sp.Expr = sp.diff(expression.xreplace({x: plain}), plain)
    slope = slope.replace(sp.sign, lambda u: u / sp.Abs(u))
    return slope.xreplace({plain: x})


def _written_out(stable: Stable) -> Iterator[sp.Expr]:
    """Yield steps and results of all branches, as expressions in the variable alone."""
    value = stable.value
    sides = (value.below, value.above) if isinstance(value, Switch) else (Branch((), value),)
    for side in sides:
        steps = (*stable.steps, *side.steps)
        for index, expression in enumerate((*(s.expression for s in steps), side.value)):
            yield _in_variable(expression, steps[:index])


def _in_variable(expression: sp.Expr, steps: Sequence[Step]) -> sp.Expr:
    """Return an expression with the steps substituted."""
    for step in reversed(steps):
        expression = expression.xreplace({step.symbol: step.expression})
    return expression


def _horner(variable: sp.Expr, *coefficients: sp.Expr) -> sp.Expr:
    value = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        value = value * variable + coefficient
    return value


def difficult_points(stable: Stable, low: float, high: float) -> list[float]:
    """Return doubles next to which a part changes sign, overflows or underflows.

    Switch points are among them.

    Parameters
    ----------
    stable
        The formula with its form.
    low, high
        The range of the variable.
    """
    x, points = stable.variable, grid(low, high)
    watched = [part for part in parts(stable) if enclosable(part)]
    tape, slots = record_all(watched, (x,))
    values: set[float] = set()
    with flint.ctx.workprec(BITS):
        enclosures = (tape.run([flint.arb(point)]) for point in points)
        rows = [[_state(balls[slot]) for slot in slots] for balls in enclosures]
        for index, part in enumerate(watched):
            changes = [k for k in range(1, len(points)) if rows[k - 1][index] != rows[k][index]]
            for k in _selection(changes):
                values.add(_change(part, x, points[k - 1], points[k]))
    return [place for place in _selection(sorted(values)) if low <= place <= high]


def _selection(numbers: list[Number]) -> list[Number]:
    """Return the first `_FIRST` entries, and an even selection of the others."""
    others = numbers[_FIRST:]
    if len(others) <= _SPREAD:
        return numbers
    step = len(others) / _SPREAD
    return numbers[:_FIRST] + [others[int(k * step)] for k in range(_SPREAD)]


def _state(value: flint.arb) -> tuple[int, int]:
    """Return sign (0 if unknown) and size class of a value: overflow, normal, subnormal, zero."""
    if not value.is_finite():
        return 0, 3
    sign = (value > 0) - (value < 0)
    if sign == 0:
        return 0, 0
    mantissa, exponent = abs(value).mid().man_exp()
    size = int(exponent) + int(mantissa).bit_length()
    return sign, (size > _LARGEST) - (size < _SMALLEST) - (size < _LEAST)


def _change(part: sp.Expr, x: sp.Symbol, below: float, above: float) -> float:
    """Return a double at which the sign or class of a part changes, by bisection of an interval."""
    first, last = ordinal(below), ordinal(above)
    start = _state(enclose(part, {x: flint.arb(below)}))
    while last - first > 1:
        middle = (first + last) // 2
        if _state(enclose(part, {x: flint.arb(from_ordinal(middle))})) == start:
            first = middle
        else:
            last = middle
    return from_ordinal(last)
