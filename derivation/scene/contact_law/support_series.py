"""Contribution of simple supports to the contact law of plates, as Chebyshev series.

The contribution divided by alpha = a/b is an even function of alpha with its nearest singularity
near alpha = 1. It is expanded in Chebyshev polynomials of alpha^2 up to a multiple of Hertz's
largest contact radius.
"""

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from derivation.scene import kernels

Array = NDArray[np.float64]
WIDEST, TERMS = 0.15, 9
"""Largest alpha of a series, and its number of terms; the last one is below 1e-17 of the first."""
WIDER = 1.3
"""Largest contact radius of a series over Hertz's largest one."""
STEPS = 256.0
"""It is rounded up to a multiple of the next power of two divided by this number. Rounding errors
of Hertz's radius then do not change the series."""


class Supports(NamedTuple):
    """Series of plates (first axis): largest alpha, coefficients of the value and its slope."""

    reach: Array
    value: Array
    growth: Array

    def take(self, index: Any) -> "Supports":
        """Return the series of some of the plates."""
        return Supports(*(x[index] for x in self))


def supports_of(hertz: Array, h: Array, b: Array, lam: Array, mu: Array) -> Supports:
    """Compute the series of plates from columns; `hertz` is Hertz's largest radius of each [m]."""
    fraction, exponent = np.frexp(WIDER * hertz / b)
    reach = np.minimum(np.ldexp(np.ceil(fraction * STEPS) / STEPS, exponent), WIDEST)
    nodes, values, slopes = _rules()
    alpha = reach * np.sqrt(0.5 * (1.0 + nodes))
    sampled = kernels.supported_edge(alpha * b, h, b, lam, mu) / alpha
    return Supports(reach, *(np.vecdot(matrix, sampled[:, None]) for matrix in (values, slopes)))


def support_contribution(supports: Supports, alpha: Array) -> tuple[Array, Array]:
    """Return the contributions to F and S at rows of alpha; NaN beyond the series."""
    point = 2.0 * (alpha / supports.reach) ** 2 - 1.0
    value, growth = _sum(supports.value, point), _sum(supports.growth, point)
    value = np.where(alpha <= supports.reach, value, np.nan)
    return alpha * value, alpha * (1.5 * value + (1.0 + point) * growth)


@cache
def _rules() -> tuple[Array, Array, Array]:
    """Return Chebyshev nodes, and matrices from values there to coefficients of value and slope."""
    nodes = chebyshev.chebpts1(TERMS)
    values = np.linalg.inv(chebyshev.chebvander(nodes, TERMS - 1))
    slopes = np.zeros((TERMS, TERMS))
    slopes[:-1] = chebyshev.chebder(values)
    return nodes, np.asarray(values, dtype=np.float64), slopes


def _sum(coefficients: Array, point: Array) -> Array:
    """Sum the series by Clenshaw's rule; three arrays are used again at each step."""
    twice, older, spare = 2.0 * point, np.zeros_like(point), np.empty_like(point)
    newer = coefficients[:, -1:] + older
    for k in range(TERMS - 2, 0, -1):
        np.multiply(twice, newer, out=spare)
        spare += coefficients[:, k : k + 1]
        spare -= older
        newer, older, spare = spare, newer, older
    return coefficients[:, :1] + point * newer - older
