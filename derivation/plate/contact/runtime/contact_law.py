"""Contact law of a sphere on an elastic plate: indentation, contact radius, force, stiffness.

For Hertz pressure on the contact radius a and the paper's edge condition, with A = a/h::

    delta = (a^2/R) (1 + F(A)),   P = 16 mu (lam + mu)/(3 (lam + 2 mu)) a^3/R

F is a set of polynomials for each plate, see `contact_series`. All arguments broadcast. For many
calls with the same plate use `prepared_plate`, which has the same functions.

Arithmetic: none.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from generated import contact_kernels as kernels
from generated.arrays import as_doubles, as_result, in_manifest, inside, quiet
from generated.contact_domain import elastic, modulus_factors
from generated.prepared_plate import prepare


@in_manifest(
    r"\delta",
    equation="6",
    domain="a >= 0, a < b, a < R, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "a <= 6 * h or h/b >= 1e-5",
)
def indentation(a: ArrayLike, R: ArrayLike, h: ArrayLike, b: ArrayLike) -> np.ndarray:
    """Compute the indentation for a given contact radius, plate deflection included.

    Formula::

        delta = (a^2/R) (1 + F),  F = c1 A + c3 A^3 + ... continued to all a < b

    Parameters
    ----------
    a : array_like
        Contact radius [m]; a >= 0, a < b, a < R; above 6 h slower and only for h/b >= 1e-5.
    R : array_like
        Sphere radius [m]; R > 0.
    h : array_like
        Half the plate's thickness [m]; h > 0.
    b : array_like
        Plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90.

    Returns
    -------
    float or ndarray
        delta [m] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import indentation
    >>> print(f"{indentation(1e-4, 0.01, 0.004, 0.15):.6g}")
    3.80959e-06
    """
    return prepare(h, b).indentation(a, R)


@in_manifest(
    "a",
    equation="6",
    domain="delta >= 0, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, a < R, a <= b, "
    "a <= 6 * h for the a that results",
)
def contact_radius(delta: ArrayLike, R: ArrayLike, h: ArrayLike, b: ArrayLike) -> np.ndarray:
    """Compute the contact radius for a given indentation.

    Newton's method is applied to the logarithm of the ratio of a to the Hertz contact radius. It
    starts at the smaller of 1 and the ratio of a thin plate, and stays in the polynomial's range.

    Parameters
    ----------
    delta : array_like
        Indentation [m]; from 0 to its value at a = min(b, 6 h), and such that a < R.
    R : array_like
        Sphere radius [m]; R > 0.
    h : array_like
        Half the plate's thickness [m]; h > 0.
    b : array_like
        Plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90.

    Returns
    -------
    float or ndarray
        a [m] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import contact_radius
    >>> print(f"{contact_radius(6e-6, 0.01, 0.004, 0.15):.6g}")
    0.000117939
    """
    return prepare(h, b).contact_radius(delta, R)


@in_manifest(
    "P",
    equation="10",
    domain="delta >= 0, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, 3 * lam > -2 * mu, "
    "mu > 0, a < R, a <= b, a <= 6 * h for the a that results",
)
def force(
    delta: ArrayLike, R: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute the contact force for a given indentation.

    Parameters
    ----------
    delta : array_like
        Indentation [m]; from 0 to its value at a = min(b, 6 h), and such that a < R.
    R : array_like
        Sphere radius [m]; R > 0.
    h : array_like
        Half the plate's thickness [m]; h > 0.
    b : array_like
        Plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90.
    lam : array_like
        First Lame constant [Pa]; 3 lam > -2 mu.
    mu : array_like
        Second Lame constant (shear modulus) [Pa]; mu > 0.

    Returns
    -------
    float or ndarray
        P [N] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import force
    >>> print(f"{force(6e-6, 0.01, 0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    16.0906
    """
    return prepare(h, b).force(delta, R, lam, mu)


@in_manifest("P", equation="7", domain="a >= 0, a < R, R > 0, 3 * lam > -2 * mu, mu > 0")
@quiet
def force_of_radius(a: ArrayLike, R: ArrayLike, lam: ArrayLike, mu: ArrayLike) -> np.ndarray:
    """Compute the contact force for a given contact radius.

    Formula::

        P = 16 mu (lam + mu)/(3 (lam + 2 mu)) a^3/R

    Parameters
    ----------
    a : array_like
        Contact radius [m]; a >= 0, a < R.
    R : array_like
        Sphere radius [m]; R > 0.
    lam : array_like
        First Lame constant [Pa]; 3 lam > -2 mu.
    mu : array_like
        Second Lame constant (shear modulus) [Pa]; mu > 0.

    Returns
    -------
    float or ndarray
        P [N] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import force_of_radius
    >>> print(f"{force_of_radius(1e-4, 0.01, 22.5e9, 28.7e9):.6g}")
    9.80853
    """
    kind, [a, R, lam, mu] = as_doubles(a, R, lam, mu)
    [a, R, lam, mu] = inside([a, R, lam, mu], a >= 0, a < R, R > 0, *elastic(lam, mu))
    return as_result(kernels.hertz_force(a, R, *modulus_factors(lam, mu)), kind)


@in_manifest(
    "a",
    equation="7",
    domain="P >= 0, R > 0, 3 * lam > -2 * mu, mu > 0, a < R for the a that results",
)
@quiet
def radius_of_force(P: ArrayLike, R: ArrayLike, lam: ArrayLike, mu: ArrayLike) -> np.ndarray:
    """Compute the contact radius for a given contact force.

    Formula::

        a = (3 (lam + 2 mu) P R/(16 mu (lam + mu)))^(1/3)

    Parameters
    ----------
    P : array_like
        Contact force [N]; P >= 0, such that a < R.
    R : array_like
        Sphere radius [m]; R > 0.
    lam : array_like
        First Lame constant [Pa]; 3 lam > -2 mu.
    mu : array_like
        Second Lame constant (shear modulus) [Pa]; mu > 0.

    Returns
    -------
    float or ndarray
        a [m] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import radius_of_force
    >>> print(f"{radius_of_force(10.0, 0.01, 22.5e9, 28.7e9):.6g}")
    0.000100647
    """
    kind, [P, R, lam, mu] = as_doubles(P, R, lam, mu)
    [P, R, lam, mu] = inside([P, R, lam, mu], P >= 0, R > 0, *elastic(lam, mu))
    a = kernels.hertz_radius(P, R, *modulus_factors(lam, mu))
    return as_result(inside([a], a < R)[0], kind)


@in_manifest(
    r"\mathrm{d}P/\mathrm{d}\delta",
    equation="10",
    domain="a >= 0, a < b, a < R, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "3 * lam > -2 * mu, mu > 0, a <= 6 * h or h/b >= 1e-5",
)
def stiffness(
    a: ArrayLike, R: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Compute the contact stiffness dP/d delta for a given contact radius.

    Formula::

        dP/d delta = 16 mu (lam + mu)/(lam + 2 mu) a/(2 (1 + F) + A F')

    Parameters
    ----------
    a : array_like
        Contact radius [m]; a >= 0, a < b, a < R; above 6 h slower and only for h/b >= 1e-5.
    R : array_like
        Sphere radius [m]; R > 0.
    h : array_like
        Half the plate's thickness [m]; h > 0.
    b : array_like
        Plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90.
    lam : array_like
        First Lame constant [Pa]; 3 lam > -2 mu.
    mu : array_like
        Second Lame constant (shear modulus) [Pa]; mu > 0.

    Returns
    -------
    float or ndarray
        dP/d delta [N/m] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import stiffness
    >>> print(f"{stiffness(1e-4, 0.01, 0.004, 0.15, 22.5e9, 28.7e9):.6g}")
    2.82158e+06
    """
    return prepare(h, b).stiffness(a, R, lam, mu)


@in_manifest("p_0", equation="7", domain="a >= 0, a < R, R > 0, 3 * lam > -2 * mu, mu > 0")
@quiet
def max_pressure(a: ArrayLike, R: ArrayLike, lam: ArrayLike, mu: ArrayLike) -> np.ndarray:
    """Compute the largest contact pressure, at the centre of the contact, as a positive number.

    Formula::

        p_0 = 3 P/(2 pi a^2) = 8 mu (lam + mu)/(pi (lam + 2 mu)) a/R

    Parameters
    ----------
    a : array_like
        Contact radius [m]; a >= 0, a < R.
    R : array_like
        Sphere radius [m]; R > 0.
    lam : array_like
        First Lame constant [Pa]; 3 lam > -2 mu.
    mu : array_like
        Second Lame constant (shear modulus) [Pa]; mu > 0.

    Returns
    -------
    float or ndarray
        p_0 [Pa] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import max_pressure
    >>> print(f"{max_pressure(1e-4, 0.01, 22.5e9, 28.7e9):.6g}")
    4.68323e+08
    """
    kind, [a, R, lam, mu] = as_doubles(a, R, lam, mu)
    [a, R, lam, mu] = inside([a, R, lam, mu], a >= 0, a < R, R > 0, *elastic(lam, mu))
    return as_result(kernels.largest_pressure(a, R, *modulus_factors(lam, mu)), kind)
