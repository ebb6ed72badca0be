"""Units in the last place (ULP): spacing of floats, errors against exact balls, neighbours.

Nothing is computed in the tested format: differences use ball arithmetic, and the powers of two
are exact.
"""

import math
import struct
from dataclasses import dataclass

import flint

_GUARD_BITS = 128
"""Additional bits of a difference, with which its rounding error is below 2^-128 ULP."""


@dataclass(frozen=True)
class Format:
    """A binary floating-point format.

    Parameters
    ----------
    name
        Name in NumPy.
    precision
        Bits of the significand, including the implicit one.
    smallest
        Exponent of the smallest subnormal, 2^smallest.
    limit
        Every finite number is below 2^limit.
    real, integer
        `struct` codes of the number and of an integer of the same size.
    """

    name: str
    precision: int
    smallest: int
    limit: int
    real: str
    integer: str


DOUBLE = Format("float64", 53, -1074, 1024, "<d", "<q")
SINGLE = Format("float32", 24, -149, 128, "<f", "<i")


def spacing_exponent(reference: flint.arb, fmt: Format = DOUBLE) -> int:
    """Return the exponent k of the unit in the last place 2^k of an exact value.

    Below the smallest normal number, and at zero, the unit is the smallest subnormal. Above the
    largest finite number it is that number's unit. A ball that contains a power of two is treated
    as that power, which its exact value may be.
    """
    with flint.ctx.workprec(fmt.precision + _GUARD_BITS):
        mantissa, exponent = reference.abs_upper().man_exp()
    if mantissa == 0:
        return fmt.smallest
    leading = int(exponent) + abs(int(mantissa)).bit_length() - 1
    return min(max(leading - fmt.precision + 1, fmt.smallest), fmt.limit - fmt.precision)


def spacing(x: float, fmt: Format = DOUBLE) -> float:
    """Return the unit in the last place of a finite number, a power of two."""
    return math.ldexp(1.0, spacing_exponent(flint.arb(x), fmt))


def overflows(reference: flint.arb, fmt: Format = DOUBLE) -> bool:
    """Return whether rounding to nearest turns the exact value into an infinity."""
    threshold = flint.arb(2) ** fmt.limit - flint.arb(2) ** (fmt.limit - fmt.precision - 1)
    return bool(abs(reference) >= threshold)


def ulp_error(got: float, reference: flint.arb, fmt: Format = DOUBLE) -> float:
    """Return the distance between a computed number and the exact value, in ULP of the exact value.

    Parameters
    ----------
    got
        The computed number; a float32 is passed as the double of the same value.
    reference
        Ball around the exact value. Its radius is part of the error.
    fmt
        The format that defines the unit.

    Returns
    -------
    float
        Rounded upwards; infinite for NaN, and for an infinity where the exact value does not
        overflow.

    Raises
    ------
    ValueError
        If the exact value is not finite.
    """
    if not reference.is_finite():
        raise ValueError(f"expected a finite ball as the exact value, got {reference}")
    if math.isnan(got):
        return math.inf
    if math.isinf(got):
        # An infinity of the same sign is the correctly rounded overflow.
        return 0.0 if overflows(reference, fmt) and (got > 0) == bool(reference > 0) else math.inf
    return upper_float(distance(got, reference) * flint.arb(2) ** -spacing_exponent(reference, fmt))


def distance(got: float, reference: flint.arb) -> flint.arb:
    """Return |got - reference| as a ball whose rounding is far below a unit of either format."""
    with flint.ctx.workprec(DOUBLE.precision + _GUARD_BITS):
        return abs(flint.arb(got) - reference)


def upper_float(ball: flint.arb) -> float:
    """Return the largest absolute value of the ball, rounded up to a double."""
    upper = ball.abs_upper()
    nearest = float(upper)
    return nearest if flint.arb(nearest) >= upper else math.nextafter(nearest, math.inf)


def ordinal(x: float, fmt: Format = DOUBLE) -> int:
    """Return the position of a finite number among the floats: neighbours differ by 1, zeros are 0.

    Raises
    ------
    ValueError
        For NaN and infinities, which do not have two neighbours.
    """
    if not math.isfinite(x):
        raise ValueError(f"expected a finite number, got {x}")
    (bits,) = struct.unpack(fmt.integer, struct.pack(fmt.real, x))
    # Negative floats order their magnitude bits backwards, below the sign bit.
    return int(bits) if bits >= 0 else -(int(bits) + (1 << (struct.calcsize(fmt.integer) * 8 - 1)))


def from_ordinal(position: int, fmt: Format = DOUBLE) -> float:
    """Return the float at a position, the inverse of `ordinal` (which maps both zeros to 0)."""
    (magnitude,) = struct.unpack(fmt.real, struct.pack(fmt.integer, abs(position)))
    return math.copysign(float(magnitude), position)


def neighbours(x: float, count: int, fmt: Format = DOUBLE) -> tuple[float, ...]:
    """Return the finite floats up to `count` positions on either side of a number, ascending."""
    centre = ordinal(x, fmt)
    last = _largest_ordinal(fmt)
    positions = range(max(centre - count, -last), min(centre + count, last) + 1)
    return tuple(from_ordinal(position, fmt) for position in positions)


def _largest_ordinal(fmt: Format) -> int:
    largest = math.ldexp(2.0 - math.ldexp(1.0, 1 - fmt.precision), fmt.limit - 1)
    return ordinal(largest, fmt)
