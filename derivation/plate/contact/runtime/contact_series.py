"""Correction F of the contact law delta = (a^2/R) (1 + F) as polynomials, one set for each plate.

With A = a/h, eta = h/b, alpha = a/b = A eta < 1 and g = 3 (sin y - y cos y)/y^3::

    F   = W(alpha) + (8 alpha/(3 pi)) sum_n w_n g(alpha j_n)
    w_n = (G(2 eta j_n) - 1)/(j_n J1(j_n)^2)

F/A is analytic in A^2; its nearest singularities are A = 4i and alpha = 2. It is one polynomial up
to reach = min(REACH, 1/eta), a second one up to FAR_REACH, and the modal sum beyond. Coefficients
are linear maps of the first w_n for eta >= 1/REACH, else those of a thin plate and a remainder.

Arithmetic: Horner's rule in place; scaling of the variables; number of modes in the direct sum.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from generated import contact_kernels as kernels
from generated.arrays import Double, as_doubles, as_result, in_manifest, inside, quiet
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros
from generated.contact_cells import Cells, horner, in_cells
from generated.contact_numbers import (
    CELLS,
    EDGE,
    FAR_CELLS,
    FAR_REACH,
    MODES,
    REACH,
    SHORT,
    SHORTENED,
    THIN,
    THIN_FAR,
    WIDE_END,
    WIDE_START,
)

THINNEST, THICKEST = 1e-90, 1e90
"""Range of eta = h/b for which plates are computed."""
THINNEST_SUM = 1e-5
"""Lower limit of eta for A > FAR_REACH, where the direct sum takes 4/eta modes."""

ROUNDED = 1.0 + 2.0**-50
"""Relative tolerance for the end of a range, so that a few roundings do not exceed it."""

_BLOCK = 32768  # number of points in one block, so that intermediate arrays fit in the cache
_ORDINARY = 1e-100, 1e100  # range of lengths whose products neither overflow nor underflow
_USUAL = 1e-20, 1e20  # range of h/b for which that also applies to the coefficients
_MODE_BLOCK = 4096
_THINNER = CELLS[-1][1]  # value of 1/eta above which the remainder is negligible


class Piece(NamedTuple):
    """Polynomials F = A (S_0 + S_1 t + ...), t = (A^2 - middle)/half; plates on the last axis."""

    coefficients: Double
    middle: Double
    half: Double


class Columns(NamedTuple):
    """`Piece` at given points: one plate for each point (arrays) or one plate for all (scalars)."""

    coefficients: list[Double] | list[float]
    middle: Double
    inverse_half: Double


class Plates(NamedTuple):
    """Polynomials of several plates; eta and the limits reach and far of A have shape (plates,)."""

    eta: Double
    reach: Double
    far: Double
    short: Piece
    first: Piece


class Single(NamedTuple):
    """Law of one sphere on one plate: delta = a^2 (1/R + a S(t)/(h R)), t = (a scale)^2."""

    plates: Plates
    h: Double
    inverse_R: Double
    scale: float
    short_limit: float  # largest a of the short polynomial
    end: float  # largest a of the first polynomial
    short: list[float]  # coefficients divided by h R
    first: list[float]


@in_manifest("S_k", domain="eta >= 1e-90, eta <= 1e90")
@quiet
def plate_coefficients(eta: ArrayLike) -> np.ndarray:
    """Compute the polynomial coefficients of the contact law of a plate.

    Formula::

        delta = (a^2/R) (1 + F),  F = A sum_k S_k (A/reach)^(2k)
        A = a/h, reach = min(REACH, 1/eta), REACH as in `contact_numbers`

    For small k, S_k reach^(-2k) is close to the coefficient c_(2k+1) of A^(2k+1) in the series of
    F about A = 0. It is not equal, because the polynomial interpolates F/A over the whole range.

    Parameters
    ----------
    eta : array_like
        Half-thickness over plate radius, h/b [1]; 1e-90 <= eta <= 1e90.

    Returns
    -------
    ndarray
        S_0, S_1, ... [1] along a last axis of the length of `contact_numbers.THIN`; NaN
        outside the domain.

    Examples
    --------
    >>> from generated import plate_coefficients
    >>> print(plate_coefficients(0.1)[:3].round(6))
    [ 8.099018 -0.796645  0.161018]
    """
    kind, [eta] = as_doubles(eta)
    [eta] = inside([eta], eta >= THINNEST, eta <= THICKEST)
    rows = _first(np.ravel(eta))
    return as_result(np.moveaxis(rows, 0, -1).reshape(*np.shape(eta), rows.shape[0]), kind)


def plates_of(eta: Double) -> Plates:
    """Return the polynomials of plates h/b = eta of shape (plates,)."""
    inverse = 1.0 / eta
    reach, coefficients = np.minimum(REACH, inverse), _first(eta)
    whole = np.zeros_like(eta)
    count = SHORTENED.shape[0]
    short_limit = coefficients[:count].copy()
    for power in range(SHORTENED.shape[1]):
        short_limit += SHORTENED[:, power, None] * coefficients[count + power]
    first = Piece(coefficients, whole, reach * reach)
    short = Piece(short_limit, whole, first.half)
    return Plates(eta, reach, np.minimum(FAR_REACH, inverse), short, first)


def _first(eta: Double) -> Double:
    """Return the coefficients of F/A in powers of (A/reach)^2, of shape (terms, plates)."""
    table = np.full((THIN.size, eta.size), np.nan)
    for some, coefficients in ((eta >= 1.0 / REACH, _thick), (eta < 1.0 / REACH, _thin)):
        if some.any():
            table[:, some] = coefficients(eta[some])
    return table


def _thick(eta: Double) -> Double:
    """Return the coefficients from the finite radius and the first modes, for reach = 1/eta."""
    zeros, weights = _weights(eta, MODES.shape[0])
    total = np.repeat(EDGE[:, None], eta.size, axis=1)
    for index in reversed(range(zeros.size)):
        total += MODES[index][:, None] * weights[..., index]
    return total * eta


def _thin(eta: Double) -> Double:
    """Return the closed form of the thin plate plus its remainder where that is not negligible."""
    v = 1.0 / eta
    total = np.repeat(THIN[:, None], v.size, axis=1)
    _tabulated(v, CELLS, total)
    linear, cubic = kernels.thin_near(v)
    total[0] += linear
    total[1] += cubic
    return total


def _tabulated(v: Double, cells: Cells, total: Double) -> None:
    """Add the cells' polynomials in v to the coefficients, which have shape (terms, plates)."""
    for chosen, tau, _, rows in in_cells(v, cells):
        value = rows[-1] * tau + rows[-2]
        for row in rows[-3::-1]:
            value *= tau
            value += row
        total[:, chosen] += value


def _bending(v: Double) -> tuple[Double, Double]:
    """Return c1 and c3 of the thin plate for v = 1/eta."""
    return kernels.thin_coefficients(v)


def far_piece(eta: Double) -> Piece:
    """Return the second polynomial, up to min(FAR_REACH, 1/eta), of plates eta < 1/REACH."""
    v = 1.0 / eta
    [v] = inside([v], v > REACH)
    middle, half = _far_span(v)
    coefficients = np.zeros((THIN_FAR.size, eta.size))
    _tabulated(v, FAR_CELLS, coefficients)
    chosen = np.flatnonzero(v > _THINNER)
    constant, linear = kernels.thin_far(v[chosen])
    coefficients[:, chosen] = THIN_FAR[:, None]
    coefficients[0, chosen] += constant
    coefficients[1, chosen] += linear
    return Piece(coefficients, middle, half)


def _far_span(v: Double) -> tuple[Double, Double]:
    """Return middle and half-width of the second polynomial's range of A^2, never too narrow."""
    low, top = np.where(v <= WIDE_END, WIDE_START, REACH) ** 2, np.minimum(FAR_REACH, v) ** 2
    return 0.5 * (top + low), 0.5 * (top - low)


def _weights(eta: Double, count: int) -> tuple[Double, Double]:
    """Return j_n and w_n, the latter with the modes along a last axis."""
    zeros, slopes = bessel_j0_zeros(count), bessel_j1_at_j0_zeros(count)
    return zeros, kernels.mode_weight(np.asarray(eta)[..., None], zeros, slopes)


def direct(A: Double, eta: float) -> tuple[Double, Double]:
    """Return F and A F' by summation over the modes, for one plate and alpha = A eta < 1.

    Parameters
    ----------
    A
        Contact radius over half-thickness [1], of shape (points,).
    eta
        h/b [1].
    """
    alpha = A * eta
    value, slope = with_slope(alpha, Columns(EDGE.tolist(), np.zeros(()), np.ones(())))
    # T = 2 eta j_n > 24, where w_n is below 1e-19 times the first weight.
    zeros, weights = _weights(np.asarray(eta), int(3.9 / eta) + 2)
    points = max(1, 65536 // min(zeros.size, _MODE_BLOCK))
    for begin in range(0, A.size, points):
        part = slice(begin, begin + points)
        near = alpha[part, None]
        total, rise = np.zeros(near.shape[0]), np.zeros(near.shape[0])
        for start in reversed(range(0, zeros.size, _MODE_BLOCK)):
            modes = slice(start, start + _MODE_BLOCK)
            terms = kernels.mode_terms(near * zeros[modes], weights[modes])
            total += terms[0].sum(axis=1)
            rise += terms[1].sum(axis=1)
        modal = kernels.of_modes(alpha[part], total, rise)
        value[part] += modal[0]
        slope[part] += modal[1]
    return value, slope


def columns(piece: Piece, index: np.ndarray | None) -> Columns:
    """Return the piece at points of the plates `index`; None stands for the only plate."""
    if index is None:
        return Columns(piece.coefficients[:, 0].tolist(), piece.middle[0], 1.0 / piece.half[0])
    gathered = [row.take(index) for row in piece.coefficients]
    return Columns(gathered, piece.middle.take(index), 1.0 / piece.half.take(index))


def value_of(A: Double, piece: Columns) -> Double:
    """Return F = A S(t) of a piece about A = 0."""
    t = A * A
    t *= piece.inverse_half  # in place, because the block fits in the cache
    value: Double = piece.coefficients[-1] * t
    value += piece.coefficients[-2]
    for coefficient in piece.coefficients[-3::-1]:
        value *= t
        value += coefficient
    value *= A
    return value


def with_slope(A: Double, piece: Columns) -> tuple[Double, Double]:
    """Return F and A F'(A)."""
    square = A * A
    value, slope = horner(piece.coefficients, (square - piece.middle) * piece.inverse_half)
    return kernels.with_slope_of(A, square, piece.inverse_half, value, slope)


def with_slopes(A: Double, piece: Columns) -> tuple[Double, Double, Double]:
    """Return F, A F'(A) and A (A F')'."""
    square = A * A
    t = (square - piece.middle) * piece.inverse_half
    value = np.full_like(t, piece.coefficients[-1])
    slope, curve = np.zeros_like(t), np.zeros_like(t)
    for coefficient in piece.coefficients[-2::-1]:
        curve *= t
        curve += slope
        slope *= t
        slope += value
        value *= t
        value += coefficient
    return kernels.with_slopes_of(A, square, piece.inverse_half, value, slope, curve)


def sphere_on_plate(plates: Plates, h: Double, R: Double) -> Single | None:
    """Return the law of one sphere and one plate of ordinary lengths; None for other lengths."""
    if plates.eta.size != 1 or R.size != 1 or not _USUAL[0] < plates.eta[0] < _USUAL[1]:
        return None
    if not all(_ORDINARY[0] < length < _ORDINARY[1] for length in (R.item(), h.flat[0])):
        return None
    height, reach = h.ravel()[0], plates.reach[0]
    both = np.concatenate((plates.short.coefficients, plates.first.coefficients))[:, 0]
    over, scaled = kernels.depth_coefficients(both, R.ravel()[0], height)
    count = plates.short.coefficients.shape[0]
    short, first = scaled[:count].tolist(), scaled[count:].tolist()
    short_limit, end = reach * SHORT * height, reach * ROUNDED * height
    return Single(plates, height, over, 1.0 / (height * reach), short_limit, end, short, first)


def indent(a: Double, most: float, law: Single, out: Double) -> None:
    """Write the indentation at a block of radii a >= 0 of shape (points,), alpha < 1, to `out`.

    NaN stays NaN. `most` is the largest radius, or NaN if some radii may be NaN.
    """
    if most <= law.short_limit:
        _indent(a, law, law.short, out)
    elif most <= law.end:
        _indent(a, law, law.first, out)
        chosen = np.flatnonzero(a <= law.short_limit)
        if chosen.size:
            part = np.empty(chosen.size)
            _indent(a[chosen], law, law.short, part)
            out[chosen] = part
    else:
        near = a <= law.end
        inner, beyond = a[near], a[~near]
        if inner.size:
            part = np.empty(inner.size)
            indent(inner, inner.max(), law, part)
            out[near] = part
        value = correction(beyond / law.h, law.plates, None)
        out[~near] = kernels.indentation_in_range(beyond, law.inverse_R, value)


def _indent(a: Double, law: Single, coefficients: list[float], out: Double) -> None:
    """Write a^2 (1/R + a S) to `out`, in one pass over memory for each operation."""
    t = a * law.scale
    t *= t
    np.multiply(t, coefficients[-1], out=out)
    out += coefficients[-2]
    for coefficient in coefficients[-3::-1]:
        out *= t
        out += coefficient
    out *= a
    out += law.inverse_R
    out *= a
    out *= a


def correction(A: Double, plates: Plates, index: np.ndarray | None) -> Double:
    """Return F at a block of points A >= 0 of shape (points,), alpha < 1; NaN stays NaN."""
    reach = plates.reach[slice(None) if index is None else index]
    short_limit = reach * SHORT >= A
    if short_limit.all():
        return value_of(A, columns(plates.short, index))
    total = value_of(A, columns(plates.first, index))
    chosen = np.flatnonzero(short_limit)
    if chosen.size:
        at = None if index is None else index[chosen]
        total[chosen] = value_of(A[chosen], columns(plates.short, at))
    near = reach * ROUNDED >= A
    if not near.all():
        for part, values, _ in _beyond(A, near, plates, index):
            total[part] = values
    return total


def correction_with_slope(
    A: Double, plates: Plates, index: np.ndarray | None
) -> tuple[Double, Double]:
    """Return F and A F' at a block of points A >= 0 of shape (points,), alpha < 1."""
    reach = plates.reach[slice(None) if index is None else index]
    near = reach * ROUNDED >= A
    total, slopes = with_slope(A, columns(plates.first, index))
    if not near.all():
        for part, values, rises in _beyond(A, near, plates, index):
            total[part], slopes[part] = values, rises
    return total, slopes


def _beyond(
    A: Double, near: np.ndarray, plates: Plates, index: np.ndarray | None
) -> list[tuple[np.ndarray, Double | float, Double | float]]:
    """Return the points with A > reach, and F and A F' there."""
    outside = np.flatnonzero(~near)
    owner = np.zeros(outside.size, dtype=np.intp) if index is None else index[outside]
    within = ROUNDED * plates.far[owner] >= A[outside]
    which, position = np.unique(owner[within], return_inverse=True)
    parts: list[tuple[np.ndarray, Double | float, Double | float]] = []
    if which.size:
        piece = columns(far_piece(plates.eta[which]), None if which.size == 1 else position)
        parts.append((outside[within], *with_slope(A[outside[within]], piece)))
    rest, owner = outside[~within], owner[~within]
    for plate in np.unique(owner):
        selected, eta = rest[owner == plate], float(plates.eta[plate])
        summable = (A[selected] * eta <= ROUNDED) & (eta >= THINNEST_SUM)
        if summable.any():
            parts.append((selected[summable], *direct(A[selected[summable]], eta)))
        parts.append((selected[~summable], np.nan, np.nan))
    return parts


def blocks_of(size: int) -> list[slice]:
    """Return slices of at most _BLOCK points that cover `size` points."""
    return [slice(start, start + _BLOCK) for start in range(0, size, _BLOCK)]
