"""Sequences of ball operations (tapes) that evaluate an expression and its derivatives.

A tape is evaluated forwards for the value, and backwards for all partial derivatives.

A tape is recorded once per formula and evaluated at any precision. Equal subexpressions are
recorded once.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from operator import itemgetter
from typing import Any

import flint
import sympy as sp

from derivation.engine.formula.operations import PARTIAL, Operation, operation

Step = tuple[Operation, tuple[int, ...]]
"""An operation, and the slots of its operands."""


_Call = tuple[Callable[..., Any], Callable[[Any], Sequence[Any]]]
"""A function for the value, and one that reads its operands from slots."""


@dataclass(frozen=True)
class Tape:
    """Inputs fill the first slots, each step fills the next one, and the last is the result."""

    inputs: tuple[sp.Basic, ...]
    steps: tuple[Step, ...]

    def run(self, values: Iterable[flint.arb], holomorphic: bool = False) -> list[flint.arb]:
        """Return every slot's ball at the current precision; the last one is the value.

        If `holomorphic`, a slot that is not holomorphic in the values is not finite.
        """
        slots = list(values)
        for value, read in self._holomorphic_calls if holomorphic else self._calls:
            slots.append(value(*read(slots)))
        return slots

    def is_undefined(self, slots: Sequence[flint.arb]) -> bool:
        """Return whether an evaluation is NaN at any precision, as the logarithm of -1 is."""
        for slot, (done, reads) in zip(slots[len(self.inputs) :], self.steps, strict=True):
            if slot.is_nan():
                return done.value in PARTIAL and all(slots[i].is_exact() for i in reads)
        return False

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the inputs."""
        return tuple(str(symbol) for symbol in self.inputs)

    @cached_property
    def _calls(self) -> tuple[_Call, ...]:
        return tuple((done.value, _reader(reads)) for done, reads in self.steps)

    @cached_property
    def _holomorphic_calls(self) -> tuple[_Call, ...]:
        return tuple((done.holomorphic or done.value, _reader(reads)) for done, reads in self.steps)

    def gradient(self, slots: Sequence[flint.arb]) -> list[flint.arb]:
        """Return the partial derivatives by the inputs, from the slots of an evaluation."""
        first = len(self.inputs)
        weights: list[flint.arb | None] = [None] * len(slots)
        weights[-1] = flint.arb(1)
        for position in range(len(slots) - 1, first - 1, -1):
            weight, (done, reads) = weights[position], self.steps[position - first]
            if weight is None or not reads:
                continue
            slopes = done.slopes(slots[position], *(slots[i] for i in reads))
            for i, slope in zip(reads, slopes, strict=True):
                contribution, known = weight * slope, weights[i]
                weights[i] = contribution if known is None else known + contribution
        return [weight if weight is not None else flint.arb(0) for weight in weights[:first]]


def _reader(reads: tuple[int, ...]) -> Callable[[Any], Sequence[Any]]:
    """Return a function that returns the operands in some slots."""
    if len(reads) > 1:
        return itemgetter(*reads)
    return itemgetter(slice(reads[0], reads[0] + 1) if reads else slice(0))


def record(expression: sp.Expr, inputs: Sequence[sp.Symbol]) -> Tape:
    """Return the tape of an expression in the given inputs.

    Raises
    ------
    NotImplementedError
        For a function or constant without ball arithmetic.
    ValueError
        If the expression depends on a symbol that is not an input.
    """
    missing = sorted(str(symbol) for symbol in expression.free_symbols - set(inputs))
    if missing:
        raise ValueError(f"the expression also depends on {', '.join(missing)}")
    return recorded(expression, tuple(inputs))


@lru_cache(maxsize=4096)
def recorded(expression: sp.Basic, inputs: tuple[sp.Basic, ...]) -> Tape:
    """Return the tape of an expression in symbols or parts of it.

    Raises
    ------
    NotImplementedError
        For a function, constant or symbol without ball arithmetic.
    """
    tape, (last,) = record_all((expression,), inputs)
    if last < len(inputs):  # a bare input: the result must be the last slot
        same = Operation((expression,), lambda x: x, lambda *_: (flint.arb(1),))
        tape = replace(tape, steps=((same, (last,)),))
    return tape


def record_all(
    expressions: Sequence[sp.Basic], inputs: tuple[sp.Basic, ...]
) -> tuple[Tape, list[int]]:
    """Return the tape of several expressions, and the slot of each."""
    slots: dict[sp.Basic, int] = {symbol: i for i, symbol in enumerate(inputs)}
    steps: list[Step] = []

    def visit(node: sp.Basic) -> int:
        if node not in slots:
            own = operation(node)
            step = own, tuple(visit(operand) for operand in own.operands)
            slots[node] = len(inputs) + len(steps)
            steps.append(step)
        return slots[node]

    positions = [visit(expression) for expression in expressions]
    return Tape(inputs, tuple(steps)), positions
