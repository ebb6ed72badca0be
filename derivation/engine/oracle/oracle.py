"""Arb references: a paper's derived expressions in ball arithmetic, at exact doubles."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property

import flint
import sympy as sp

from derivation.engine.formula.ball import LOG2_10, MAX_BITS, SPARE_BITS, PrecisionError, enclosable
from derivation.engine.formula.record import Record
from derivation.engine.formula.tape import Tape, record
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.oracle.reference import Reference, exact_reference

FLOOR = flint.arb(2) ** -1200
"""A ball inside +-2^-1200 is returned as zero.

The smallest double is 2^-1074, so that a value below this limit is zero in a test of doubles. The
limit is necessary because no ball around an exact zero is relatively small.
"""

SLOPE_BITS = 20
"""Number of correct bits of the sensitivities, which only determine allowances."""


@dataclass(frozen=True)
class Terms:
    """Quantities that differ from term to term of a summed formula.

    Parameters
    ----------
    symbols
        Their symbols.
    at
        Function from j, the arguments and a precision in bits to their values in the j-th term.
    through
        For some of these symbols, an argument on which the symbol depends, and its power.
    expression
        Function from a formula to the expression of one term, in the arguments and these symbols.
    """

    symbols: tuple[sp.Symbol, ...]
    at: Callable[[int, Mapping[str, flint.arb], int], dict[str, flint.arb]]
    through: Mapping[str, tuple[str, int]]
    expression: Callable[[Record], sp.Expr]


Numbers = Mapping[str, tuple[str, Callable[[int, int], flint.arb]]]
"""For each constant, the name of its index, and a function from index and bits to the ball."""

Limit = tuple[str, Callable[[sp.Expr], sp.Expr | None]]
"""An argument, and a function from an expression to its limit where the argument is zero; None if
the expression itself can be evaluated there."""


@dataclass(frozen=True)
class _Program:
    """Tape of a formula, tape of its limit if that differs, and whether it is a sum."""

    tape: Tape
    at_limit: Tape | None
    summed: bool


@dataclass(frozen=True, eq=False)
class Balls:
    """A paper's Arb references.

    Parameters
    ----------
    vocabulary
        The paper's symbols.
    formulas
        Function that returns formulas by name; it is called first.
    further
        Function that returns further formulas, which take longer to derive.
    functions
        Further functions of one argument by name: the argument and the expression.
    numbers
        Constants by index. For a table, the constant is the last of `count` entries.
    terms
        Quantities that differ from term to term of a summed formula.
    limit
        An argument, and the limits of expressions where it is zero.
    """

    vocabulary: Vocabulary
    formulas: Callable[[], Mapping[str, Record]]
    further: Callable[[], Mapping[str, Record]] = dict
    functions: Mapping[str, tuple[sp.Symbol, sp.Expr]] = field(default_factory=dict)
    numbers: Numbers = field(default_factory=dict)
    terms: Terms | None = None
    limit: Limit | None = None

    @cached_property
    def _known(self) -> Mapping[str, Record]:
        return self.formulas()

    @cached_property
    def _programs(self) -> dict[str, _Program]:
        return {}

    def names(self) -> tuple[str, ...]:
        """Return the names of formulas, functions and constants, without those in `further`."""
        closed = (n for n, f in self._known.items() if not f.expression.atoms(sp.Derivative))
        return (*closed, *self.functions, *self.numbers)

    def arguments(self, name: str) -> tuple[str, ...]:
        """Return the arguments of a formula, without quantities that differ from term to term."""
        if name in self.numbers:
            return (self.numbers[name][0],)
        program = self._program(name)
        own = self.terms.symbols if program.summed and self.terms else ()
        tape = program.tape
        return tuple(
            n for n, symbol in zip(tape.names, tape.inputs, strict=True) if symbol not in own
        )

    def is_summed(self, name: str) -> bool:
        """Return whether a formula is a sum."""
        return name not in self.numbers and self._program(name).summed

    def value(
        self, name: str, values: Mapping[str, float], digits: int = 50, modes: int | None = None
    ) -> flint.arb:
        """Return a ball around a formula's value, with a relative radius below 10^-digits.

        Parameters
        ----------
        name
            A formula, a function or a constant by index; for a table the value is the entry of
            index `count`.
        values
            Its arguments by name; a double stands for the binary fraction that it represents.
            Arguments that the formula does not depend on are allowed.
        digits
            Number of correct decimal digits.
        modes
            For a summed formula, and only then: the number of terms.

        Raises
        ------
        PrecisionError
            At a singular point, and at a branch point of a root, where a ball has no value.
        ValueError
            If `modes` is missing or not allowed.
        KeyError
            For an unknown formula, and for missing or unknown arguments.
        """
        return self._refined(name, values, digits, modes, slopes=False).value

    def reference(
        self, name: str, values: Mapping[str, float], digits: int = 50, modes: int | None = None
    ) -> Reference:
        """Return value and sensitivities; parameters and exceptions are those of `value`.

        Raises
        ------
        PrecisionError
            Also if a sensitivity is not finite.
        """
        return self._refined(name, values, digits, modes, slopes=True)

    def stated(self, name: str) -> tuple[Record, sp.Expr]:
        """Return a formula and its expression, for a sum the expression of one term.

        Raises
        ------
        KeyError
            If the name is unknown, or denotes an equation, an integral or an infinite sum.
        """
        formula = self._known[name] if name in self._known else self.further().get(name)
        if formula is None or not enclosable(formula.expression):
            raise KeyError(f"no formula {name!r}; expected one of {', '.join(self.names())}")
        if formula.summed and self.terms is not None:
            return formula, self.terms.expression(formula)
        return formula, formula.expression

    def _refined(
        self,
        name: str,
        values: Mapping[str, float],
        digits: int,
        modes: int | None,
        slopes: bool,
    ) -> Reference:
        self._check(name, values, modes)
        if name in self.numbers:
            return self._by_index(name, values, digits)
        program, terms = self._program(name), self.terms
        zero = self.limit is not None and values.get(self.limit[0]) == 0
        tape = program.at_limit if program.at_limit and zero else program.tape

        def compute(bits: int) -> Reference:
            known = {key: flint.arb(value) for key, value in values.items()}
            if modes is None or terms is None:
                return _at(tape, known, slopes, {})
            through = terms.through
            return _added(
                _at(tape, known | terms.at(j, known, bits), slopes, through)
                for j in range(1, modes + 1)
            )

        return _refine(compute, digits, f"{name} at {dict(values)}")

    def _by_index(self, name: str, values: Mapping[str, float], digits: int) -> Reference:
        """Return the constant for an index, with `SPARE_BITS` more bits than the digits need."""
        argument, number = self.numbers[name]
        if values[argument] != int(values[argument]):
            raise ValueError(f"{name} needs an integer index, got {values[argument]}")
        ball = number(int(values[argument]), int(digits * LOG2_10) + SPARE_BITS)
        return exact_reference(ball)

    def _check(self, name: str, values: Mapping[str, float], modes: int | None) -> None:
        summed = self.is_summed(name)
        if summed and (modes is None or modes < 1):
            raise ValueError(f"{name} is a modal sum: expected the number of modes, got {modes}")
        if not summed and modes is not None:
            raise ValueError(f"{name} is not a modal sum, got modes={modes}")
        missing = set(self.arguments(name)) - set(values)
        unknown = set(values) - set(self.arguments(name)) - set(self.vocabulary.by_name)
        if missing or unknown:
            raise KeyError(
                f"{name} takes {', '.join(self.arguments(name))}; "
                f"missing: {sorted(missing)}, unknown: {sorted(unknown)}"
            )

    def _program(self, name: str) -> _Program:
        """Return the tape of the formula's expression."""
        if name not in self._programs:
            self._programs[name] = self._recorded(name)
        return self._programs[name]

    def _recorded(self, name: str) -> _Program:
        if name in self.functions:
            argument, expression = self.functions[name]
            return _Program(record(expression, (argument,)), None, summed=False)
        formula, expression = self.stated(name)
        inputs = tuple(x.symbol for x in self.vocabulary.arguments_of(expression))
        limit = None if self.limit is None else self.limit[1](expression)
        at_limit = None if limit is None else record(limit, inputs)
        return _Program(record(expression, inputs), at_limit, formula.summed)


def _refine(compute: Callable[[int], Reference], digits: int, what: str) -> Reference:
    """Repeat with doubled precision until the balls of value and sensitivities are narrow."""
    target = int(digits * LOG2_10) + 1
    bits = target + SPARE_BITS
    while bits <= MAX_BITS:
        with flint.ctx.workprec(bits):
            reference = compute(bits)
            unit = abs(reference.value) * flint.arb(2) ** -SLOPE_BITS
            sensitivities = reference.sensitivity.values()
            if _is_narrow(reference.value, target) and all(
                _is_narrow(one, SLOPE_BITS) or bool(one < unit) for one in sensitivities
            ):
                value = flint.arb(0) if abs(reference.value) < FLOOR else reference.value
                return Reference(value, reference.sensitivity, reference.magnitude)
        bits *= 2
    raise PrecisionError(f"no {digits} digits of {what:.300} within {MAX_BITS} bits")


def _is_narrow(ball: flint.arb, bits: int) -> bool:
    """Return whether a ball is finite, and relatively narrow or below the limit for zero."""
    return ball.is_finite() and (ball.rel_accuracy_bits() >= bits or bool(abs(ball) < FLOOR))


def _at(
    tape: Tape,
    known: Mapping[str, flint.arb],
    slopes: bool,
    through: Mapping[str, tuple[str, int]],
) -> Reference:
    """Return value and sensitivities of one term at the current precision."""
    inputs = [known[name] for name in tape.names]
    slots = tape.run(inputs)
    gradient = tape.gradient(slots) if slopes else []
    sensitivities = {k: x * g for k, x, g in zip(tape.names, inputs, gradient, strict=False)}
    for symbol, (argument, power) in through.items():
        if symbol in sensitivities:
            direct = sensitivities.get(argument, flint.arb(0))
            sensitivities[argument] = direct + power * sensitivities[symbol]
    sizes = {key: abs(value) for key, value in sensitivities.items()}
    return Reference(slots[-1], sizes, abs(slots[-1]))


def _added(terms: Iterable[Reference]) -> Reference:
    """Return the sum: values are added with their signs, sensitivities without."""
    value, magnitude, sensitivities = flint.arb(0), flint.arb(0), dict[str, flint.arb]()
    for term in terms:
        value += term.value
        magnitude += term.magnitude
        for key, sensitivity in term.sensitivity.items():
            sensitivities[key] = sensitivities.get(key, flint.arb(0)) + sensitivity
    return Reference(value, sensitivities, magnitude)
