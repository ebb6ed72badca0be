"""Products and roots whose factors may leave the range of doubles although the result does not.

Arithmetic: products, quotients and roots of mantissas, with exponents of 2 kept separately; sums
with compensation of rounding errors.
"""

import numpy as np
from numpy.typing import NDArray

from .arrays import Double

Factors = tuple[Double | float, ...]
ONCE = 512
"""Largest v for which e^(-v) is applied in one factor; e^(-745) is the smallest double."""


def product(factors: Factors, divisors: Factors = ()) -> Double:
    """Return the product of the factors divided by the product of the divisors."""
    value, power = _split(factors, divisors)
    result: Double = np.ldexp(value, power)
    return result


def times(value: Double, *powers: tuple[Double, int]) -> Double:
    """Return value times base^power for every pair; products are rounded, but do not overflow.

    Powers of bases and intermediate products may leave the range of doubles. Factors are multiplied
    in the given order.
    """
    total, exponent = np.frexp(value)
    for base, power in powers:
        mantissa, shift = np.frexp(base)
        for _ in range(abs(power)):
            total = total * mantissa if power > 0 else total / mantissa
        exponent = exponent + power * shift
    result: Double = np.ldexp(total, exponent)
    return result


def times_closely(value: Double, *powers: tuple[Double, int]) -> Double:
    """Return the product of `times`, with compensation of the rounding errors."""
    total, exponent = np.frexp(value)
    rest: Double = np.zeros(())
    with np.errstate(invalid="ignore"):  # infinities have no rounding error
        for base, power in powers:
            mantissa, shift = np.frexp(base)
            exponent = exponent + power * shift
            if (mantissa == 0.5).all():  # powers of two multiply exactly
                exponent = exponent - power
                continue
            own = halves(mantissa)
            for _ in range(abs(power)):
                if power > 0:
                    before, total = total, total * mantissa
                    rest = rest * mantissa
                    rest = rest + lost_by_halves(halves(before), own, total)
                else:
                    before, total = total, total / mantissa
                    rest = rest - lost_by_halves(halves(total), own, before)
                    rest = rest / mantissa
        whole = total + rest
    result: Double = np.ldexp(np.where(np.isfinite(rest), whole, total), exponent)
    return result


def sum_closely(*parts: Double | float) -> Double:
    """Return the sum of the parts, with compensation of rounding errors; the last part is small."""
    total, rest = np.asarray(parts[0]), parts[-1]
    for part in parts[1:-1]:
        before, total = total, total + part
        added = total - before
        rest = rest + ((before - (total - added)) + (part - added))  # exact (Knuth)
    result: Double = total + rest
    return result


def moderate(first: Double, second: Double) -> tuple[Double, Double]:
    """Return both numbers over the power of two above the larger one, to keep sums in range."""
    _, power = np.frexp(np.maximum(np.abs(first), np.abs(second)))
    return np.ldexp(first, -power), np.ldexp(second, -power)


def tail(v: Double) -> Double:
    """Return e^(min(v, ONCE) - v), the factor by which e^(-min(v, ONCE)) differs from e^(-v)."""
    if not (v > ONCE).any():
        return np.ones(())
    result: Double = np.exp(np.minimum(v, ONCE) - v)
    return result


def rounding_error(a: Double, b: Double) -> Double:
    """Return the rounding error of the product of two numbers of moderate size."""
    with np.errstate(invalid="ignore"):  # infinities have no rounding error
        return lost_by_halves(halves(a), halves(b), a * b)


def lost_by_halves(a: tuple[Double, Double], b: tuple[Double, Double], product: Double) -> Double:
    """Return the rounding error of a product from the halves of both numbers (Dekker)."""
    (a_high, a_low), (b_high, b_low) = a, b
    missing: Double = a_high * b_high
    missing -= product
    missing += a_high * b_low
    missing += a_low * b_high
    missing += a_low * b_low
    return missing


def halves(x: Double) -> tuple[Double, Double]:
    """Return a number as two parts with at most 27 bits each."""
    high: Double = (x.view(np.int64) & -(2**27)).view(np.float64)
    return high, x - high


def root(degree: int, factors: Factors, divisors: Factors = ()) -> Double:
    """Return the square, cube or fifth root of a non-negative product (see `product`)."""
    result: Double = np.ldexp(*_root(degree, factors, divisors))
    return result


def root_factors(
    degree: int, factors: Factors, divisors: Factors = ()
) -> tuple[Double, Double, Double]:
    """Return the root of `root` as three factors, also if it leaves the range of doubles."""
    value, power = _root(degree, factors, divisors)
    half = np.clip(power // 2, -1000, 1000)
    return value, np.ldexp(1.0, half), np.ldexp(1.0, np.clip(power - half, -1000, 1000))


def _root(degree: int, factors: Factors, divisors: Factors) -> tuple[Double, NDArray[np.intc]]:
    """Return the root as a number of moderate size and a power of two."""
    value, power = _split(factors, divisors)
    value = np.ldexp(value, power % degree)
    if degree == 2:
        value = np.sqrt(value)
    elif degree == 3:
        value = np.cbrt(value)
    else:
        value = value ** (1.0 / degree)  # accurate, because the number is of moderate size
    return value, power // degree


def _split(factors: Factors, divisors: Factors) -> tuple[Double, NDArray[np.intc]]:
    """Return the product as a number of moderate size times a power of two."""
    value, power = np.frexp(factors[0])
    for factor in factors[1:]:
        mantissa, exponent = np.frexp(factor)
        value, power = value * mantissa, power + exponent
    for divisor in divisors:
        mantissa, exponent = np.frexp(divisor)
        value, power = value / mantissa, power - exponent
    return value, power
