"""Quantities as text: SI prefixes, significant digits, counts."""

import math
from decimal import ROUND_CEILING, Context, Decimal

import numpy as np

from generated.arrays import Double as Array

PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
"""SI prefixes by their powers of ten."""
IN_FRONT = 3
"""Largest number of digits before the decimal point."""
FEWEST_DIGITS, MOST_DIGITS = 2, 12
"""Limits of the number of significant digits that are shown; fewer if the error is large."""
ONE_DIGIT, NO_DIGITS = 0.3, 1.0
"""Relative errors from which one digit is shown, and none."""

MOST = 10.0
"""Ratio above which only "more than" this ratio is stated, in per cent."""
ROUNDED = 1e-12
"""Relative rounding error of a number that must not be rounded up further, such as 0.01 [1]."""


def digits_of(error: float) -> int:
    """Return the number of significant digits to show with a relative error; 0 for none.

    Examples
    --------
    >>> digits_of(3e-4), digits_of(0.2), digits_of(0.5), digits_of(30.0)
    (4, 2, 1, 0)
    """
    if not math.isfinite(error):
        return FEWEST_DIGITS
    if error >= ONE_DIGIT:
        return 1 if error < NO_DIGITS else 0
    digits = math.ceil(-math.log10(max(error, 1e-300)))
    return min(MOST_DIGITS, max(FEWEST_DIGITS, digits))


def significant(value: float, digits: int) -> str:
    """Return a number with the given significant digits, trailing zeros included.

    Examples
    --------
    >>> significant(0.5, 3), significant(374.6, 1), significant(0.0, 12)
    ('0.500', '4e+02', '0')
    """
    if value == 0.0:  # it has no significant digits
        return "0"
    return f"{value:#.{digits}g}".removesuffix(".").replace(".e", "e")


def percent(ratio: float) -> str:
    """Return a ratio in per cent with two digits; of a large one only that it is large.

    Examples
    --------
    >>> percent(0.00126), percent(2.83), percent(774.0)
    ('0.13 %', '280 %', 'more than 1000 %')
    """
    if ratio > MOST:
        return f"more than {100.0 * MOST:g} %"
    return f"{float(f'{100.0 * ratio:.2g}'):g} %"


def upwards(value: float, digits: int) -> float:
    """Return a positive number rounded up to the given significant digits.

    Examples
    --------
    >>> upwards(1.2101e6, 3), upwards(0.25, 2), upwards(1e-3, 2)
    (1220000.0, 0.25, 0.001)
    """
    nearest = float(f"{value:.{digits - 1}e}")
    if nearest >= value:  # 1e-3 is, as a double, slightly more than a thousandth
        return nearest
    return float(Context(prec=digits, rounding=ROUND_CEILING).create_decimal(value))


def rounded_up(bound: float) -> str:
    """Return a bound as text with two digits, rounded up.

    Examples
    --------
    >>> rounded_up(1.2101e-4), rounded_up(0.0), rounded_up(math.inf)
    ('1.3e-04', '0.0e+00', 'inf')
    """
    return f"{upwards(bound, 2):.1e}"


def up_to(error: float) -> str:
    """Return a bound on an error in per cent, rounded up.

    Examples
    --------
    >>> up_to(0.00121), up_to(774.0)
    ('up to 0.13 %', 'more than 1000 %')
    """
    if error > MOST:
        return percent(error)
    return f"up to {percent(upwards((1.0 - ROUNDED) * error, 2))}"


def counted(number: int, noun: str) -> str:
    """Return a number with its noun, which has an s unless the number is 1.

    Examples
    --------
    >>> counted(1, "mode"), counted(12, "mode")
    ('1 mode', '12 modes')
    """
    return f"{number} {noun}{'' if number == 1 else 's'}"


def prefixed(value: float, unit: str, digits: int) -> tuple[str, str]:
    """Return a value with the given significant digits, and its unit with an SI prefix.

    The prefix leaves at most three digits before the decimal point, all of them significant:
    0.37 kN with two digits, 375 N with three. A value outside the range of the prefixes has a power
    of ten.

    Parameters
    ----------
    value
        Value in the unit.
    unit
        SI unit without prefix; "1" for a ratio.
    digits
        Number of significant digits; 0 if the value is unknown.

    Examples
    --------
    >>> prefixed(9.6155e-05, "s", 3)
    ('96.2', 'µs')
    >>> prefixed(374.6, "N", 2)
    ('0.37', 'kN')
    """
    if not math.isfinite(value) or not digits:
        return "unknown", ""
    rounded = Decimal(f"{value:.{digits - 1}e}")
    if unit == "1":
        return significant(value, digits), ""
    if not value:
        return "0", unit
    order = _order(rounded.adjusted(), digits)
    if order not in PREFIXES:
        return f"{rounded:e}", unit
    return f"{rounded.scaleb(-order):f}", PREFIXES[order] + unit


def common_prefix(values: Array, unit: str, digits: int = IN_FRONT) -> tuple[Array, str]:
    """Return values in a multiple of their unit that suits the largest value, and the multiple.

    Parameters
    ----------
    values
        Finite values in the unit.
    unit
        SI unit without prefix.
    digits
        Number of significant digits.
    """
    largest = float(np.max(np.abs(values), initial=0.0))
    order = _order(math.floor(math.log10(largest)), digits) if largest > 0 else 0
    order = min(max(order, min(PREFIXES)), max(PREFIXES))
    return values / 10.0**order, PREFIXES[order] + unit


def _order(exponent: int, digits: int) -> int:
    """Return the power of ten of the prefix for a number with the given power of ten.

    More digits before the decimal point than are significant would be meaningless zeros.
    """
    return 3 * math.ceil((exponent + 1 - min(digits, IN_FRONT)) / 3)
