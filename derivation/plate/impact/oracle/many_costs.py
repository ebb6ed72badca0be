"""What many digits cost, and from that the way each oracle goes and how far.

Seconds are those measured on one idle core of the kind this was written on: right within
a factor of two or three elsewhere, which is enough to choose and to announce.
"""

import math

from derivation.engine.formula.ball import LOG2_10
from derivation.plate.contact.oracle import points as contact_points
from derivation.plate.contact.oracle.modes import THIN

Motion = tuple[float, float, float, float, float, float, float]
"""R [m], m [kg], v0 [m/s], h [m], b [m], lam [Pa], mu [Pa]."""

INPUTS = ("R", "m", "v0", "h", "b", "lam", "mu")

SECOND_DEEP, PATIENCE = 100, 600.0
"""Digits that oracle 2 is asked for at most in contacts so much wider than a thin plate is thick
that its powers take longer than this [s] and than oracle 1.
"""


def by_residues(eta: float, reach: float, digits: int) -> bool:
    """Whether oracle 2 takes its power series for contacts up to a/b = reach."""
    longest = sums_seconds(digits)
    if digits > SECOND_DEEP:
        longest = max(PATIENCE, first_seconds(eta, reach, digits))
    return eta >= THIN or residues_seconds(eta, reach, digits) <= longest


def second_digits(eta: float, reach: float, digits: int) -> int:
    """To how many digits oracle 2 is asked for law and impact of a plate of h/b = eta."""
    return digits if by_residues(eta, reach, digits) else min(digits, SECOND_DEEP)


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
    second = residues_seconds(eta, reach, digits)
    if not by_residues(eta, reach, digits):
        second = sums_seconds(second_digits(eta, reach, digits))
    return 1 + first_seconds(eta, reach, digits) + second


def first_seconds(eta: float, reach: float, digits: int) -> float:
    """About how long oracle 1 takes [s]."""
    if by_series(eta, reach, digits):
        return series_seconds(eta, digits)
    return integrals_seconds(digits)


def residues_seconds(eta: float, reach: float, digits: int) -> float:
    """About how long oracle 2 takes by its power series [s]: its powers, and the poles."""
    powers = 30 * (digits / 1000) ** 3 * (1 + (reach / eta / 2.5) ** 2.5)
    return float(powers + 50 * eta * 2 / (2 - reach) * (digits / 1000) ** 2.2)


def sums_seconds(digits: int) -> float:
    """About how long oracle 2 takes by its sums over modes [s], for a thin plate."""
    return float(40 * (digits / 200) ** 2.3 + 600 * (digits / 200) ** 2.6)


def series_seconds(eta: float, digits: int) -> float:
    """About how long oracle 1 takes by the power series [s]."""
    modes = contact_points.mode_count(eta, math.ceil(digits * LOG2_10))
    return 0.5 + modes * (3e-4 + 0.02 * (digits / 1000) ** 2) + 50 * (digits / 1000) ** 3


def integrals_seconds(digits: int) -> float:
    """About how long oracle 1 takes in integrals [s]."""
    return 2 + 220 * (digits / 300) ** 3
