"""Search for larger errors: random points, then decreasing steps around the worst of them.

The sequence of points of a function depends only on the seed and the function, and functions take
turns in a fixed order. The time limit only determines how many points are evaluated.
"""

import itertools
import random
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from derivation.engine.interruption import interruptions
from derivation.engine.measure.judge import Error
from derivation.engine.measure.point import Point
from derivation.engine.measure.target import Target

DRAWN = 256
"""Number of random points between local searches."""

STRIDES = tuple(2**bits for bits in range(46, -1, -2))
"""Largest steps of a local search, in floats: from about 2 % of a number to its neighbour."""

WHOLE_STRIDES = (4096, 256, 32, 8, 3, 2, 1)
"""The same for whole numbers."""

Progress = Callable[[str, int, float], None]
"""Called at every function's turn with its name, the number of points, and the largest ratio."""


@dataclass(frozen=True)
class LargeError:
    """A point and its error.

    Parameters
    ----------
    point
        The arguments.
    second
        A second point that is passed in the same array, if the error is then larger than for plain
        numbers.
    error
        Error and allowance.
    """

    point: Point
    second: Point | None
    error: Error

    @property
    def ratio(self) -> float:
        """Error over allowance [1]."""
        return self.error.ratio


@dataclass
class TargetSearch:
    """The state of the search for one function.

    Parameters
    ----------
    evaluations
        Number of evaluated points.
    unjudged
        Number of points without a reference value, or with one outside the range of doubles.
    worst
        The point with the largest ratio of error to allowance.
    """

    evaluations: int = 0
    unjudged: int = 0
    worst: LargeError | None = None

    @property
    def ratio(self) -> float:
        """Largest ratio of error to allowance; -1 before the first one."""
        return -1.0 if self.worst is None else self.worst.ratio


@dataclass
class Search:
    """A search and its results.

    Parameters
    ----------
    seed
        Seed of the sequence of points.
    states
        States by function, in the order of their turns.
    interrupted
        Whether it was interrupted.
    """

    seed: int
    states: dict[str, TargetSearch] = field(default_factory=dict)
    interrupted: bool = False

    @property
    def evaluations(self) -> int:
        """Number of points evaluated for all functions."""
        return sum(state.evaluations for state in self.states.values())

    @property
    def ratio(self) -> float:
        """Largest ratio of error to allowance of all functions."""
        return max((state.ratio for state in self.states.values()), default=-1.0)


def search(
    targets: Sequence[Target],
    seed: int,
    seconds: float | None = None,
    evaluations: int | None = None,
    progress: Progress | None = None,
    keep: Callable[[Search], None] | None = None,
) -> Search:
    """Search for larger errors until the time or the number of evaluations is used up.

    Parameters
    ----------
    targets
        The functions.
    seed
        Random seed; equal seeds and numbers of evaluations give the same worst points.
    seconds, evaluations
        Limits; the search ends at the first one reached. At least one is required.
    progress
        Called at every function's turn.
    keep
        Called after every round with the search so far.

    Returns
    -------
    Search
        The state of each function's search; also after Ctrl-C.

    Raises
    ------
    ValueError
        If there is no limit.
    """
    if seconds is None and evaluations is None:
        raise ValueError("expected seconds or evaluations, got neither: a search has no end")
    result = Search(seed, {target.name: TargetSearch() for target in targets})
    searches = [search_target(target, seed, result.states[target.name]) for target in targets]
    end = None if seconds is None else time.monotonic() + seconds

    def over() -> bool:
        enough = evaluations is not None and result.evaluations >= evaluations
        return enough or (end is not None and time.monotonic() >= end)

    try:
        with np.errstate(all="ignore"), interruptions():
            _search_in_turns(targets, searches, result, over, progress, keep)
    except KeyboardInterrupt:
        result.interrupted = True
    return result


def _search_in_turns(
    targets: Sequence[Target],
    searches: Sequence[Iterator[None]],
    result: Search,
    over: Callable[[], bool],
    progress: Progress | None,
    keep: Callable[[Search], None] | None,
) -> None:
    for number in itertools.count():
        for target, steps in zip(targets, searches, strict=True):
            if (number + 1) % target.every:
                continue  # slow functions begin after the first turns of the others
            if progress is not None:
                progress(target.name, result.evaluations, result.ratio)
            for _ in range(target.turn_size):
                if over():
                    return
                next(steps)
        if keep is not None:
            keep(result)


def search_target(target: Target, seed: int, state: TargetSearch) -> Iterator[None]:
    """Search for one function's worst point without end; yield after every point.

    Points are drawn at random. A local search then starts from the worst of them or, in every other
    cycle, from the worst point so far. It changes one argument at a time by decreasing steps and
    keeps each step that leads to a larger ratio.
    """
    generator = random.Random(f"{target.name} from {seed}")
    for cycle in itertools.count():
        best = TargetSearch()
        drawn = (target.draw(target.domain, generator) for _ in range(DRAWN))
        while points := list(itertools.islice(drawn, 16)):
            yield from _evaluate_points(target, points, best, state)
        here = state if cycle % 2 else best
        yield from _local_search(target, generator, TargetSearch(worst=here.worst), state)


def _local_search(
    target: Target, generator: random.Random, here: TargetSearch, state: TargetSearch
) -> Iterator[None]:
    """Evaluate points at decreasing steps from the worst one, to both sides in each argument."""
    if here.worst is None:
        return
    domain = target.domain
    for stride in WHOLE_STRIDES if domain.whole else STRIDES:
        for name in domain.arguments:
            centre = here.worst.point
            if centre.values[name] == 0.0 and not domain.whole:
                continue  # the neighbours of zero are subnormal numbers
            steps = (generator.randint(1, stride), -generator.randint(1, stride))
            neighbours = (domain.moved(centre, name, step) for step in steps)
            points = [point for point in neighbours if domain.holds(point)]
            yield from _evaluate_points(target, points, here, state)


def _evaluate_points(
    target: Target, points: Sequence[Point], here: TargetSearch, state: TargetSearch
) -> Iterator[None]:
    """Evaluate points one by one; store a larger ratio in `here`, and in `state`."""
    if not points:
        return
    results = target.call(points) if target.bound is not None else None
    for i, point in enumerate(points):
        if results is None or _may_be_worse(target, point, results[i], here.ratio):
            error = point_error(target, point, points[i - 1])
            if error is None:
                state.unjudged += 1
            elif error.ratio > here.ratio:
                here.worst = error
                if error.ratio > state.ratio:
                    state.worst = error
        state.evaluations += 1
        yield


def _may_be_worse(target: Target, point: Point, got: tuple[float, ...], ratio: float) -> bool:
    """Return whether an upper bound of the ratio exceeds the largest ratio so far."""
    return target.bound is None or target.bound(point, got) > ratio


def point_error(target: Target, point: Point, second: Point | None) -> LargeError | None:
    """Return a point's error: for plain numbers, or in an array with a second point if larger.

    Returns None if there is no reference value.
    """
    plain = target.call([point])[0]
    alone = target.measure(point, plain)
    if alone is None:
        return None
    if second is not None and second.modes == point.modes:
        together = target.call([point, second])[0]
        error = target.measure(point, together) if together != plain else None
        if error is not None and error.ratio > alone.ratio:
            return LargeError(point, second, error)
    return LargeError(point, None, alone)
