"""Time elements of many scenes at once: Newton's steps, values, largest values and zeros.

The last axes hold the nodes or Legendre coefficients of one element on [-1, 1]. No rounding error
of a scene depends on the others: sums are products of vectors, or of a matrix for each scene.
"""

import math
from functools import cache

import numpy as np
from numpy.polynomial.legendre import legder
from numpy.typing import NDArray

from derivation.scene.numerics.collocation import CLOSE, NEARLY, NEXT
from generated.arrays import Double as Array

PEAK_STEPS, ZERO_STEPS = 6, 60
"""Numbers of steps of Newton's iteration for a largest value, and for a zero."""
Mask = NDArray[np.bool_]


def newton_steps(systems: Array, residuals: Array, by_x: Array, a: Array) -> tuple[Array, Array]:
    """Return steps of da/dx, shortened so that no radius falls below half, and their full sizes.

    They are NaN where the system has no finite solution.

    Parameters
    ----------
    systems
        Decrease of the residual per da/dx, a matrix for each scene.
    residuals, a
        Residuals and radii at the nodes.
    by_x
        Matrices of the integrals to the nodes.
    """
    steps = _solved(systems, residuals)
    moved = np.vecdot(by_x, steps[:, None, :])
    sizes = np.abs(moved).max(axis=-1) / a.max(axis=-1)
    shorter = steps / np.maximum(1.0, -2.0 * (moved / a).min(axis=-1))[:, None]
    return shorter, sizes


def _solved(systems: Array, values: Array) -> Array:
    """Return the solutions of linear systems; NaN where a matrix is singular."""
    try:
        return np.asarray(np.linalg.solve(systems, values[..., None])[..., 0])
    except np.linalg.LinAlgError:
        if len(systems) == 1:
            return np.full_like(values, np.nan)
        each = [_solved(systems[i : i + 1], values[i : i + 1]) for i in range(len(systems))]
        return np.concatenate(each)


def all_converged(sizes: Array, before: Array) -> Mask:
    """Return where the next step would be due to rounding, like `collocation.converged`.

    The derivative is approximate.

    Parameters
    ----------
    sizes, before
        Sizes of the last steps and of those before them, NaN if there was none.
    """
    ratio = sizes / before
    settled = (sizes <= CLOSE) | ((sizes <= NEARLY) & (ratio > 0.1))
    mask: Mask = settled | ((ratio < 1.0) & (sizes * ratio <= NEXT))
    return mask


def values_at(coefficients: Array, s: Array) -> Array:
    """Return the values of polynomials at one position each, in [-1, 1]."""
    return np.asarray(np.vecdot(coefficients, _basis(s, coefficients.shape[-1])))


def continued(coefficients: Array, ahead: Array) -> Array:
    """Return the values of each polynomial at several positions near its end.

    Parameters
    ----------
    ahead
        Positions less the end of the element, over its length. Beyond the end no sum cancels.
    """
    powers = np.empty((*ahead.shape, coefficients.shape[-1]))
    powers[..., 0], powers[..., 1:] = 1.0, ahead[..., None]
    np.multiply.accumulate(powers, axis=-1, out=powers)
    by_power = np.vecdot(_by_power(coefficients.shape[-1]), coefficients[..., None, :])
    return np.asarray(np.vecdot(powers, by_power[..., None, :]))


@cache
def _by_power(n: int) -> Array:
    """Return the matrix from Legendre coefficients to those of powers of (s - 1)/2."""
    return np.array([[math.comb(k, j) * math.comb(k + j, j) for k in range(n)] for j in range(n)],
                    dtype=np.float64)  # fmt: skip


def _basis(s: Array, n: int) -> Array:
    """Return the first n Legendre polynomials at positions, along a last axis."""
    values = np.empty((n, *s.shape))
    values[0], values[1] = 1.0, s
    for k in range(2, n):
        values[k] = values[k - 1] * s * ((2 * k - 1) / k) - values[k - 2] * ((k - 1) / k)
    return np.ascontiguousarray(np.moveaxis(values, 0, -1))


def slopes_of(coefficients: Array) -> Array:
    """Return the Legendre coefficients of the slopes, as many, of which the last is 0."""
    return np.asarray(np.vecdot(_slope(coefficients.shape[-1]), coefficients[..., None, :]))


@cache
def _slope(n: int) -> Array:
    """Return the matrix of `slopes_of`."""
    return np.vstack((legder(np.eye(n)), np.zeros(n)))


@cache
def _grid(n: int) -> tuple[Array, Array]:
    """Return positions with both ends, close enough for Newton's iteration, and the basis there."""
    s: Array = -np.cos(np.pi * np.arange(4 * n + 1) / (4 * n))
    return s, _basis(s, n)


def largest_values(coefficients: Array, known: Array) -> Array:
    """Return the largest values of polynomials on [-1, 1], or known values if these are larger.

    No Legendre polynomial exceeds 1. The sum of the absolute coefficients is therefore an upper
    bound, and that of the slope limits how far a value between two positions can exceed these.
    """
    searched = np.abs(coefficients).sum(axis=-1) > known
    if not searched.any():
        return known
    rows, largest = coefficients[searched], known.copy()
    odd, even = rows[:, 1::2].sum(axis=-1), rows[:, ::2].sum(axis=-1)
    largest[searched] = _peaks(rows, np.maximum(known[searched], even + np.abs(odd)))
    return largest


def _peaks(coefficients: Array, known: Array) -> Array:
    """Return the largest values of polynomials inside [-1, 1], or known values."""
    slope = slopes_of(coefficients)
    steepest = np.abs(slope).sum(axis=-1)
    s, basis = _grid(coefficients.shape[-1])
    on_grid = np.vecdot(basis, coefficients[:, None, :])
    at, top = on_grid.argmax(axis=-1), on_grid.max(axis=-1)
    turns = 2.0 * np.abs(slope[:, 0]) < steepest
    near = np.flatnonzero(turns & (top + 0.5 * (s[1 + len(s) // 2]) * steepest > known))
    if not near.size:
        return known
    largest: Array = np.maximum(known, top)
    at = at[near]
    coefficients, slope = coefficients[near], slope[near]
    low, high = s[np.maximum(at - 1, 0)], s[np.minimum(at + 1, len(s) - 1)]
    curvature, position = slopes_of(slope), s[at]
    for _ in range(PEAK_STEPS):
        rate, bent = values_at(slope, position), values_at(curvature, position)
        uphill = -0.25 * np.copysign(high - low, rate)
        step = np.divide(rate, bent, uphill, where=bent < 0.0)
        position = np.clip(position - step, low, high)
    largest[near] = np.maximum(largest[near], values_at(coefficients, position))
    return largest


def zeros_of(coefficients: Array) -> Array:
    """Return where polynomials, positive at -1 and not at 1, fall through zero.

    Newton's iteration starts at 1 and halves the interval where its step would leave it.
    """
    slope = slopes_of(coefficients)
    low, high = np.full(len(slope), -1.0), np.ones(len(slope))
    s, before = high.copy(), np.full(len(slope), np.inf)
    moving = np.ones(len(slope), dtype=bool)
    for _ in range(ZERO_STEPS):
        value, rate = values_at(coefficients, s), values_at(slope, s)
        low, high = np.where(value > 0.0, s, low), np.where(value > 0.0, high, s)
        after = s - value / rate
        inside = (after >= low) & (after <= high)
        after = np.where(inside, after, 0.5 * (low + high))
        step = np.abs(after - s)
        s = np.where(moving, after, s)
        moving &= ~((step <= CLOSE) | ((step <= NEARLY) & (step >= before)))
        if not moving.any():
            break
        before = step
    return s
