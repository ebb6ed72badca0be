"""Curvature under the contact by a simply supported or clamped edge, for `non_hertzian_pressure`.

The state of bending by which the edge differs from the paper's deflects the contact face by a
constant plus kappa P r^2/2: the sphere meets a profile of curvature 1/R + kappa P. The integral
equation has the additional terms N_s (t^2 + s^2 - 2 t^2 s^2/b^2)/h^3, N_s = 2 E* h^3 kappa, in its
kernel. With the notation of `edge`::

    N_s = -(3/pi) (1 - nu)/(1 + nu) sum (1 + 3 n - n Q)/(j^3 J1)   simply supported
    N_s = 3/(8 pi) (1 - s + 2 chi eta)                              clamped

Arithmetic: none.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from generated import edge_kernels as kernels
from generated.arrays import as_result, in_manifest, quiet
from generated.edge_numbers import WIDEST
from generated.edge_sums import INDENTATION, edge_ratios, edge_sums


@in_manifest(
    "",
    equation="",
    domain="h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, 3 * lam > -2 * mu, mu > 0",
)
@quiet
def supported_edge_curvature(
    h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute the term of the contact kernel due to a simple support instead of the paper's edge.

    Formula (step 20 of the derivation)::

        2 E* h^3 kappa,   1/R + kappa P = curvature of the profile that the sphere meets

    It is negative for a thin plate, which is more curved than with the paper's edge.

    Parameters
    ----------
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
        coefficient of (t^2 + s^2)/h^3 in the kernel [1], the argument `edge` of
        `non_hertzian_pressure.plate`, in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import supported_edge_curvature
    >>> print(f"{supported_edge_curvature(0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    -0.0763355
    """
    kind, centre, eta, n, support = edge_ratios(0.0, h, b, lam, mu, WIDEST)
    bending_part, _ = edge_sums(centre, eta, n, INDENTATION)
    return as_result(kernels.kernel_of_support(support, bending_part), kind)


@in_manifest(
    "",
    equation="",
    domain="h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, 3 * lam > -2 * mu, mu > 0",
)
@quiet
def clamped_edge_curvature(h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike) -> np.ndarray:
    """Compute the term of the contact kernel due to a clamped edge instead of the paper's edge.

    Formula (step 20 of the derivation)::

        2 E* h^3 kappa,   1/R + kappa P = curvature of the profile that the sphere meets

    It is positive for a thin plate, which is less curved than with the paper's edge.

    Parameters
    ----------
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
        coefficient of (t^2 + s^2)/h^3 in the kernel [1], the argument `edge` of
        `non_hertzian_pressure.plate`, in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import clamped_edge_curvature
    >>> print(f"{clamped_edge_curvature(0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    0.119392
    """
    kind, _, eta, n, _ = edge_ratios(0.0, h, b, lam, mu, WIDEST)
    return as_result(kernels.kernel_of_clamp(eta, n), kind)
