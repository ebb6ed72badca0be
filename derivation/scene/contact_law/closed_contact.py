"""The largest radius of a contact with non-Hertzian pressure that is closed at its centre."""

from functools import lru_cache

import numpy as np

from derivation.scene.numerics.crossing import last_true

_HALVINGS = 30


@lru_cache(maxsize=32)
def closed_up_to(
    h: float, b: float, R: float, modulus: float, plate_modulus: float, spherical: bool, high: float
) -> float:
    """Return the radius [m], at most `high`, up to which a contact is closed at its centre.

    The pressure is non-Hertzian; several laws of a scene share the result.
    """
    from generated import non_hertzian_pressure

    plate = non_hertzian_pressure.plate(h, b)

    def closed(a: float) -> bool:
        contact = non_hertzian_pressure.contact(
            plate, np.array([a]), R, modulus, plate_modulus, sphere=spherical
        )
        return bool(np.isfinite(contact.force[0]))

    return high if closed(high) else last_true(closed, 0.0, high, _HALVINGS)
