"""Bending modes of a circular plate of finite thickness with a clamped or supported edge.

With b = 1 a mode is J0(k r) - c I0(k2 r), c = J0(k)/I0(k2). Its frequency is that of the lowest
bending branch A0 at x = k h/b, kap = (omega h/c_T)^2; k2 belongs to Mindlin's evanescent wave::

    k2^2 = k^2 - (kap/eta^2) (1/k_s + (1 - nu)/2),   k_s = 5/(6 - nu),   eta = h/b
    g1 = 1 - kap/(k_s x^2),   g2 = 1 + kap/(k_s eta^2 k2^2)
    g1 k J1(k)/J0(k) + g2 k2 I1(k2)/I0(k2) = beta (k^2 + k2^2)
    beta = 1/(1 - nu) simply supported,   chi eta/(1 + chi eta) clamped

One root lies between neighbouring zeros of J0, for k below the cut-off k2 = 0 only. Newton's method
for J1 = q J0 finds it, with bisection where a step leaves the interval. The difference between the
root and the double nearest to it is taken into account in c and W. The first mode of a supported
plate has k = 0 at nu = -1; it is found from power series in -k^2 and k2^2.

I0, I1 and I2 come from Bessel's integral as a sum, or from their series at infinity.

Arithmetic: x = k eta; starting value, steps and intervals of Newton's method; a quadrature.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from generated import edge_mode_kernels as kernels
from generated.arrays import Double, quiet, whole
from generated.bessel import bessel_j0, bessel_j0_zeros, bessel_j1
from generated.edge_mode_numbers import NODES, WEIGHTS
from generated.inertia import bending_frequency, bending_residue

THINNEST, THICKEST = 1e-80, 0.5
"""Range of eta."""

_STEPS = 60  # largest number of steps of Newton's method and bisection; 5 to 8 are usual
_CLOSE = 2.0**-50  # relative step after which the next would be below rounding


class Waves(NamedTuple):
    """Modes w = J0(k r/b) - c I0(k2 r/b) of a clamped or supported plate, the lowest first.

    A force P at the centre of a plate of density rho moves the contact face there by q, where
    q'' + omega^2 q = residue weight P/(rho h b^2) and omega = root c_T/h.

    Attributes
    ----------
    k
        Wave number times plate radius b [1].
    root
        omega h/c_T [1].
    k2
        Wave number of the evanescent part I0, times b [1].
    c
        Amplitude of the evanescent part I0 [1].
    t
        Ratio of contact-face to mean deflection, of I0 relative to J0 [1].
    weight
        Modal weight W [1].
    residue
        rho h r of the branch A0 at x = k h/b [1].
    """

    k: np.ndarray
    root: np.ndarray
    k2: np.ndarray
    c: np.ndarray
    t: np.ndarray
    weight: np.ndarray
    residue: np.ndarray


@quiet
def clamped_waves(count: int, eta: float, nu: float) -> Waves:
    """Compute the modes of a clamped circular plate of finite thickness, below the cut-off.

    Formula::

        g1 k J1(k)/J0(k) + g2 k2 I1(k2)/I0(k2) = beta (k^2 + k2^2),   beta = chi eta/(1 + chi eta)
        W = (1 - c t)^2 (1 + (eta^2/3) g1^2 k^2)/(2 pi N)

    Parameters
    ----------
    count : int
        largest number of modes, the lowest first [1]; count >= 0
    eta : float
        half-thickness over radius h/b [1]; 1e-80 <= eta <= 0.5
    nu : float
        Poisson's ratio [1]; -1 < nu < 0.5

    Returns
    -------
    Waves
        seven arrays [1] of one length: the count, or the number of modes below the cut-off if
        that is smaller. c is 0 where it underflows. The n-th k lies between the n-th zero of J0
        and the next zero.

    Raises
    ------
    ValueError
        If an argument is outside its range.

    Examples
    --------
    >>> from generated.edge_modes import clamped_waves
    >>> print(clamped_waves(3, 0.03, 0.22).k.round(4))
    [3.1926 6.2878 9.3957]
    """
    count, size, ratio = _given(count, eta, nu)
    return _below_cutoff(count, size, ratio, kernels.clamp(size, ratio))


@quiet
def supported_waves(count: int, eta: float, nu: float) -> Waves:
    """Compute the modes of a supported circular plate of finite thickness, below the cut-off.

    Formula::

        g1 k J1(k)/J0(k) + g2 k2 I1(k2)/I0(k2) = beta (k^2 + k2^2),   beta = 1/(1 - nu)
        W = (1 - c t)^2 (1 + (eta^2/3) g1^2 k^2)/(2 pi N)

    Parameters
    ----------
    count : int
        largest number of modes, the lowest first [1]; count >= 0
    eta : float
        half-thickness over radius h/b [1]; 1e-80 <= eta <= 0.5
    nu : float
        Poisson's ratio [1]; -1 < nu < 0.5

    Returns
    -------
    Waves
        seven arrays [1] of one length: the count, or the number of modes below the cut-off if
        that is smaller. c is 0 where it underflows. The n-th k lies between the (n-1)-th zero
        of J0, or 0, and the n-th zero.

    Raises
    ------
    ValueError
        If an argument is outside its range.

    Examples
    --------
    >>> from generated.edge_modes import supported_waves
    >>> print(supported_waves(3, 0.03, 0.22).k.round(4))
    [2.1943 5.4436 8.6072]
    """
    count, size, ratio = _given(count, eta, nu)
    goal, beta = kernels.support(ratio)
    if count == 0:
        return _below_cutoff(0, size, ratio, beta)
    parts = _lowest(size, ratio, goal), _below_cutoff(count - 1, size, ratio, beta)
    return Waves(*(np.concatenate(both) for both in zip(*parts, strict=True)))


@quiet
def cutoff(nu: float) -> float:
    """Compute the wave number times half-thickness x = k h/b at which k2 vanishes.

    Parameters
    ----------
    nu : float
        Poisson's ratio [1]; -1 < nu < 0.5

    Returns
    -------
    float
        x [1]; modes of a clamped or supported plate exist only below it

    Raises
    ------
    ValueError
        If nu is outside its range.

    Examples
    --------
    >>> from generated.edge_modes import cutoff
    >>> print(f"{cutoff(0.22):.6g}")
    1.9761
    """
    return float(_cutoff(_given(0, THICKEST, nu)[2]))


@quiet
def shape(waves: Waves, r: ArrayLike) -> np.ndarray:
    """Compute the ratio of the contact-face deflection in each mode to that on the axis.

    Formula::

        [J0(k r/b) - c t I0(k2 r/b)]/(1 - c t)

    Parameters
    ----------
    waves : Waves
        modes of a clamped or supported plate
    r : array_like
        distances from the axis divided by the radius b [1], one-dimensional; 0 <= r <= 1

    Returns
    -------
    ndarray
        of shape (modes, distances) [1]; NaN outside the range

    Examples
    --------
    >>> from generated.edge_modes import clamped_waves, shape
    >>> print(shape(clamped_waves(2, 0.03, 0.22), [0.0, 0.5, 1.0]).round(4))
    [[ 1.000e+00  5.261e-01  5.000e-04]
     [ 1.000e+00 -3.208e-01 -1.500e-03]]
    """
    return kernels.face(_within(r), waves.k, waves.k2, waves.c, waves.t).T


@quiet
def modal_weights_less_one(waves: Waves, a: ArrayLike) -> np.ndarray:
    """Compute s - 1, s the mean contact-face deflection under a flat punch over that at r = 0.

    Formula::

        s - 1,   s = [sh(k a/b) - c t shc(k2 a/b)]/(1 - c t),   sh y = sin(y)/y, shc y = sinh(y)/y

    Parameters
    ----------
    waves : Waves
        modes of a clamped or supported plate
    a : array_like
        radii of the punch divided by the radius b [1], one-dimensional; 0 <= a <= 1

    Returns
    -------
    ndarray
        of shape (radii, modes) [1]; NaN outside the range

    Examples
    --------
    >>> from generated.edge_modes import clamped_waves, modal_weights_less_one
    >>> print(modal_weights_less_one(clamped_waves(2, 0.03, 0.22), [0.1]).round(5))
    [[-0.01509 -0.06498]]
    """
    return kernels.punch_mean_less_one(_within(a), waves.k, waves.k2, waves.c, waves.t)


# --- modes


def _given(count: int, eta: float, nu: float) -> tuple[int, Double, Double]:
    """Return the arguments with their types, after a check of their ranges."""
    count = whole(count, "modes")
    if not THINNEST <= eta <= THICKEST:
        raise ValueError(f"expected eta = h/b from {THINNEST:g} to {THICKEST:g}, got {eta!r}")
    if not -1.0 < nu < 0.5:
        raise ValueError(f"expected Poisson's ratio nu with -1 < nu < 0.5, got {nu!r}")
    return count, np.asarray(eta, dtype=np.float64), np.asarray(nu, dtype=np.float64)


def _within(r: ArrayLike) -> Double:
    """Return a column of distances, NaN outside their range."""
    given = np.ravel(np.asarray(r, dtype=np.float64))[:, None]
    return np.where((given >= 0.0) & (given <= 1.0), given, np.nan)


def _cutoff(nu: Double) -> Double:
    x = kernels.cutoff_of_mindlin(nu)
    for _ in range(_STEPS):
        previous = x
        x = kernels.to_cutoff(previous, nu, bending_frequency(previous, nu))
        if np.abs(x - previous) <= _CLOSE * previous:
            break
    return x


class _State(NamedTuple):
    """Quantities of the wave with one wave number.

    Attributes
    ----------
    root
        omega h/c_T.
    xi, left, bending_part, turned
        kap/x^2, k2^2/k^2, g1 and g2 k2^2/k^2.
    k2
        Wave number of the evanescent part.
    mean, less, scaled
        M = 2 I1/(k2 I0), L = (1 - M)/k2^2 and I0 e^(-k2) of the evanescent part.
    """

    root: Double
    xi: Double
    left: Double
    bending_part: Double
    turned: Double
    k2: Double
    mean: Double
    less: Double
    scaled: Double


def _state(k: Double, eta: Double, nu: Double) -> _State:
    root = bending_frequency(k * eta, nu)
    wave = kernels.wave(k, eta, nu, root)
    return _State(root, *wave, *kernels.modified(wave[-1]))


def _below_cutoff(count: int, eta: Double, nu: Double, beta: Double) -> Waves:
    """Return the modes between neighbouring zeros of J0."""
    top = _cutoff(nu) / eta
    count = int(np.minimum(count, top / np.pi + 2.0))  # zeros of J0 are nearly pi apart
    j = bessel_j0_zeros(count + 1)
    low, high = j[:-1], j[1:]
    sign = -np.ones(count)  # sign of J0 between the zeros
    sign[1::2] = 1.0
    # The last interval may end at the cut-off and then contain no root.
    last = np.minimum(high, top)
    there = (low < top) & ((high <= top) | (sign * _residual(last, eta, nu, beta)[1] > 0.0))
    count_there = np.count_nonzero(np.logical_and.accumulate(there))
    return _solved(
        low[:count_there], last[:count_there], high[:count_there], sign[:count_there], eta, nu, beta
    )


def _residual(k: Double, eta: Double, nu: Double, beta: Double) -> tuple[Double, ...]:
    """Return q, J1 - q J0 and its slope with respect to k."""
    _, xi, left, bending_part, turned, _, mean, less, _ = _state(k, eta, nu)
    bessel = bessel_j0(k), bessel_j1(k)
    return kernels.edge(k, nu, beta, xi, left, bending_part, turned, mean, less, *bessel)


def _solved(
    low: Double, high: Double, zero: Double, sign: Double, eta: Double, nu: Double, beta: Double
) -> Waves:
    """Return the modes in (low, high), where J0 has the given sign and vanishes at `zero`."""
    start = low
    k = 0.5 * (low + high)
    step = np.zeros_like(k)
    if k.size:
        # Start from J1/J0 = q at the middle, where J1/J0 is nearly the tangent of a phase.
        q = _residual(k, eta, nu, beta)[0]
        phase = start + (zero - start) * (0.5 + np.arctan(q) / np.pi)
        k = np.where((low < phase) & (phase < high), phase, k)
    for _ in range(_STEPS * (k.size > 0)):
        previous = k
        _, excess, rise = _residual(previous, eta, nu, beta)
        over = sign * excess > 0.0
        low, high = np.where(over, low, previous), np.where(over, previous, high)
        step = -excess / rise
        close = np.abs(step) <= _CLOSE * previous
        k = previous + step
        k = np.where(close | ((low < k) & (k < high)), k, 0.5 * (low + high))
        if close.all():
            break
    lacking = step - (k - previous) if k.size else step
    root, xi, left, bending_part, turned, k_2, mean, less, scaled = _state(k, eta, nu)
    j0, j1 = bessel_j0(k), bessel_j1(k)
    q = kernels.edge(k, nu, beta, xi, left, bending_part, turned, mean, less, j0, j1)[0]
    _, j1 = kernels.moved(k, lacking, j0, j1)
    c, t, weight = kernels.weight(
        k, eta, nu, left, bending_part, turned, mean, less, scaled, k_2, q, j1
    )  # fmt: skip
    return Waves(k, root, k_2, c, t, weight, bending_residue(k * eta, nu))


def _lowest(eta: Double, nu: Double, goal: Double) -> Waves:
    """Return the first mode of a supported plate."""
    pole = bessel_j0_zeros(1)
    power = kernels.first_power(eta, goal)
    k = np.sqrt(np.sqrt(power / (1.0 + power / pole**4)))
    for _ in range(_STEPS):
        previous = k
        _, xi, left, bending_part, turned, _, mean, _, _ = _state(previous, eta, nu)
        bessel = bessel_j0(previous), bessel_j1(previous)
        excess, rise = kernels.first_edge(
            previous, nu, goal, xi, left, bending_part, turned, mean, *bessel
        )  # fmt: skip
        step = -excess / rise
        k = np.minimum(previous + step, 0.5 * (previous + pole))
        if (np.abs(step) <= _CLOSE * previous).all():
            break
    lacking = step - (k - previous)
    root, _, left, bending_part, turned, k_2, _, _, scaled = _state(k, eta, nu)
    j0, _ = kernels.moved(k, lacking, bessel_j0(k), bessel_j1(k))
    c = kernels.first_part(j0, scaled, k_2)
    kinetic = WEIGHTS @ kernels.energy(k, eta, NODES, c, left, bending_part, turned)
    t, weight = kernels.first_weight(k, eta, nu, left, bending_part, c, kinetic)
    return Waves(k, root, k_2, c, t, weight, bending_residue(k * eta, nu))
