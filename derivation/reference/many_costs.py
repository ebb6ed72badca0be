"""What many digits cost, and from that the way each oracle goes and how far.

Seconds are those measured on one idle core of the kind this was written on: right within
a factor of two or three elsewhere, which is enough to choose and to announce.
"""

import math

from derivation.formula.ball import LOG2_10
from derivation.reference import contact_points
from derivation.reference.contact_modes import THIN

Motion = tuple[float, float, float, float, float, float, float]
"""R [m], m [kg], v0 [m/s], h [m], b [m], lam [Pa], mu [Pa]."""

INPUTS = ("R", "m", "v0", "h", "b", "lam", "mu")

SECOND_LAW, SECOND_IMPACT, SECOND_THIN = 300, 200, 100
"""Digits that oracle 2 is asked for at most, so that it takes minutes: of the law, of the
impact, and of either in thin plates, where its integral of G - 1 takes the most nodes.
"""


def second_digits(eta: float, digits: int) -> tuple[int, int]:
    """To how many digits oracle 2 is asked for law and impact of a plate of h/b = eta."""
    limits = (SECOND_THIN,) * 2 if eta < THIN else (SECOND_LAW, SECOND_IMPACT)
    return min(digits, limits[0]), min(digits, limits[1])


def by_series(eta: float, reach: float, digits: int) -> bool:
    """Whether oracle 1 takes the power series."""
    if reach > 4 * contact_points.DEEPEST * eta:
        return False
    return series_seconds(eta, digits) < integrals_seconds(digits)


def expected_seconds(motion: Motion, radius: float, digits: int) -> float:
    """About how long `reference` takes [s] on one idle core, both oracles together.

    Parameters
    ----------
    motion
        The scene in numbers.
    radius
        Largest contact radius [m], which a double tells well enough.
    digits
        Digits asked for.
    """
    eta, reach = motion[3] / motion[4], radius / motion[4]
    first = integrals_seconds(digits)
    if by_series(eta, reach, digits):
        first = series_seconds(eta, digits)
    law, impact = second_digits(eta, digits)
    seconds = float(10 * (law / 200) ** 2.3 + 150 * (impact / 200) ** 2.6)
    return 1 + first + seconds * (4.0 if eta < THIN else 1.0)


def series_seconds(eta: float, digits: int) -> float:
    """About how long oracle 1 takes by the power series [s]."""
    modes = contact_points.mode_count(eta, math.ceil(digits * LOG2_10))
    return 0.5 + modes * (3e-4 + 0.02 * (digits / 1000) ** 2) + 50 * (digits / 1000) ** 3


def integrals_seconds(digits: int) -> float:
    """About how long oracle 1 takes in integrals [s]."""
    return 2 + 220 * (digits / 300) ** 3
