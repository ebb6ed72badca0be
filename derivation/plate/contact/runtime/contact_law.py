"""Contact law of a sphere pressed into a plate: indentation, contact radius, force, stiffness.

Hertz pressure over the contact radius a, the plate's edge as in the paper, A = a/h::

    delta = (a^2/R) (1 + F(A)),   P = 16 mu (lam + mu)/(3 (lam + 2 mu)) a^3/R

F is a polynomial per plate, see `contact_series`. All arguments broadcast.

Arithmetic: A = a/h; where the iteration for the contact radius starts, its ends, and its steps.
"""

import numpy as np
from numpy.typing import ArrayLike

from generated import contact_kernels as kernels
from generated.arrays import Double, as_doubles, as_result, in_manifest, inside, quiet
from generated.contact_points import cut, cut_index, flat, index_of
from generated.contact_series import (
    ROUNDED,
    THICKEST,
    THINNEST,
    Plates,
    blocks_of,
    columns,
    correction,
    correction_with_slope,
    indent,
    plates_of,
    sphere_on_plate,
    value_of,
)
from generated.ranges import moderate

_STEPS = 60  # of Newton's iteration at most; it takes four to six
_CLOSE = 1e-9  # a relative residual whose square is far below rounding


@in_manifest(
    r"\delta",
    equation="6",
    domain="a >= 0, a < b, a < R, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "a <= 6 * h or h/b >= 1e-5",
)
@quiet
def indentation(a: ArrayLike, R: ArrayLike, h: ArrayLike, b: ArrayLike) -> np.ndarray:
    """Indentation of the loaded face for a given contact radius.

    Formula::

        delta = (a^2/R) (1 + F),  F = c1 A + c3 A^3 + ... continued to all a < b

    Parameters
    ----------
    a : array_like
        Contact radius [m]; a >= 0, a < b, a < R; beyond 6 h only for h/b >= 1e-5, slowly.
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
    """
    kind, [a, R, h, b] = as_doubles(a, R, h, b)
    [R], [h] = inside([R], R > 0), inside([h], h > 0)
    plates, owner = _plates(h, b)
    shape = np.broadcast_shapes(a.shape, R.shape, owner.shape)
    flat_a, flat_R, flat_h, end = (flat(x, shape) for x in (a, R, h, np.minimum(b, R)))
    index = index_of(owner, shape)
    single = sphere_on_plate(plates, h, R)
    result = np.empty(int(np.prod(shape)))
    for part in blocks_of(result.size):
        radius, limit = flat_a[part], cut(end, part)
        most = radius.max()
        if not (radius.min() >= 0 and most < np.min(limit)):
            [radius] = inside([radius], radius >= 0, radius < limit)
            most = np.nan
        if single is not None:
            indent(radius, most, single, result[part])
            continue
        value = correction(radius / cut(flat_h, part), plates, cut_index(index, part))
        result[part] = kernels.indentation_of(radius, cut(flat_R, part), value)
    return as_result(result.reshape(shape), kind)


@in_manifest(
    "a",
    equation="6",
    domain="delta >= 0, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, a < R, a <= b, "
    "a <= 6 * h for the a that results",
)
@quiet
def contact_radius(delta: ArrayLike, R: ArrayLike, h: ArrayLike, b: ArrayLike) -> np.ndarray:
    """Contact radius for a given indentation.

    Newton's iteration for the logarithm of a over Hertz's radius, from the lesser of
    that and the radius of a thin plate, guarded by the ends of the polynomial.

    Parameters
    ----------
    delta : array_like
        Indentation [m]; from 0 to its value at a = min(b, 6 h).
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
    """
    kind, doubles = as_doubles(delta, R, h, b)
    return as_result(_contact(*doubles)[0], kind)


@in_manifest(
    "P",
    equation="10",
    domain="delta >= 0, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, 3 * lam > -2 * mu, "
    "mu > 0, a < R, a <= b, a <= 6 * h for the a that results",
)
@quiet
def force(
    delta: ArrayLike, R: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Contact force for a given indentation.

    Parameters
    ----------
    delta : array_like
        Indentation [m]; from 0 to its value at a = min(b, 6 h).
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
    """
    kind, doubles = as_doubles(delta, R, h, b, lam, mu)
    delta, R, h, b, lam, mu = doubles
    [lam, mu] = inside([lam, mu], *_elastic(lam, mu))
    a, share = _contact(delta, R, h, b)
    return as_result(kernels.force_of_share(share, delta, a, *_modulus(lam, mu)), kind)


@in_manifest("P", equation="7", domain="a >= 0, a < R, R > 0, 3 * lam > -2 * mu, mu > 0")
@quiet
def force_of_radius(a: ArrayLike, R: ArrayLike, lam: ArrayLike, mu: ArrayLike) -> np.ndarray:
    """Contact force for a given contact radius.

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
    """
    kind, [a, R, lam, mu] = as_doubles(a, R, lam, mu)
    [a, R, lam, mu] = inside([a, R, lam, mu], a >= 0, a < R, R > 0, *_elastic(lam, mu))
    return as_result(kernels.hertz_force(a, R, *_modulus(lam, mu)), kind)


@in_manifest(
    "a",
    equation="7",
    domain="P >= 0, R > 0, 3 * lam > -2 * mu, mu > 0, a < R for the a that results",
)
@quiet
def radius_of_force(P: ArrayLike, R: ArrayLike, lam: ArrayLike, mu: ArrayLike) -> np.ndarray:
    """Contact radius for a given contact force.

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
    """
    kind, [P, R, lam, mu] = as_doubles(P, R, lam, mu)
    [P, R, lam, mu] = inside([P, R, lam, mu], P >= 0, R > 0, *_elastic(lam, mu))
    a = kernels.hertz_radius(P, R, *_modulus(lam, mu))
    return as_result(inside([a], a < R)[0], kind)


@in_manifest(
    r"\mathrm{d}P/\mathrm{d}\delta",
    equation="10",
    domain="a >= 0, a < b, a < R, R > 0, h > 0, b > 0, h/b >= 1e-90, h/b <= 1e90, "
    "3 * lam > -2 * mu, mu > 0, a <= 6 * h or h/b >= 1e-5",
)
@quiet
def stiffness(
    a: ArrayLike, R: ArrayLike, h: ArrayLike, b: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    """Contact stiffness dP/d delta for a given contact radius.

    Formula::

        dP/d delta = 16 mu (lam + mu)/(lam + 2 mu) a/(2 (1 + F) + A F')

    Parameters
    ----------
    a : array_like
        Contact radius [m]; a >= 0, a < b, a < R; beyond 6 h only for h/b >= 1e-5, slowly.
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
    """
    kind, [a, R, h, b, lam, mu] = as_doubles(a, R, h, b, lam, mu)
    [a, lam, mu] = inside([a, lam, mu], a >= 0, a < b, a < R, R > 0, *_elastic(lam, mu))
    [h] = inside([h], h > 0)
    plates, owner = _plates(h, b)
    shape = np.broadcast_shapes(a.shape, owner.shape)
    flat_a, flat_h, index = flat(a, shape), flat(h, shape), index_of(owner, shape)
    result = np.empty(int(np.prod(shape)))
    for part in blocks_of(result.size):
        A = flat_a[part] / cut(flat_h, part)
        value, slope = correction_with_slope(A, plates, cut_index(index, part))
        result[part] = kernels.relative_rise(value, slope)
    whole = np.broadcast_to(result.reshape(shape), np.broadcast_shapes(shape, R.shape))
    return as_result(kernels.contact_stiffness(a, whole, *_modulus(lam, mu)), kind)


@in_manifest("p_0", equation="7", domain="a >= 0, a < R, R > 0, 3 * lam > -2 * mu, mu > 0")
@quiet
def max_pressure(a: ArrayLike, R: ArrayLike, lam: ArrayLike, mu: ArrayLike) -> np.ndarray:
    """Largest contact pressure, at the centre, as a positive number.

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
    """
    kind, [a, R, lam, mu] = as_doubles(a, R, lam, mu)
    [a, R, lam, mu] = inside([a, R, lam, mu], a >= 0, a < R, R > 0, *_elastic(lam, mu))
    return as_result(kernels.largest_pressure(a, R, *_modulus(lam, mu)), kind)


def _contact(delta: Double, R: Double, h: Double, b: Double) -> tuple[Double, Double]:
    """Contact radius, and what share it is of Hertz's radius sqrt(R delta)."""
    # -0 becomes 0, of which roots and quotients have no sign.
    [delta, R], [h] = inside([delta + 0.0, R], delta >= 0, R > 0), inside([h], h > 0)
    plates, owner = _plates(h, b)
    shape = np.broadcast_shapes(delta.shape, R.shape, owner.shape)
    index = index_of(owner, shape)
    eps = np.ravel(np.broadcast_to(kernels.depth_ratio(delta, R, h), shape))
    limits = _limits(eps, plates, index)
    found = np.empty(eps.size)
    for part in blocks_of(eps.size):
        found[part] = _invert(eps[part], plates, limits, cut_index(index, part))
    share: Double = found.reshape(shape)
    a = kernels.radius_of_share(share, delta, R)
    a = np.where(a <= ROUNDED * b, np.minimum(a, b), np.nan)
    return inside([a], a < R)[0], share


def _invert(
    eps: Double, plates: Plates, limits: tuple[Double, Double], index: np.ndarray | None
) -> Double:
    """A/eps where A sqrt(1 + F) is eps; NaN where that is beyond the second of `limits`."""
    pick: slice | np.ndarray = slice(None) if index is None else index
    near, limit = (x[pick] for x in limits)
    linear = np.maximum(plates.first.coefficients[0][pick], 0.0)
    [eps] = inside([eps], eps <= ROUNDED * limit)
    most = np.where(eps <= near, plates.reach[pick], plates.far[pick]) / eps
    share = np.minimum(np.minimum(1.0 / np.cbrt(eps * linear), 1.0), most)
    for _ in range(_STEPS):
        value, slope = correction_with_slope(share * eps, plates, index)
        residual, step = kernels.newton_step(share, value, slope)
        share = np.minimum(share * np.clip(1.0 + step, 0.3, 3.0), most)
        if not (np.abs(residual) > _CLOSE).any():
            break
    return share


def _limits(eps: Double, plates: Plates, index: np.ndarray | None) -> tuple[Double, Double]:
    """A sqrt(1 + F) of each plate at A = reach, and at its far end if any point needs that."""
    every = np.arange(plates.eta.size)
    near = kernels.depth_ratio_at(
        plates.reach, value_of(plates.reach, columns(plates.first, every))
    )
    owner = np.zeros(eps.size, dtype=np.intp) if index is None else index
    needed = np.unique(owner[eps > near[owner]])
    limit = near.copy()
    if needed.size:
        end = plates.far[needed]
        limit[needed] = kernels.depth_ratio_at(end, correction(end, plates, needed))
    return near, limit


def _plates(h: Double, b: Double) -> tuple[Plates, np.ndarray]:
    """Polynomials of each plate of the broadcast h and b, and the plate's number in that shape."""
    h, b = np.broadcast_arrays(h, b)
    sound = (h > 0) & (b > 0)
    eta = np.where(sound, h, np.nan) / b
    [eta] = inside([eta], eta >= THINNEST, eta <= THICKEST)
    return plates_of(eta.ravel()), np.arange(eta.size).reshape(eta.shape)


def _elastic(lam: Double, mu: Double) -> tuple[np.ndarray, np.ndarray]:
    first, second = moderate(lam, mu)
    return 3.0 * first > -2.0 * second, mu > 0


def _modulus(lam: Double, mu: Double) -> tuple[Double, Double]:
    """(4/3) E*, as factors."""
    return mu, kernels.modulus_over_mu(*moderate(lam, mu))
