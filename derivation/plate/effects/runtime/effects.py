"""Contributions of single effects to the contact law, and parameters that show when they matter.

`depth` and `slope` are contributions to F and S at equal force, a being the Hertz contact radius::

    delta = (a^2/R) (1 + F),   d delta/da = (2a/R) S

Arithmetic: the power series of the finite radius, whose coefficients are computed in advance.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from generated import effect_kernels as kernels
from generated.arrays import as_doubles, as_result, in_manifest, inside, quiet
from generated.blocks import polynomial
from generated.effect_numbers import LATERAL_DEPTH, LATERAL_SLOPE


class Sphere(NamedTuple):
    """Ratios of a sphere on a half-space to Hertz's paraboloid at equal contact radius.

    Attributes
    ----------
    force
        Ratio of the forces [1].
    depth
        Ratio of the indentations [1].
    slope
        Ratio of d delta/da [1].
    """

    force: np.ndarray
    depth: np.ndarray
    slope: np.ndarray


class Contribution(NamedTuple):
    """Contribution of an effect to the reduced indentation and to its slope.

    Attributes
    ----------
    depth
        Contribution to F = delta R/a^2 - 1 [1].
    slope
        Contribution to S = (R/2a) d delta/da [1].
    """

    depth: np.ndarray
    slope: np.ndarray


@in_manifest("", equation="7", domain="a_over_R >= 0, a_over_R < 1")
@quiet
def sphere_contact(a_over_R: ArrayLike) -> Sphere:
    """Compute force, indentation and slope of a spherical profile relative to a paraboloid.

    Formula (Sneddon, 1965), x = a/R::

        force = (3/4) [(1 + x^2)/2 log((1+x)/(1-x)) - x]/x^3
        depth = log((1+x)/(1-x))/(2x),   slope = (depth + 1/(1 - x^2))/2

    Parameters
    ----------
    a_over_R : array_like
        contact radius over sphere radius, a/R [1]; 0 <= a/R < 1

    Returns
    -------
    Sphere
        P/((4/3) E* a^3/R), delta R/a^2 and (R/2a) d delta/da [1], in the shape of the
        argument, a being the actual contact radius; NaN outside the domain.

    Examples
    --------
    >>> from generated import sphere_contact
    >>> print(f"{sphere_contact(0.5).force:.6g}")
    1.1198
    """
    kind, [a_over_R] = as_doubles(a_over_R)
    [a_over_R] = inside([a_over_R], a_over_R >= 0, a_over_R < 1)
    values = kernels.sphere_over_paraboloid(a_over_R)
    return Sphere(*(as_result(x, kind) for x in values))


@in_manifest("W", equation="6", domain="alpha >= 0, alpha < 1")
@quiet
def finite_radius(alpha: ArrayLike) -> Contribution:
    """Compute the effect of the plate's finite radius for Hertz pressure and the paper's edge.

    Formula::

        F = -(8/pi^2) sum_(k>=2) kappa_(2k-4) (2k-2)/(2k-1)! alpha^(2k-3)

    Parameters
    ----------
    alpha : array_like
        contact radius over plate radius, a/b [1]; 0 <= a/b < 1

    Returns
    -------
    Contribution
        Contributions to F and S [1], both negative, in the shape of the argument; NaN outside
        the domain.

    Examples
    --------
    >>> from generated import finite_radius
    >>> print(f"{finite_radius(0.1).depth:.6g}")
    -0.0369707
    """
    kind, [alpha] = as_doubles(alpha)
    [alpha] = inside([alpha], alpha >= 0, alpha < 1)
    square = alpha * alpha
    depth, slope = (-alpha * polynomial(square, *row) for row in (LATERAL_DEPTH, LATERAL_SLOPE))
    return Contribution(as_result(depth, kind), as_result(slope, kind))


@in_manifest("F_B", equation="6", domain="a_ratio >= 0, eta > 0")
@quiet
def bending(a_ratio: ArrayLike, eta: ArrayLike) -> Contribution:
    """Compute the effect of thin-plate bending, P b^2/(8 pi D), for the paper's edge.

    Formula::

        F = a_ratio/(4 pi eta^2),   S = (3/2) F

    Parameters
    ----------
    a_ratio : array_like
        contact radius over half-thickness, a/h [1]; a/h >= 0
    eta : array_like
        half-thickness over plate radius, h/b [1]; h/b > 0

    Returns
    -------
    Contribution
        Contributions to F and S [1], in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import bending
    >>> print(f"{bending(0.1, 0.03).depth:.6g}")
    8.84194
    """
    kind, [a_ratio, eta] = as_doubles(a_ratio, eta)
    [a_ratio, eta] = inside([a_ratio, eta], a_ratio >= 0, eta > 0)
    return Contribution(*(as_result(x, kind) for x in kernels.bent_plate(a_ratio, eta)))


@in_manifest(r"\lambda_Z", domain="R > 0, m > 0, v0 > 0, h > 0, 3 * lam > -2 * mu, mu > 0, rho > 0")
@quiet
def zener_number(
    R: ArrayLike,
    m: ArrayLike,
    v0: ArrayLike,
    h: ArrayLike,
    lam: ArrayLike,
    mu: ArrayLike,
    rho: ArrayLike,
) -> np.ndarray:
    """Compute Zener's inelasticity parameter, a measure of the energy radiated as bending waves.

    Formula (Zener, 1941), H = 2h, D = E* H^3/12 and E* = E/(1 - nu^2) of the plate::

        zener_number = m/(8 T sqrt(D rho H)),   T^5 = m^2/(K^2 v0),   K = (4/3) E* sqrt(R)

    Parameters
    ----------
    R, h : array_like
        sphere radius and half the plate's thickness [m]; above 0
    m : array_like
        sphere mass [kg]; m > 0
    v0 : array_like
        impact speed of the sphere [m/s]; v0 > 0
    lam, mu : array_like
        Lame constants of the plate [Pa]; mu > 0, 3 lam > -2 mu
    rho : array_like
        density of the plate [kg/m^3]; rho > 0

    Returns
    -------
    float or ndarray
        Inelasticity parameter lambda [1] in the arguments' broadcast shape; NaN outside the
        domain. Inertia of the plate is usually negligible below 0.006.

    Examples
    --------
    >>> from generated import zener_number
    >>> print(f"{zener_number(0.01, 0.0327, 2.0, 0.004, 22.5e9, 28.7e9, 2500.0):.6g}")
    0.730456
    """
    kind, [R, m, v0, h, lam, mu, rho] = as_doubles(R, m, v0, h, lam, mu, rho)
    [R, m, v0] = inside([R, m, v0], R > 0, m > 0, v0 > 0)
    [h, lam, mu, rho] = inside([h, lam, mu, rho], h > 0, mu > 0, 3 * lam > -2 * mu, rho > 0)
    return as_result(kernels.zener_number_of_factors(R, m, v0, h, lam, mu, rho), kind)


@in_manifest("T_1", domain="h > 0, b > 0, 3 * lam > -2 * mu, mu > 0, rho > 0")
@quiet
def bending_period(
    h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike, rho: ArrayLike
) -> np.ndarray:
    """Compute the first bending period of the plate with the paper's edge.

    Formula (step 23 of the derivation), H = 2h, D = E* H^3/12, E* = E/(1 - nu^2)::

        bending_period = (2 pi b^2/j_1^2) sqrt(rho H/D)

    Parameters
    ----------
    h, b : array_like
        half the plate's thickness and its radius [m]; above 0
    lam, mu : array_like
        Lame constants of the plate [Pa]; mu > 0, 3 lam > -2 mu
    rho : array_like
        density of the plate [kg/m^3]; rho > 0

    Returns
    -------
    float or ndarray
        Period [s] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import bending_period
    >>> print(f"{bending_period(0.004, 0.15, 22.5e9, 28.7e9, 2500.0):.6g}")
    0.00195134
    """
    kind, [h, b, lam, mu, rho] = as_doubles(h, b, lam, mu, rho)
    [h, b, lam, mu, rho] = inside(
        [h, b, lam, mu, rho], h > 0, b > 0, mu > 0, 3 * lam > -2 * mu, rho > 0
    )
    return as_result(kernels.bending_period_of_factors(h, b, lam, mu, rho), kind)


@in_manifest("T_e", domain="h > 0, 3 * lam > -2 * mu, mu > 0, rho > 0")
@quiet
def echo_time(h: ArrayLike, lam: ArrayLike, mu: ArrayLike, rho: ArrayLike) -> np.ndarray:
    """Compute the time of two round trips of a pressure wave through the thickness.

    Formula (step 23 of the derivation), H = 2h::

        echo_time = 4 H/sqrt((lam + 2 mu)/rho)

    Parameters
    ----------
    h : array_like
        half the plate's thickness [m]; above 0
    lam, mu : array_like
        Lame constants of the plate [Pa]; mu > 0, 3 lam > -2 mu
    rho : array_like
        density of the plate [kg/m^3]; rho > 0

    Returns
    -------
    float or ndarray
        Time [s] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import echo_time
    >>> print(f"{echo_time(0.004, 22.5e9, 28.7e9, 2500.0):.6g}")
    5.66039e-06
    """
    kind, [h, lam, mu, rho] = as_doubles(h, lam, mu, rho)
    [h, lam, mu, rho] = inside([h, lam, mu, rho], h > 0, mu > 0, 3 * lam > -2 * mu, rho > 0)
    return as_result(kernels.echo_time_of_factors(h, lam, mu, rho), kind)
