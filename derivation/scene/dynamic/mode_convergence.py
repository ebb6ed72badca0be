"""Convergence of the results of an impact with the number of plate modes."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.dynamic.contact_errors import or_quasi_static
from derivation.scene.dynamic.contact_sequence import ImpactHistory, least_work, work_of
from derivation.scene.dynamic.first_contact import IRREGULAR, jump_since
from derivation.scene.dynamic.inertia_details import InertiaDetails
from derivation.scene.dynamic.integration_error import integration_error
from derivation.scene.dynamic.modal import free_modes
from derivation.scene.dynamic.mode_count import (
    FURTHER,
    MODES,
    beyond_limits,
    branching,
    coarser,
    fast,
)
from derivation.scene.dynamic.problem import DynamicProblem
from derivation.scene.dynamic.reach import Reach
from derivation.scene.dynamic.results import NONE, UNKNOWN
from derivation.scene.dynamic.short_echoes import echo_errors
from derivation.scene.dynamic.time_element import C, P
from derivation.scene.dynamic.wave_motion import DynamicImpact
from generated.arrays import Double as Array

REGULAR, QUICK = 2.2, 16.0
"""Largest expected factors by which twice as many modes reduce an error: of the contact time, which
decreases regularly with modes shorter than the thickness (`inertia_details.LATE`); of others."""
FIRST = 4000.0
"""The same factor if half as many modes were all slower than the contact: in 84 random impacts the
error then decreased by factors of up to 2300, with a single contact by up to 170."""
SHORT = 4.0
"""Largest wave number times half the thickness from which the contact time converges regularly."""
RIPPLE_RATIO = {"A0": 22.5, "all": 6.5}
"""Largest expected factors by which twice as many modes reduce the ripple of the force: at most
22.1 and 6.2 between runs of 13 random impacts, often below 2 with all branches."""
RIPPLE, DECAY = 1.25, 2.0
"""Estimated error of the largest force or radius over its ripple since half as many modes, and a
factor of it if the ripple decreases fast: `DECAY` times the decrease q since the runs before. If
this decrease continues, all further ripples together are q/(1 - q) of the last."""
NEARBY, TIMES_PER_UNIT = 0.1, 1000
"""Length of the interval in which changes of the ripple are assumed to have equal size, because its
phase is arbitrary, over the unit of time of the impact; number of times per unit at which the force
is compared."""
BEFORE = 1.0 - 1e-12
"""A time just before the end of a contact over the time of this end, so that rounding cannot move
it beyond."""
LINEAR = 0.2
"""Last part of the interval `NEARBY`, in which the force decreases steadily until its end."""
ONCE = 5.0
"""Error by omitted modes over the allowed one, up to which twice as many modes may be
sufficient."""
COMPARED, STEADY, SLOWEST = 3, 1.3, math.sqrt(2.0)
"""Number of runs that show how fast an error decreases; largest expected factor by which it then
decreases faster; the smallest factor by which the contact time is expected to improve if modes are
doubled. In random scenes, none of the 46 simulations with at least three such runs that met their
tolerance would have ended early, and 17 of those that did not."""
LEAST_WORK_RATIO, LARGEST_WORK_RATIO = {"A0": 2.0, "all": 4.0}, 4.0
"""Smallest factor by which the work grows if the bending modes are doubled; the largest one with
the branch A0 alone."""
QUICKLY = 2e5
"""Expected work of the next run up to which this run is done although short echoes exceed the
tolerance: a tenth of a second. The other results may then meet the tolerance."""


def compare(rough: DynamicImpact, found: DynamicImpact) -> DynamicImpact:
    """Return the finer run with the relative change of each result since the coarser run."""
    pairs = zip(found.numbers, rough.numbers, strict=True)
    time, depth, force, radius, speed = (abs(new - old) / abs(new) for new, old in pairs)
    change, jump = (time, depth, force, radius, speed), jump_since(found, rough)
    before = rough.inertia.mode_convergence
    recounted = len(found.inertia.contacts) != len(rough.inertia.contacts)
    ripple = _ripple(rough, found)
    known = (0.0, 0.0) if rough.inertia.recounted else rough.inertia.ripple
    force_error, radius_error = map(_error_of_ripple, ripple, known)
    time_error = IRREGULAR * _ripple_of_end(rough, found)
    inertia = replace(
        found.inertia,
        mode_convergence=change, jump=jump, earlier_change=before, recounted=recounted,
        ripple=ripple, ripple_error=(time_error, force_error, radius_error),
        first_change=_first_change(rough, found),
    )  # fmt: skip
    return replace(found, inertia=inertia)


def _first_change(rough: DynamicImpact, found: DynamicImpact) -> float:
    """Return the largest relative change of the first contact [1]; NaN if it is the only one.

    The first contact does not depend on later ones, which may be far more sensitive.
    """
    old, new = rough.inertia.contacts[0], found.inertia.contacts[0]
    if len(rough.inertia.contacts) == 1 == len(found.inertia.contacts):
        return math.nan
    pairs = (new.end, old.end), (new.impulse, old.impulse), (new.peak_force, old.peak_force)
    return max(abs(after - before) / abs(after) for after, before in pairs)


def _ripple(rough: DynamicImpact, found: DynamicImpact) -> tuple[float, float]:
    """Return relative errors of largest force and radius by the changes of their histories [1].

    Waves that return during a contact make its force ripple. The ripple changes with the number of
    modes at all times, while the maximum may agree by chance. The largest value of a history known
    up to e(t) lies between the maxima of the history less e(t) and of the history plus e(t). The
    cube of the radius is compared: it is as smooth as the force where a contact begins and ends.
    """
    fine, change = [], []
    for old, new in _same_times(rough, found):
        fine.append(_compared(found.rows(new)))
        change.append(np.abs(fine[-1] - _compared(rough.rows(old))))
    histories, changes = np.hstack(fine), np.hstack(change)
    for part, width in _parts_of_history(found, fine):
        changes[:, part] = _largest_nearby(changes[:, part], width)
    largest = np.max(histories, axis=1)
    above, below = np.max(histories + changes, axis=1), np.max(histories - changes, axis=1)
    force, cube = np.maximum(above / largest - 1.0, 1.0 - below / largest).tolist()
    # The cube root of 1 - x decreases more than that of 1 + x increases.
    return force, 1.0 - math.cbrt(1.0 - cube) if cube < 1.0 else cube


def _ripple_of_end(rough: DynamicImpact, found: DynamicImpact) -> float:
    """Return the error of the end of the first contact by such changes, over its duration [1].

    At its end the square of the radius decreases linearly, and so does the force of a viscoelastic
    contact. Their ripple moves this end. The ripple at the end itself may vanish by chance.
    """
    end, unit = found.inertia.contacts[0].end, found.impact_history.problem.T
    part = min(NEARBY, 0.5 * end / unit)
    width = part * unit
    both = min(end, rough.inertia.contacts[0].end)
    if both <= end - width:  # the duration itself changes by more
        return 0.0
    times = np.linspace(end - width, both, 2 + math.ceil(part * TIMES_PER_UNIT))
    change = np.max(np.abs(_linear_at_end(found, times) - _linear_at_end(rough, times)))
    late = LINEAR * width
    rate = float(_linear_at_end(found, np.array([end - late]))[0]) / late
    return float(change) / (rate * end)


def _linear_at_end(run: DynamicImpact, times: Array) -> Array:
    """Return the quantity that decreases linearly at the end of a contact, at times [s]."""
    rows = run.rows(times)
    history = rows[P] if run.law.viscous else np.maximum(rows[C], 0.0) ** 2
    return np.asarray(history)


def _parts_of_history(found: DynamicImpact, histories: list[Array]) -> list[tuple[slice, int]]:
    """Return parts of the history, and the number of times over which each has equal changes.

    During unloading a plastic contact is stiffer and its ripple larger. It cannot reach the largest
    force again, because the force has decreased too far.

    Parameters
    ----------
    histories
        Force and cube of the radius of each contact.
    """
    whole = round(NEARBY * TIMES_PER_UNIT)
    starts = np.cumsum([0, *(one.shape[1] for one in histories)])
    if found.impact_history.problem.yielding is None:
        return [(slice(None), whole)]
    largest = int(np.argmax([np.max(one[0]) for one in histories]))
    peak = int(starts[largest] + np.argmax(histories[largest][0])) + 1
    end = int(starts[largest + 1])
    return [(slice(None, peak), whole), (slice(peak, end), 1), (slice(end, None), whole)]


def _compared(rows: Array) -> Array:
    """Return the force and the cube of the contact radius at some times."""
    return np.stack((rows[P], np.maximum(rows[C], 0.0) ** 3))


def _same_times(rough: DynamicImpact, found: DynamicImpact) -> Iterator[tuple[Array, Array]]:
    """Yield times [s] in both runs, contact by contact, at which to compare them.

    Two contacts that overlap most are assumed to correspond. They are compared from their starts
    on. Beyond the end of the coarser one its state at the end is used, because a viscoelastic
    contact ends with a large radius. Any other contact of either run, for example a short one that
    the other run misses, is compared with the other run at the same times.
    """
    unit = found.impact_history.problem.T
    overlaps = _overlaps(rough, found)
    partners = {
        j: i
        for j, i in enumerate(np.argmax(overlaps, axis=0).tolist())
        if overlaps[i, j] > 0.0 and int(np.argmax(overlaps[i])) == j
    }
    for j, new in enumerate(found.inertia.contacts):
        times = _times_between(new.start, BEFORE * new.end, unit)
        if j not in partners:
            yield times, times
            continue
        known = rough.inertia.contacts[partners[j]]
        yield np.minimum(known.start + (times - new.start), BEFORE * known.end), times
    for i, old in enumerate(rough.inertia.contacts):
        if i not in partners.values():
            times = _times_between(old.start, old.end, unit)
            yield times, times


def _overlaps(rough: DynamicImpact, found: DynamicImpact) -> Array:
    """Return how long [s] the contacts of the coarser run (rows) and of the finer one overlap."""
    spans = ([(one.start, one.end) for one in run.inertia.contacts] for run in (rough, found))
    old, new = map(np.array, spans)
    start = np.maximum.outer(old[:, 0], new[:, 0])
    return np.asarray(np.minimum.outer(old[:, 1], new[:, 1]) - start)


def _times_between(start: float, end: float, unit: float) -> Array:
    """Return times between two others, `TIMES_PER_UNIT` in each unit of time."""
    return np.linspace(start, end, 2 + math.ceil((end - start) / unit * TIMES_PER_UNIT))


def _largest_nearby(values: Array, count: int) -> Array:
    """Return the largest of `count` values around each one of a row of positive values.

    Importing SciPy, which has this function, takes longer than the function.
    """
    if not values.size:
        return values
    before = count // 2
    padded = np.pad(values, ((0, 0), (before, count - before - 1)))
    return np.asarray(sliding_window_view(padded, count, axis=1).max(axis=2))


def _error_of_ripple(ripple: float, before: float) -> float:
    """Return the estimated error of a largest value for its ripple and that of the runs before."""
    decay = ripple / before if before else 1.0
    return RIPPLE * ripple * min(1.0, DECAY * decay)


def largest_change(one: DynamicImpact, other: DynamicImpact) -> DynamicImpact:
    """Return a run with the larger changes of two comparisons with coarser runs."""
    pairs = one.inertia.mode_convergence, other.inertia.mode_convergence
    time, depth, force, radius, speed = map(max, *pairs)
    change = time, depth, force, radius, speed
    first = float(np.maximum(one.inertia.first_change, other.inertia.first_change))
    return replace(one, inertia=replace(one.inertia, mode_convergence=change, first_change=first))


def largest_error(one: DynamicImpact, other: DynamicImpact) -> DynamicImpact:
    """Return a run with the larger changes and ripples of two comparisons with coarser runs."""
    found = largest_change(one, other)
    time, force, radius = map(max, one.inertia.ripple_error, other.inertia.ripple_error)
    jump = max(one.inertia.jump, other.inertia.jump)
    inertia = replace(found.inertia, jump=jump, ripple_error=(time, force, radius))
    return replace(found, inertia=inertia)


def without_estimate(found: DynamicImpact) -> DynamicImpact:
    """Return a run without an error estimate for its omitted modes."""
    unknown = replace(found.inertia, mode_convergence=UNKNOWN, earlier_change=NONE)
    return replace(found, inertia=unknown)


def unreachable(
    runs: Sequence[DynamicImpact], law: ContactLaw, count: int, work: float, reach: Reach
) -> bool:
    """Return whether no number of modes within the limits can be expected to meet the tolerance.

    If the runs differ in the number of contacts, nothing can be expected.

    Parameters
    ----------
    runs
        Runs with error estimates, each with twice as many modes as the one before.
    count
        Number of bending modes of the last one.
    work
        Expected work of the run with twice as many.
    """
    found = runs[-1]
    if found.inertia.recounted:  # the next run may have the same number of contacts
        return False
    next_work = work
    branches = "all" if law.model.inertia.branches == "all" else "A0"
    work_ratio, ripple_ratio = LEAST_WORK_RATIO[branches], RIPPLE_RATIO[branches]
    shortest = float(np.max(found.impact_history.problem.contact.modes.phi)) * law.model.h
    timed = REGULAR if shortest > SHORT else QUICK
    resolved = fast(law, coarser(count))
    doublings, count = 1, 2 * count
    while not beyond_limits(law, count, work, near=True):
        count, doublings = 2 * count, doublings + 1
        work = max(work_ratio * work, _least_work(found, law, count))
    if "max_force" in reach.outputs and next_work > QUICKLY:
        echo = _with_modes(found, count).echo_error
        if echo + found.inertia.left(reach.outputs)[1] > reach.need:
            return True
    factors = {name: timed if name == "contact_time" else QUICK for name in reach.outputs}
    for name, factor in factors.items():
        first = factor if resolved or factor == REGULAR else FIRST
        error = found.inertia.error_by_change(name) / (first * factor ** (doublings - 1))
        ripple = found.inertia.error_by_ripple(name) / ((first / factor) * ripple_ratio**doublings)
        if max(error, ripple, _after(runs, name, doublings)) > reach.need:
            return True
    return False


def _least_work(run: DynamicImpact, law: ContactLaw, count: int) -> float:
    """Return a lower bound on the work of a run with more bending modes; 0 if it is unknown."""
    if law.model.inertia.branches == "all":
        return 0.0
    fastest = float(free_modes(branching(law, "A0").model, count).omega[-1])
    return least_work(run.impact_history, fastest, count)


def attainable(run: DynamicImpact) -> InertiaDetails:
    """Return the details of a run with the error by short echoes that remains with more modes."""
    law, history = run.law, run.impact_history
    if law.model.inertia.modes or not run.inertia.echo_error:
        return run.inertia
    count, work = history.problem.contact.modes.phi.size, work_of(history)
    while not beyond_limits(law, count, work, near=False):
        count, work = 2 * count, LARGEST_WORK_RATIO * work
    return _with_modes(run, count)


def _with_modes(run: DynamicImpact, count: int) -> InertiaDetails:
    """Return the details of a run with the error by short echoes of more bending modes."""
    if not run.inertia.echo_error:
        return run.inertia
    known = run.law, run.impact_history, run.max_contact_radius, run.max_force
    return replace(run.inertia, echo_error=echo_errors(*known, count)[1])


def _after(runs: Sequence[DynamicImpact], output: str, doublings: int) -> float:
    """Return the least expected error of an output after further doublings of the modes [1].

    It follows from the last three runs, and is 0 if there are fewer with the same contacts.
    """
    if len(runs) < COMPARED or any(run.inertia.recounted for run in runs[-COMPARED:]):
        return 0.0
    oldest, older, last = (run.inertia.error_of_modes(output) for run in runs[-COMPARED:])
    if not min(oldest, older, last) > 0.0:
        return 0.0
    return last / (STEADY * max(SLOWEST, oldest / older, older / last)) ** doublings


def echoes_matter(run: DynamicImpact, reach: Reach) -> bool:
    """Return whether short echoes exceed the tolerance, and more modes may reduce them enough.

    Their effect on the force decreases as the square root of the number of modes.
    """
    error, room = run.inertia.echo_error, room_for_modes(run, reach)
    if "max_force" not in reach.outputs or not room < error:
        return False
    return error <= room * math.sqrt(FURTHER * MODES / run.impact_history.problem.omega.size)


def jump_matters(run: DynamicImpact, reach: Reach) -> bool:
    """Return whether more modes may exclude a jump of the contact time beyond the tolerance.

    They cannot if the omitted branches alone may cause it.
    """
    if "contact_time" not in reach.outputs or run.inertia.jump <= reach.need:
        return False
    return run.inertia.jump > jump_since(run)


def nearly_meets(run: DynamicImpact, reach: Reach) -> bool:
    """Return whether results that do not meet the tolerance probably do after one more doubling."""
    modes, room = run.inertia.left(reach.outputs)[0], room_for_modes(run, reach)
    return room < modes <= ONCE * room


def room_for_modes(run: DynamicImpact, reach: Reach) -> float:
    """Return the part of the tolerance that omitted branches and time elements leave [1]."""
    branches = run.inertia.left(reach.outputs)[1]
    return reach.need - branches - integration_error(run.impact_history)


def unchecked(coarse: ImpactHistory, problem: DynamicProblem, fewer: int) -> ImpactHistory:
    """Return a run as incomplete, because a finer one for its error estimate is too much work."""
    return replace(
        coarse,
        reason=f"the error of {coarse.problem.omega.size} modes is unknown, because the "
        f"{problem.omega.size} modes for its estimate exceed the limit of time steps and modes",
        remedy=f"set inertia.modes = {fewer}, without a tolerance{or_quasi_static(problem)}",
    )
