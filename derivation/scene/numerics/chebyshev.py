"""Chebyshev polynomials on [0, 1]: values, coefficients, weighted means."""

from functools import lru_cache

import numpy as np
from numpy.polynomial.chebyshev import chebder

from derivation.scene.numerics.quadrature import gauss
from generated.arrays import Double as Array


def chebyshev(s: Array, degree: int) -> Array:
    """Return the Chebyshev polynomials up to a degree at points of [-1, 1], along a last axis.

    The cosines follow from the tangent of half the angle, which NumPy may compute faster.
    """
    t = np.arccos(s)[..., None] * _halves(degree)
    np.tan(t, out=t)
    t *= t
    values = 1.0 - t
    t += 1.0
    values /= t
    return np.asarray(values, dtype=np.float64)


@lru_cache(maxsize=64)
def _halves(degree: int) -> Array:
    """Return half of each number up to a degree."""
    return np.asarray(0.5 * np.arange(degree + 1), dtype=np.float64)


def by_growth(table: Array) -> Array:
    """Return the coefficients of x df/dx on [0, 1] from those of f (columns); x = (1 + T_1)/2."""
    slopes = np.zeros_like(table)
    slopes[:-1] = 2.0 * chebder(table)
    coefficients = 0.5 * slopes
    coefficients[1:] += 0.25 * slopes[:-1]
    coefficients[:-1] += 0.25 * slopes[1:]
    coefficients[1] += 0.25 * slopes[0]
    return coefficients


@lru_cache(maxsize=8)
def knots(degree: int) -> tuple[Array, Array, Array]:
    """Return Chebyshev points on [0, 1], the matrix of coefficients, and int_0^1 t^2 f(x t) dt."""
    x, analysis = points(2 * degree, degree)
    t, weights = gauss(degree + 8)
    mean = [(weights * t * t) @ chebyshev(2.0 * point * t - 1.0, degree) for point in x]
    return x, analysis, np.array(mean)


@lru_cache(maxsize=16)
def points(count: int, degree: int) -> tuple[Array, Array]:
    """Return Chebyshev points on [0, 1], and the matrix of the coefficients up to a degree."""
    odd = np.arange(2 * count - 1, 0, -2)
    x = (1.0 + np.cos(np.pi / (2 * count) * odd)) / 2.0
    # The polynomials, cos(k angle), are orthogonal over the points; whole turns are removed.
    turned = np.outer(np.arange(degree + 1), odd) % (4 * count)
    analysis = (2.0 / count) * np.cos(np.pi / (2 * count) * turned)
    analysis[0] *= 0.5
    return x, analysis
