"""Normalised time history of an impact: indentation, its rate, and the remaining work.

q = a/a_m is the ratio of the contact radius to its largest value, and E is the work. The quotient
(1 - E/E_m)/(1 - q) is a polynomial, computed by synthetic division. Beyond the law's first
polynomial, a quadrature gives the remaining work.

Arithmetic: Horner's rule; the change of variable q = w (2 - w); the nodes and sum of the
quadrature; which points lie beyond the first polynomial, and how far.
"""

from types import EllipsisType
from typing import NamedTuple

import numpy as np

from generated import impact_kernels as kernels
from generated.arrays import Double
from generated.contact_series import Columns, with_slope
from generated.impact_numbers import INNER_NODES, INNER_WEIGHTS

_POINTS = 1024  # points in one block beyond the first polynomial, so that arrays fit in the cache


class Scenes(NamedTuple):
    """Impacts of shape (scenes,): lift is 1 + F and energy is E/A^5 at the largest A.

    Up to A_near = A or reach, F = sum terms_k s^(2k + 1), s = A'/A_near; `tails` are the sums
    over l >= k of (2l + 3)/(2l + 6) terms_l. Both have shape (terms, scenes).
    """

    A: Double
    lift: Double
    energy: Double
    terms: Double
    tails: Double
    slot: np.ndarray  # index among the impacts beyond the first polynomial, -1 for the others
    beyond: "Beyond"


class Beyond(NamedTuple):
    """Additional data of impacts that go beyond the first polynomial."""

    near: Double  # A_near/A
    gap: Double  # 1 - A_near/A
    rise: Double  # (E - E_near)/A^5
    piece: Columns  # the second polynomial


def time_rate(w: Double, scenes: Scenes, pick: slice | np.ndarray) -> Double:
    """Return dt/dw in units of delta_m/v0, for w of shape (scenes, points)."""
    _, rate, quotient = shapes(w, scenes, pick)
    return kernels.time_density(rate, quotient)


def shapes(w: Double, scenes: Scenes, pick: slice | np.ndarray) -> tuple[Double, Double, Double]:
    """Return (1 + F)/(1 + F_m), d(delta/delta_m)/dq and (1 - E/E_m)/(1 - q), q = w (2 - w).

    The results have the shape of w, (scenes, points).
    """
    q = w * (2.0 - w)
    lift, slope, quotient = _near_shapes(q, scenes.terms[:, pick], scenes.tails[:, pick])
    slot = scenes.slot[pick]
    far = np.flatnonzero(slot >= 0)
    if far.size:
        near = scenes.terms[:, pick][:, far], scenes.tails[:, pick][:, far]
        far_shapes = _far_shapes(w[far], near, scenes.A[pick][far], scenes.beyond, slot[far])
        lift[far], slope[far], quotient[far] = far_shapes
    whole, energy = scenes.lift[pick, None], scenes.energy[pick, None]
    return kernels.shapes(q, lift, slope, quotient, whole, energy)


def _near_shapes(s: Double, terms: Double, tails: Double) -> tuple[Double, Double, Double]:
    """Return 1 + F, A F' and (E_near - E)/((1 - s) A_near^5) of the first polynomial."""
    square = s * s
    value, slope = np.full_like(s, terms[-1][:, None]), np.zeros_like(s)
    rest = np.full_like(s, tails[-1][:, None])
    for k in range(terms.shape[0] - 2, -1, -1):
        slope *= square
        slope += value
        value *= square
        value += terms[k][:, None]
        if k > 0:
            rest *= square
            rest += tails[k][:, None]
    slope *= 2.0 * square
    slope += value
    return 1.0 + s * value, s * slope, kernels.near_quotient(s, tails[0][:, None], rest)


def _far_shapes(
    w: Double, near: tuple[Double, Double], A: Double, beyond: Beyond, slot: np.ndarray
) -> tuple[Double, Double, Double]:
    """Return 1 + F, A F' and (E_m - E)/((1 - q) A^5) of impacts beyond the first polynomial."""
    ratio, gap, rise = (x[slot, None] for x in (beyond.near, beyond.gap, beyond.rise))
    q, left = w * (2.0 - w), (1.0 - w) ** 2  # left is 1 - q
    outside = left <= gap
    lift, slope, quotient = _near_shapes(q / ratio, *near)
    safe = np.where(outside, 1.0, left)
    quotient = kernels.far_quotient(quotient, left - gap, safe, ratio, rise)
    rows, places = np.nonzero(outside)
    for start in range(0, rows.size, _POINTS):
        row, place = rows[start : start + _POINTS], places[start : start + _POINTS]
        piece = cut(beyond.piece, slot[row])
        x = np.maximum(q[row, place], ratio[row, 0])[:, None]
        value, fall = with_slope(A[row, None] * x, piece)
        lift[row, place], slope[row, place] = 1.0 + value[:, 0], fall[:, 0]
        quotient[row, place] = mean_work(x, A[row], piece)[:, 0]
    return lift, slope, quotient


def mean_work(q: Double, A: Double, piece: Columns) -> Double:
    """Return (E_m - E)/((1 - q) A^5), the mean work density over [q, 1], for reach <= q A."""
    x = q[..., None] + (1.0 - q[..., None]) * INNER_NODES
    value, slope = with_slope(A[:, None, None] * x, cut(piece, ...))
    mean: Double = (kernels.work_density(x, value, slope) * INNER_WEIGHTS).sum(axis=-1)
    return mean


def cut(piece: Columns, pick: np.ndarray | slice | EllipsisType) -> Columns:
    """Return a piece at some of its points, with one additional axis."""
    rows, *scale = piece
    middle, inverse_half = (np.asarray(x)[pick, None] for x in scale)
    return Columns([np.asarray(row)[pick, None] for row in rows], middle, inverse_half)
