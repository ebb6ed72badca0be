"""How many modes of a plate follow an impact, and when more of them are too dear."""

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np

from derivation.scene.law import ContactLaw
from derivation.scene.limits import zener_number
from derivation.scene.modal import free_modes
from derivation.scene.scene import SceneError

PHASE = 12.5
"""omega_M That/max(1, lambda^(2/3)) of the fastest oscillator, of the run that checks."""
FEWEST, MOST = 2, 3000
"""Modes of the run that checks, to begin with; the one that counts has twice as many."""
MODES, MANY = 6000, 30_000
"""Most bending modes, and most oscillators of all branches, of the run that counts."""
WORK = 6.5e5
"""Work of a course beyond which its modes are not doubled once more: that may take minutes."""
LAST, FURTHER = 8.0, 4.5
"""Where the change with the modes is no more than this times what is small enough, once more may
do, and all three limits are so much higher."""


def branching(law: ContactLaw, branches: str) -> ContactLaw:
    """The same law with other branches."""
    inertia = replace(law.model.inertia, branches=branches)
    return replace(law, model=replace(law.model, inertia=inertia))


@lru_cache(maxsize=64)
def count_of(law: ContactLaw) -> int:
    """How many oscillators the run that checks has."""
    model = law.model
    if model.inertia.modes:
        return model.inertia.modes // 2
    highest = _highest(law)
    # Modes are counted by their bending: of all branches there are far more oscillators.
    model = replace(model, inertia=replace(model.inertia, branches="A0"))
    count = FEWEST
    while count < MOST and free_modes(model, count).omega[-1] < highest:
        count = min(2 * count, MOST)
    slower = int(np.searchsorted(free_modes(model, count).omega, highest))
    return max(FEWEST, min(count, slower + 1))


def _highest(law: ContactLaw) -> float:
    """Angular frequency [1/s] of the fastest oscillator of the run that checks."""
    model = law.model
    stiffness = 4.0 / 3.0 * law.modulus * math.sqrt(model.R)
    duration = math.pow(model.m / stiffness, 0.4) / math.pow(model.v0, 0.2)
    return PHASE * max(1.0, math.pow(zener_number(model), 2.0 / 3.0)) / duration


def affordable(law: ContactLaw) -> int:
    """How many bending modes the run that checks has: down to half where branches are too many."""
    count = count_of(law)
    if law.model.inertia.modes:
        return count
    least = count // 2 + 1
    while count > least and oscillators(law, 2 * count) > MANY:
        count = max(least, 9 * count // 10)
    return count


def fast(law: ContactLaw, count: int) -> bool:
    """Whether so many bending modes are as fast as the contact.

    Slower ones agree with each other, whatever the truth is.
    """
    lowest = branching(law, "A0").model
    return bool(free_modes(lowest, count).omega[-1] >= _highest(law))


def followed(law: ContactLaw, count: int) -> bool:
    """Whether so many modes are fast enough and can be afforded, or are what the scene says."""
    afforded = oscillators(law, count) <= FURTHER * MANY
    return bool(law.model.inertia.modes) or (afforded and fast(law, count))


def check_followed(law: ContactLaw, count: int) -> None:
    """Refuse a contact so short that no affordable number of modes follows it.

    Raises
    ------
    SceneError
        If the modes are too slow, and the scene does not say how many there are.
    """
    inertia = law.model.inertia
    if followed(law, count):
        return
    remedy = 'branches = "A0", or ' if inertia.branches == "all" else ""
    remedy += "effects.inertia = false" if inertia.infinite_plate else 'extent = "infinite"'
    raise SceneError(
        f"inertia.modes: expected a contact that {count} modes can follow, got one that needs "
        f"frequencies up to {_highest(law) / (2.0 * math.pi):.3g} Hz; use a smaller or thinner "
        f"plate, or set {remedy}"
    )


def oscillators(law: ContactLaw, count: int) -> float:
    """How many oscillators so many bending modes come with, about.

    Of all branches those whose wave numbers along the plate and across it, of shear and of
    pressure waves, lie within a quarter of a circle.
    """
    model = law.model
    if model.inertia.branches != "all":
        return count
    omega = free_modes(branching(law, "A0").model, count).omega
    highest = float(omega[-1]) * model.h / model.shear_speed
    return count * (1.0 + 0.5 * highest * (1.0 + model.mu / (model.lam + 2.0 * model.mu)))


def too_dear(law: ContactLaw, count: int, work: float, near: bool) -> bool:
    """Whether twice as many bending modes are more than can be afforded.

    Parameters
    ----------
    work
        That of the course with so many.
    near
        Whether twice as many may be the last.
    """
    more = FURTHER if near else 1.0
    many = oscillators(law, 2 * count) > more * MANY or 2 * count > more * MODES
    return many or work > more * WORK
