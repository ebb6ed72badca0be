"""Contacts with non-Hertzian pressure, cached because bounds and motion need the same radii."""

from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from generated.arrays import Double as Array

if TYPE_CHECKING:
    from generated.non_hertzian_pressure import Contact, Plate


class SolvedCase(NamedTuple):
    """The quantities that determine the contact of a law at a radius, for many scenes in columns.

    Attributes
    ----------
    h, b, R
        Half the thickness and radius of the plate, and radius of the sphere [m].
    modulus, plate_modulus
        E* of the contact and of the plate alone [Pa].
    sphere
        Whether the profile is that of a sphere instead of its paraboloid.
    edge
        Coefficient of (t^2 + s^2)/h^3 in the kernel by another edge [1].
    """

    h: float
    b: float
    R: float
    modulus: float
    plate_modulus: float
    sphere: bool
    edge: float

    def rows(self, count: int) -> list["SolvedCase"]:
        """Return the quantities of each of many scenes."""
        columns = (np.broadcast_to(x, (count, 1))[:, 0].tolist() for x in self)
        return [SolvedCase(*numbers) for numbers in zip(*columns, strict=True)]


@lru_cache(maxsize=64)
def plate_of(h: float, b: float, edge: float) -> "Plate":
    """Return the kernel of a plate, see `generated.non_hertzian_pressure.plate`."""
    from generated import non_hertzian_pressure

    return non_hertzian_pressure.plate(h, b, edge)


def contact_at(a: Array, case: SolvedCase) -> "Contact":
    """Return the contact at contact radii [m]; see `generated.non_hertzian_pressure.contact`.

    Parameters
    ----------
    a
        Contact radii [m], not too small; a row of them for each of many scenes.
    case
        Plate and sphere.
    """
    if a.ndim == 1:
        return _contact(a.tobytes(), a.shape, case)
    cases, plates = case.rows(len(a)), dict[SolvedCase, list[int]]()
    for row, one in enumerate(cases):  # all radii of a plate together
        plates.setdefault(one._replace(R=0.0, modulus=0.0, plate_modulus=0.0), []).append(row)
    parts = []
    for one, rows in plates.items():
        columns: Any = np.array([cases[row][2:5] for row in rows])
        R, modulus, own = (columns[:, i : i + 1] for i in range(3))
        parts.append(solved(a[rows], one._replace(R=R, modulus=modulus, plate_modulus=own)))
    order = np.argsort(np.concatenate([np.array(rows) for rows in plates.values()]))
    return type(parts[0])(*(np.concatenate(x)[order] for x in zip(*parts, strict=True)))


@lru_cache(maxsize=16)
def _contact(radii: bytes, shape: tuple[int, ...], case: SolvedCase) -> "Contact":
    a = np.frombuffer(radii).reshape(shape)
    solution = solved(a, case)
    for values in solution:
        values.setflags(write=False)
    return solution


def pressure_at(r: Array, a: float, case: SolvedCase) -> Array:
    """Return the contact pressure [Pa] at distances r [m] from the axis, 0 <= r <= a."""
    from generated import non_hertzian_pressure

    h, b, R, modulus, plate_modulus, sphere, edge = case
    plate = plate_of(h, b, edge)
    return non_hertzian_pressure.pressure(r, plate, a, R, modulus, plate_modulus, sphere=sphere)


def solved(a: Array, case: SolvedCase) -> "Contact":
    """Solve the integral equation at contact radii [m]."""
    from generated import non_hertzian_pressure

    h, b, R, modulus, plate_modulus, sphere, edge = case
    plate = plate_of(h, b, edge)
    return non_hertzian_pressure.contact(plate, a, R, modulus, plate_modulus, sphere=sphere)
