"""The largest radius of a contact with non-Hertzian pressure that is closed at its centre."""

from functools import lru_cache
from math import isfinite

from derivation.scene.contact_law.solved_contact import MANY, SolvedCase, force_at
from derivation.scene.numerics.crossing import last_true

_HALVINGS = 30


@lru_cache(maxsize=MANY)
def closed_up_to(case: SolvedCase, high: float) -> float:
    """Return the radius [m], at most `high`, up to which a contact is closed at its centre.

    The pressure is non-Hertzian; several laws of a scene share the result.
    """

    def closed(a: float) -> bool:
        return isfinite(force_at(a, case))

    return high if closed(high) else last_true(closed, 0.0, high, _HALVINGS)
