"""Slope of the contact law, and logarithmic derivatives of the results of an impact.

With A = a/h, eta = h/b and Y the ratio of m v0^2/2 to (4/3) E* h^5/R^2, each result of an impact
is a product of powers times a function of Y and eta::

    d log A_m/d log Y = E/V,   d log A_m/d log eta = -E_eta/V,   V = 2 (1 + F) + A F'
    A^5 E = int_0^A x^3 d(x^2 (1 + F)),   E_eta = eta dE/d eta at fixed A

The derivatives of the indentation are similar. The contact time is proportional to
sqrt(m/(E* h)) A_m^(-1/2) int N/sqrt(S) dw with N and S of `impact`; the derivative of this
integral is int (N' - N S'/(2 S))/sqrt(S) dw.

Arithmetic: sums over powers by Horner's rule, over quadrature nodes, and of the work up to the
end of the first polynomial and beyond it; A = a/h; the positions of the nodes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from generated import sensitivity_kernels as kernels
from generated.arrays import Double, as_doubles, as_result, in_manifest, inside, quiet
from generated.contact_domain import plates_of_lengths
from generated.contact_kernels import relative_rise, slope_of_indentation
from generated.contact_numbers import ENERGY, ETA, PARAMETERS, POWERS, RESULTS
from generated.contact_points import cut, cut_index, flat, index_of
from generated.contact_series import (
    Columns,
    blocks_of,
    columns,
    correction_with_slope,
    far_piece,
    with_slope,
    with_slopes,
)
from generated.contact_thickness import far_by_thickness, first_by_thickness
from generated.impact import _parts, _solve
from generated.impact_numbers import INNER_NODES, INNER_WEIGHTS, NODES, WEIGHTS
from generated.impact_shapes import Scenes

__all__ = ["PARAMETERS", "RESULTS", "impact_sensitivities", "indentation_slope"]


class _Sums(NamedTuple):
    """N and S at the nodes, for the law or for one of its derivatives."""

    rate: Double
    stored: Double


class _Law(NamedTuple):
    """F, or a derivative of F, up to A_near = min(A_m, reach): sum terms_k s^(2k+1), s = A/A_near.

    `tails` are the sums over l >= k of (2l + 3)/(2l + 6) terms_l; both have shape (terms, scenes).
    """

    terms: Double
    tails: Double


@in_manifest(
    r"\mathrm{d}\delta/\mathrm{d}a",
    equation="6",
    domain="a >= 0, a < b, a < R, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "a <= 6 * h or h/b >= 1e-5",
)
@quiet
def indentation_slope(a: ArrayLike, R: ArrayLike, h: ArrayLike, b: ArrayLike) -> np.ndarray:
    """Compute the slope d delta/da of the indentation with respect to the contact radius.

    Formula::

        d delta/da = (a/R) (2 (1 + F) + A F'),  delta = (a^2/R) (1 + F)

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
        d delta/da [1] in the arguments' broadcast shape; NaN outside the domain.

    Examples
    --------
    >>> from generated import indentation_slope
    >>> print(f"{indentation_slope(1e-4, 0.01, 0.004, 0.15):.6g}")
    0.104288
    """
    kind, [a, R, h, b] = as_doubles(a, R, h, b)
    [a, R], [h] = inside([a, R], a >= 0, a < b, a < R, R > 0), inside([h], h > 0)
    plates, owner = plates_of_lengths(h, b)
    shape = np.broadcast_shapes(a.shape, R.shape, owner.shape)
    flat_a, flat_R, flat_h = (flat(x, shape) for x in (a, R, h))
    index = index_of(owner, shape)
    result = np.empty(int(np.prod(shape)))
    for part in blocks_of(result.size):
        A = flat_a[part] / cut(flat_h, part)
        value, slope = correction_with_slope(A, plates, cut_index(index, part))
        result[part] = slope_of_indentation(flat_a[part], cut(flat_R, part), value, slope)
    return as_result(result.reshape(shape), kind)


@in_manifest(
    "",
    equation="13",
    domain="m > 0, v0 > 0, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, 3 * lam > -2 * mu, "
    "mu > 0, a < R, a <= b, a <= 6 * h for the largest a",
)
@quiet
def impact_sensitivities(
    R: ArrayLike,
    m: ArrayLike,
    v0: ArrayLike,
    h: ArrayLike,
    b: ArrayLike,
    lam: ArrayLike,
    mu: ArrayLike,
) -> np.ndarray:
    """Compute d log(result)/d log(parameter) for the results and parameters of `impact`.

    A value of 0.4 means that a 1 % larger parameter gives a 0.4 % larger result. For lam,
    which may be negative or zero, the value is (lam/result) d(result)/d(lam).

    Parameters
    ----------
    R : array_like
        Sphere radius [m]; R > 0.
    m : array_like
        Sphere mass [kg]; m > 0.
    v0 : array_like
        Impact speed of the sphere [m/s]; v0 > 0.
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
    ndarray
        Logarithmic derivatives [1], of shape (4, 7) + the arguments' broadcast shape. The
        first axis follows RESULTS (contact time, peak indentation, force, contact radius),
        the second PARAMETERS (R, m, v0, h, b, lam, mu). NaN where `impact` gives NaN.

    Examples
    --------
    >>> from generated import impact_sensitivities
    >>> sensitivities = impact_sensitivities(0.01, 0.0327, 2.0, 0.004, 0.15, 22.5e9, 28.7e9)
    >>> print(sensitivities[0].round(3))  # of the contact time: by R, m, v0, h, b, lam, mu
    [-0.015  0.493 -0.015 -1.388  0.924 -0.078 -0.415]
    """
    kind, [R, m, v0, h, b, lam, mu] = as_doubles(R, m, v0, h, b, lam, mu)
    scenes, radius, _, _, ok = _solve(R, m, v0, h, b, lam, mu)
    plates, numbers = plates_of_lengths(h, b)
    owner = np.ravel(np.broadcast_to(numbers, ok.shape))
    by_energy, by_eta = np.empty((4, owner.size)), np.empty((4, owner.size))
    slopes = first_by_thickness(plates.first, plates.eta)
    for part in _parts(owner.size):
        which = owner[part]
        scale = np.minimum(scenes.A[part], plates.reach[which])
        by_energy[:, part], by_eta[:, part] = _changes(
            scenes, part, plates.eta[which], _Law(*_scaled(slopes, which, scale, plates.reach))
        )
    undefined = np.isnan(np.ravel(radius))
    by_energy[:, undefined], by_eta[:, undefined] = np.nan, np.nan
    parameters = POWERS[:, :, None], ENERGY[:, None], ETA[:, None]
    powers = kernels.parameter_power(*parameters, by_energy[:, None], by_eta[:, None])
    powers = powers.reshape(*POWERS.shape, *ok.shape)
    modulus = np.where(ok, powers[:, -1:], np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        constants = kernels.constants_powers(modulus, lam, mu)
    return as_result(np.concatenate((powers[:, :-1], *constants), axis=1), kind)


def _scaled(rows: Double, which: np.ndarray, near: Double, reach: Double) -> tuple[Double, Double]:
    """Return coefficients of the plates `which` as terms in powers of A/near, and their tails."""
    terms = rows[:, which] * near
    ratio = (near / reach[which]) ** 2
    power = ratio.copy()
    for k in range(1, terms.shape[0]):
        terms[k] *= power
        power *= ratio
    return terms, _tails(terms)


def _tails(terms: Double) -> Double:
    return np.cumsum(kernels.power_work(_orders(terms), terms)[::-1], axis=0)[::-1]


def _orders(terms: Double) -> Double:
    """Return the factors by which powers of A change the terms of F in the indentation."""
    return 2.0 * np.arange(terms.shape[0], dtype=np.float64)[:, None] + 3.0


def _changes(scenes: Scenes, part: slice, eta: Double, deeper: _Law) -> tuple[Double, Double]:
    """Return logarithmic derivatives of A_m^(-1/2) I, A^2 (1 + F), A^3 and A: for Y and for eta."""
    terms = scenes.terms[:, part]
    wider = kernels.power_slope(_orders(terms), terms)
    laws = _Law(terms, scenes.tails[:, part]), _Law(wider, _tails(wider)), deeper
    lift, energy = scenes.lift[part], scenes.energy[part]
    rate = relative_rise(terms.sum(axis=0), wider.sum(axis=0))
    lift_slope, energy_slope = deeper.terms.sum(axis=0), deeper.tails[0].copy()
    slot = scenes.slot[part]
    far = np.flatnonzero(slot >= 0)
    ratio, gap, rises = np.ones(lift.size), np.zeros(lift.size), np.zeros((3, lift.size))
    outer = np.zeros((3, lift.size))
    if far.size:
        ends = scenes.beyond.near[slot[far]], scenes.beyond.gap[slot[far]]
        beyond = _beyond(scenes.A[part][far], ends[1], eta[far])
        ratio[far], gap[far] = ends
        rises[:, far], outer[:, far] = beyond.rises, beyond.integrals
        rate[far], lift_slope[far] = beyond.rate, beyond.lift_slope
        energy_slope[far] = kernels.whole_work(ends[0], energy_slope[far], beyond.rises[2])
    by_energy, by_eta, *others = kernels.peak_growth(energy, rate, energy_slope, lift, lift_slope)
    total, by_radius, by_thickness = _inner(laws, ratio, gap, rises) + outer
    time = kernels.time_growth(total, by_radius, by_thickness, by_energy, by_eta)
    return np.stack((time[0], *others[::2], by_energy)), np.stack((time[1], *others[1::2], by_eta))


def _inner(laws: tuple[_Law, _Law, _Law], ratio: Double, gap: Double, rises: Double) -> Double:
    """Return int N/sqrt(S) dw up to q = ratio, and its slopes with respect to log A_m and log eta.

    Shape: (3, scenes).
    Here q = w (2 - w), w <= 1 - sqrt(gap) and gap = 1 - ratio; `rises` is the work beyond q.
    """
    q, s, left, factor, last = kernels.near_nodes(NODES, ratio[:, None], np.sqrt(gap)[:, None])
    sums_of_parts = []
    made = kernels.near_terms, kernels.near_slope_terms, kernels.near_slope_terms
    for law, rise, terms in zip(laws, rises, made, strict=True):
        sums = terms(q, s, left, factor, *_near_sums(s, law), rise[:, None])
        sums_of_parts.append(_Sums(*sums))
    return _integrals(sums_of_parts, WEIGHTS * last)


def _near_sums(s: Double, law: _Law) -> tuple[Double, Double, Double]:
    """Return the sums of terms times powers, of tails from the second on, and the first tail."""
    square, count = s * s, law.terms.shape[0]
    rate = (2 * count + 1) * law.terms[-1][:, None] + 0.0 * s
    rest = law.tails[-1][:, None] + 0.0 * s
    for k in range(count - 2, -1, -1):
        rate *= square
        rate += (2 * k + 3) * law.terms[k][:, None]
        if k > 0:
            rest *= square
            rest += law.tails[k][:, None]
    return rate, law.tails[0][:, None], rest


def _integrals(sums: list[_Sums], weights: Double) -> Double:
    """Return int N/sqrt(S), and int (N' - N S'/(2 S))/sqrt(S) for both slopes."""
    law, by_radius, by_thickness = sums
    terms = kernels.time_terms(*law, *by_radius, *by_thickness, weights)
    return np.stack([term.sum(axis=1) for term in terms])


class _Beyond(NamedTuple):
    """Contributions beyond the first polynomial, with slopes with respect to log A_m and log eta.

    `rises` is the work divided by A_m^5, `integrals` the part of the integral in the contact time;
    `rate` and `lift_slope` are V and the slope of F with respect to log eta at A_m.
    """

    rises: Double
    integrals: Double
    rate: Double
    lift_slope: Double


def _beyond(A: Double, gap: Double, eta: Double) -> _Beyond:
    which, position = np.unique(eta, return_inverse=True)
    far = far_piece(which)
    pieces = columns(far, position), columns(far_by_thickness(far, which), position)
    law, deeper = (_more_axes(piece) for piece in pieces)
    # The outer nodes follow 1 - q = gap u^2; the inner ones cover [q, 1] and [near, 1].
    u = np.concatenate((NODES, [1.0]))
    nodes = np.concatenate(([1.0], INNER_NODES))
    x = kernels.far_nodes(gap[:, None, None], u[:, None], nodes)
    rates = _rates(A[:, None, None] * x, law, deeper)
    fourth = kernels.work_weight(x[:, :, 1:], INNER_WEIGHTS)
    means = [(rate[:, :, 1:] * fourth).sum(axis=2) for rate in rates]
    sums = [
        _Sums(x[:, :-1, 0] * rate[:, :-1, 0], mean[:, :-1])
        for rate, mean in zip(rates, means, strict=True)
    ]
    integrals = _integrals(sums, WEIGHTS * np.sqrt(gap)[:, None])
    rises = np.stack([gap * mean[:, -1] for mean in means])
    value, slope = with_slope(A, pieces[0])
    lift_slope, _ = with_slope(A, pieces[1])
    return _Beyond(rises, integrals, relative_rise(value, slope), lift_slope)


def _rates(A: Double, law: Columns, deeper: Columns) -> tuple[Double, Double, Double]:
    """Return V and its slopes with respect to log A and log eta."""
    value, slope, curve = with_slopes(A, law)
    return kernels.rates(value, slope, curve, *with_slope(A, deeper))


def _more_axes(piece: Columns) -> Columns:
    """Return a piece for points of shape (scenes, nodes, nodes)."""
    rows, *scale = piece
    middle, inverse_half = (np.asarray(x)[:, None, None] for x in scale)
    return Columns([np.asarray(row)[:, None, None] for row in rows], middle, inverse_half)
