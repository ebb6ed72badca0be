"""Entire functions of a squared argument, scaled, and power series in two variables.

Arithmetic: Horner's rule, quotients that equal 1 at 0, scaling by exponentials.
"""

import numpy as np

from generated.arrays import Double
from generated.blocks import sinh_cubic
from generated.wave_numbers import CLOSE, FACTORIALS


def series(first: Double, second: Double) -> Double:
    """Return F as defined in `differences`."""
    inner, total = np.zeros_like(first), np.zeros_like(first)
    for coefficient in FACTORIALS[::-1]:
        inner = coefficient + second * inner
        total = inner + first * total
    return total


def hyperbolic(level: Double) -> tuple[Double, Double]:
    """Return cosh and sinh(p)/p from p^2, divided by e^p where p is real."""
    size = np.sqrt(np.abs(level))
    real, sine = level >= 0, over_of(np.sin(size), size)
    return np.where(real, 0.5 + 0.5 * np.exp(-2.0 * size), np.cos(size)), np.where(
        real, shc(size), sine
    )


def shc(y: Double) -> Double:
    """Return sinh(y)/y divided by e^y, for y >= 0."""
    return over_of(-0.5 * np.expm1(-2.0 * y), y)


def over_of(above: Double, y: Double) -> Double:
    """Return the ratio of a function to its leading term y; 1 at y = 0."""
    safe = np.where(y > 0, y, 1.0)
    return np.where(y > 0, above / safe, 1.0)


def differences(
    first: Double, second: Double, fall: Double, growth: Double
) -> tuple[Double, Double]:
    """Return F as a power series in S^2 and d^2, and its derivatives with respect to S^2 and d^2.

    sum_i S^(2i) sum_k d^(2k)/(2 (i + k) + 3)!, both sums by one pass of Horner's rule.
    """
    inner, inner_change = np.zeros_like(first), np.zeros_like(first)
    total, change = np.zeros_like(first), np.zeros_like(first)
    for coefficient in FACTORIALS[::-1]:
        inner_change = growth * inner + second * inner_change
        inner = coefficient + second * inner
        change = inner_change + fall * total + first * change
        total = inner + first * total
    return total, change


def compared(first: Double, second: Double, gap: Double) -> tuple[Double, Double]:
    """Return F, and the difference F(S^2 + gap, d = 0) - F."""
    inner, total, less = np.zeros_like(first), np.zeros_like(first), np.zeros_like(first)
    for coefficient in FACTORIALS[::-1]:
        less = (first + gap) * less + gap * total - second * inner
        inner = coefficient + second * inner
        total = inner + first * total
    return total, less


def double(level: Double) -> Double:
    """Return (sinh(2 p)/(2 p) - 1)/p^2, divided by e^(2 p) where p is real."""
    close, faded = np.abs(level) < CLOSE, fading(level)
    cosh, sinh = hyperbolic(level)
    far = (cosh * sinh - faded) / np.where(close, 1.0, level)
    low = np.where(close, level, 0.0)
    return np.where(close, 4.0 * sinh_cubic(4.0 * low) * faded, far)


def slope(level: Double, cosh: Double, sinh: Double) -> Double:
    """Return d/d(p^2) of sinh(p)/p, scaled like cosh p, accurate enough for Newton's method."""
    close = np.abs(level) < CLOSE
    far = 0.5 * (cosh - sinh) / np.where(close, 1.0, level)
    return np.where(close, cosh / 6.0, far)


def fading(level: Double) -> Double:
    """Return e^(-2 p) where p is real, 1 elsewhere."""
    return np.exp(-2.0 * np.sqrt(np.maximum(level, 0.0)))


def least(sinh_p: Double, level: Double, sinh_q: Double, over: Double) -> Double:
    """Return the smaller of |sinh p| and |sinh q|."""
    sizes = np.abs(sinh_p) * np.sqrt(np.abs(level)), np.abs(sinh_q) * np.sqrt(np.abs(over))
    return np.minimum(*sizes)


def tanhc(y: Double) -> Double:
    """Return tanh(y)/y for y >= 0."""
    return over_of(np.tanh(y), y)
