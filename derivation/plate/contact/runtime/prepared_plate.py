"""A prepared plate: its contact law for any number of calls.

    >>> from generated.prepared_plate import prepare
    >>> pane = prepare(0.1, 1.0)
    >>> print(f"{pane.indentation(0.004, 0.13):.10g}")
    0.0001629483151

`contact_law` has the same functions with the plate's dimensions as arguments; it prepares the
plate again in each call.

Arithmetic: none.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from generated import plate_arrays, plate_points
from generated.arrays import Double, as_doubles, as_result, inside, quiet, refuse_masked
from generated.contact_domain import elastic, plates_of_lengths
from generated.plate_arrays import PlateArrays
from generated.plate_points import PlatePoints


@dataclass(frozen=True, eq=False)
class PreparedPlate:
    """A plate, or plates of broadcast dimensions, with computed polynomials; see `prepare`.

    The errors and budgets are those of `contact_law`. Arrays of contacts broadcast with the
    plates' dimensions. A single contact on a single plate takes about ten microseconds.

    Parameters
    ----------
    h, b
        Half the plate's thickness and its radius [m], as given.
    arrays
        Polynomials of the plates.
    """

    h: ArrayLike
    b: ArrayLike
    arrays: PlateArrays

    def indentation(self, a: ArrayLike, R: ArrayLike) -> np.ndarray:
        """Compute the indentation for a given contact radius, plate deflection included.

        Parameters
        ----------
        a : array_like
            Contact radius [m]; a >= 0, a < b, a < R; above 6 h slower and only for h/b >= 1e-5.
        R : array_like
            Sphere radius [m]; R > 0.

        Returns
        -------
        float or ndarray
            delta [m] in the broadcast shape of arguments and plates; NaN outside the domain.

        Examples
        --------
        >>> from generated.prepared_plate import prepare
        >>> print(f"{prepare(0.1, 1.0).indentation(0.004, 0.13):.10g}")
        0.0001629483151
        """
        if (point := _numbers(a, R)) and self.points is not None:
            value = plate_points.indentation(self.points, *point)
            if value is not None:
                return _single(value)
        return _indentation(self, a, R)

    def contact_radius(self, delta: ArrayLike, R: ArrayLike) -> np.ndarray:
        """Compute the contact radius for a given indentation.

        Parameters
        ----------
        delta : array_like
            Indentation [m]; from 0 to its value at a = min(b, 6 h), and such that a < R.
        R : array_like
            Sphere radius [m]; R > 0.

        Returns
        -------
        float or ndarray
            a [m] in the broadcast shape of arguments and plates; NaN outside the domain.

        Examples
        --------
        >>> from generated.prepared_plate import prepare
        >>> print(f"{prepare(0.1, 1.0).contact_radius(0.00016294831507, 0.13):.10g}")
        0.004
        """
        if (point := _numbers(delta, R)) and self.points is not None:
            value = plate_points.contact_radius(self.points, *point)
            if value is not None:
                return _single(value)
        return _contact_radius(self, delta, R)

    def force(self, delta: ArrayLike, R: ArrayLike, lam: ArrayLike, mu: ArrayLike) -> np.ndarray:
        """Compute the contact force for a given indentation.

        Parameters
        ----------
        delta : array_like
            Indentation [m]; from 0 to its value at a = min(b, 6 h), and such that a < R.
        R : array_like
            Sphere radius [m]; R > 0.
        lam : array_like
            First Lame constant [Pa]; 3 lam > -2 mu.
        mu : array_like
            Second Lame constant (shear modulus) [Pa]; mu > 0.

        Returns
        -------
        float or ndarray
            P [N] in the broadcast shape of arguments and plates; NaN outside the domain.

        Examples
        --------
        >>> from generated.prepared_plate import prepare
        >>> print(f"{prepare(0.1, 1.0).force(0.00016294831507, 0.13, 0.36e9, 0.43e9):.6g}")
        731.09
        """
        if (point := _numbers(delta, R, lam, mu)) and self.points is not None:
            value = plate_points.force(self.points, *point)
            if value is not None:
                return _single(value)
        return _force(self, delta, R, lam, mu)

    def stiffness(self, a: ArrayLike, R: ArrayLike, lam: ArrayLike, mu: ArrayLike) -> np.ndarray:
        """Compute the contact stiffness dP/d delta for a given contact radius.

        Parameters
        ----------
        a : array_like
            Contact radius [m]; a >= 0, a < b, a < R; above 6 h slower and only for h/b >= 1e-5.
        R : array_like
            Sphere radius [m]; R > 0.
        lam : array_like
            First Lame constant [Pa]; 3 lam > -2 mu.
        mu : array_like
            Second Lame constant (shear modulus) [Pa]; mu > 0.

        Returns
        -------
        float or ndarray
            dP/d delta [N/m] in the broadcast shape of arguments and plates; NaN outside the
            domain.

        Examples
        --------
        >>> from generated.prepared_plate import prepare
        >>> print(f"{prepare(0.1, 1.0).stiffness(0.004, 0.13, 0.36e9, 0.43e9):.6g}")
        5.99637e+06
        """
        if (point := _numbers(a, R, lam, mu)) and self.points is not None:
            value = plate_points.stiffness(self.points, *point)
            if value is not None:
                return _single(value)
        return _stiffness(self, a, R, lam, mu)

    @cached_property
    def points(self) -> PlatePoints | None:
        """Plate for contacts in plain numbers; None unless h and b are plain, ordinary numbers."""
        plain = isinstance(self.h, (int, float)) and isinstance(self.b, (int, float))
        return plate_points.plate_points(self.arrays) if plain else None


@quiet
def prepare(h: ArrayLike, b: ArrayLike) -> PreparedPlate:
    """Prepare one plate, or many, for repeated contacts.

    Parameters
    ----------
    h : array_like
        Half the plate's thickness [m]; h > 0.
    b : array_like
        Plate radius [m]; b > 0, 1e-90 <= h/b <= 1e90.

    Returns
    -------
    PreparedPlate
        Its methods return NaN for plates outside the domain.

    Raises
    ------
    TypeError
        If an argument is not real, or a masked array.

    Examples
    --------
    >>> import numpy as np
    >>> from generated.prepared_plate import prepare
    >>> panes = prepare(np.array([0.01, 0.1, 10.0]), 1.0)
    >>> np.round(1e3 * panes.indentation(0.004, 0.13), 4)
    array([39.3342,  0.1629,  0.1229])
    """
    refuse_masked(h, b)
    h, b = _kept(h), _kept(b)
    _, [half, radius] = as_doubles(h, b)
    plates, owner = plates_of_lengths(half, radius)
    [valid] = inside([half], half > 0)
    return PreparedPlate(h, b, PlateArrays(valid, radius, plates, owner))


def _kept(length: ArrayLike) -> ArrayLike:
    """Return a number, or a copy of an array, because the caller may change the array later."""
    return length if isinstance(length, (int, float)) else np.array(length)


def _numbers(*arguments: ArrayLike) -> tuple[float, ...]:
    """Return the arguments as plain numbers; an empty result if one of them is not a number."""
    for argument in arguments:
        if not isinstance(argument, (int, float)):
            return ()
    try:
        return tuple(map(float, arguments))  # type: ignore[arg-type]
    except OverflowError:
        return ()


def _single(value: float) -> np.ndarray:
    """Return a number as a NumPy scalar."""
    scalar: np.ndarray = np.float64(value)  # type: ignore[assignment]
    return scalar


@quiet
def _indentation(plate: PreparedPlate, a: ArrayLike, R: ArrayLike) -> np.ndarray:
    kind, [a, R, *_] = as_doubles(a, R, plate.h, plate.b)
    return as_result(plate_arrays.indentations(plate.arrays, a, R), kind)


@quiet
def _contact_radius(plate: PreparedPlate, delta: ArrayLike, R: ArrayLike) -> np.ndarray:
    kind, [delta, R, *_] = as_doubles(delta, R, plate.h, plate.b)
    return as_result(plate_arrays.radii(plate.arrays, delta, R), kind)


@quiet
def _force(
    plate: PreparedPlate, delta: ArrayLike, R: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    kind, [delta, R, lam, mu, *_] = as_doubles(delta, R, lam, mu, plate.h, plate.b)
    return as_result(plate_arrays.forces(plate.arrays, delta, R, *_inside(lam, mu)), kind)


@quiet
def _stiffness(
    plate: PreparedPlate, a: ArrayLike, R: ArrayLike, lam: ArrayLike, mu: ArrayLike
) -> np.ndarray:
    kind, [a, R, lam, mu, *_] = as_doubles(a, R, lam, mu, plate.h, plate.b)
    return as_result(plate_arrays.stiffnesses(plate.arrays, a, R, *_inside(lam, mu)), kind)


def _inside(lam: Double, mu: Double) -> list[Double]:
    return inside([lam, mu], *elastic(lam, mu))
