"""Searches a wide range of the constant of a measurement with several contacts.

A light sphere on a thin plate is hit again by the vibrating plate. Its restitution then depends on
the phase of this vibration: in random scenes it increased and decreased several times with the
constant, jumped where a contact appeared, and exceeded that without energy loss by a factor of up
to 2.7. The values are simulated with `rough_search.HALF` the modes, from the smallest energy loss
on, first at a ratio of `FACTOR`, then between, and at last around the restitution that is closest.
"""

import math
from collections.abc import Iterator
from contextlib import suppress
from itertools import pairwise

from derivation.scene.errors import SceneError
from derivation.scene.measured.constant import UNITS
from derivation.scene.measured.measurement import FACTOR, Measurement
from derivation.scene.measured.narrowing import near_solution, solution
from derivation.scene.measured.trial import (
    ExceedsError,
    Point,
    Trial,
    UnreachedError,
)

YIELD_RANGE = 0.625, 6e-4
"""Largest and smallest yield stress over the largest elastic pressure [1]: the contact yields at
1.6 times the yield stress."""
TIME_RANGE = 1e-3, 16.0
"""Smallest and largest retardation time over the contact time without viscosity [1]."""
LOSSY = {"yield_stress": (0.125, 0.015), "retardation_time": (0.3, 3.0)}
"""Values over this pressure or time with which a sphere is slow enough to be hit again, if any."""
NO_LOSS = 1e-6
"""Retardation time over the contact time that stands for a contact without loss [1]."""
ABOVE = 0.4
"""Restitution above that without loss beyond which no value is searched; at most 0.31 above it in
52 random scenes."""
BELOW = 0.4
"""Restitution over the first minimum with increasing retardation time, below which none is
searched: later minima were at least 0.43 of it in 27 random scenes."""
UNSURE, NEARLY, HALVED = 0.03, 0.15, 0.5
"""Relative difference from the measured restitution up to which accurate simulations decide whether
a value gives it, up to which values close to it are simulated, and up to which all intervals are
halved."""
CLOSER = 5
"""Number of times that the intervals at the closest restitution are halved."""
FURTHER = 32.0
"""Yield stress of a single contact over the one with which the sphere is hit again, if with any;
least ratio of the longest retardation time to that of a single contact."""
STEP, STEPS = 0.04, 10
"""Distance, in the logarithm, of the first accurate values from one that few modes give; largest
number of further ones."""


def values_of(key: str, lossless: Trial) -> list[float]:
    """Return the logarithms of the values that are simulated first, the smallest loss first."""
    if key == "yield_stress":
        first, last = (math.log(part * lossless.max_pressure) for part in YIELD_RANGE)
    else:
        first, last = (math.log(part * lossless.contact_time) for part in TIME_RANGE)
    count = math.ceil(abs(last - first) / math.log(FACTOR))
    return [first + (last - first) * i / count for i in range(count + 1)]


def touches_again(half: Measurement, lossless: Trial) -> bool:
    """Return whether some value of the constant gives several contacts."""
    if lossless.contacts > 1 or any(trial.contacts > 1 for trial in half.trials().values()):
        return True
    unit = lossless.max_pressure if half.key == "yield_stress" else lossless.contact_time
    return any(_contacts(half, part * unit) > 1 for part in LOSSY[half.key])


def _contacts(half: Measurement, value: float) -> int:
    """Return the number of contacts with a value; 0 if the simulation fails."""
    try:
        return half.simulated(value).contacts
    except SceneError:
        return 0


def searched(half: Measurement, lossless: Trial, rejected: SceneError) -> float:
    """Return a value near that of the smallest loss that gives the measured restitution.

    Parameters
    ----------
    half, lossless
        The measurement with few modes, and that without energy loss by the constant.
    rejected
        The error of a search that expects a restitution that depends on the constant steadily.

    Raises
    ------
    SceneError
        If no value gives the restitution.
    """
    goal, close = half.goal, half.goal * half.close_enough(lossless)
    least = rejected.least if isinstance(rejected, UnreachedError) else 0.0
    if half.key == "retardation_time" and goal < BELOW * least:
        raise rejected
    if goal > (most := lossless.restitution + ABOVE) and isinstance(rejected, ExceedsError):
        raise ExceedsError(
            f"{rejected}; with several contacts a loss of energy may increase the restitution: "
            f"values are searched up to a restitution of about {most:.2g}"
        )
    if goal > most or not touches_again(half, lossless):
        raise rejected
    points = [_without_loss(half, lossless)]
    jump: Point | None = None
    for one, other in _intervals(half, points, values_of(half.key, lossless)):
        if one.above * other.above > 0.0:
            continue
        with suppress(SceneError):
            low, high = sorted((one, other))
            found = near_solution(half.point, low, high, close)
            if abs(found.above) <= close:
                return math.exp(found.x)
            jump = jump or found
    best = min(points, key=lambda point: abs(point.above))
    if jump or abs(best.above) <= UNSURE * goal:
        return math.exp((jump or best).x)
    if best is points[0]:
        raise rejected
    raise _unreached(half, best, rejected)


def _without_loss(half: Measurement, lossless: Trial) -> Point:
    """Return a point for a contact without loss, beside the values that are simulated."""
    x, restitution = values_of(half.key, lossless)[0], lossless.restitution
    if half.key == "retardation_time":
        x += math.log(NO_LOSS / TIME_RANGE[0])
    return Point(x, restitution - half.goal, restitution)


def _intervals(
    half: Measurement, points: list[Point], values: list[float]
) -> Iterator[tuple[Point, Point]]:
    """Yield pairs of adjacent values, closer and closer ones, and add them to the points.

    Parameters
    ----------
    points
        The points, in the order of the loss.
    values
        Logarithms of the values that are simulated first.
    """
    for x in values:
        if point := _simulated(half, x):
            points.append(point)
            yield points[-2], point
    if min(abs(point.above) for point in points) > HALVED * half.goal:
        return
    for i in range(len(points) - 1, 1, -1):
        _insert(half, points, i)
    yield from pairwise(tuple(points))
    for _ in range(CLOSER):
        i = min(range(len(points)), key=lambda j: abs(points[j].above))
        if abs(points[i].above) > NEARLY * half.goal:
            return
        for j in (i + 1, i):
            if 0 < j < len(points):
                _insert(half, points, j)
        yield from pairwise(tuple(points[max(0, i - 1) : i + 4]))


def _insert(half: Measurement, points: list[Point], i: int) -> None:
    """Insert the value in the middle of an interval, if it can be simulated."""
    if point := _simulated(half, 0.5 * (points[i - 1].x + points[i].x)):
        points.insert(i, point)


def _simulated(half: Measurement, x: float) -> Point | None:
    """Return a simulation with the value exp(x); None if it fails."""
    with suppress(SceneError):
        return half.point(x)
    return None


def _unreached(measurement: Measurement, best: Point, rejected: SceneError) -> SceneError:
    """Return the error of a restitution that no value gives, with the closest one."""
    restitution, value = measurement.goal + best.above, math.exp(best.x)
    if best.above > 0.0:
        below = isinstance(rejected, UnreachedError)
        return measurement.below(restitution, best.least, value) if below else rejected
    if not isinstance(rejected, ExceedsError):
        return rejected
    how = " (estimated with few modes)" if measurement.part else ""
    return ExceedsError(
        f"measured.restitution: expected less than about {restitution:.3g}, the largest "
        f"restitution that a {measurement.name} was found to give{how}, at about {value:.2g} "
        f"{UNITS[measurement.key]}, got {measurement.goal:.6g}; correct measured.restitution or "
        "measured.target"
    )


def value_near(accurate: Measurement, first: float, close: float, rejected: SceneError) -> float:
    """Return the value of accurate simulations near that of simulations with few modes.

    Parameters
    ----------
    first
        The value of simulations with few modes.
    close
        Relative accuracy of the value that suffices [1].
    rejected
        The error that is raised if there is none.

    Raises
    ------
    SceneError
        If there is none.
    """
    points = list[Point]()
    for x in _positions(points, math.log(first)):
        if point := _simulated(accurate, x):
            points[:] = sorted((*points, point))
        for low, high in pairwise(points):
            if low.above * high.above <= 0.0:
                return solution(accurate.point, low, high, accurate.goal, close)
    if not points:
        raise rejected
    best = min(points, key=lambda point: abs(point.above))
    if abs(best.above) <= best.above + accurate.goal - best.least:  # within its error
        return math.exp(best.x)
    raise _unreached(accurate, best, rejected)


def _positions(points: list[Point], x: float) -> Iterator[float]:
    """Yield logarithms of values, towards the measured restitution and then around the closest.

    Parameters
    ----------
    points
        The simulations of these values, in their order.
    x
        The first position.
    """
    yield from (x, x - STEP, x + STEP)
    for i in range(STEPS):
        closest = min(points, key=lambda point: abs(point.above), default=None)
        if closest is None:
            return
        j = points.index(closest)
        if j in (0, len(points) - 1):
            yield closest.x + (STEP if j else -STEP) * 2 ** min(i, 3)
        else:
            yield 0.5 * (closest.x + points[j + (-1) ** i].x)


def repeats(half: Measurement, value: float, found: Trial) -> bool:
    """Return whether a value with a larger loss has the restitution of a value, too.

    Parameters
    ----------
    half
        The measurement with few modes.
    value, found
        The value, with a single contact, and its results.
    """
    if half.key == "retardation_time":  # with the longest ones the contact hardly deforms
        far = _simulated(half, math.log(max(FURTHER * value, TIME_RANGE[1] * found.contact_time)))
        return far is not None and far.above > 0.0
    if _contacts(half, value / FURTHER) == 1:
        return False
    values = (value / FACTOR**i for i in range(1, round(math.log(FURTHER, FACTOR)) + 1))
    points = (_simulated(half, math.log(one)) for one in values)
    return any(point is not None and point.above > 0.0 for point in points)
