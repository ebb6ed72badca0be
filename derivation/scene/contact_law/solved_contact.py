"""Contacts with non-Hertzian pressure, remembered as bounds and motion need the same radii."""

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from generated.arrays import Double as Array

if TYPE_CHECKING:
    from generated.non_hertzian_pressure import Contact, Plate


@lru_cache(maxsize=16)
def plate_of(h: float, b: float) -> "Plate":
    """Return the kernel of a plate with half the thickness h and radius b [m]."""
    from generated import non_hertzian_pressure

    return non_hertzian_pressure.plate(h, b)


def contact_at(
    a: Array, h: float, b: float, R: float, modulus: float, own: float, sphere: bool
) -> "Contact":
    """Return the contact at contact radii [m]; see `generated.non_hertzian_pressure.contact`.

    Parameters
    ----------
    a
        Contact radii [m], not too small.
    h, b, R
        Half the thickness and radius of the plate, and radius of the sphere [m].
    modulus, own
        E* of the contact and of the plate alone [Pa].
    sphere
        Whether the profile is that of a sphere instead of its paraboloid.
    """
    return _contact(a.tobytes(), a.shape, h, b, R, modulus, own, sphere)


@lru_cache(maxsize=16)
def _contact(
    radii: bytes,
    shape: tuple[int, ...],
    h: float,
    b: float,
    R: float,
    modulus: float,
    own: float,
    sphere: bool,
) -> "Contact":
    from generated import non_hertzian_pressure

    a = np.frombuffer(radii).reshape(shape)
    solution = non_hertzian_pressure.contact(plate_of(h, b), a, R, modulus, own, sphere=sphere)
    for values in solution:
        values.setflags(write=False)
    return solution
