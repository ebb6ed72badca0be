"""Results of an impact."""

from typing import NamedTuple


class Impact(NamedTuple):
    """Contact time [s], largest indentation [m], force [N] and radius [m], and restitution [1]."""

    contact_time: float
    max_indentation: float
    max_force: float
    max_contact_radius: float
    restitution: float
