"""All Lamb-wave branches of a free plate: frequencies, and responses to a load on one face.

For a wave number x = phi h, a load of frequency omega deflects the contact face by::

    w(+h)/A = (h/mu) (1/Ba + 1/Bs),   1/B(kap) = sum r_k/(kap_k - kap),   kap = (omega h/c_T)^2

with Ba and Bs as in `inertia`. Both decrease wherever they are finite, so that between two
poles of either there is exactly one zero, which is one branch of that symmetry. The poles are
known: with p^2 = x^2 - gam kap and q^2 = x^2 - kap, those of Ba are at -p^2, -q^2 = (pi/2)^2,
(3 pi/2)^2, ...; those of Bs are at -p^2 = 0, pi^2, ... and -q^2 = pi^2, ....

Arithmetic: the poles, between which Newton's method and bisection find the zeros.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from generated.arrays import Double, as_doubles, as_result, inside, quiet
from generated.inertia import bending_frequency, bending_residue
from generated.wave_kernels import (
    bending_part,
    bending_residues,
    extension_part,
    material,
    stretching_residues,
)

_MOST = 200  # largest number of steps: of Newton's method, or bisections between two poles


@quiet
def branches(
    x: ArrayLike, nu: ArrayLike, count: int, parity: str = "antisymmetric"
) -> tuple[np.ndarray, np.ndarray]:
    """Compute frequencies and residues of the first Lamb-wave branches of one symmetry.

    Parameters
    ----------
    x : array_like
        Wave number times half-thickness, phi h [1]; 1e-40 <= x <= 1e40.
    nu : array_like
        Poisson's ratio [1]; -1 < nu < 0.5.
    count : int
        Number of branches; at least 1.
    parity : str
        "antisymmetric" for A0, A1, ... (bending), "symmetric" for S0, S1, ... (extension).

    Returns
    -------
    tuple of ndarray
        Frequencies omega h/c_T, ascending, and residues rho h r [1], in the arguments'
        broadcast shape with one more axis of length `count`; NaN outside the domain. A branch
        with residue 0 is not excited by pressure.

    Raises
    ------
    ValueError
        If `parity` is not one of these, or `count` is below 1.

    Notes
    -----
    A0 is computed by `inertia`. Measured for the other branches: frequencies are accurate to 8
    units in the last place, residues to 1e-12 of the largest, most of them to 1e-15 (relative).

    Examples
    --------
    >>> from generated.plate_waves import branches
    >>> frequencies, residues = branches(0.5, 0.22, 3)
    >>> print(frequencies.round(5))
    [0.20162 1.79722 4.67054]
    """
    if parity not in ("antisymmetric", "symmetric"):
        raise ValueError(f"parity is 'antisymmetric' or 'symmetric', got {parity!r}")
    if count < 1:
        raise ValueError(f"expected at least one branch, got count = {count}")
    kind, [x, nu] = as_doubles(x, nu)
    [x] = inside([x], x >= 1e-40, x <= 1e40)
    [nu] = inside([nu], nu > -1, nu < 0.5)
    shape = np.broadcast_shapes(x.shape, nu.shape)
    wave, ratio = (np.ravel(np.broadcast_to(y, shape)) for y in (x, nu))
    known = ~np.isnan(wave + ratio)
    frequency = np.full((wave.size, count), np.nan)
    residue = frequency.copy()
    gam, rest = material(ratio[known])
    if parity == "symmetric":
        frequency[known], residue[known] = _stretching(wave[known], gam, rest, count)
    else:
        plate = wave[known], ratio[known]
        frequency[known, 0], residue[known, 0] = bending_frequency(*plate), bending_residue(*plate)
        frequency[known, 1:], residue[known, 1:] = _bending(wave[known], gam, rest, count)
    sizes = (*shape, count)
    return as_result(frequency.reshape(sizes), kind), as_result(residue.reshape(sizes), kind)


def _bending(x: Double, gam: Double, rest: Double, count: int) -> tuple[Double, Double]:
    """Return all branches but A0: one between two poles, the lowest of which is above x^2."""
    wave, gam, rest = (y[:, None] for y in (x, gam, rest))
    edges = _edges(wave, gam, rest, (np.arange(count) + 0.5) * np.pi)[:, :count]
    over = _between(edges, np.zeros_like(edges[:, 1:]), bending_part, wave, gam, rest)
    return np.sqrt(wave * wave + over), bending_residues(over, wave, gam, rest)


def _stretching(x: Double, gam: Double, rest: Double, count: int) -> tuple[Double, Double]:
    """Return S0, whose interval starts at kap = 0, and the other branches between the poles."""
    wave, gam, rest = (y[:, None] for y in (x, gam, rest))
    square = wave * wave
    poles = _edges(wave, gam, rest, np.arange(count + 1) * np.pi)
    edges = np.hstack((-square, poles[:, 1 : count + 1]))  # q = 0 is not a pole
    floor = np.zeros_like(edges[:, 1:])
    floor[:, :1] = square  # S0 may have kap = x^2
    over = _between(edges, floor, extension_part, wave, gam, rest)
    return np.sqrt(square + over), stretching_residues(over, wave, gam, rest)


def _edges(x: Double, gam: Double, rest: Double, angles: np.ndarray) -> Double:
    """Return kap - x^2 where |p| or |q| equals one of the angles, ascending."""
    square = angles * angles
    return np.sort(np.hstack((square + 0.0 * x, (rest * (x * x) + square) / gam)), axis=1)


def _between(
    edges: Double,
    floor: Double,
    terms: Callable[..., tuple[Double, Double, Double]],
    *plate: Double,
) -> Double:
    """Return kap - x^2 of the zero in each interval, by Newton's method with bisection.

    Most zeros are found in a few steps, some only by many bisections. Each step is therefore
    computed only for the zeros that have not been found yet.
    """
    sizes = floor.shape
    low, high, floor, *own = (
        np.ravel(np.broadcast_to(y, sizes)) for y in (edges[:, :-1], edges[:, 1:], floor, *plate)
    )
    zeros = 0.5 * (low + high)
    sign, open_ = terms(zeros, *own)[2], high > low
    place, over = np.arange(zeros.size), zeros
    for _ in range(_MOST):
        if not open_.any():
            break
        place, low, high, floor, sign, over, *own = (
            y[open_] for y in (place, low, high, floor, sign, over, *own)
        )
        value, change, _ = terms(over, *own)
        beyond = value * sign > 0
        low, high = np.where(beyond, low, over), np.where(beyond, over, high)
        new = over - value / np.where(change == 0, 1.0, change)
        new = np.where((new > low) & (new < high), new, 0.5 * (low + high))
        moved = value != 0
        last, over = over, np.where(moved, new, over)
        zeros[place] = over
        open_ = moved & (np.abs(over - last) > 4e-16 * (floor + np.abs(over)))
    return zeros.reshape(sizes)
