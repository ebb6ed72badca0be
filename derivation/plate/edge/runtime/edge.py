"""Corrections of the paper's contact law for a simply supported or clamped edge.

The paper's edge is elastically restrained: w = 0 and sigma_rr = -(2 mu/b) u at r = b. A simple
support removes its force and moment by the exact polynomial states of extension and bending::

    delta R/a^2 = 1 + F + (1 - nu)/(1 + nu) X        simply supported
    delta R/a^2 = 1 + F - X_c                        clamped

At fixed a, both corrections are proportional to the force, delta = P 3 (...)/(4 E* a). With
alpha = a/b, eta = h/b, n = nu/(1 - nu), T = 2 eta j and j the zeros of J0::

    X = (alpha/pi) [ (1 - 2 n eta^2)/eta^3 sum g (1 + 3 n - n Q)/(j^3 J1)
                     + (8/3) n^2 sum g H/(j^2 J1) ],  g = 3 (sin y - y cos y)/y^3, y = alpha j
    Q = T (cosh T - 1)/(sinh T - T),  H = (cosh T - 1)/(sinh T + T)

In the slope (R/2a) d delta/da, (3/2) sin y/y replaces g. The remaining tractions at the edge decay
within a distance of one thickness from the edge and are neglected.

A clamped edge, u = w = 0 for all z, removes the displacement of the same states and prevents
thinning of the plate at the edge. There psi = chi eta psi' for the plate's rotation, and the middle
plane has w = n G h^2 (kappa_r + kappa_t). chi and G were computed for a strip and are fitted by
`turn_of_clamp` and `indentation_loss` in `edge_kernels`::

    X_c = alpha/(8 pi eta^3) [ (1 - s) (1 - 2 alpha^2/5 - s) + 2 chi eta (1 - 2 alpha^2/5)
                               + eta^3/5 + (16/3) n^2 eta^4 ],  s = 2 n (1 - 2 G) eta^2

In the slope, 2/3 replaces 2/5, and everything is multiplied by 3/2.

Arithmetic: none.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from generated import edge_kernels as kernels
from generated.arrays import as_result, in_manifest, quiet
from generated.edge_numbers import WIDEST
from generated.edge_sums import INDENTATION, SLOPE, SummedKernel, edge_ratios, edge_sums


@in_manifest(
    "",
    equation="6",
    domain="a >= 0, a <= 0.9 * b, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "3 * lam > -2 * mu, mu > 0",
)
@quiet
def supported_edge(
    a: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute the change of delta R/a^2 due to a simple support instead of the paper's edge.

    Formula (step 19 of the derivation)::

        (1 - nu)/(1 + nu) X

    Parameters
    ----------
    a : array_like
        contact radius [m]; 0 <= a <= 0.9 b
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
        change of delta R/a^2 [1] in the arguments' broadcast shape;
        NaN outside the domain.

    Examples
    --------
    >>> from generated import supported_edge
    >>> print(f"{supported_edge(1e-4, 0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    0.894198
    """
    return _supported(a, h, b, lam, mu, INDENTATION)


@in_manifest(
    "",
    equation="6",
    domain="a >= 0, a <= 0.9 * b, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "3 * lam > -2 * mu, mu > 0",
)
@quiet
def clamped_edge(
    a: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute the change of delta R/a^2 due to a clamped edge, which is stiffer than the paper's.

    Formula (step 19 of the derivation)::

        -X_c

    Parameters
    ----------
    a : array_like
        contact radius [m]; 0 <= a <= 0.9 b
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
        change of delta R/a^2 [1] in the arguments' broadcast shape;
        NaN outside the domain.

    Examples
    --------
    >>> from generated import clamped_edge
    >>> print(f"{clamped_edge(1e-4, 0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    -1.39871
    """
    kind, alpha, eta, n, _ = edge_ratios(a, h, b, lam, mu, WIDEST)
    return as_result(kernels.of_clamp(alpha, eta, n), kind)


@in_manifest(
    "",
    equation="6",
    domain="a >= 0, a <= 0.9 * b, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "3 * lam > -2 * mu, mu > 0",
)
@quiet
def supported_edge_slope(
    a: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute the change of (R/2a) d delta/da due to a simple support instead of the paper's edge.

    Formula (step 19 of the derivation)::

        (1 - nu)/(1 + nu) (X + a X'/2)

    Parameters
    ----------
    a : array_like
        contact radius [m]; 0 <= a <= 0.9 b
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
        change of (R/2a) d delta/da [1] in the arguments' broadcast shape;
        NaN outside the domain.

    Examples
    --------
    >>> from generated import supported_edge_slope
    >>> print(f"{supported_edge_slope(1e-4, 0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    1.3413
    """
    return _supported(a, h, b, lam, mu, SLOPE)


@in_manifest(
    "",
    equation="6",
    domain="a >= 0, a <= 0.9 * b, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "3 * lam > -2 * mu, mu > 0",
)
@quiet
def clamped_edge_slope(
    a: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute the change of (R/2a) d delta/da due to a clamped edge instead of the paper's edge.

    Formula (step 19 of the derivation)::

        -(X_c + a X_c'/2)

    Parameters
    ----------
    a : array_like
        contact radius [m]; 0 <= a <= 0.9 b
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
        change of (R/2a) d delta/da [1] in the arguments' broadcast shape;
        NaN outside the domain.

    Examples
    --------
    >>> from generated import clamped_edge_slope
    >>> print(f"{clamped_edge_slope(1e-4, 0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    -2.09806
    """
    kind, alpha, eta, n, _ = edge_ratios(a, h, b, lam, mu, WIDEST)
    return as_result(kernels.slope_of_clamp(alpha, eta, n), kind)


@in_manifest(
    "",
    equation="6",
    domain="a >= 0, a <= b, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, 3 * lam > -2 * mu, mu > 0",
)
@quiet
def supported_edge_bound(
    a: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute a bound of the change by `supported_edge_slope` for all contact radii up to a.

    Formula (step 19 of the derivation)::

        (1 - nu)/(1 + nu) (3 alpha/(2 pi)) [|1 - 2 n eta^2|/eta^3 (1/8 + 2 eta |n| s) + (8/3) n^2 s]
        s exceeds sum 1/(j^2 |J1|) by less than 0.001

    Parameters
    ----------
    a : array_like
        contact radius [m]; 0 <= a <= b
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
        bound of the magnitude, without rounding errors [1], in the arguments' broadcast
        shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import supported_edge_bound
    >>> print(f"{supported_edge_bound(1e-4, 0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    1.45912
    """
    kind, *plate = edge_ratios(a, h, b, lam, mu, 1.0)
    return as_result(kernels.support_bound(*plate), kind)


@in_manifest(
    "",
    equation="6",
    domain="a >= 0, a <= b, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, 3 * lam > -2 * mu, mu > 0",
)
@quiet
def clamped_edge_bound(
    a: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute a bound of the change by `clamped_edge_slope` for all contact radii up to a.

    Formula (step 19 of the derivation)::

        (3 alpha/(16 pi eta^3)) [(1 - s)^2 + 2 chi eta + eta^3/5 + (16/3) n^2 eta^4
                                 + (|1 - s| - (1 - s))/3]

    Parameters
    ----------
    a : array_like
        contact radius [m]; 0 <= a <= b
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
        bound of the magnitude, without rounding errors [1], in the arguments' broadcast
        shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import clamped_edge_bound
    >>> print(f"{clamped_edge_bound(1e-4, 0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    2.09807
    """
    kind, alpha, eta, n, _ = edge_ratios(a, h, b, lam, mu, 1.0)
    return as_result(kernels.clamp_bound(alpha, eta, n), kind)


def _supported(
    a: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike, kernel: SummedKernel
) -> np.ndarray:
    """Return the correction for a simple support from the sums of the kernel."""
    kind, alpha, eta, n, support = edge_ratios(a, h, b, lam, mu, WIDEST)
    sums = edge_sums(alpha, eta, n, kernel)
    return as_result(kernels.of_support(alpha, eta, n, support, *sums), kind)
