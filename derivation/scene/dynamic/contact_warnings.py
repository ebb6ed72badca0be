"""Warnings about several contacts: grazing or uncertain ones, and a fall back onto the plate."""

import math
from collections.abc import Sequence

from derivation.scene.quantity import NO_DIGITS, percent

GRAZING = 1e-3
"""Approach speed over impact speed, or force over peak force, of a grazing contact."""
BRANCHES = 0.02
"""Error by omitted wave branches from which a warning names an infinite plate [1]."""


def grazing_warnings(speeds: Sequence[float], least: float) -> tuple[str, ...]:
    """Warn of grazing contacts, where the number of contacts is sensitive to rounding.

    Parameters
    ----------
    speeds
        Relative approach speeds of the contacts over the impact speed [1].
    least
        Smallest force between two maxima of the force, over the peak force [1]; 1 if none.
    """
    slow = min(speeds)
    if slow >= GRAZING and least >= GRAZING:
        return ()
    event = f"grazing contact: the force falls to {least:.2g} of its peak"
    if slow < GRAZING:
        event = f"grazing re-contact at {slow:.2g} of the impact speed"
    text = (
        f"{event}: the number of contacts and the restitution are sensitive to rounding of the "
        "input"
    )
    return (text,)


def duration_warnings(jump: float, bounded: bool) -> tuple[str, ...]:
    """Warn of a first contact that more modes or wave branches may split, or join with the next.

    Parameters
    ----------
    jump
        Relative change of its duration if they do [1]; 0 if that is not expected.
    bounded
        Whether the duration has an error bound, which includes this change.
    """
    if not jump:
        return ()
    text = (
        "the omitted modes or wave branches may split the first contact or join it with the next "
        f"one: contact_time may change by {percent(jump)}"
        f"{', which its error includes' if bounded else ''}"
    )
    return (text,)


def branch_warnings(error: float) -> tuple[str, ...]:
    """Warn of omitted wave branches that an infinite plate would include.

    Parameters
    ----------
    error
        Relative change of the results by the omitted branches [1].
    """
    if error < BRANCHES:
        return ()
    text = (
        "the contact is too short for all wave branches on this plate; the omitted ones may change "
        f"the results by {percent(error)}, which their error includes. No wave returns from the "
        'edge in time: set extent = "infinite" in [inertia] to include all branches'
    )
    return (text,)


def model_jump_warnings(decisive_change: float, error: float) -> tuple[str, ...]:
    """Warn of a first contact that the model error may split, or join with the next one.

    Parameters
    ----------
    decisive_change
        Relative change of the force that splits or joins it [1]; 1 if none does.
    error
        Model error of the force [1].
    """
    if error < decisive_change or decisive_change >= 1.0:
        return ()
    text = (
        f"the model error of the force, {percent(error)}, may split the first contact or join it "
        "with the next one: contact_time may change by a jump"
    )
    return (text,)


def fall_warnings(
    gravity: float, rebound_speed: float, deflection: float, error: float = 0.0
) -> tuple[str, ...]:
    """Warn of a sphere that its weight returns to the plate before it has risen clear of it.

    A contact to which only the weight returns the sphere is another impact. Usually the plate no
    longer vibrates then.

    Parameters
    ----------
    gravity
        Gravitational acceleration [m/s^2].
    rebound_speed
        Speed of the sphere after the last contact [m/s].
    deflection
        Largest deflection of the plate after the last contact [m].
    error
        Relative error of the rebound speed [1]; infinite if it is unknown.
    """
    if not (gravity and rebound_speed > 0.0):
        return ()
    rise = 0.5 * rebound_speed**2 / gravity
    slower = max(0.0, 1.0 - error) if math.isfinite(error) else 1.0
    if rise * slower**2 > deflection:
        return ()
    returns = "returns"
    if rise > deflection:
        known = f"known to {percent(error)}" if error < NO_DIGITS else "unknown"
        returns = f"may return (speed {known})"
    text = (
        f"after the impact the sphere rises by {rise:.2g} m, and the vibrating plate deflects "
        f"by up to {deflection:.2g} m: the weight {returns} the sphere to a moving plate, and the "
        "restitution does not include the contacts that follow"
    )
    return (text,)
