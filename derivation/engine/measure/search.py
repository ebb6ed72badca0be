"""The search for worse: random points, then steps ever smaller around the worst, without end.

Which points follow each other depends on the seed and the kernel alone, and the
kernels take turns in a fixed order: time only decides how far a search goes.
"""

import itertools
import random
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from derivation.engine.measure.judge import Error
from derivation.engine.measure.point import Point
from derivation.engine.measure.target import Target

DRAWN = 256
"""Points drawn at random between climbs."""

STRIDES = tuple(2**bits for bits in range(46, -1, -2))
"""Steps of a climb, in floats: from 2% of a number down to its neighbour."""

WHOLE_STRIDES = (4096, 256, 32, 8, 3, 2, 1)
"""The same for whole numbers."""

Tell = Callable[[str, int, float], None]
"""Called at every kernel's turn: its name, how many points all have had, the worst ratio."""


@dataclass(frozen=True)
class Found:
    """A point and its error.

    Parameters
    ----------
    point
        The arguments.
    company
        A second point, handed over together with it in one array, if the error is
        larger so than for plain numbers.
    error
        Error and allowance.
    """

    point: Point
    company: Point | None
    error: Error

    @property
    def ratio(self) -> float:
        """Error over allowance."""
        return self.error.ratio


@dataclass
class Standing:
    """How far a kernel's search has come.

    Parameters
    ----------
    evaluations
        Points looked at.
    unjudged
        How many were found to have no truth that a double can hold, or none at all.
    worst
        The largest error in proportion to what is allowed.
    """

    evaluations: int = 0
    unjudged: int = 0
    worst: Found | None = None

    @property
    def ratio(self) -> float:
        """The worst ratio; -1 before there is any."""
        return -1.0 if self.worst is None else self.worst.ratio


@dataclass
class Search:
    """A search and what it has found.

    Parameters
    ----------
    seed
        What the sequence of points depends on.
    standings
        By kernel, in the order of their turns.
    interrupted
        Whether it was stopped from outside.
    """

    seed: int
    standings: dict[str, Standing] = field(default_factory=dict)
    interrupted: bool = False

    @property
    def evaluations(self) -> int:
        """Points looked at by all kernels."""
        return sum(standing.evaluations for standing in self.standings.values())

    @property
    def ratio(self) -> float:
        """The worst ratio of all kernels."""
        return max((standing.ratio for standing in self.standings.values()), default=-1.0)


def search(
    targets: Sequence[Target],
    seed: int,
    seconds: float | None = None,
    evaluations: int | None = None,
    tell: Tell | None = None,
    keep: Callable[[Search], None] | None = None,
) -> Search:
    """Look for larger and larger errors until the time or the evaluations are used up.

    Parameters
    ----------
    targets
        The kernels.
    seed
        The same seed and number of evaluations give the same worst points.
    seconds, evaluations
        When to stop, whichever comes first; at least one is needed.
    tell
        Told about every turn.
    keep
        Called after every round with what has been found so far.

    Raises
    ------
    ValueError
        If nothing says when to stop.
    """
    if seconds is None and evaluations is None:
        raise ValueError("expected seconds or evaluations, got neither: a search has no end")
    found = Search(seed, {target.name: Standing() for target in targets})
    hunts = [hunt(target, seed, found.standings[target.name]) for target in targets]
    end = None if seconds is None else time.monotonic() + seconds

    def over() -> bool:
        enough = evaluations is not None and found.evaluations >= evaluations
        return enough or (end is not None and time.monotonic() >= end)

    try:
        with np.errstate(all="ignore"):
            _take_turns(targets, hunts, found, over, tell, keep)
    except KeyboardInterrupt:
        found.interrupted = True
    return found


def _take_turns(
    targets: Sequence[Target],
    hunts: Sequence[Iterator[None]],
    found: Search,
    over: Callable[[], bool],
    tell: Tell | None,
    keep: Callable[[Search], None] | None,
) -> None:
    for number in itertools.count():
        for target, steps in zip(targets, hunts, strict=True):
            if (number + 1) % target.every:
                continue  # so that what takes long waits for the others' first turns
            if tell is not None:
                tell(target.name, found.evaluations, found.ratio)
            for _ in range(target.share):
                if over():
                    return
                next(steps)
        if keep is not None:
            keep(found)


def hunt(target: Target, seed: int, standing: Standing) -> Iterator[None]:
    """Look for one kernel's worst point; pauses after every point, and never ends.

    Points are drawn at random; then the worst of them, or in every other cycle the
    worst of all so far, is where steps begin that grow smaller, one argument at a
    time, and are kept where they lead to something worse.
    """
    generator = random.Random(f"{target.name} from {seed}")
    for cycle in itertools.count():
        best = Standing()
        drawn = (target.draw(target.domain, generator) for _ in range(DRAWN))
        while points := list(itertools.islice(drawn, 16)):
            yield from _look(target, points, best, standing)
        here = standing if cycle % 2 else best
        yield from _climb(target, generator, Standing(worst=here.worst), standing)


def _climb(
    target: Target, generator: random.Random, here: Standing, standing: Standing
) -> Iterator[None]:
    """Steps from a point, to either side in each argument, shrinking."""
    if here.worst is None:
        return
    domain = target.domain
    for stride in WHOLE_STRIDES if domain.whole else STRIDES:
        for name in domain.arguments:
            centre = here.worst.point
            if centre.values[name] == 0.0 and not domain.whole:
                continue  # next to zero are subnormal numbers, far below every other length
            steps = (generator.randint(1, stride), -generator.randint(1, stride))
            beside = (domain.moved(centre, name, step) for step in steps)
            points = [point for point in beside if domain.holds(point)]
            yield from _look(target, points, here, standing)


def _look(
    target: Target, points: Sequence[Point], here: Standing, standing: Standing
) -> Iterator[None]:
    """Judge points one by one; what is worse than before is kept here and overall."""
    if not points:
        return
    results = target.call(points) if target.bound is not None else None
    for i, point in enumerate(points):
        if results is None or _may_be_worse(target, point, results[i], here.ratio):
            found = weigh(target, point, points[i - 1])
            if found is None:
                standing.unjudged += 1
            elif found.ratio > here.ratio:
                here.worst = found
                if found.ratio > standing.ratio:
                    standing.worst = found
        standing.evaluations += 1
        yield


def _may_be_worse(target: Target, point: Point, got: tuple[float, ...], ratio: float) -> bool:
    """The screen: whether an upper bound of the ratio leaves a chance."""
    return target.bound is None or target.bound(point, got) > ratio


def weigh(target: Target, point: Point, company: Point | None) -> Found | None:
    """A point's error: alone as plain numbers, or in company if that is worse."""
    plain = target.call([point])[0]
    alone = target.measure(point, plain)
    if alone is None:
        return None
    if company is not None and company.modes == point.modes:
        together = target.call([point, company])[0]
        error = target.measure(point, together) if together != plain else None
        if error is not None and error.ratio > alone.ratio:
            return Found(point, company, error)
    return Found(point, None, alone)
