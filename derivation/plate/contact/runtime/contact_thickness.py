"""Derivatives of the contact law's polynomials with respect to the plate thickness.

Slopes dF/d log(eta), eta = h/b, at fixed A = a/h, in the powers used by `contact_series`.

Arithmetic: Horner's rule, and the scaling of the polynomials' variables to their ranges.
"""

import numpy as np

from generated import contact_kernels as kernels
from generated.arrays import Double
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros
from generated.contact_cells import Cells, horner, in_cells
from generated.contact_numbers import (
    CELLS,
    FAR_BY_LOG,
    FAR_CELLS,
    FAR_REACH,
    MODES,
    NEAR_BY_LOG,
    REACH,
    THIN,
)
from generated.contact_series import Piece

_THINNER = CELLS[-1][1]  # value of 1/eta above which the remainder is negligible


def first_by_thickness(first: Piece, eta: Double) -> Double:
    """Return coefficients of dF/d log(eta) at fixed A, in the powers of the first piece."""
    coefficients = np.full(first.coefficients.shape, np.nan)
    chosen = np.flatnonzero(eta >= 1.0 / REACH)
    if chosen.size:
        zeros, slopes = _weight_slopes(eta[chosen], MODES.shape[0])
        total = np.zeros((MODES.shape[1], chosen.size))
        for index in reversed(range(zeros.size)):
            total += MODES[index][:, None] * slopes[..., index]
        # reach is 1/eta: for fixed weights F is a function of alpha = A eta.
        orders = 2.0 * np.arange(total.shape[0], dtype=np.float64)[:, None] + 1.0
        whole = first.coefficients[:, chosen]
        coefficients[:, chosen] = kernels.thick_by_thickness(orders, whole, eta[chosen], total)
    chosen = np.flatnonzero(eta < 1.0 / REACH)
    if chosen.size:
        v = 1.0 / eta[chosen]
        total = np.zeros((THIN.size, chosen.size))
        _tabulated_slope(v, CELLS, total)
        total[0] += kernels.linear_by_log(v)
        total[1] += NEAR_BY_LOG
        coefficients[:, chosen] = -total
    return coefficients


def far_by_thickness(far: Piece, eta: Double) -> Piece:
    """Return dF/d log(eta) at fixed A as a piece on the second polynomial's range."""
    v = 1.0 / eta
    total = np.zeros_like(far.coefficients)
    _tabulated_slope(v, FAR_CELLS, total)
    # Up to FAR_REACH the range grows with v, and t decreases in proportion to 1 + t.
    order = np.arange(total.shape[0])[:, None]
    inner = order * far.coefficients
    inner[:-1] += inner[1:]
    total -= np.where(v <= FAR_REACH, kernels.range_by_thickness(v, far.half), 0.0) * inner
    chosen = np.flatnonzero(v > _THINNER)
    total[0, chosen] = kernels.linear_by_log(v[chosen]) + FAR_BY_LOG[0]
    total[1, chosen] = FAR_BY_LOG[1]
    return Piece(-total, far.middle, far.half)


def _tabulated_slope(v: Double, cells: Cells, total: Double) -> None:
    """Add v times the derivatives with respect to v of the cells' polynomials."""
    for chosen, tau, half, rows in in_cells(v, cells):
        total[:, chosen] += horner(rows, tau)[1] * (v[chosen] / half)


def _weight_slopes(eta: Double, count: int) -> tuple[Double, Double]:
    """Return j_n and the derivatives of w_n with respect to log(eta); modes along the last axis."""
    zeros, slopes = bessel_j0_zeros(count), bessel_j1_at_j0_zeros(count)
    return zeros, kernels.weight_by_thickness(eta[..., None], zeros, slopes)
