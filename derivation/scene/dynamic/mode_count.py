"""Number of plate modes that an impact requires, and its limits."""

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np

from derivation.scene import scales
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.modal import free_modes
from derivation.scene.errors import SceneError
from derivation.scene.model import infinite_plate_radius

PHASE = 12.5
"""omega That/max(1, lambda^(2/3)) of the fastest mode in the first run."""
FEWEST, MOST = 8, 3000
"""Limits of the number of modes in the first run; the second run has twice as many. Between runs
with two and four modes the contact time changed by a fifth of its error on a thick plate."""
MODES, MANY = 6000, 30_000
"""Largest numbers of bending modes, and of modes of all branches, in the final run."""
WORK = 6.5e5
"""Work of a run above which the modes are not doubled again: the next run may take minutes."""
LAST, FURTHER = 8.0, 4.5
"""If the change with the number of modes is at most `LAST` times the accepted one, another doubling
may be sufficient: the three limits are then multiplied by `FURTHER`."""


def branching(law: ContactLaw, branches: str) -> ContactLaw:
    """Return the law with other wave branches."""
    inertia = replace(law.model.inertia, branches=branches)
    return replace(law, model=replace(law.model, inertia=inertia))


def with_modes(law: ContactLaw, count: int) -> ContactLaw:
    """Return the law with a given number of modes, or with an automatic one for 0."""
    inertia = replace(law.model.inertia, modes=count)
    return replace(law, model=replace(law.model, inertia=inertia))


def finer(law: ContactLaw, count: int) -> int:
    """Return the number of bending modes in the run after one with a number of them.

    It is twice as many, or one more so that exactly one of both is even: the contribution of the
    last mode to the waves that return from the edge to the axis has alternating signs, and runs
    with n and 2n modes, both even, would agree although both are wrong.
    """
    return law.model.inertia.modes or 2 * count + 1 - count % 2


def coarser(count: int) -> int:
    """Return half a number of modes, or one fewer so that exactly one of both is even."""
    half = count // 2
    return max(1, half if half % 2 != count % 2 else half - 1)


@lru_cache(maxsize=64)
def count_of(law: ContactLaw) -> int:
    """Return the number of bending modes in the first run."""
    model = law.model
    if model.inertia.modes:
        return coarser(model.inertia.modes)
    highest = _highest(law)
    # Only bending modes are counted; with all branches there are far more modes.
    model = replace(model, inertia=replace(model.inertia, branches="A0"))
    count = FEWEST
    while count < MOST and free_modes(model, count).omega[-1] < highest:
        count = min(2 * count, MOST)
    slower = int(np.searchsorted(free_modes(model, count).omega, highest))
    return max(FEWEST, min(count, slower + 1))


def _highest(law: ContactLaw) -> float:
    """Return the angular frequency [1/s] that the fastest mode of the first run must reach."""
    return PHASE * max(1.0, math.pow(scales.zener_number(law.model), 2.0 / 3.0)) / unit_time(law)


def unit_time(law: ContactLaw) -> float:
    """Return the time That [s]: That^5 = m^2/(K^2 v0), K = (4/3) E* sqrt(R)."""
    return scales.time_unit(law.model, law.modulus)


def affordable(law: ContactLaw) -> int:
    """Return the number of bending modes in the first run; up to half fewer with all branches."""
    count = count_of(law)
    if law.model.inertia.modes:
        return count
    least = count // 2 + 1
    while count > least and mode_total(law, 2 * count) > MANY:
        count = max(least, 9 * count // 10)
    return count


def fast(law: ContactLaw, count: int) -> bool:
    """Return whether the fastest of a number of bending modes is as fast as the contact.

    Runs with slower modes may agree although both are wrong.
    """
    lowest = branching(law, "A0").model
    return bool(free_modes(lowest, count).omega[-1] >= _highest(law))


def least_modes(law: ContactLaw) -> int:
    """Return how many modes are as fast as the contact, if those of the scene are not; else 0."""
    modes = law.model.inertia.modes
    return count_of(with_modes(law, 0)) if modes and not fast(law, modes) else 0


def check_resolving(law: ContactLaw) -> None:
    """Raise an error if the number of modes of a scene is too small for any error bound.

    Raises
    ------
    SceneError
        If its modes are slower than the contact. The message names the smallest sufficient number,
        or twice as many: an automatic simulation of this number ends with twice as many.
    """
    modes, least = law.model.inertia.modes, least_modes(law)
    if not least:
        return
    if least < MOST:
        remedy = (
            f"to resolve it, increase inertia.modes to {2 * least} (the tolerance may require "
            'more) or set it to "auto", or remove the tolerance'
        )
    else:
        remedy = "remove the tolerance"
    raise SceneError(
        f"inertia.modes: expected at least {least} modes with a tolerance, because slower ones do "
        f"not resolve the contact and have no error bound, got {modes}; {remedy}"
    )


def followed(law: ContactLaw, count: int) -> bool:
    """Return whether the modes are fast enough and not too many, or given by the scene."""
    afforded = mode_total(law, count) <= FURTHER * MANY
    return bool(law.model.inertia.modes) or (afforded and fast(law, count))


def needs_infinite_plate(law: ContactLaw) -> bool:
    """Return whether all wave branches can be dynamic on an infinite plate, but not on this one.

    The radius of the plate must exceed that of a plate that represents an infinite one: then no
    wave returns from its edge during the contact either.
    """
    model = law.model
    if model.inertia.infinite_plate or law.stretches or law.viscous:
        return False
    wave, whole = infinite_plate_radius(model), branching(law, "all")
    endless = replace(whole.model.inertia, infinite_plate=True)
    part = replace(whole, model=replace(model, b=wave, edge="paper", inertia=endless))
    return wave < model.b and not _all_followed(whole) and _all_followed(part)


def _all_followed(every: ContactLaw) -> bool:
    """Return whether the modes of a law with all branches are fast enough and not too many."""
    return followed(every, finer(every, affordable(every)))


def check_followed(law: ContactLaw, count: int) -> None:
    """Raise an error if a contact is too short for the allowed number of modes.

    Raises
    ------
    SceneError
        If the modes are too slow or too many, and the scene does not give their number.
    """
    inertia = law.model.inertia
    if followed(law, count):
        return
    remedy = 'branches = "A0", or ' if inertia.branches == "all" else ""
    remedy = f'use a smaller or thinner plate, or set {remedy}extent = "infinite"'
    if inertia.infinite_plate:
        remedy = 'use a thicker plate or a lighter sphere, or remove extent = "infinite"'
    raise SceneError(
        f"inertia.modes: expected a contact that {count} modes can resolve, got one that needs "
        f"frequencies up to {_highest(law) / (2.0 * math.pi):.3g} Hz; {remedy}"
    )


def mode_total(law: ContactLaw, count: int) -> float:
    """Return the estimated number of modes of all included branches up to the same frequency.

    With all branches these are the modes whose wave numbers along and across the plate, of shear
    and of pressure waves, lie within a quarter of a circle.
    """
    model = law.model
    if model.inertia.branches != "all":
        return count
    omega = free_modes(branching(law, "A0").model, count).omega
    highest = float(omega[-1]) * model.h / model.shear_speed
    return count * (1.0 + 0.5 * highest * (1.0 + model.mu / (model.lam + 2.0 * model.mu)))


def beyond_limits(law: ContactLaw, count: int, work: float, near: bool) -> bool:
    """Return whether doubling the number of bending modes exceeds a limit.

    Parameters
    ----------
    work
        Work of the run with `count` modes.
    near
        Whether another doubling may be sufficient, so that the limits are higher.
    """
    more = FURTHER if near else 1.0
    many = mode_total(law, 2 * count) > more * MANY or 2 * count > more * MODES
    return many or work > more * WORK
