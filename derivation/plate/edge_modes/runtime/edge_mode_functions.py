"""Modified Bessel functions for the modes of clamped and supported plates.

Arithmetic: Bessel's integral as a sum, and power series by Horner's rule.
"""

import numpy as np

from generated.arrays import Double
from generated.blocks import polynomial
from generated.edge_mode_numbers import (
    CURL,
    CURL_SLOPE,
    EVEN,
    FOURTH,
    LOGARITHM,
    MEAN,
    ODD,
    PUNCH,
    RATIO,
    SECOND,
    TURNS,
)


def turn_mean(y: Double) -> Double:
    """Return I0 e^(-y) for 0 <= y <= START."""
    value: Double = np.sum(_faded(y) * MEAN, axis=-1)
    return value


def turn_means(y: Double) -> tuple[Double, Double, Double]:
    """Return I0 e^(-y), I1 e^(-y)/y and 3 I2 e^(-y)/y^2 for 0 <= y <= START."""
    faded = _faded(y)
    return (
        np.sum(faded * MEAN, axis=-1),
        np.sum(faded * SECOND, axis=-1),
        np.sum(faded * FOURTH, axis=-1),
    )


def _faded(y: Double) -> Double:
    value: Double = np.exp(-np.multiply.outer(y, TURNS))
    return value


def ratio_series(inverse: Double) -> Double:
    """Return I1/I0 at y = 1/inverse >= START."""
    return polynomial(inverse, *RATIO)


def logarithm_series(inverse: Double) -> Double:
    """Return y log(I0 sqrt(2 pi y) e^(-y)) at y = 1/inverse >= START."""
    return polynomial(inverse, *LOGARITHM)


def even(y: Double) -> Double:
    """Return I0(sqrt(y))."""
    return polynomial(y, *EVEN)


def even_beyond(y: Double) -> Double:
    """Return (I0(sqrt(y)) - 1)/y."""
    return polynomial(y, *EVEN[1:])


def odd(y: Double) -> Double:
    """Return 2 I1(sqrt(y))/sqrt(y)."""
    return polynomial(y, *ODD)


def punch_beyond(y: Double) -> Double:
    """Return (sinh(sqrt(y))/sqrt(y) - 1)/y."""
    return polynomial(y, *PUNCH[1:])


def curled(y: Double) -> tuple[Double, Double]:
    """Return R = y/8 I0(sqrt(y)) - I2(sqrt(y)), and its derivative with respect to y."""
    return y * polynomial(y, *CURL), polynomial(y, *CURL_SLOPE)


def grown(y: Double, r: Double) -> Double:
    """Return I0(sqrt(y)) - I0(r sqrt(y)), computed term by term."""
    total, square, part = np.zeros_like(r), r * r, np.ones_like(r)
    terms = []
    for m, coefficient in enumerate(EVEN):
        terms.append(coefficient * y**m * (1.0 - part))
        part = part * square
    for term in terms[::-1]:
        total = total + term
    return total
