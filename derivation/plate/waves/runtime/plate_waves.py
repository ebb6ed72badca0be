"""Every branch of waves in a free plate: frequencies, and how each answers a load on one face.

Of one wave number x = phi h the loaded face yields to a load of frequency omega as::

    w(+h)/A = (h/mu) (1/Ba + 1/Bs),   1/B(kap) = sum r_k/(kap_k - kap),   kap = (omega h/c_T)^2

with Ba and Bs as in `inertia`. Both fall wherever they are finite (they are the kinetic energy's
quotients), so that between two poles of either there is one zero, one branch of its kind. The
poles are known: with p^2 = x^2 - gam kap and q^2 = x^2 - kap those of Ba are at
-p^2, -q^2 = (pi/2)^2, (3 pi/2)^2, ..., those of Bs at -p^2 = 0, pi^2, ... and -q^2 = pi^2, ....

Arithmetic: the poles, between which Newton's method and bisection find the zeros.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from generated.arrays import Double, as_doubles, as_result, inside, quiet
from generated.inertia import bending_frequency, bending_residue
from generated.wave_kernels import bending_residues, bent, material, stretched, stretching_residues

_MOST = 200  # steps at most: Newton's, or halvings of the interval between two poles


@quiet
def branches(
    x: ArrayLike, nu: ArrayLike, count: int, parity: str = "antisymmetric"
) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies of the first branches of one kind, and how they answer a load.

    Parameters
    ----------
    x : array_like
        Wave number times half-thickness, phi h [1]; 1e-40 <= x <= 1e40.
    nu : array_like
        Poisson's ratio [1]; -1 < nu < 0.5.
    count : int
        How many branches; at least 1.
    parity : str
        "antisymmetric" for A0, A1, ... (bending), "symmetric" for S0, S1, ... (stretching).

    Returns
    -------
    tuple of ndarray
        Frequencies omega h/c_T, ascending, and residues rho h r [1], in the arguments'
        broadcast shape and `count` along one more axis; NaN outside the domain. A residue of
        0 is a branch that no pressure moves.

    Raises
    ------
    ValueError
        For another parity, and a count below 1.

    Notes
    -----
    A0 is that of `inertia`. Measured, of the others: frequencies are right to 8 units in the last
    place, residues to 1e-12 of the largest, most of them to 1e-15 of themselves.
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
    """All but A0: between the poles, the lowest of which is above x^2."""
    wave, gam, rest = (y[:, None] for y in (x, gam, rest))
    edges = _edges(wave, gam, rest, (np.arange(count) + 0.5) * np.pi)[:, :count]
    over = _between(edges, np.zeros_like(edges[:, 1:]), bent, wave, gam, rest)
    return np.sqrt(wave * wave + over), bending_residues(over, wave, gam, rest)


def _stretching(x: Double, gam: Double, rest: Double, count: int) -> tuple[Double, Double]:
    """S0 from kap = 0 on, the others between the poles."""
    wave, gam, rest = (y[:, None] for y in (x, gam, rest))
    square = wave * wave
    poles = _edges(wave, gam, rest, np.arange(count + 1) * np.pi)
    edges = np.hstack((-square, poles[:, 1 : count + 1]))  # q = 0 is no pole
    floor = np.zeros_like(edges[:, 1:])
    floor[:, :1] = square  # S0 may have kap = x^2
    over = _between(edges, floor, stretched, wave, gam, rest)
    return np.sqrt(square + over), stretching_residues(over, wave, gam, rest)


def _edges(x: Double, gam: Double, rest: Double, angles: np.ndarray) -> Double:
    """kap - x^2 where |p| or |q| is one of the angles, ascending."""
    square = angles * angles
    return np.sort(np.hstack((square + 0.0 * x, (rest * (x * x) + square) / gam)), axis=1)


def _between(
    edges: Double,
    floor: Double,
    terms: Callable[..., tuple[Double, Double, Double]],
    *plate: Double,
) -> Double:
    """kap - x^2 of the zero between every two edges: Newton's method, or halving."""
    low, high = edges[:, :-1].copy(), edges[:, 1:].copy()
    over = 0.5 * (low + high)
    sign, open_ = terms(over, *plate)[2], high > low
    for _ in range(_MOST):
        value, change, _ = terms(over, *plate)
        beyond = value * sign > 0
        low, high = np.where(beyond, low, over), np.where(beyond, over, high)
        new = over - value / np.where(change == 0, 1.0, change)
        new = np.where((new > low) & (new < high), new, 0.5 * (low + high))
        moved = open_ & (value != 0)
        last, over = over, np.where(moved, new, over)
        open_ = moved & (np.abs(over - last) > 4e-16 * (floor + np.abs(over)))
        if not open_.any():
            break
    return over
