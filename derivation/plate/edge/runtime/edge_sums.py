"""Parameters of the edge corrections, and both modal sums of a simple support.

With n = nu/(1 - nu), T = 2 eta j and k the weight function of the indentation or of the slope::

    sum k (1 + 3 n - n Q)/(j^3 J1),   Q = T (cosh T - 1)/(sinh T - T)
    sum k H/(j^2 J1),                 H = (cosh T - 1)/(sinh T + T)

Arithmetic: quotients of the arguments, and limits of their domain; the number of modes summed; the
variable of the tables.
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from generated import edge_kernels as kernels
from generated import edge_numbers as numbers
from generated.arrays import Double, as_doubles, inside
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros
from generated.blocks import polynomial
from generated.contact_series import THICKEST, THINNEST

_POINTS = 128  # number of points in one block of the sum
_MODES = 16  # the number of modes is a multiple of it


class SummedKernel(NamedTuple):
    """Weight function of the indentation or of the slope, with its modal sums.

    Attributes
    ----------
    value
        k as a function of alpha and j.
    thin
        sum k/(j^3 J1) and both sums of a thin plate as functions of alpha, eta and n.
    third, square
        sum k/(j^3 J1), sum k/(j^2 J1) without the first mode, in powers of alpha^2/MIDDLE - 1.
    """

    value: Callable[[Double, Double], Double]
    thin: Callable[[Double, Double, Double], tuple[Double, Double, Double]]
    third: tuple[float, ...]
    square: tuple[float, ...]


INDENTATION = SummedKernel(
    kernels.indentation_kernel,
    kernels.thin_indentation,
    numbers.INDENTATION_THIRD,
    numbers.INDENTATION_SQUARE,
)
SLOPE = SummedKernel(
    kernels.slope_kernel, kernels.thin_slope, numbers.SLOPE_THIRD, numbers.SLOPE_SQUARE
)


def elastic_ratios(lam: Double, mu: Double) -> tuple[Double, Double]:
    """Return n and (1 - nu)/(1 + nu), with lam and mu scaled to avoid overflow and underflow."""
    most = np.maximum(lam, mu)
    return kernels.elastic_ratios(lam / most, mu / most)


def edge_ratios(
    a: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike, widest: float
) -> tuple[np.dtype, Double, Double, Double, Double]:
    """Return the result's type, alpha, eta, n and (1 - nu)/(1 + nu); NaN outside the domain."""
    kind, [a, h, b, lam, mu] = as_doubles(a, h, b, lam, mu)
    [a] = inside([a], a >= 0, a <= widest * b, b > 0)
    [h, b] = inside([h, b], h > 0, b > 0)
    [lam, mu] = inside([lam, mu], 3.0 * lam > -2.0 * mu, mu > 0)
    eta = h / b
    [eta] = inside([eta], eta >= THINNEST, eta <= THICKEST)
    return kind, a / b, eta, *elastic_ratios(lam, mu)


def edge_sums(alpha: Double, eta: Double, n: Double, kernel: SummedKernel) -> tuple[Double, Double]:
    """Return both sums: closed forms for a thin plate where these suffice, else modal sums."""
    shape = np.broadcast_shapes(alpha.shape, eta.shape, n.shape)
    alpha, eta, n = (np.ravel(np.broadcast_to(x, shape)) for x in (alpha, eta, n))
    plain, bending_part, extension_part = kernel.thin(alpha, eta, n)
    thick = np.flatnonzero(1.0 - alpha < numbers.THIN * eta)
    for some, count in blocks_of_modes(eta[thick], numbers.FADED):
        part = thick[some]
        sums = _summed(alpha[part], eta[part], n[part], plain[part], kernel, count)
        bending_part[part], extension_part[part] = sums
    return bending_part.reshape(shape), extension_part.reshape(shape)


def blocks_of_modes(eta: Double, faded: float) -> Iterator[tuple[np.ndarray, int]]:
    """Yield blocks of points, as indices, and the number of their modes.

    Later modes are negligible because T = 2 eta j > faded. The number of modes, and thereby the
    rounding error of their sum, does not depend on the other points. It is rounded up, so that
    there are few blocks.
    """
    counts = 2 + (faded / (2.0 * np.pi * eta)).astype(np.intp)
    counts += -counts % _MODES
    for count in np.unique(counts):
        points = np.flatnonzero(counts == count)
        for start in range(0, points.size, _POINTS):
            yield points[start : start + _POINTS], int(count)


def _summed(
    alpha: Double, eta: Double, n: Double, plain: Double, kernel: SummedKernel, count: int
) -> tuple[Double, Double]:
    """Return both sums over a number of modes."""
    j, J1 = bessel_j0_zeros(count), bessel_j1_at_j0_zeros(count)
    place = alpha * alpha / numbers.MIDDLE - 1.0
    rest_third, rest_square = (polynomial(place, *x) for x in (kernel.third, kernel.square))
    later = kernel.value(alpha[:, None], j[1:])
    plates, owner = np.unique(eta, return_inverse=True)  # whose points have the same modes
    fading = kernels.later_modes(plates[:, None], j[1:], J1[1:], np.ones(1))
    third, square = ((part[owner] * later).sum(axis=1) for part in fading)
    first, rest = kernel.value(alpha, j[0]), (plain, rest_third, rest_square)
    return kernels.all_modes(eta, n, j[0], first, *rest, third, square)
