"""Constants of the contact law for an integer index.

    kappa_n = int_0^oo y^n K0(y)/I0(y) dy            moments of the lateral surface
    M_k     = FP int_0^oo T^(2k-4) (G(T) - 1) dT     finite parts of the thin plate

Both grow like factorials and exceed the range of doubles for n > 196 and k > 99. Their ratios to
the leading terms tend to 1 and are available for every index. For small indices they are tabulated
and correctly rounded; for large indices they come from the first terms of an expansion.

Arithmetic: look-up, and the expansions, whose coefficients are computed in advance.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from generated.arrays import Double, as_doubles, as_result, in_manifest, quiet
from generated.series_numbers import (
    FINITE_PART,
    FINITE_PART_RATIO,
    FINITE_PART_START,
    FIRST_K,
    KAPPA,
    KAPPA_RATIO,
    KAPPA_START,
    KAPPA_STEPS,
    LIMIT_POLE,
    LIMIT_RESIDUE,
)


@in_manifest(r"\kappa_n", domain="n >= 0", kernel=True)
@quiet
def kappa(n: ArrayLike) -> np.ndarray:
    """Compute the moment kappa_n of the lateral surface.

    Formula (step 13 of the derivation)::

        kappa_n = int_0^oo y^n K0(y)/I0(y) dy

    Parameters
    ----------
    n : array_like
        index [1], an integer of at least 0, of any shape

    Returns
    -------
    float or ndarray
        kappa_n [1] in the shape of n; float32 for float32 input, else float64. NaN for other
        numbers, and for values too large for the type: n > 196 in float64.

    Examples
    --------
    >>> from generated import kappa
    >>> print(f"{kappa(2):.6g}")
    0.646889
    """
    kind, (index,) = as_doubles(n)
    return _representable(_looked_up(KAPPA, index), kind)


@in_manifest(r"2^{n+1}\kappa_n/(\pi n!)", domain="n >= 0", kernel=True)
@quiet
def kappa_ratio(n: ArrayLike) -> np.ndarray:
    """Compute the ratio of the moment kappa_n to its leading term for large n.

    Formula (step 13 of the derivation)::

        r_n = kappa_n 2^(n+1)/(pi n!) = 1 - 1/(2n) + 1/(8n(n-1)) - ...

    Parameters
    ----------
    n : array_like
        index [1], an integer of at least 0, of any shape and size

    Returns
    -------
    float or ndarray
        r_n [1] in the shape of n; float32 for float32 input, else float64. NaN for other
        numbers.

    Examples
    --------
    >>> from generated import kappa_ratio
    >>> print(f"{kappa_ratio(2):.6g}")
    0.823645
    """
    kind, (index,) = as_doubles(n)
    far = (index >= KAPPA_START) & (index == np.floor(index))
    large = np.where(far, index, KAPPA_START)
    value = np.full_like(large, KAPPA_STEPS[-1])
    for step in range(len(KAPPA_STEPS) - 2, -1, -1):
        value /= large - step
        value += KAPPA_STEPS[step]
    return as_result(np.where(far, value, _looked_up(KAPPA_RATIO, index)), kind)


@in_manifest("M_k", domain="k >= 2", kernel=True)
@quiet
def finite_part(k: ArrayLike) -> np.ndarray:
    """Compute the constant M_k of the thin plate, a finite part in the sense of Hadamard.

    Formula (step 14 of the derivation)::

        M_k = FP int_0^oo T^(2k-4) (G(T) - 1) dT

        G(T) = (sinh(T) cosh(T) + T)/(sinh(T)^2 - T^2)

    Parameters
    ----------
    k : array_like
        index [1], an integer of at least 2, of any shape

    Returns
    -------
    float or ndarray
        M_k [1] in the shape of k; float32 for float32 input, else float64. NaN for other
        numbers, and for values too large for the type: k > 99 in float64.

    Examples
    --------
    >>> from generated import finite_part
    >>> print(f"{finite_part(2):.6g}")
    -1.12648
    """
    kind, (index,) = as_doubles(k)
    return _representable(_looked_up(FINITE_PART, index - FIRST_K), kind)


@in_manifest("2^{2k-3}M_k/(2k-2)!", domain="k >= 2", kernel=True)
@quiet
def finite_part_ratio(k: ArrayLike) -> np.ndarray:
    """Compute the ratio of the thin plate's constant M_k to its leading term for large k.

    Formula (step 14 of the derivation)::

        rho_k = M_k 2^(2k-3)/(2k-2)! = (2k-1)/(2k-3) + O(k^2 4^-k)

    Parameters
    ----------
    k : array_like
        index [1], an integer of at least 2, of any shape and size

    Returns
    -------
    float or ndarray
        rho_k [1] in the shape of k; float32 for float32 input, else float64. NaN for other
        numbers.

    Examples
    --------
    >>> from generated import finite_part_ratio
    >>> print(f"{finite_part_ratio(3):.6g}")
    2.57462
    """
    kind, (index,) = as_doubles(k)
    far = (index >= FINITE_PART_START) & (index == np.floor(index))
    large = np.where(far, index, FINITE_PART_START)
    limit = 1.0 + LIMIT_RESIDUE / (large - LIMIT_POLE)
    return as_result(np.where(far, limit, _looked_up(FINITE_PART_RATIO, index - FIRST_K)), kind)


def _looked_up(table: Double, place: Double) -> Double:
    """Return entries of a table; NaN for an index that it does not contain."""
    known = (place >= 0.0) & (place < table.size) & (place == np.floor(place))
    values = table.take(np.where(known, place, 0.0).astype(np.intp))
    return np.where(known, values, np.nan)


def _representable(value: Double, kind: np.dtype) -> np.ndarray:
    """Return the value in the requested type; NaN where it would overflow."""
    limited = np.abs(value) <= float(np.finfo(kind).max)
    return as_result(np.where(limited, value, np.nan), kind)
