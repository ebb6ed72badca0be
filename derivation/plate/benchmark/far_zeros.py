"""Zeros of J0 far out, and J1 there, by McMahon's expansion in NumPy floats of any width."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from derivation.mathematics.bessel.theory.zeros import (
    phase_at_zeros,
    slope_squared,
    zero_correction,
)

Values = NDArray[np.floating[Any]]

FIRST = 1000
"""Zeros up to this number are not asked for."""

TERMS = 4
"""Of either expansion: beyond FIRST they leave out less than 1e-26 of the value."""


def far_zeros(begin: int, end: int, pi: np.floating[Any]) -> tuple[Values, Values]:
    """Zeros j_n of J0 and J1(j_n), FIRST <= begin < n <= end, in the floats that pi is given in.

    With beta = (n - 1/4) pi, j_n = beta (1 + s) and J1(j_n)^2 = 2 q/(pi beta), s and q in powers
    of 1/beta^2 (McMahon 1895; DLMF 10.21.19 and 10.21.20), as `mathematics.bessel.theory.zeros`
    proves them.

    Parameters
    ----------
    begin, end
        How many zeros lie before the first one, and the number of the last.
    pi
        pi, as wide a float as the result's.

    Raises
    ------
    ValueError
        If zeros are asked for that are not far out.
    """
    if begin < FIRST:
        raise ValueError(f"expected zeros of J0 beyond number {FIRST}, got number {begin + 1}")
    wide = type(pi)
    n = np.arange(begin + 1, end + 1).astype(wide)
    beta = (n + wide(phase_at_zeros(0)[0]) / 4) * pi
    w = 1 / (beta * beta)
    stretch, slope = (_horner(row, w) for row in _coefficients(wide))
    return beta * (1 + w * stretch), np.sqrt(2 * slope / (pi * beta)) * np.where(n % 2, 1, -1)


def _horner(row: Values, w: Values) -> Values:
    value = np.full_like(w, row[-1])
    for coefficient in row[-2::-1]:
        value = value * w + coefficient
    return value


def _coefficients(wide: type[np.floating[Any]]) -> tuple[Values, Values]:
    """Of s/w and q, w = 1/beta^2: small integers' quotients."""
    rows = zero_correction(0, TERMS).coefficients, slope_squared(TERMS).coefficients
    first, second = (np.array([wide(int(c.p)) / wide(int(c.q)) for c in row]) for row in rows)
    return first, second
