"""Bounds C y^k e^(c y) of functions of y >= T, with T >= 1."""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

import flint
from flint import acb, arb


@dataclass(frozen=True)
class Power:
    """The function C y^k e^(c y)."""

    C: arb
    k: Fraction
    c: arb

    def at(self, y: arb) -> arb:
        """Return the value."""
        exponent = flint.fmpq(self.k.numerator, self.k.denominator)
        return self.C * y ** arb(exponent) * (self.c * y).exp()

    def up(self) -> "Power":
        """Return a larger function with exact numbers."""
        return Power(arb(self.C.upper()), self.k, arb(self.c.upper()))

    def down(self) -> "Power | None":
        """Return a smaller function with exact numbers; None if that is not positive."""
        C, c = arb(self.C.lower()), arb(self.c.lower())
        return Power(C, self.k, c) if bool(C > 0) and c.is_finite() else None

    def times(self, other: "Power") -> "Power":
        """Return the product."""
        return Power(self.C * other.C, self.k + other.k, self.c + other.c)

    def to(self, n: Fraction) -> "Power":
        """Return the power with exponent n."""
        m = arb(flint.fmpq(n.numerator, n.denominator))
        return Power(self.C**m, self.k * n, self.c * m)


@dataclass(frozen=True)
class Growth:
    """Bounds of a modulus for y >= T.

    Parameters
    ----------
    high, low
        Upper and lower bound of the modulus; without a lower bound, None.
    real, right
        Whether the value is real, and whether its real part is positive.
    """

    high: Power
    low: Power | None = None
    real: bool = False
    right: bool = False

    @property
    def positive(self) -> bool:
        """Whether the value is a positive number."""
        return self.real and self.right


class UnboundedError(ArithmeticError):
    """No rule bounds an expression."""


def tail(bound: Power, T: arb) -> arb:
    """Return an upper bound of the integral of a power from T to infinity.

    Raises
    ------
    UnboundedError
        If the power does not decay fast enough.
    """
    # y^k <= T^k e^(k (y - T)/T) for k >= 0, because the logarithm is concave
    rate = -bound.c - max(0, float(bound.k)) * (1 + arb(2) ** -40) / T
    if not bool(rate > 0):
        raise UnboundedError
    return bound.at(T) / rate


def constant(ball: acb) -> Growth:
    """Return the bounds of a constant in a ball."""
    low, high = ball.abs_lower(), ball.abs_upper()
    zero = Fraction(0)
    return Growth(
        Power(arb(high), zero, arb(0)),
        Power(arb(low), zero, arb(0)) if bool(low > 0) else None,
        bool(ball.imag == 0),
        bool(ball.real > 0),
    )


def small_argument(
    order: int, factor: arb, series: Callable[[arb], arb]
) -> Callable[..., Growth | None]:
    """Return the rule near 0 of a function between (2 - s) and s times factor |z|^order.

    `series` is the sum s of the moduli of the terms of its power series over the first one.
    """

    def rule(argument: Growth, T: arb) -> Growth | None:
        high = argument.high
        if not (bool(high.c <= 0) and high.k <= 0):
            return None
        size = series(arb(high.at(T).upper()))
        power = Fraction(order)
        least = 2 - size
        low = None
        if argument.low is not None and bool(least > 0):
            low = argument.low.to(power).times(Power(factor * least, Fraction(0), arb(0)))
        above = high.to(power).times(Power(factor * size, Fraction(0), arb(0)))
        positive = argument.positive and low is not None
        return Growth(above, low, argument.real, positive)

    return rule
