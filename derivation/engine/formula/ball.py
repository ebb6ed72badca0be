"""Certified evaluation of exact expressions by Arb balls of increasing precision."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

import flint
import sympy as sp

from derivation.engine.formula.tape import recorded

Exact = int | float | Fraction
"""An exact number; a double stands for the binary fraction that it represents."""

LOG2_10 = 3.3219280948873626
MAX_BITS = 1 << 16
MAX_BITS_OF_INTEGRALS = 1 << 10
SPARE_BITS = 24


class PrecisionError(ArithmeticError):
    """A ball did not become small enough: the value is zero, singular or out of range."""


class DigitsError(PrecisionError):
    """A value has too few correct digits.

    Its message is written when it is shown, because printing the formula takes longer than its
    evaluation, and most of these errors are caught.
    """

    def __init__(self, digits: int, what: object, bits: int) -> None:
        super().__init__(digits, what, bits)

    def __str__(self) -> str:
        digits, what, bits = self.args
        return f"no {digits} digits of {what!s:.200} within {bits} bits"


@dataclass
class LastPrecision:
    """The precision [bits] that the last of successive points required.

    The next one, which is usually close, begins with half of it. Otherwise most precisions would be
    too small where digits cancel.
    """

    bits: int = 0


def to_ball(number: Exact) -> flint.arb:
    """Return a ball around an exact number at the current precision (a point for a double)."""
    if isinstance(number, int | float):
        return flint.arb(number)
    numerator, denominator = number.as_integer_ratio()
    return flint.arb(flint.fmpq(int(numerator), int(denominator)))


def enclose(expression: sp.Basic, values: Mapping[sp.Basic, flint.arb]) -> flint.arb:
    """Return a ball that contains the expression's value, at the current precision.

    Raises
    ------
    NotImplementedError
        For a SymPy function that is not implemented in ball arithmetic.
    """
    return recorded(expression, tuple(values)).run(values.values())[-1]


@cache
def enclosable(expression: sp.Basic) -> bool:
    """Return whether `enclose` can evaluate every function in the expression."""
    try:
        recorded(expression, tuple(sorted(expression.free_symbols, key=str)))
    except NotImplementedError:
        return False
    return True


def evaluate(
    expression: sp.Basic,
    values: Mapping[sp.Symbol, Exact],
    digits: int = 50,
    last: LastPrecision | None = None,
) -> flint.arb:
    """Return a ball around the value of an expression, with a relative radius below 10^-digits.

    Parameters
    ----------
    expression
        Exact SymPy expression.
    values
        Exact numbers for its free symbols; a double stands for the binary fraction that it
        represents.
    digits
        Number of correct decimal digits.
    last
        As for `refine`.

    Raises
    ------
    PrecisionError
        If 65536 bits are not sufficient; the value is then probably zero, or the point singular.
        Also if a function has no real value there, as the logarithm of a negative number.
        With integrals, which take long, the largest precision is `MAX_BITS_OF_INTEGRALS`.
    """
    tape, most = recorded(expression, tuple(values)), _largest_precision(expression)

    def compute() -> flint.arb:
        slots = tape.run([to_ball(value) for value in values.values()])
        if slots[-1].is_nan() and tape.is_undefined(slots):
            raise DigitsError(digits, expression, most)
        return slots[-1]

    return refine(compute, digits, expression, most, last)


@cache
def _largest_precision(expression: sp.Basic) -> int:
    return MAX_BITS_OF_INTEGRALS if expression.has(sp.Integral) else MAX_BITS


def refine(
    compute: Callable[[], flint.arb],
    digits: int,
    what: object,
    most: int = MAX_BITS,
    last: LastPrecision | None = None,
) -> flint.arb:
    """Repeat a computation with doubled precision until its ball is small enough.

    Parameters
    ----------
    compute
        Function that returns a ball at the current precision; a ball of radius zero is accepted.
    digits
        Number of correct decimal digits.
    what
        Description of the value for the error message.
    most
        Largest precision in bits.
    last
        Precision of the last point of several, which is updated.

    Raises
    ------
    PrecisionError
        If `most` bits are not sufficient.
    """
    target = int(digits * LOG2_10) + 1
    bits = max(target + SPARE_BITS, last.bits // 2 if last else 0)
    while bits <= most:
        with flint.ctx.workprec(bits):
            ball = compute()
        if ball.is_finite() and (ball.is_exact() or ball.rel_accuracy_bits() >= target):
            if last:
                last.bits = bits
            return ball
        bits *= 2
    raise DigitsError(digits, what, most)
