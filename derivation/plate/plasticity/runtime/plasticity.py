"""Elastic-plastic contact: onset of yield, plastic indentation, and residual indentation.

Arithmetic: limits of the domain.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from generated import plasticity_kernels as kernels
from generated.arrays import as_doubles, as_result, in_manifest, inside, quiet


@in_manifest("a_y", domain="R > 0, 3 * lam > -2 * mu, mu > 0, yield_stress > 0")
@quiet
def yield_radius(
    R: ArrayLike, lam: ArrayLike, mu: ArrayLike, yield_stress: ArrayLike
) -> np.ndarray:
    """Compute the contact radius at the onset of yield.

    Formula (Johnson, 1985)::

        a_y = pi p_y R/(2 E*),   p_y = 1.6 Y

    Parameters
    ----------
    R : array_like
        sphere radius [m]; R > 0
    lam, mu : array_like
        Lame constants of the plate [Pa]; mu > 0, 3 lam > -2 mu
    yield_stress : array_like
        smaller yield stress of the two bodies [Pa]; yield_stress > 0

    Returns
    -------
    float or ndarray
        Contact radius [m] for a rigid sphere, in the arguments' broadcast shape; NaN outside
        the domain. It is proportional to 1/E*.

    Examples
    --------
    >>> from generated import yield_radius
    >>> print(f"{yield_radius(0.01, 115e9, 77e9, 300e6):.6g}")
    3.42974e-05
    """
    kind, [R, lam, mu, yield_stress] = as_doubles(R, lam, mu, yield_stress)
    [R, lam, mu] = inside([R, lam, mu], R > 0, mu > 0, 3 * lam > -2 * mu)
    [yield_stress] = inside([yield_stress], yield_stress > 0)
    return as_result(kernels.yield_radius_of_factors(R, lam, mu, yield_stress), kind)


@in_manifest("v_y", domain="R > 0, m > 0, 3 * lam > -2 * mu, mu > 0, yield_stress > 0")
@quiet
def yield_speed(
    R: ArrayLike, m: ArrayLike, lam: ArrayLike, mu: ArrayLike, yield_stress: ArrayLike
) -> np.ndarray:
    """Compute the impact speed at the onset of yield for a half-space.

    Formula (Thornton, 1997)::

        v_y = (pi p_y/(2 E*))^2 sqrt(8 pi p_y R^3/(15 m)),   p_y = 1.6 Y

    Parameters
    ----------
    R : array_like
        sphere radius [m]; R > 0
    m : array_like
        sphere mass [kg]; m > 0
    lam, mu : array_like
        Lame constants of the half-space [Pa]; mu > 0, 3 lam > -2 mu
    yield_stress : array_like
        smaller yield stress of the two bodies [Pa]; yield_stress > 0

    Returns
    -------
    float or ndarray
        Impact speed [m/s] for a rigid sphere, in the arguments' broadcast shape; NaN outside
        the domain. It is proportional to 1/E*^2.

    Examples
    --------
    >>> from generated import yield_speed
    >>> print(f"{yield_speed(0.01, 0.0327, 115e9, 77e9, 300e6):.6g}")
    0.00184478
    """
    kind, [R, m, lam, mu, yield_stress] = as_doubles(R, m, lam, mu, yield_stress)
    [R, m] = inside([R, m], R > 0, m > 0)
    [lam, mu, yield_stress] = inside(
        [lam, mu, yield_stress], mu > 0, 3 * lam > -2 * mu, yield_stress > 0
    )
    return as_result(kernels.yield_speed_of_factors(R, m, lam, mu, yield_stress), kind)


@in_manifest("Delta", domain="xi_y >= 1, xi_y <= 1e50")
@quiet
def plastic_indentation(xi_y: ArrayLike) -> np.ndarray:
    """Compute the plastic part of the indentation during loading, divided by a_y^2/R.

    Formula (Thornton, 1997)::

        (2 xi^3 + 1)/3 - xi^2

    Parameters
    ----------
    xi_y : array_like
        Hertz contact radius of the force divided by the yield radius [1]; 1 <= xi_y <= 1e50

    Returns
    -------
    float or ndarray
        Plastic part of the indentation at this force [1], in the shape of the argument; NaN
        outside the domain.

    Examples
    --------
    >>> from generated import plastic_indentation
    >>> print(f"{plastic_indentation(2.0):.6g}")
    1.66667
    """
    kind, [xi_y] = as_doubles(xi_y)
    [xi_y] = _yielding(xi_y)
    return as_result(kernels.loaded(xi_y)[0], kind)


@in_manifest("c", domain="xi_y >= 1, xi_y <= 1e50")
@quiet
def flattening(xi_y: ArrayLike) -> np.ndarray:
    """Compute the Hertz radius of the peak force divided by the actual contact radius.

    Formula (Thornton, 1997)::

        c = xi/sqrt((2 xi^3 + 1)/3),   flattened radius R_p = R/c^3

    Parameters
    ----------
    xi_y : array_like
        Hertz contact radius of the peak force divided by the yield radius [1]; 1 <= xi_y <= 1e50

    Returns
    -------
    float or ndarray
        Ratio at the beginning of unloading [1], in the shape of the argument; NaN outside the
        domain.

    Examples
    --------
    >>> from generated import flattening
    >>> print(f"{flattening(2.0):.6g}")
    0.840168
    """
    kind, [xi_y] = as_doubles(xi_y)
    [xi_y] = _yielding(xi_y)
    return as_result(kernels.unloaded(xi_y)[0], kind)


@in_manifest("delta_p", domain="xi_y >= 1, xi_y <= 1e50")
@quiet
def dent(xi_y: ArrayLike) -> np.ndarray:
    """Compute the residual indentation divided by a_y^2/R.

    Formula (Thornton, 1997)::

        delta_p = (2 xi^3 + 1)/3 (1 - c^3),   c = xi/sqrt((2 xi^3 + 1)/3)

    Parameters
    ----------
    xi_y : array_like
        Hertz contact radius of the peak force divided by the yield radius [1]; 1 <= xi_y <= 1e50

    Returns
    -------
    float or ndarray
        Residual indentation [1] in the shape of the argument; NaN outside the domain.

    Examples
    --------
    >>> from generated import dent
    >>> print(f"{dent(2.0):.6g}")
    2.30599
    """
    kind, [xi_y] = as_doubles(xi_y)
    [xi_y] = _yielding(xi_y)
    return as_result(kernels.unloaded(xi_y)[1], kind)


@in_manifest("W_p", domain="xi_y >= 1, xi_y <= 1e50")
@quiet
def plastic_work(xi_y: ArrayLike) -> np.ndarray:
    """Compute the plastic work divided by the elastic energy at the onset of yield.

    Formula (Thornton, 1997)::

        W_p = (5 xi^6 + 1)/6 - c xi^5,   c = xi/sqrt((2 xi^3 + 1)/3)

    Parameters
    ----------
    xi_y : array_like
        Hertz contact radius of the peak force divided by the yield radius [1]; 1 <= xi_y <= 1e50

    Returns
    -------
    float or ndarray
        Plastic work [1] in the shape of the argument; NaN outside the domain.

    Examples
    --------
    >>> from generated import plastic_work
    >>> print(f"{plastic_work(2.0):.6g}")
    26.6146
    """
    kind, [xi_y] = as_doubles(xi_y)
    [xi_y] = _yielding(xi_y)
    return as_result(kernels.worked(xi_y)[0], kind)


@in_manifest("e", domain="xi_y >= 1, xi_y <= 1e50")
@quiet
def plastic_restitution(xi_y: ArrayLike) -> np.ndarray:
    """Compute the coefficient of restitution of an elastic-plastic contact on a half-space.

    Formula (Thornton, 1997)::

        e^2 = 6 c xi^5/(5 xi^6 + 1),   c = xi/sqrt((2 xi^3 + 1)/3),   (5 xi^6 + 1)/6 = (v0/v_y)^2

    Parameters
    ----------
    xi_y : array_like
        Hertz contact radius of the peak force divided by the yield radius [1]; 1 <= xi_y <= 1e50

    Returns
    -------
    float or ndarray
        Coefficient of restitution [1] in the shape of the argument; NaN outside the domain.

    Examples
    --------
    >>> from generated import plastic_restitution
    >>> print(f"{plastic_restitution(2.0):.6g}")
    0.708894
    """
    kind, [xi_y] = as_doubles(xi_y)
    [xi_y] = _yielding(xi_y)
    return as_result(kernels.worked(xi_y)[1], kind)


def _yielding(xi_y: np.ndarray) -> list[np.ndarray]:
    return inside([xi_y], xi_y >= 1, xi_y <= 1e50)
