"""Largest tensile stress of a plate: on the back face, opposite the centre of the contact.

For Hertz pressure of resultant P on the contact radius a, with H = 2h, alpha = a/b,
eta = h/b and j the zeros of J0::

    sigma_rr = sigma_tt = (1 + nu) P/(2 pi H^2) (S + edge)
    S = sum 4 eta^2 g(alpha j) B(2 eta j)/J1(j)^2,   g(y) = 3 (sin y - y cos y)/y^3
    B(T) = 2 T sinh T/(sinh^2 T - T^2)

In a thin plate S + 3 log(h/b) depends on a/h alone, so the sum for a thicker plate gives it.
Up to a = h/4 the Taylor polynomial of g gives S from sums that depend on h/b alone::

    S = sum_k t_k alpha^(2k) M_k,   M_k = sum 4 eta^2 j^(2k) B(2 eta j)/J1(j)^2

If a is much larger than h, with rational c_k::

    S = 3 (4/3 - log 2 - log alpha) + sum c_k (2 h/a)^(2k+2)

The edge term is 0 for the paper's edge, -X_c for a clamped edge and (1 - nu)/(1 + nu) X for a
simple support. With the symbols of `edge`::

    X = sum g [12 (1 + 3 n - n Q)/(j^3 J1) + 8 n eta H/(j^2 J1)]
    X_c = (3/2) [(1 + 2 chi eta) (1 - 2 alpha^2/5) - s] + 2 n eta^2

Arithmetic: quotients of the arguments, limits of their domain, the number of modes summed, and
powers of j.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from generated import back_face_kernels as kernels
from generated import back_face_numbers as numbers
from generated.arrays import Double, as_doubles, as_result, in_manifest, inside, quiet
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros
from generated.contact_series import THICKEST, THINNEST
from generated.edge_kernels import indentation_kernel
from generated.edge_numbers import WIDEST
from generated.edge_sums import INDENTATION, blocks_of_modes, edge_sums, elastic_ratios


@in_manifest(
    r"\sigma_{rr}(0, -h)",
    domain="P >= 0, a > 0, a < b, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "3 * lam > -2 * mu, mu > 0",
)
@quiet
def back_face_stress(
    P: ArrayLike, a: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute the largest tensile stress on the back face of a plate with the paper's edge.

    Formula (step 25 of the derivation)::

        (1 + nu) P/(2 pi H^2) S

    Parameters
    ----------
    P : array_like
        contact force [N]; P >= 0
    a : array_like
        contact radius [m]; 0 < a < b
    h : array_like
        half the plate's thickness [m]; h > 0
    b : array_like
        plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90
    lam : array_like
        first Lame constant [Pa]; 3 lam > -2 mu
    mu : array_like
        second Lame constant (shear modulus) [Pa]; mu > 0

    Returns
    -------
    float or ndarray
        sigma_rr = sigma_tt at r = 0, z = -h [Pa], tensile stress positive,
        in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import back_face_stress
    >>> print(f"{back_face_stress(100.0, 1e-4, 0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    4.14397e+06
    """
    return _evaluated(P, a, h, b, lam, mu, None)


@in_manifest(
    r"\sigma_{rr}(0, -h)",
    domain="P >= 0, a > 0, a <= 0.9 * b, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "3 * lam > -2 * mu, mu > 0",
)
@quiet
def supported_back_face_stress(
    P: ArrayLike, a: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute the largest tensile stress on the back face of a simply supported plate.

    Formula (step 25 of the derivation)::

        (1 + nu) P/(2 pi H^2) (S + (1 - nu)/(1 + nu) X)

    Parameters
    ----------
    P : array_like
        contact force [N]; P >= 0
    a : array_like
        contact radius [m]; 0 < a <= 0.9 b
    h : array_like
        half the plate's thickness [m]; h > 0
    b : array_like
        plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90
    lam : array_like
        first Lame constant [Pa]; 3 lam > -2 mu
    mu : array_like
        second Lame constant (shear modulus) [Pa]; mu > 0

    Returns
    -------
    float or ndarray
        sigma_rr = sigma_tt at r = 0, z = -h [Pa], tensile stress positive; negative
        where the back face of a thick plate is compressed,
        in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import supported_back_face_stress
    >>> print(f"{supported_back_face_stress(100.0, 1e-4, 0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    4.43501e+06
    """
    return _evaluated(P, a, h, b, lam, mu, _with_support)


@in_manifest(
    r"\sigma_{rr}(0, -h)",
    domain="P >= 0, a > 0, a <= 0.9 * b, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "3 * lam > -2 * mu, mu > 0",
)
@quiet
def clamped_back_face_stress(
    P: ArrayLike, a: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute the largest tensile stress on the back face of a clamped plate.

    Formula (step 25 of the derivation)::

        (1 + nu) P/(2 pi H^2) (S - X_c)

    Parameters
    ----------
    P : array_like
        contact force [N]; P >= 0
    a : array_like
        contact radius [m]; 0 < a <= 0.9 b
    h : array_like
        half the plate's thickness [m]; h > 0
    b : array_like
        plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90
    lam : array_like
        first Lame constant [Pa]; 3 lam > -2 mu
    mu : array_like
        second Lame constant (shear modulus) [Pa]; mu > 0

    Returns
    -------
    float or ndarray
        sigma_rr = sigma_tt at r = 0, z = -h [Pa], tensile stress positive; negative
        where the back face of a thick plate is compressed,
        in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import clamped_back_face_stress
    >>> print(f"{clamped_back_face_stress(100.0, 1e-4, 0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    3.68877e+06
    """
    return _evaluated(P, a, h, b, lam, mu, _with_clamp)


def _evaluated(
    P: ArrayLike,
    a: ArrayLike,
    h: ArrayLike,
    b: ArrayLike,
    lam: ArrayLike,
    mu: ArrayLike,
    edge: Callable[[Double, Double, Double, Double, Double], Double] | None,
) -> np.ndarray:
    """Return the stress from S and the edge term, which is zero for the paper's edge."""
    kind, [P, a, h, b, lam, mu] = as_doubles(P, a, h, b, lam, mu)
    reach = a < b if edge is None else a <= WIDEST * b
    [P, a] = inside([P, a], P >= 0, a > 0, reach)
    [h, b] = inside([h, b], h > 0, b > 0)
    [lam, mu] = inside([lam, mu], 3.0 * lam > -2.0 * mu, mu > 0)
    eta, A = h / b, a / h
    [eta, A] = inside([eta, A], eta >= THINNEST, eta <= THICKEST)
    alpha = a / b
    total = _sum(alpha, eta, A)
    if edge is not None:
        total = edge(total, alpha, eta, *elastic_ratios(lam, mu))
    most = np.maximum(lam, mu)
    return as_result(kernels.stress_of_sum(total, P, h, lam / most, mu / most), kind)


def _with_support(total: Double, alpha: Double, eta: Double, n: Double, support: Double) -> Double:
    sums = edge_sums(alpha, eta, n, INDENTATION)
    return kernels.with_support(total, eta, n, support, *sums)


def _with_clamp(total: Double, alpha: Double, eta: Double, n: Double, _: Double) -> Double:
    return kernels.with_clamp(total, alpha, eta, n)


def _sum(alpha: Double, eta: Double, A: Double) -> Double:
    """Return S: by series where the contact is narrow or wide compared with h, else by its sum."""
    shape = np.broadcast_shapes(alpha.shape, eta.shape, A.shape)
    alpha, eta, A = (np.ravel(np.broadcast_to(x, shape)) for x in (alpha, eta, A))
    value = kernels.under_wide_contact(alpha, np.maximum(A, numbers.WIDE))
    near = np.flatnonzero(A < numbers.WIDE)
    width, thick = kernels.summed_plate(alpha[near], eta[near], A[near])
    sums, narrow = np.empty_like(thick), A[near] <= numbers.NARROW
    if narrow.any():
        plates, owner = np.unique(thick[narrow], return_inverse=True)  # equal plates only once
        moments = _moments(plates)
        sums[narrow] = kernels.under_narrow_contact(width[narrow], *moments[:, owner])
    if not narrow.all():
        sums[~narrow] = _modal_sum(width[~narrow], thick[~narrow])
    value[near] = kernels.of_thin_plate(sums, thick, eta[near])
    return value.reshape(shape)


def _moments(eta: Double) -> Double:
    """Return the sums of the modes times j^(2k), shape (terms, plates)."""
    moments = np.empty((numbers.TERMS, eta.size))
    for some, count in blocks_of_modes(eta, numbers.FADED):
        j, J1 = bessel_j0_zeros(count), bessel_j1_at_j0_zeros(count)
        modes = kernels.back_face_modes(eta[some, None], j, J1, np.ones(1))
        for moment in moments:
            moment[some] = modes.sum(axis=1)
            modes *= j * j
    return moments


def _modal_sum(alpha: Double, eta: Double) -> Double:
    """Return S, mode by mode."""
    sums = np.empty_like(eta)
    for some, count in blocks_of_modes(eta, numbers.FADED):
        j, J1 = bessel_j0_zeros(count), bessel_j1_at_j0_zeros(count)
        plates, owner = np.unique(eta[some], return_inverse=True)  # equal plates only once
        modes = kernels.back_face_modes(plates[:, None], j, J1, np.ones(1))
        sums[some] = (modes[owner] * indentation_kernel(alpha[some, None], j)).sum(axis=1)
    return sums
