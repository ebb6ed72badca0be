"""Products and roots whose shares may leave the range of doubles though the whole does not.

Arithmetic: products, quotients and roots of fractions, their exponents of 2 apart; sums that keep
what rounding drops.
"""

import numpy as np
from numpy.typing import NDArray

from .arrays import Double

Factors = tuple[Double | float, ...]
ONCE = 512
"""e^(-v) is applied in one piece up to this v; e^(-745) is the smallest double."""


def product(factors: Factors, divisors: Factors = ()) -> Double:
    """The factors' product over that of the divisors."""
    value, power = _split(factors, divisors)
    result: Double = np.ldexp(value, power)
    return result


def times(value: Double, *powers: tuple[Double, int]) -> Double:
    """The value times base^power for every pair, as if only the whole were rounded to a double.

    Bases and their powers may leave the range of doubles in between; the shares are
    multiplied in the order given.
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
    """The same, with what the roundings on the way take from the whole given back in the end."""
    total, exponent = np.frexp(value)
    rest: Double = np.zeros(())
    with np.errstate(invalid="ignore"):  # infinities have no rest
        for base, power in powers:
            mantissa, shift = np.frexp(base)
            exponent = exponent + power * shift
            if (mantissa == 0.5).all():  # powers of two: nothing is rounded
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
    """The sum of the parts, the last of them small, as if only the whole were rounded."""
    total, rest = np.asarray(parts[0]), parts[-1]
    for part in parts[1:-1]:
        before, total = total, total + part
        share = total - before
        rest = rest + ((before - (total - share)) + (part - share))  # by Knuth, exactly
    result: Double = total + rest
    return result


def moderate(first: Double, second: Double) -> tuple[Double, Double]:
    """Both over the power of two above the larger, so that their sums stay in range."""
    _, power = np.frexp(np.maximum(np.abs(first), np.abs(second)))
    return np.ldexp(first, -power), np.ldexp(second, -power)


def tail(v: Double) -> Double:
    """What e^(-min(v, ONCE)) lacks of e^(-v), which may underflow alone: as a factor."""
    if not (v > ONCE).any():
        return np.ones(())
    result: Double = np.exp(np.minimum(v, ONCE) - v)
    return result


def lost(a: Double, b: Double) -> Double:
    """The product of two numbers, itself of moderate size, less what it is rounded to."""
    with np.errstate(invalid="ignore"):  # infinities lose nothing that could be told
        return lost_by_halves(halves(a), halves(b), a * b)


def lost_by_halves(a: tuple[Double, Double], b: tuple[Double, Double], product: Double) -> Double:
    """The same by the halves of both (Dekker); its own error is of no account."""
    (a_high, a_low), (b_high, b_low) = a, b
    missing: Double = a_high * b_high
    missing -= product
    missing += a_high * b_low
    missing += a_low * b_high
    missing += a_low * b_low
    return missing


def halves(x: Double) -> tuple[Double, Double]:
    """The upper and the lower half of a number's digits."""
    high: Double = (x.view(np.int64) & -(2**27)).view(np.float64)
    return high, x - high


def root(degree: int, factors: Factors, divisors: Factors = ()) -> Double:
    """The square, cube or fifth root of such a product, which is not negative."""
    result: Double = np.ldexp(*_root(degree, factors, divisors))
    return result


def root_factors(
    degree: int, factors: Factors, divisors: Factors = ()
) -> tuple[Double, Double, Double]:
    """That root as factors, which hold it where it leaves the range of doubles itself."""
    value, power = _root(degree, factors, divisors)
    half = np.clip(power // 2, -1000, 1000)
    return value, np.ldexp(1.0, half), np.ldexp(1.0, np.clip(power - half, -1000, 1000))


def _root(degree: int, factors: Factors, divisors: Factors) -> tuple[Double, NDArray[np.intc]]:
    """The root as a number of moderate size and a power of two."""
    value, power = _split(factors, divisors)
    value = np.ldexp(value, power % degree)
    if degree == 2:
        value = np.sqrt(value)
    elif degree == 3:
        value = np.cbrt(value)
    else:
        value = value ** (1.0 / degree)  # a number of moderate size, so that this is accurate
    return value, power // degree


def _split(factors: Factors, divisors: Factors) -> tuple[Double, NDArray[np.intc]]:
    """The product as a number of moderate size times a power of two."""
    value, power = np.frexp(factors[0])
    for factor in factors[1:]:
        mantissa, exponent = np.frexp(factor)
        value, power = value * mantissa, power + exponent
    for divisor in divisors:
        mantissa, exponent = np.frexp(divisor)
        value, power = value / mantissa, power - exponent
    return value, power
