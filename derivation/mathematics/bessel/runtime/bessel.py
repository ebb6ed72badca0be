"""Bessel functions J0 and J1, their zeros, and J1 at the zeros of J0, in NumPy alone.

Below ASYMPTOTIC_START the functions are Taylor polynomials. Each zero of J0 and J1 in that range is
a centre, stored as a sum of two doubles, so that values near a zero keep their relative accuracy.
Above, modulus and phase are used,

    J_nu(x) = sqrt(2 p(x) / (pi x)) sin(x +- pi/4 + s(x)),   + for J0, - for J1,

where p and s are series in 1/x with exact rational coefficients. The multiple of pi/4 that is
subtracted from x is a sum of two doubles.

Arithmetic: polynomials of expansions whose coefficients are computed in advance, the multiple
of pi/4 and its sign, beta as such a multiple, and one Newton step in two doubles.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from generated import bessel_kernels as kernels
from generated.arrays import Double, in_manifest, quiet, refuse_masked, whole
from generated.bessel_numbers import (
    ASYMPTOTIC_START,
    CELLS,
    CENTRE_HIGH,
    CENTRE_LOW,
    EIGHT_OVER_PI2,
    EIGHT_OVER_PI2_TAIL,
    FIRST_MCMAHON,
    INVERSE_PI,
    LARGEST_PHASE,
    LOW_SLOPES,
    LOW_ZEROS,
    MODULUS,
    QUARTER_PI,
    QUARTER_PI_TAIL,
    QUARTERS,
    SHIFT,
    SLOPE_EXCESS,
    SWITCHES,
    TAYLOR,
    ZERO_CORRECTION,
)
from generated.ranges import halves, lost_by_halves

_BLOCK = 8192  # number of points in one block, so that intermediate arrays fit in the cache
# Ordered by power, the highest first: each line contains one coefficient of all centres.
_TAYLOR = tuple(np.array(table).T[::-1].copy() for table in TAYLOR)
_CELLS = np.arange(int(CELLS * ASYMPTOTIC_START)) / CELLS
_CENTRE_OF_CELL = np.searchsorted(SWITCHES, _CELLS, "right") - 1
_QUARTER_HALVES = halves(np.array(QUARTER_PI))
_HIGH, _LOW = np.array(CENTRE_HIGH), np.array(CENTRE_LOW)


@in_manifest("J_0(x)", kernel=True)
@quiet
def bessel_j0(x: ArrayLike) -> np.ndarray:
    """Compute the Bessel function of the first kind of order 0.

    Formula (Watson, 1944, section 2.2)::

        J_0(x) = (1/pi) int_0^pi cos(x sin t) dt

    Parameters
    ----------
    x : array_like
        argument [1], real and finite, of any shape

    Returns
    -------
    float or ndarray
        J_0(x) [1] in the shape of x; float32 for float16 and float32 input, else float64. NaN
        for NaN and infinite arguments.

    Raises
    ------
    TypeError
        If x is complex or a masked array.

    Notes
    -----
    The condition number is |x J_1(x)/J_0(x)|.

    Examples
    --------
    >>> from generated import bessel_j0
    >>> print(f"{bessel_j0(1.0):.6g}")
    0.765198
    """
    return _evaluate(x, 0)


@in_manifest("J_1(x)", kernel=True)
@quiet
def bessel_j1(x: ArrayLike) -> np.ndarray:
    """Compute the Bessel function of the first kind of order 1.

    Formula (Watson, 1944, section 2.2)::

        J_1(x) = (1/pi) int_0^pi cos(t - x sin t) dt = -J_0'(x)

    Parameters
    ----------
    x : array_like
        argument [1], real and finite, of any shape

    Returns
    -------
    float or ndarray
        J_1(x) [1] in the shape of x; float32 for float16 and float32 input, else float64. NaN
        for NaN and infinite arguments.

    Raises
    ------
    TypeError
        If x is complex or a masked array.

    Notes
    -----
    The condition number is |x J_0(x)/J_1(x) - 1|.

    Examples
    --------
    >>> from generated import bessel_j1
    >>> print(f"{bessel_j1(1.0):.6g}")
    0.440051
    """
    return _evaluate(x, 1)


@in_manifest("j_n", domain="count >= 0", kernel=True)
@quiet
def bessel_j0_zeros(count: int) -> Double:
    """Compute the first positive zeros of J_0 in ascending order.

    Formula for all but the first ten (McMahon, 1894)::

        j_n = beta + 1/(8 beta) - 31/(384 beta^3) + ...,   beta = (n - 1/4) pi

    Parameters
    ----------
    count : int
        number of zeros, n = 1 ... count [1]; count >= 0

    Returns
    -------
    ndarray
        j_1 ... j_count [1], of shape (count,)

    Raises
    ------
    ValueError
        If the count is negative or not an integer.

    Examples
    --------
    >>> from generated import bessel_j0_zeros
    >>> print(bessel_j0_zeros(3).round(6))
    [2.404826 5.520078 8.653728]
    """
    return _zeros(count, 0)


@in_manifest("j_{1,n}", domain="count >= 0", kernel=True)
@quiet
def bessel_j1_zeros(count: int) -> Double:
    """Compute the first positive zeros of J_1 in ascending order, without the zero at x = 0.

    Formula for all but the first seven (McMahon, 1894)::

        j_(1,n) = beta - 3/(8 beta) + 3/(128 beta^3) - ...,   beta = (n + 1/4) pi

    Parameters
    ----------
    count : int
        number of zeros, n = 1 ... count [1]; count >= 0

    Returns
    -------
    ndarray
        j_(1,1) ... j_(1,count) [1], of shape (count,)

    Raises
    ------
    ValueError
        If the count is negative or not an integer.

    Examples
    --------
    >>> from generated import bessel_j1_zeros
    >>> print(bessel_j1_zeros(3).round(6))
    [ 3.831706  7.015587 10.173468]
    """
    return _zeros(count, 1)


@in_manifest("J_1(j_n)", domain="count >= 0", kernel=True)
@quiet
def bessel_j1_at_j0_zeros(count: int) -> Double:
    """Compute J_1 at the first positive zeros of J_0.

    Formula for all but the first ten (from McMahon, 1894)::

        J_1(j_n)^2 = 2/(pi beta) (1 - 7/(48 beta^4) + ...),   beta = (n - 1/4) pi

    Parameters
    ----------
    count : int
        number of zeros, n = 1 ... count [1]; count >= 0

    Returns
    -------
    ndarray
        J_1(j_1) ... J_1(j_count) [1], of shape (count,), with alternating signs; the first
        value is positive

    Raises
    ------
    ValueError
        If the count is negative or not an integer.

    Examples
    --------
    >>> from generated import bessel_j1_at_j0_zeros
    >>> print(bessel_j1_at_j0_zeros(3).round(6))
    [ 0.519147 -0.340265  0.271452]
    """
    count = whole(count, "zeros")
    m = _mcmahon_numbers(count, 0)
    square = 1.0 / (QUARTER_PI * m) ** 2
    excess = square * _polynomial(SLOPE_EXCESS, square)
    slope = kernels.slope(m, excess)
    # One Newton step for m J_1^2 = (8/pi^2) (1 + excess), with an exactly computed residual.
    slope_squared, slope_halves = slope * slope, halves(slope)
    scaled = m * slope_squared
    missing = EIGHT_OVER_PI2 - scaled
    missing -= lost_by_halves(halves(m), halves(slope_squared), scaled)
    missing -= m * lost_by_halves(slope_halves, slope_halves, slope_squared)
    missing += EIGHT_OVER_PI2_TAIL + EIGHT_OVER_PI2 * excess
    slope += slope * missing / (2.0 * EIGHT_OVER_PI2)
    slope[FIRST_MCMAHON[0] % 2 :: 2] *= -1.0  # zeros with an even index
    return np.concatenate((LOW_SLOPES[:count], slope))


def _evaluate(argument: ArrayLike, order: int) -> np.ndarray:
    """Return J_order of an array of any shape, block by block; J_order is even or odd."""
    refuse_masked(argument)
    given = np.asarray(argument)
    signed = given.astype(np.float64, casting="same_kind").ravel()
    x = np.abs(signed)
    result = np.empty_like(x)
    for start in range(0, x.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        result[part] = _block(x[part], order)
    if order == 1:
        result = np.where(np.signbit(signed), -result, result)
    single = given.dtype.kind == "f" and given.dtype.itemsize <= 4
    kind = np.float32 if single else np.float64
    return result.astype(kind).reshape(given.shape)[()]


def _block(x: Double, order: int) -> Double:
    """Return J_order for x >= 0, each point by the method for its range."""
    low = x < ASYMPTOTIC_START
    if low.all():
        return _taylor(x, order)
    result = np.full_like(x, np.nan)
    middle = (x >= ASYMPTOTIC_START) & (x <= LARGEST_PHASE)
    high = (x > LARGEST_PHASE) & (x < np.inf)
    for points, method in ((low, _taylor), (middle, _modulus_phase), (high, _far)):
        chosen = np.flatnonzero(points)
        if chosen.size == x.size:
            return method(x, order)
        if chosen.size:
            result[chosen] = method(x[chosen], order)
    return result


def _taylor(x: Double, order: int) -> Double:
    """Return the Taylor polynomial about the centre nearest to x, 0 <= x < ASYMPTOTIC_START."""
    centre = _CENTRE_OF_CELL.take((CELLS * x).astype(np.intp))
    # The first difference is exact where it cancels; the second adds the low part of the centre.
    t = (x - _HIGH.take(centre)) - _LOW.take(centre)
    table = _TAYLOR[order]
    value: Double = table[0].take(centre)
    coefficient = np.empty_like(value)
    for line in table[1:]:
        value *= t
        value += line.take(centre, out=coefficient, mode="clip")
    return value


def _modulus_phase(x: Double, order: int) -> Double:
    """Return sqrt(2 p/(pi x)) sin(x +- pi/4 + s) for ASYMPTOTIC_START <= x <= LARGEST_PHASE."""
    quarter = 2.0 * order - 1.0  # J0 has zeros near (4 k - 1) pi/4, J1 near (4 k + 1) pi/4
    inverse = 1.0 / x
    square = inverse * inverse
    shift = inverse * _polynomial(SHIFT[order], square)
    modulus = _polynomial(MODULUS[order], square)
    half_turns = np.rint(x * INVERSE_PI - 0.25 * quarter)
    wave = kernels.wave(x, modulus, shift, *_times_quarter_pi(4.0 * half_turns + quarter))
    half = 0.5 * half_turns
    wave *= 1.0 - 4.0 * (half - np.floor(half))  # (-1)^half_turns
    return wave


def _far(x: Double, order: int) -> Double:
    """Return J_order for x > LARGEST_PHASE, where p = 1 and s = 0 in double precision."""
    return (kernels.far_0, kernels.far_1)[order](x)


def _zeros(count: int, order: int) -> Double:
    """Return the first positive zeros of J_order: a table, then McMahon's expansion."""
    count = whole(count, "zeros")
    beta, rest = _times_quarter_pi(_mcmahon_numbers(count, order))
    inverse = 1.0 / beta
    rest += inverse * _polynomial(ZERO_CORRECTION[order], inverse * inverse)
    return np.concatenate((LOW_ZEROS[order][:count], beta + rest))


def _times_quarter_pi(n: Double) -> tuple[Double, Double]:
    """Return n pi/4 as the sum of two doubles."""
    product = n * QUARTER_PI
    return product, lost_by_halves(halves(n), _QUARTER_HALVES, product) + n * QUARTER_PI_TAIL


def _mcmahon_numbers(count: int, order: int) -> Double:
    """Return beta/(pi/4) for zeros of J_order from the expansion's first index up to count."""
    index = np.arange(FIRST_MCMAHON[order], count + 1, dtype=np.float64)
    return 4.0 * index + QUARTERS[order]


def _polynomial(coefficients: tuple[float, ...], variable: Double) -> Double:
    """Evaluate a polynomial by Horner's rule, constant term first."""
    value = np.full_like(variable, coefficients[-1])
    for coefficient in coefficients[-2::-1]:
        value *= variable
        value += coefficient
    return value
