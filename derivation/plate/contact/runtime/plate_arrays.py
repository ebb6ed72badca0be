"""Contact law for arrays of points on prepared plates.

Points are processed in blocks. If each plate has many points along axes of its own, the plates
are processed one after another; otherwise the coefficients are gathered for each point.

Arithmetic: A = a/h; starting value, limits and steps of the iteration for the contact radius.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from generated import contact_kernels as kernels
from generated.arrays import Double, inside
from generated.contact_domain import modulus_factors
from generated.contact_points import cut, cut_index, flat, index_of
from generated.contact_series import (
    ROUNDED,
    Piece,
    Plates,
    blocks_of,
    columns,
    correction,
    correction_with_slope,
    indent,
    sphere_on_plate,
    value_of,
)

_STEPS = 60  # largest number of Newton steps; four to six are usual
_CLOSE = 1e-9  # relative residual whose square is far below rounding
_APART = 512  # number of points per plate from which the plate is processed separately


@dataclass(frozen=True, eq=False)
class PlateArrays:
    """Plates of the broadcast lengths h and b; h is NaN where h <= 0.

    Parameters
    ----------
    h, b
        Half-thickness and radius [m], of any shapes.
    plates
        Polynomials of the distinct plates.
    owner
        Index of the polynomials of each plate, in the broadcast shape of h and b.
    """

    h: Double
    b: Double
    plates: Plates
    owner: np.ndarray

    @cached_property
    def near(self) -> Double:
        """sqrt(R delta)/h [1] at the end of the first polynomial, for each distinct plate."""
        every = np.arange(self.plates.eta.size)
        value = value_of(self.plates.reach, columns(self.plates.first, every))
        return kernels.depth_ratio_at(self.plates.reach, value)


def indentations(some: PlateArrays, a: Double, R: Double) -> Double:
    """Return the indentation [m] at contact radii [m]; NaN outside the domain."""
    [R] = inside([R], R > 0)
    return _plate_by_plate(_indentations, some, a, R)


def radii(some: PlateArrays, delta: Double, R: Double) -> Double:
    """Return the contact radius [m] at indentations [m]; NaN outside the domain."""
    return _plate_by_plate(lambda *given: _contact(*given)[0], some, delta, R)


def forces(some: PlateArrays, delta: Double, R: Double, lam: Double, mu: Double) -> Double:
    """Return the force [N] at indentations [m] for valid Lame constants; NaN outside the domain."""
    return _plate_by_plate(_forces, some, delta, R, lam, mu)


def stiffnesses(some: PlateArrays, a: Double, R: Double, lam: Double, mu: Double) -> Double:
    """Return the stiffness [N/m] at radii [m] for valid Lame constants; NaN outside the domain."""
    [a] = inside([a], a >= 0, a < some.b, a < R, R > 0)
    rise = _plate_by_plate(_rises, some, a)
    whole = np.broadcast_to(rise, np.broadcast_shapes(rise.shape, R.shape))
    return kernels.contact_stiffness(a, whole, *modulus_factors(lam, mu))


def _plate_by_plate(
    function: Callable[..., Double], some: PlateArrays, *arguments: Double
) -> Double:
    """Evaluate a function plate by plate, if each plate has many points along its own axes."""
    owner = some.owner
    shape = np.broadcast_shapes(owner.shape, *(x.shape for x in arguments))
    count = int(np.prod(shape))
    if owner.size == 1 or owner.size != some.plates.eta.size or count < _APART * owner.size:
        return function(some, *arguments)
    values = np.empty(shape)
    for place in np.ndindex(owner.shape):
        where = (
            ...,
            *(i if n > 1 else slice(None) for i, n in zip(place, owner.shape, strict=True)),
        )
        h, b, *rest = (_at(x, place, owner.shape) for x in (some.h, some.b, *arguments))
        values[where] = function(_one_of(some, int(owner[place]), h, b), *rest)
    return values


def _at(x: Double, place: tuple[int, ...], lengths: tuple[int, ...]) -> Double:
    """Return the part of an argument that belongs to the plate at an index of the plates' axes."""
    whole = x.reshape((1,) * (len(place) - x.ndim) + x.shape)
    sizes = whole.shape[whole.ndim - len(place) :]
    own = (min(i, size - 1) for i, size in zip(place, sizes, strict=True))
    where = (i if n > 1 else slice(None) for i, n in zip(own, lengths, strict=True))
    value: Double = whole[(..., *where)]
    return value


def _one_of(some: PlateArrays, number: int, h: Double, b: Double) -> PlateArrays:
    """Return one of the plates."""
    pick = slice(number, number + 1)
    eta, reach, far, short, first = some.plates
    pieces = (Piece(x.coefficients[:, pick], x.middle[pick], x.half[pick]) for x in (short, first))
    plates = Plates(eta[pick], reach[pick], far[pick], *pieces)
    return PlateArrays(h, b, plates, np.zeros((1,) * h.ndim, dtype=np.intp))


def _indentations(some: PlateArrays, a: Double, R: Double) -> Double:
    shape = np.broadcast_shapes(a.shape, R.shape, some.owner.shape)
    flat_a, flat_R, flat_h, end = (flat(x, shape) for x in (a, R, some.h, np.minimum(some.b, R)))
    index = index_of(some.owner, shape)
    single = sphere_on_plate(some.plates, some.h, R)
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
        value = correction(radius / cut(flat_h, part), some.plates, cut_index(index, part))
        result[part] = kernels.indentation_of(radius, cut(flat_R, part), value)
    return result.reshape(shape)


def _rises(some: PlateArrays, a: Double) -> Double:
    """Return (R/a) d delta/da."""
    shape = np.broadcast_shapes(a.shape, some.owner.shape)
    flat_a, flat_h, index = flat(a, shape), flat(some.h, shape), index_of(some.owner, shape)
    result = np.empty(int(np.prod(shape)))
    for part in blocks_of(result.size):
        A = flat_a[part] / cut(flat_h, part)
        value, slope = correction_with_slope(A, some.plates, cut_index(index, part))
        result[part] = kernels.relative_rise(value, slope)
    return result.reshape(shape)


def _forces(some: PlateArrays, delta: Double, R: Double, lam: Double, mu: Double) -> Double:
    a, radius_ratio = _contact(some, delta, R)
    return kernels.force_of_ratio(radius_ratio, delta + 0.0, a, *modulus_factors(lam, mu))


def _contact(some: PlateArrays, delta: Double, R: Double) -> tuple[Double, Double]:
    """Return the contact radius and its ratio to Hertz's radius sqrt(R delta)."""
    # -0 becomes 0, whose roots and quotients carry no sign.
    [delta, R] = inside([delta + 0.0, R], delta >= 0, R > 0)
    shape = np.broadcast_shapes(delta.shape, R.shape, some.owner.shape)
    index = index_of(some.owner, shape)
    eps = np.ravel(np.broadcast_to(kernels.depth_ratio(delta, R, some.h), shape))
    limit = _limits(eps, some, index)
    radii = np.empty(eps.size)
    for part in blocks_of(eps.size):
        radii[part] = _invert(eps[part], some, limit, cut_index(index, part))
    radius_ratio: Double = radii.reshape(shape)
    a = kernels.radius_of_ratio(radius_ratio, delta, R)
    a = np.where(a <= ROUNDED * some.b, np.minimum(a, some.b), np.nan)
    return inside([a], a < R)[0], radius_ratio


def _invert(eps: Double, some: PlateArrays, limits: Double, index: np.ndarray | None) -> Double:
    """Return A/eps, where A sqrt(1 + F) equals eps; NaN where that exceeds `limits`."""
    plates = some.plates
    pick: slice | np.ndarray = slice(None) if index is None else index
    near, limit = some.near[pick], limits[pick]
    linear = np.maximum(plates.first.coefficients[0][pick], 0.0)
    [eps] = inside([eps], eps <= ROUNDED * limit)
    most = np.where(eps <= near, plates.reach[pick], plates.far[pick]) / eps
    radius_ratio = np.minimum(np.minimum(1.0 / np.cbrt(eps * linear), 1.0), most)
    for _ in range(_STEPS):
        value, slope = correction_with_slope(radius_ratio * eps, plates, index)
        residual, step = kernels.newton_step(radius_ratio, value, slope)
        radius_ratio = np.minimum(radius_ratio * np.clip(1.0 + step, 0.3, 3.0), most)
        if not (np.abs(residual) > _CLOSE).any():
            break
    return radius_ratio


def _limits(eps: Double, some: PlateArrays, index: np.ndarray | None) -> Double:
    """Return A sqrt(1 + F) of each plate at its far end if a point needs it, else at A = reach."""
    plates, near = some.plates, some.near
    owner = np.zeros(eps.size, dtype=np.intp) if index is None else index
    needed = np.unique(owner[eps > near[owner]])
    limit = near.copy()
    if needed.size:
        end = plates.far[needed]
        limit[needed] = kernels.depth_ratio_at(end, correction(end, plates, needed))
    return limit
