"""Run times of several candidates, measured in interleaved rounds.

In each round every candidate runs once, in an order drawn from a fixed seed. Its time is divided by
the shortest time of a reference workload in the same round, because a change of the machine's speed
affects both. The result is the lower quartile of these ratios, times that of the reference's times.
Times are processor times, which other processes affect less than elapsed times.
"""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]
Call = Callable[[Any], Any]
Clock = Callable[[], float]
CPU: Clock = time.process_time
"""Clock for the measurements [s]."""

LEAST, MOST = 2e-3, 2e-2
"""Shortest time of a block of calls, and time of a call up to which its array is enlarged [s]."""

CONTENDED = 1.5
"""Upper over lower quartile of the reference's times above which the machine counts as busy."""

REFERENCES = 3
"""Number of runs of the reference in a round; the shortest time is used."""

SEED = 11


@dataclass(frozen=True)
class Effort:
    """Number of rounds, and largest number of attempts on a busy machine."""

    rounds: int
    attempts: int


FULL, QUICK = Effort(25, 2), Effort(5, 1)


@dataclass(frozen=True)
class Candidate:
    """Work to be timed: a block of repeated calls on an array."""

    call: Call
    array: Doubles
    repeats: int

    @property
    def work(self) -> int:
        """Number of points in a block."""
        return self.repeats * self.array.size

    def run(self) -> None:
        """Run one block."""
        for _ in range(self.repeats):
            self.call(self.array)


@dataclass(frozen=True)
class Timing:
    """Run time of a candidate.

    Attributes
    ----------
    seconds
        Time per point [s].
    points
        Number of points of an array.
    spread
        Upper over lower quartile of the times of a block [1].
    rounds
        Number of rounds.
    """

    seconds: float
    points: int
    spread: float
    rounds: int


@dataclass(frozen=True)
class Session:
    """Run times of candidates that were measured in the same rounds.

    Attributes
    ----------
    timings
        Run time of each candidate, in order.
    spread
        Upper over lower quartile of the reference's times [1].
    attempts
        Number of attempts; the one with the smallest spread is used.
    """

    timings: tuple[Timing, ...]
    spread: float
    attempts: int

    @property
    def contended(self) -> bool:
        """Whether the machine was busy in every attempt."""
        return self.spread > CONTENDED


def plan(call: Call, sample: Doubles, clock: Clock = CPU) -> Candidate:
    """Return a candidate for the whole sample, or for a part if one call would take too long."""
    size, seconds, before = 1, _once(call, sample[:1], clock), math.inf
    # The array is also enlarged beyond MOST while the time of a call hardly depends on its size.
    while size < sample.size and (seconds < MOST or seconds < 2 * before):
        size, before = min(4 * size, sample.size), seconds
        seconds = _once(call, sample[:size], clock)
    repeats = max(1, math.ceil(LEAST / max(seconds, 1e-9)))
    return Candidate(call, sample[:size], repeats)


def _once(call: Call, array: Doubles, clock: Clock) -> float:
    begin = clock()
    call(array)
    return clock() - begin


def session(candidates: Sequence[Candidate], effort: Effort, clock: Clock = CPU) -> Session:
    """Measure candidates, again if the machine is busy; return the attempt of least spread."""
    best: Session | None = None
    for attempt in range(1, effort.attempts + 1):
        timings, spread = interleaved(candidates, effort.rounds, clock)
        if best is None or spread < best.spread:
            best = Session(timings, spread, attempt)
        if not best.contended:
            break
    assert best is not None
    return Session(best.timings, best.spread, attempt)


def interleaved(
    candidates: Sequence[Candidate], rounds: int, clock: Clock = CPU
) -> tuple[tuple[Timing, ...], float]:
    """Return run times from rounds in shuffled order, and the spread of the reference's times."""
    # A large array is allocated and freed first. Otherwise the C library may return memory to the
    # operating system after every call, which takes time.
    np.ones(4_000_000)
    everyone = [*candidates, *[reference()] * REFERENCES]
    random, times = np.random.default_rng(SEED), np.empty((rounds, len(everyone)))
    for row in times:
        for index in random.permutation(len(everyone)):
            begin = clock()
            everyone[index].run()
            row[index] = clock() - begin
    own, base = times[:, : len(candidates)], times[:, len(candidates) :].min(axis=1)
    low, high = np.quantile(own, (0.25, 0.75), axis=0)
    usual, busy = np.quantile(base, (0.25, 0.75))
    # If the reference was disturbed, the product may be smaller than every measured time.
    seconds = np.maximum(np.quantile(own / base[:, None], 0.25, axis=0) * usual, own.min(axis=0))
    timings = tuple(
        Timing(float(t) / c.work, c.array.size, float(wide), rounds)
        for c, t, wide in zip(candidates, seconds, high / low, strict=True)
    )
    return timings, float(busy / usual)


def reference() -> Candidate:
    """Return the reference workload: exponentials, in about the time of a block."""
    x: Any = np.linspace(0.0, 1.0, 10_000)
    return Candidate(np.exp, x, 40)
