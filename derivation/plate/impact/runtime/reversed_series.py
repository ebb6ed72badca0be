"""Force as a function of indentation by the paper's reversed series: for comparison only.

Arithmetic: Horner's rule; powers of a power series by Euler's recurrence; the search for the
best circle; scaling of coefficients by powers of a radius.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from generated import reversed_kernels as kernels
from generated.arrays import Double, as_doubles, as_result, in_manifest, inside, quiet
from generated.contact_domain import elastic, modulus_factors, plates_of_lengths
from generated.contact_series import Plates

_CIRCLE = 129  # number of directions in the search for the radius of convergence
_TOGETHER = 64  # number of circles searched together


@in_manifest(
    "P",
    equation="10",
    domain="delta >= 0, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, 3 * lam > -2 * mu, mu > 0, "
    "sqrt(R * delta)/h < radius of convergence",
)
@quiet
def force_by_series(
    delta: ArrayLike,
    R: ArrayLike,
    h: ArrayLike,
    b: ArrayLike,
    lam: ArrayLike,
    mu: ArrayLike,
    *,
    terms: int = 12,
) -> np.ndarray:
    """Compute the contact force by the truncated reversed series, within its radius of convergence.

    Formula (Lagrange's inversion)::

        P = (4/3) E* sqrt(R) delta^(3/2) (1 + p_1 eps + p_2 eps^2 + ...),  eps = sqrt(R delta)/h
        p_n = 3/(n + 3) [A^n] (1 + F)^(-(n + 3)/2)

    Parameters
    ----------
    delta : array_like
        indentation [m]; 0 <= delta, eps within the radius of convergence
    R : array_like
        sphere radius [m]; R > 0
    h : array_like
        half the plate's thickness [m]; h > 0
    b : array_like
        plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90
    lam : array_like
        first Lame constant [Pa]; 3 lam > -2 mu
    mu : array_like
        second Lame constant (shear modulus) [Pa]; mu > 0
    terms : int
        Number of terms of the series in parentheses, at least 1.

    Returns
    -------
    float or ndarray
        P [N] in the arguments' broadcast shape; NaN outside the domain and for eps above a
        lower bound of the radius of convergence (Rouche's theorem).

    Raises
    ------
    ValueError
        If terms is less than 1.

    Examples
    --------
    >>> from generated import force_by_series
    >>> print(f"{force_by_series(1e-6, 0.01, 0.004, 0.02, 22.5e9, 28.7e9):.6g}")
    9.14599
    """
    if terms < 1:
        raise ValueError(f"expected at least one term, got terms={terms}")
    kind, [delta, R, h, b, lam, mu] = as_doubles(delta, R, h, b, lam, mu)
    [delta, R, lam, mu] = inside([delta, R, lam, mu], delta >= 0, R > 0, *elastic(lam, mu))
    [h] = inside([h], h > 0)
    plates, owner = plates_of_lengths(h, b)
    rows = [_reversed(plates, plate, terms) for plate in range(plates.eta.size)]
    radius = np.array([row[0] for row in rows] or [np.nan])[owner]
    eps = kernels.eps_over(delta, R, h, radius)
    [eps] = inside([eps], eps < 1)
    value = np.zeros_like(eps)
    for power in reversed(range(terms)):
        coefficient = np.array([row[1][power] for row in rows] or [np.nan])[owner]
        value = value * eps + coefficient
    _, modulus = modulus_factors(lam, mu)  # divided by mu
    return as_result(kernels.force_of_bracket(delta, R, mu, modulus, value), kind)


def _reversed(plates: Plates, plate: int, terms: int) -> tuple[float, Double]:
    """Return a lower bound r of the radius of convergence in eps, and p_n r^n for n < terms.

    Within a circle on which |eps(A)| is at least e and 1 + F has no zero, eps(A) =
    A sqrt(1 + F) takes each value below e once. The circle with the largest e is sought.
    """
    reach = plates.reach[plate]
    if not np.isfinite(reach):
        return np.nan, np.full(terms, np.nan)
    row = plates.first.coefficients[:, plate]
    start = min(reach, 0.05 / max(abs(float(row[0])), 1e-300))
    circles = reach * np.geomspace(start / reach, 1.0, 1 + int(400 * (1 - np.log10(start / reach))))
    directions = np.exp(1j * np.linspace(0.0, np.pi, _CIRCLE))  # the others are conjugate
    radius = scale = 0.0
    for begin in range(0, circles.size, _TOGETHER):
        some = circles[begin : begin + _TOGETHER]
        A = some[:, None] * directions
        value = np.polyval(row[::-1], (A / reach) ** 2)
        least = kernels.size_of_eps(some[:, None], A * value).min(axis=1)
        fallen = np.flatnonzero(least < np.append(radius, least[:-1]))
        count = int(fallen[0]) if fallen.size else some.size
        if count:
            radius, scale = float(least[count - 1]), float(some[count - 1])
        if fallen.size:
            break
    scaled = np.zeros(terms)  # F in powers of A/scale
    for k in range(min(row.size, terms // 2)):
        scaled[2 * k + 1] = row[k] * scale * (scale / reach) ** (2 * k)
    ratio = radius / scale
    exponents, factors = kernels.lagrange(np.arange(float(terms)))
    powers = [_power(scaled, exponent)[n] for n, exponent in enumerate(exponents)]
    return radius, np.array(powers) * factors * ratio ** np.arange(terms)


def _power(series: Double, exponent: float) -> Double:
    """Return a power of 1 + a power series without constant term, by Euler's recurrence."""
    result = np.zeros_like(series)
    result[0] = 1.0
    for n in range(1, series.size):
        k = np.arange(1, n + 1)
        result[n] = ((exponent * k - (n - k)) * series[k] * result[n - k]).sum() / n
    return result
