"""The largest radius of a contact with non-Hertzian pressure that is closed at its centre."""

from functools import lru_cache
from typing import Any

import numpy as np

from derivation.scene.contact_law.solved_contact import SolvedCase, solved
from derivation.scene.numerics.crossing import last_true

_HALVINGS = 30


def largest_closed(case: SolvedCase, high: float) -> Any:
    """Return `closed_up_to` for one scene, or for many as a column."""
    radii = np.broadcast_arrays(high, *case)[0]
    if not radii.ndim:
        return closed_up_to(case, float(high))
    pairs = zip(case.rows(len(radii)), radii[:, 0].tolist(), strict=True)
    return np.array([closed_up_to(one, largest) for one, largest in pairs])[:, None]


@lru_cache(maxsize=128)
def closed_up_to(case: SolvedCase, high: float) -> float:
    """Return the radius [m], at most `high`, up to which a contact is closed at its centre.

    The pressure is non-Hertzian; several laws of a scene share the result.
    """

    def closed(a: float) -> bool:
        return bool(np.isfinite(solved(np.array([a]), case).force[0]))

    return high if closed(high) else last_true(closed, 0.0, high, _HALVINGS)
