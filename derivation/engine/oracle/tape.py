"""Expression -> tape: a straight line of ball operations, run forwards for the value and
backwards for every partial derivative.

A tape is recorded once per formula and run at any precision; equal
subexpressions are recorded once.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import flint
import sympy as sp

Unary = tuple[Callable[[flint.arb], flint.arb], Callable[[flint.arb, flint.arb], flint.arb]]
"""A function, and its derivative from argument and value."""

_UNARY: dict[type[sp.Basic], Unary] = {
    sp.sin: (lambda x: x.sin(), lambda x, _: x.cos()),
    sp.cos: (lambda x: x.cos(), lambda x, _: -x.sin()),
    sp.sinh: (lambda x: x.sinh(), lambda x, _: x.cosh()),
    sp.cosh: (lambda x: x.cosh(), lambda x, _: x.sinh()),
    sp.exp: (lambda x: x.exp(), lambda _, value: value),
}


@dataclass(frozen=True)
class Operation:
    """One operation: the slots it reads, its value, and its slopes towards each of them."""

    reads: tuple[int, ...]
    value: Callable[..., flint.arb]
    slopes: Callable[..., tuple[flint.arb, ...]]


@dataclass(frozen=True)
class Tape:
    """Inputs take the first slots, then each step fills the next; the last one is the result."""

    inputs: tuple[sp.Symbol, ...]
    steps: tuple[Operation, ...]

    def run(self, values: Sequence[flint.arb]) -> list[flint.arb]:
        """Every slot's ball at the precision now set; the last one is the formula's value."""
        slots = list(values)
        for step in self.steps:
            slots.append(step.value(*(slots[i] for i in step.reads)))
        return slots

    def gradient(self, slots: Sequence[flint.arb]) -> list[flint.arb]:
        """Partial derivatives to the inputs, from the slots of a run (reverse accumulation)."""
        first = len(self.inputs)
        weights: list[flint.arb | None] = [None] * len(slots)
        weights[-1] = flint.arb(1)
        for position in range(len(slots) - 1, first - 1, -1):
            weight, step = weights[position], self.steps[position - first]
            if weight is None or not step.reads:
                continue
            arguments = (slots[i] for i in step.reads)
            slopes = step.slopes(slots[position], *arguments)
            for i, slope in zip(step.reads, slopes, strict=True):
                share, known = weight * slope, weights[i]
                weights[i] = share if known is None else known + share
        return [weight if weight is not None else flint.arb(0) for weight in weights[:first]]


def record(expression: sp.Expr, inputs: Sequence[sp.Symbol]) -> Tape:
    """Tape of an expression in the given inputs.

    Raises
    ------
    NotImplementedError
        For a function, constant or power without ball arithmetic here.
    ValueError
        If the expression depends on a symbol that is not an input.
    """
    missing = sorted(str(symbol) for symbol in expression.free_symbols - set(inputs))
    if missing:
        raise ValueError(f"the expression also depends on {', '.join(missing)}")
    slots: dict[sp.Basic, int] = {symbol: i for i, symbol in enumerate(inputs)}
    steps: list[Operation] = []

    def visit(node: sp.Basic) -> int:
        if node not in slots:
            step = _step(node, tuple(visit(argument) for argument in _operands(node)))
            slots[node] = len(inputs) + len(steps)
            steps.append(step)
        return slots[node]

    if visit(expression) < len(inputs):  # a bare input: the result must be the last slot
        steps.append(Operation((slots[expression],), lambda x: x, lambda _, __: (flint.arb(1),)))
    return Tape(tuple(inputs), tuple(steps))


def _operands(node: sp.Basic) -> tuple[sp.Basic, ...]:
    """The parts of a node that are slots of their own."""
    if node.is_Atom:
        return ()
    if isinstance(node, sp.Pow):
        return (node.base,)
    if isinstance(node, sp.besselj):
        return (node.args[1],)
    return tuple(node.args)


def _step(node: sp.Basic, reads: tuple[int, ...]) -> Operation:
    if isinstance(node, sp.Rational):
        return _constant(flint.fmpq(int(node.p), int(node.q)))
    if node is sp.pi:
        return Operation((), flint.arb.pi, lambda _: ())
    if isinstance(node, sp.Add):
        return Operation(reads, _sum, lambda _, *terms: (flint.arb(1),) * len(terms))
    if isinstance(node, sp.Mul):
        return Operation(reads, _product, _product_slopes)
    if isinstance(node, sp.Pow):
        return _power(reads, node.exp)
    if isinstance(node, sp.besselj) and node.args[0].is_Integer:
        return _bessel(reads, int(node.args[0]))
    if node.func in _UNARY:
        function, slope = _UNARY[node.func]
        return Operation(reads, function, lambda value, x: (slope(x, value),))
    raise NotImplementedError(f"no ball arithmetic for {node.func.__name__} in {node}")


def _constant(number: flint.fmpq) -> Operation:
    return Operation((), lambda: flint.arb(number), lambda _: ())


def _sum(*terms: flint.arb) -> flint.arb:
    return sum(terms[1:], terms[0])


def _product(*factors: flint.arb) -> flint.arb:
    result = factors[0]
    for factor in factors[1:]:
        result = result * factor
    return result


def _product_slopes(_: flint.arb, *factors: flint.arb) -> tuple[flint.arb, ...]:
    # Products of the others, not value/factor: a factor may be zero.
    return tuple(
        _product(flint.arb(1), *factors[:i], *factors[i + 1 :]) for i in range(len(factors))
    )


def _power(reads: tuple[int, ...], exponent: sp.Basic) -> Operation:
    if exponent == sp.Rational(1, 2):
        return Operation(reads, lambda x: x.sqrt(), lambda value, _: (1 / (2 * value),))
    if isinstance(exponent, sp.Integer):
        n = int(exponent)
        return Operation(reads, lambda x: x**n, lambda _, x: (n * x ** (n - 1),))
    raise NotImplementedError(f"no ball arithmetic for the power {exponent}")


def _bessel(reads: tuple[int, ...], order: int) -> Operation:
    def slope(_: flint.arb, x: flint.arb) -> tuple[flint.arb, ...]:
        return ((x.bessel_j(order - 1) - x.bessel_j(order + 1)) / 2,)

    return Operation(reads, lambda x: x.bessel_j(order), slope)
