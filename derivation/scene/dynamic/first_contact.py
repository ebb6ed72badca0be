"""The smallest change that splits the first contact of an impact, or joins it with the next one.

The duration of the first contact then changes by a jump. Omitted modes and wave branches change the
approach of sphere and plate by short waves: an elastic or plastic contact may split where the
approach is least between two maxima, and join the next one if the largest gap between them closes.
A viscoelastic face does not follow the sphere; for it, the force and the time between contacts are
compared instead.
"""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from derivation.scene.dynamic.integration_error import integration_error
from derivation.scene.dynamic.time_element import C, P, W, Z
from derivation.scene.dynamic.wave_problem import echo_time
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from derivation.scene.dynamic.wave_motion import DynamicImpact

IRREGULAR = 2.0
"""Estimated error of a result by omitted modes over its change since half as many modes [1]."""
EVALUATIONS = 2001
"""Number of times at which a contact is evaluated."""
NEARBY, CLOSE = 0.1, 21
"""Length of the interval in which changes by more modes are assumed to have equal size, over the
unit of time of the impact; number of times at which they are evaluated there."""
IN_GAP = 129
"""Number of times at which the gap between two contacts is evaluated."""


class Place(NamedTuple):
    """A time at which the first contact may end, or continue.

    Attributes
    ----------
    margin
        Approach at a minimum, or largest gap, over the largest displacement of the sphere [1].
    time
        Time of the minimum, or of the largest gap [s].
    end
        End of the first contact if it jumps [s].
    before
        Largest approach before the minimum, over this displacement [1].
    """

    margin: float
    time: float
    end: float
    before: float = math.inf


def minima(history: Array) -> NDArray[np.intp]:
    """Return the indices of the minima between two maxima."""
    return 1 + np.flatnonzero((history[1:-1] <= history[:-2]) & (history[1:-1] < history[2:]))


def approach(run: "DynamicImpact", times: Array, contact: int = 0) -> Array:
    """Return the approach of sphere and plate [m] at times [s] in a contact and after it.

    In contact it follows from the contact radius as for a flat face and a sphere. It is negative
    while they are apart.
    """
    contacts = run.impact_history.contacts
    rows, yielding = run.rows(times), contacts[min(contact, len(contacts) - 1)].yielding
    # The sphere of an unloaded plastic contact is flatter, and leaves a dent.
    flatter, dent = (yielding.flattening**3, yielding.dent) if yielding else (1.0, 0.0)
    touching: Array = rows[C] ** 2 * (flatter / run.law.model.R)
    return np.where(touching > 0.0, touching, np.minimum(rows[Z] - rows[W] - dent, 0.0))


def splits(run: "DynamicImpact") -> list[Place]:
    """Return where the first contact may end, in order."""
    first = run.inertia.contacts[0]
    times = np.linspace(first.start, first.end, EVALUATIONS)
    history = approach(run, times) / run.max_indentation
    before = np.maximum.accumulate(history)
    return [
        Place(float(history[i]), float(times[i]), float(times[i]), float(before[i]))
        for i in minima(history)
    ]


def gaps(run: "DynamicImpact") -> Iterator[Place]:
    """Yield the gaps before the second and later contacts, which the first one may join."""
    for i, (before, after) in enumerate(pairwise(run.inertia.contacts)):
        times = np.linspace(before.end, after.start, IN_GAP)
        history = approach(run, times, i) / run.max_indentation
        k = int(np.argmin(history))
        yield Place(-float(history[k]), float(times[k]), after.end)


def decisive_change(run: "DynamicImpact") -> float:
    """Return the relative change that may split the first contact, or join it with the second [1].

    It is the smallest force between two maxima of the first contact, over the peak force; or the
    time up to the second contact over the duration of the first.
    """
    first, *others = run.inertia.contacts
    gap = (others[0].start - first.end) / (first.end - first.start) if others else math.inf
    return min(run.least_force(run.histories[0]), gap)


def jump_since(run: "DynamicImpact", coarser: "DynamicImpact | None" = None) -> float:
    """Return the change of the first contact's duration if it splits or joins the next one [1].

    It is relative to the shorter of the two durations.

    Parameters
    ----------
    coarser
        A run with fewer modes, from which the error by omitted modes is estimated. Without it, the
        jump of an elastic or plastic contact by omitted branches alone is returned.
    """
    if run.impact_history.problem.retardation_time:
        return _viscoelastic_jump(run, coarser) if coarser else 0.0
    end, jump = run.inertia.contacts[0].end, 0.0
    # Omitted branches and time elements change the displacements of both bodies.
    fixed = 2.0 * (run.inertia.omitted_branch_error[1] + integration_error(run.impact_history))
    found = splits(run)
    for place, changed in zip(found, _changes(run, coarser, found), strict=True):
        if place.margin <= fixed + changed < place.before:
            jump = max(jump, end / place.end - 1.0)
    for i, place in enumerate(gaps(run)):
        if place.margin > fixed + _changes(run, coarser, [place], i)[0]:
            break
        jump = max(jump, place.end / end - 1.0)
    return jump


def _changes(
    run: "DynamicImpact", coarser: "DynamicImpact | None", places: list[Place], contact: int = 0
) -> list[float]:
    """Return the estimated error of each margin by omitted modes [1].

    It is the largest one nearby, because the phase of short waves is arbitrary.
    """
    if not coarser or not places:
        return [0.0] * len(places)
    width = NEARBY * run.impact_history.problem.T
    times = np.array([place.time for place in places])[:, None]
    times = np.maximum(times + np.linspace(-0.5 * width, 0.5 * width, CLOSE), 0.0)
    change = approach(run, times.ravel(), contact) - approach(coarser, times.ravel(), contact)
    largest = np.max(np.abs(change).reshape(times.shape), axis=1)
    return list((IRREGULAR / run.max_indentation * largest).tolist())


def _viscoelastic_jump(run: "DynamicImpact", coarser: "DynamicImpact") -> float:
    """Return the change of `jump_since` for a viscoelastic contact.

    It may split where a minimum of the force is below the error of the force there, and join the
    second contact if the gap is below the error of its ends. Both errors are estimated from a run
    with fewer modes, or from the short echoes in the omitted modes.
    """
    first, *others = run.inertia.contacts[:2]
    known, *same = coarser.inertia.contacts[:2]
    times, force = np.linspace(first.start, first.end, EVALUATIONS), run.histories[0][P]
    error = IRREGULAR * np.abs(force - coarser.rows(times)[P])
    echoes = np.where(times > echo_time(run.law.model), run.inertia.echo_ripple, 0.0)
    error = np.maximum(error, echoes * run.max_force)
    # Minima before the force first exceeds its error are not significant.
    certain = int(np.argmax(force > error))
    indices = minima(force)
    indices = indices[(force[indices] <= error[indices]) & (indices > certain)]
    jump = float(np.max(first.end / times[indices] - 1.0, initial=0.0))
    for after, before in zip(others, same, strict=False):
        moved = abs(first.end - known.end) + abs(after.start - before.start)
        if after.start - first.end <= IRREGULAR * moved:
            jump = max(jump, after.end / first.end - 1.0)
    return jump
