"""Inertia of the plate: the lowest bending branch A0, and the response to an oscillating load.

One mode of a plate of half-thickness h moves with w = f(z) J0(phi r) cos(omega t). With
x = phi h, kap = (omega h/c_T)^2, gam = mu/(lam + 2 mu) = (1 - 2 nu)/(2 (1 - nu)), c_T^2 = mu/rho,
p^2 = x^2 - gam kap and q^2 = x^2 - kap, its influence coefficient at the contact face is::

    w(+h)/A = (h/mu) (1/Ba + 1/Bs)
    Ba = -(2/kap) [(2 x^2 - kap)^2 tanh(p)/p - 4 x^2 q tanh(q)]      bending, w even in z
    Bs = -(2/kap) [(2 x^2 - kap)^2 coth(p)/p - 4 x^2 q coth(q)]      extension, w odd in z

For kap below x^2 these forms cancel. With shc y = sinh(y)/y, S = p + q, d = p - q they become::

    Ba = 2 [8 x^2 q^2 (1 - gam) F/(cosh p cosh q) - kap tanh(p)/p],  F = (shc S - shc d)/(S^2 - d^2)
    Bs = (2/p^2) [2 x^2 (1 - gam) (shc S + shc d)/(shc p shc q) - kap p coth p]

The lowest bending branch A0 is the only zero of Ba below x^2. With kap = xi x^2, the ratio of the
two terms of Ba decreases as xi grows; Newton's method finds where it equals 1.

Arithmetic: starting value and steps of Newton's method; the quotient for short waves, computed in
twice the precision by error-free transformations.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from generated import wave_kernels as kernels
from generated.arrays import Double, as_doubles, as_result, in_manifest, inside, quiet
from generated.blocks import polynomial
from generated.ranges import rounding_error
from generated.wave_numbers import RAYLEIGH, SHALLOW, SMALL, STEPS


class _Wave(NamedTuple):
    """A wave number, Poisson's ratio, and a trial frequency for A0.

    Attributes
    ----------
    x, nu, gam, rest
        rest is 1 - gam.
    slope, xi
        kap divided by x^4 and by x^2.
    left
        1 - xi, including the rounding error of xi.
    P, Q
        p/x and q/x.
    """

    x: Double
    nu: Double
    gam: Double
    rest: Double
    slope: Double
    xi: Double
    left: Double
    P: Double
    Q: Double


class _Balance(NamedTuple):
    """Both terms of Ba.

    Attributes
    ----------
    excess
        First term divided by the second, minus 1.
    steep
        The slope of the logarithm of that ratio with respect to log kap is -steep/(1 - xi).
    """

    excess: Double
    steep: Double


@in_manifest(r"\omega_0 h/c_T", domain="x >= 1e-90, x <= 1e90, nu > -1, nu < 0.5")
@quiet
def bending_frequency(x: ArrayLike, nu: ArrayLike) -> np.ndarray:
    """Compute the frequency omega h/c_T of the lowest bending branch A0 of a free plate.

    Formula (Rayleigh, 1888; Lamb, 1917)::

        Omega = sqrt(kap),   Ba(kap) = 0,   0 < kap < x^2
        Omega -> x^2 sqrt(2/(3 (1 - nu))) = phi^2 sqrt(D/(rho H)) h/c_T for x -> 0

    Parameters
    ----------
    x : array_like
        Wave number times half-thickness, phi h [1]; 1e-90 <= x <= 1e90.
    nu : array_like
        Poisson's ratio [1]; -1 < nu < 0.5.

    Returns
    -------
    float or ndarray
        Frequency in units of c_T/h [1] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import bending_frequency
    >>> print(f"{bending_frequency(0.1, 0.22):.6g}")
    0.00918467
    """
    return _evaluated(x, nu, (_frequency, _frequency))


@in_manifest(r"\rho h\,r_0", domain="x >= 1e-90, x <= 1e90, nu > -1, nu < 0.5")
@quiet
def bending_residue(x: ArrayLike, nu: ArrayLike) -> np.ndarray:
    """Compute the modal residue rho h r of A0, q'' + omega^2 q = r A for its part q of w(+h).

    Formula (step 27 of the derivation)::

        rho h r = -1/Ba'(kap) at Ba(kap) = 0
        rho h r -> 1/2, r -> 1/(rho H), for x -> 0

    Parameters
    ----------
    x : array_like
        Wave number times half-thickness, phi h [1]; 1e-90 <= x <= 1e90.
    nu : array_like
        Poisson's ratio [1]; -1 < nu < 0.5.

    Returns
    -------
    float or ndarray
        Residue rho h r [1] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import bending_residue
    >>> print(f"{bending_residue(0.1, 0.22):.6g}")
    0.497446
    """
    return _evaluated(x, nu, (_shallow_residue, _deep_residue))


@in_manifest("s_0", domain="x >= 1e-90, x <= 1e90, nu > -1, nu < 0.5")
@quiet
def bending_fraction(x: ArrayLike, nu: ArrayLike) -> np.ndarray:
    """Compute the fraction of the static contact-face deflection that belongs to A0.

    Formula (step 27 of the derivation)::

        (rho h r/kap)/(mu C/h),   C = 2 G(2 x)/(E* phi) = (h/mu) (1/Ba + 1/Bs) at kap = 0
        1 for x -> 0; the remaining fraction belongs to all other branches

    Parameters
    ----------
    x : array_like
        Wave number times half-thickness, phi h [1]; 1e-90 <= x <= 1e90.
    nu : array_like
        Poisson's ratio [1]; -1 < nu < 0.5.

    Returns
    -------
    float or ndarray
        Fraction [1] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import bending_fraction
    >>> print(f"{bending_fraction(0.1, 0.22):.6g}")
    0.999957
    """
    return _evaluated(x, nu, (_shallow_fraction, _deep_fraction))


def _evaluated(
    x: ArrayLike, nu: ArrayLike, values: tuple[Callable[[_Wave, _Balance], Double], ...]
) -> np.ndarray:
    """Apply one function to A0 at small x and another one at all other x."""
    kind, [x, nu] = as_doubles(x, nu)
    [x] = inside([x], x >= 1e-90, x <= 1e90)
    [nu] = inside([nu], nu > -1, nu < 0.5)
    shape = np.broadcast_shapes(x.shape, nu.shape)
    numbers, ratios = (np.ravel(np.broadcast_to(y, shape)) for y in (x, nu))
    result, shallow = np.full(numbers.shape, np.nan), numbers < SHALLOW
    known = ~np.isnan(numbers + ratios)
    for chosen, balance, value in ((shallow, _shallow, values[0]), (~shallow, _deep, values[1])):
        part = chosen & known
        if part.any():
            wave = _lowest(numbers[part], ratios[part], balance)
            result[part] = value(wave, balance(wave))
    return as_result(result.reshape(shape), kind)


# --- the lowest bending branch


def _wave(x: Double, nu: Double, slope: Double) -> _Wave:
    gam, rest = kernels.material(nu)
    return _Wave(x, nu, gam, rest, slope, *kernels.wave_ratios(x, gam, slope))


def _lowest(x: Double, nu: Double, balance: Callable[[_Wave], _Balance]) -> _Wave:
    """Return A0 by Newton's method, starting at 1/kap = 1/Rayleigh's + 1/thin plate's."""
    (gam, rest), square = kernels.material(nu), x * x
    slope = 1.0 / (square / polynomial(gam, *RAYLEIGH) + np.exp(-square / 16.0) * 0.75 / rest)
    for _ in range(STEPS):
        before = _wave(x, nu, slope)
        excess, steep = balance(before)
        change = excess / (1.0 + (1.0 + excess) * (steep / before.left - 1.0))
        slope = slope * (1.0 + change)
    after = _wave(x, nu, slope)
    left = before.left - before.xi * change
    return after._replace(left=left, Q=np.sqrt(left))


def _frequency(wave: _Wave, _: _Balance) -> Double:
    value: Double = wave.x * (wave.x * np.sqrt(wave.slope))
    return value


def _shallow_fraction(wave: _Wave, balance: _Balance) -> Double:
    x, _, gam, rest, _, xi, _, P, Q = wave
    unlike = kernels.unlike(x)
    near_one = kernels.fraction_near_one(x, gam, rest, xi, P, Q, balance.steep, unlike)
    return np.where(x < SMALL, near_one, _fraction_beyond(wave, balance, 4.0 * P * Q))


def _deep_fraction(wave: _Wave, balance: _Balance) -> Double:
    product = kernels.deep_product(wave.x, wave.left, wave.P, wave.Q)
    return _fraction_beyond(wave, balance, product)


def _fraction_beyond(wave: _Wave, balance: _Balance, product: Double) -> Double:
    x, excess = wave.x, _less_than_one(wave)
    unlike = kernels.unlike(x)
    return kernels.fraction_beyond(x, wave.left, wave.Q, balance.steep, unlike, excess, product)


def _shallow(wave: _Wave) -> _Balance:
    x, _, gam, rest, slope, xi, left, P, Q = wave
    return _Balance(*kernels.shallow(x, gam, rest, slope, xi, left, P, Q))


def _shallow_residue(wave: _Wave, balance: _Balance) -> Double:
    return kernels.shallow_residue(wave.x, wave.left, wave.P, balance.steep)


def _deep_residue(wave: _Wave, balance: _Balance) -> Double:
    return kernels.deep_residue(wave.x, wave.left, wave.Q, balance.steep)


def _deep(wave: _Wave) -> _Balance:
    """Return the quotient with exponentials separated; `steep` is accurate at the zero only."""
    x, _, gam, _, _, xi, left, P, Q = wave
    short = _rayleigh(wave.nu, xi, left)
    excess = kernels.deep_excess(x, P, *short, _less_than_one(wave))
    return _Balance(excess, kernels.deep_steepness(x, gam, xi, left, P, Q))


def _less_than_one(wave: _Wave) -> Double:
    return kernels.less_than_one(wave.x, wave.rest, wave.xi, wave.P, wave.Q)


def _rayleigh(nu: Double, xi: Double, left: Double) -> tuple[Double, Double, Double]:
    """Return 2 Q, (1 - nu) xi (P + Q) and their difference, as in twice the working precision."""
    ratio = 1.0 - nu
    ratio_rest, left_rest = (1.0 - ratio) - nu, (1.0 - left) - xi
    Q = np.sqrt(left)
    Q_rest = 0.5 * ((left - Q * Q) - rounding_error(Q, Q) + left_rest) / Q
    # P^2 = 1 - xi + xi/(2 (1 - nu))
    added = 0.5 * xi / ratio
    added_rest = (
        (0.5 * xi - added * ratio) - rounding_error(added, ratio) - added * ratio_rest
    ) / ratio
    square = left + added
    inner = square - left
    square_rest = (left - (square - inner)) + (added - inner) + added_rest + left_rest
    P = np.sqrt(square)
    P_rest = 0.5 * ((square - P * P) - rounding_error(P, P) + square_rest) / P
    S = P + Q
    S_rest = (P - S) + Q + P_rest + Q_rest
    speed = ratio * xi
    speed_rest = rounding_error(ratio, xi) + ratio_rest * xi
    second = speed * S
    rest = rounding_error(speed, S) + speed_rest * S + speed * S_rest
    return 2.0 * Q, second, (2.0 * Q - second) + (2.0 * Q_rest - rest)


# --- any frequency


@in_manifest(
    "1/B_a, 1/B_s", domain="x >= 1e-40, x <= 1e40, kap >= 0, kap <= 1e80, nu > -1, nu < 0.5"
)
@quiet
def dynamic_influence(x: ArrayLike, kap: ArrayLike, nu: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Compute the contact-face deflection due to a load of one wave number and frequency.

    Formula (step 26 of the derivation)::

        w(+h)/A = (h/mu) (1/Ba + 1/Bs)

    Parameters
    ----------
    x : array_like
        Wave number times half-thickness, phi h [1]; 1e-40 <= x <= 1e40.
    kap : array_like
        (omega h/c_T)^2 [1]; 0 <= kap <= 1e80, 0 for a static load.
    nu : array_like
        Poisson's ratio [1]; -1 < nu < 0.5.

    Returns
    -------
    tuple of float or ndarray
        1/Ba and 1/Bs [1], bending and extension, each in the arguments' broadcast shape; NaN
        outside the domain.

    Examples
    --------
    >>> from generated import dynamic_influence
    >>> bending, extension = dynamic_influence(0.1, 0.01, 0.22)
    >>> print(f"{bending:.6g} {extension:.6g}")
    -50.1068 0.205198
    """
    kind, [x, kap, nu] = as_doubles(x, kap, nu)
    [x] = inside([x], x >= 1e-40, x <= 1e40)
    [kap] = inside([kap], kap >= 0, kap <= 1e80)
    [nu] = inside([nu], nu > -1, nu < 0.5)
    shape = np.broadcast_shapes(x.shape, kap.shape, nu.shape)
    wave, load, ratio = (np.ravel(np.broadcast_to(y, shape)) for y in (x, kap, nu))
    gam, rest = kernels.material(ratio)
    bending, stretching = np.full(wave.shape, np.nan), np.full(wave.shape, np.nan)
    slow = load <= wave * wave
    for chosen, terms in ((slow, kernels.slow), (load > wave * wave, kernels.fast)):
        if chosen.any():
            part = (y[chosen] for y in (wave, load, gam, rest))
            bending[chosen], stretching[chosen] = terms(*part)
    return as_result(bending.reshape(shape), kind), as_result(stretching.reshape(shape), kind)
