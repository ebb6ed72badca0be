"""Contact law of a single point on a single plate, as plain numbers without NumPy's overhead.

The polynomials and the iteration are those for arrays, for numbers whose products neither
overflow nor underflow. For other numbers, and outside the domain, the result is None; the caller
then evaluates an array of one point.

Arithmetic: Horner's rule; A = a/h; starting value, limits and steps of the iteration.
"""

from dataclasses import dataclass
from functools import cached_property
from math import cbrt
from typing import NamedTuple

from generated import contact_point_kernels as kernels
from generated.contact_numbers import SHORT
from generated.contact_series import ROUNDED, Piece, Plates, far_piece
from generated.plate_arrays import PlateArrays

_STEPS = 60  # largest number of Newton steps; four to six are usual
_CLOSE = 1e-9  # relative residual whose square is far below rounding
_ORDINARY = 1e-60, 1e60  # range of numbers whose products neither overflow nor underflow
_USUAL = 1e-20, 1e20  # range of h/b for which that also applies to the coefficients


class PointPiece(NamedTuple):
    """F = A (S_0 + S_1 t + ...), t = (A^2 - middle) inverse_half, with the highest power first."""

    coefficients: tuple[float, ...]
    middle: float
    inverse_half: float


@dataclass(frozen=True, eq=False)
class PlatePoints:
    """A plate whose contact law is evaluated in plain numbers.

    Parameters
    ----------
    h, b
        Half-thickness and radius [m].
    plates
        Polynomials of the plate, as arrays.
    """

    h: float
    b: float
    plates: Plates

    @cached_property
    def short_limit(self) -> float:
        """Largest A = a/h [1] of the shortened polynomial."""
        return self.reach * SHORT

    @cached_property
    def reach(self) -> float:
        """Largest A [1] of the first polynomial."""
        return self.plates.reach.item()

    @cached_property
    def far(self) -> float:
        """Largest A [1] of the second polynomial."""
        return self.plates.far.item()

    @cached_property
    def near_ratio(self) -> float:
        """sqrt(R delta)/h [1] at the end of the first polynomial."""
        return kernels.depth_ratio_at(self.reach, _value(self.reach, self.first))

    @cached_property
    def far_ratio(self) -> float:
        """sqrt(R delta)/h [1] at the end of the second polynomial."""
        return kernels.depth_ratio_at(self.far, _value(self.far, self.beyond))

    @cached_property
    def linear(self) -> float:
        """Coefficient of A in F, or 0 if that is negative [1]."""
        return max(self.first.coefficients[-1], 0.0)

    @cached_property
    def short(self) -> PointPiece:
        """First polynomial, shortened for small A."""
        return _piece(self.plates.short)

    @cached_property
    def first(self) -> PointPiece:
        """First polynomial."""
        return _piece(self.plates.first)

    @cached_property
    def beyond(self) -> PointPiece:
        """Second polynomial; equal to the first if the plate ends before the second begins."""
        return _piece(far_piece(self.plates.eta)) if self.far > self.reach else self.first


def plate_points(some: PlateArrays) -> PlatePoints | None:
    """Return the plate of scalar h and b if its lengths are ordinary, else None."""
    if some.h.ndim or some.b.ndim:
        return None
    h, b = some.h.item(), some.b.item()
    usual = _USUAL[0] < some.plates.eta.item() < _USUAL[1]
    return PlatePoints(h, b, some.plates) if usual and _ordinary(h, b) else None


def indentation(plate: PlatePoints, a: float, R: float) -> float | None:
    """Return the indentation [m] at a contact radius [m], or None."""
    if not (_ordinary(a, R) and a < plate.b and a < R):
        return None
    A = a / plate.h
    if plate.short_limit >= A:
        value = _value(A, plate.short)
    elif plate.reach * ROUNDED >= A:
        value = _value(A, plate.first)
    elif plate.far >= A:
        value = _value(A, plate.beyond)
    else:
        return None
    return kernels.indentation_in_range(a, 1.0 / R, value)


def contact_radius(plate: PlatePoints, delta: float, R: float) -> float | None:
    """Return the contact radius [m] at an indentation [m], or None."""
    radius = _contact(plate, delta, R)
    return None if radius is None else radius[0]


def force(plate: PlatePoints, delta: float, R: float, lam: float, mu: float) -> float | None:
    """Return the force [N] at an indentation [m], or None."""
    modulus = _modulus(lam, mu)
    contact = None if modulus is None else _contact(plate, delta, R)
    if modulus is None or contact is None:
        return None
    a, radius_ratio = contact
    return kernels.force_in_range(radius_ratio, delta, a, mu, modulus)


def stiffness(plate: PlatePoints, a: float, R: float, lam: float, mu: float) -> float | None:
    """Return the stiffness [N/m] at a contact radius [m], or None."""
    modulus = _modulus(lam, mu)
    if modulus is None or not (_ordinary(a, R) and a < plate.b and a < R):
        return None
    A = a / plate.h
    if not plate.far >= A:
        return None
    rise = kernels.relative_rise(*_with_slope(A, _piece_at(plate, A)))
    return kernels.stiffness_in_range(a, rise, mu, modulus)


def _contact(plate: PlatePoints, delta: float, R: float) -> tuple[float, float] | None:
    """Return the contact radius [m] and its ratio to Hertz's radius, or None."""
    if not _ordinary(delta, R):
        return None
    eps = kernels.depth_ratio_in_range(delta, R, plate.h)
    if eps > plate.near_ratio and not eps <= plate.far_ratio:
        return None
    radius_ratio = _invert(plate, eps)
    a = kernels.radius_in_range(radius_ratio, delta, R)
    return (a, radius_ratio) if a < plate.b and a < R else None


def _invert(plate: PlatePoints, eps: float) -> float:
    """Return A/eps, where A sqrt(1 + F) equals eps."""
    most = (plate.reach if eps <= plate.near_ratio else plate.far) / eps
    thin = 1.0 / cbrt(eps * plate.linear) if plate.linear > 0.0 else 1.0
    radius_ratio = min(thin, 1.0, most)
    for _ in range(_STEPS):
        A = radius_ratio * eps
        value, slope = _with_slope(A, _piece_at(plate, A))
        residual, step = kernels.newton_step(radius_ratio, value, slope)
        radius_ratio = min(radius_ratio * min(max(1.0 + step, 0.3), 3.0), most)
        if abs(residual) <= _CLOSE:
            break
    return radius_ratio


def _ordinary(one: float, other: float) -> bool:
    low, high = _ORDINARY
    return low < one < high and low < other < high


def _modulus(lam: float, mu: float) -> float | None:
    """Return (4/3) E*/mu of ordinary constants, None for others."""
    low, high = _ORDINARY
    if low < mu < high and -2.0 * mu < 3.0 * lam < high:
        return kernels.modulus_over_mu(lam, mu)
    return None


def _piece_at(plate: PlatePoints, A: float) -> PointPiece:
    """Return the polynomial, of the two with a slope, that applies at A."""
    return plate.first if plate.reach * ROUNDED >= A else plate.beyond


def _piece(piece: Piece) -> PointPiece:
    coefficients = tuple(piece.coefficients[::-1, 0].tolist())
    return PointPiece(coefficients, piece.middle.item(), 1.0 / piece.half.item())


def _value(A: float, piece: PointPiece) -> float:
    """Return F."""
    t = (A * A - piece.middle) * piece.inverse_half
    value = 0.0
    for coefficient in piece.coefficients:
        value = value * t + coefficient
    return A * value


def _with_slope(A: float, piece: PointPiece) -> tuple[float, float]:
    """Return F and A F'."""
    square = A * A
    t = (square - piece.middle) * piece.inverse_half
    value = slope = 0.0
    for coefficient in piece.coefficients:
        slope = slope * t + value
        value = value * t + coefficient
    return kernels.with_slope_of(A, square, piece.inverse_half, value, slope)
