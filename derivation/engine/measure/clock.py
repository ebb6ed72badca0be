"""Times side by side: candidates in shuffled turns, blocks of equal work, quartiles of ratios.

In each round every candidate runs once, in an order drawn from a fixed seed, and its time is
divided by the least of a reference in the same round: what the machine does meanwhile meets both.
The lower quartile of the ratios counts. Time is the processor's: on a quiet machine that of the
wall clock, and on a busy one not stretched by the turns of others.
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
"""What times are taken by [s]."""

LEAST, MOST = 2e-3, 2e-2
"""A block lasts at least the first; an array grows as long as a call takes less than the second
[s]."""

CONTENDED = 1.5
"""Upper over lower quartile of the reference's times from which the machine was busy."""

REFERENCES = 3
"""How often the reference runs in a round; the least of its times counts."""

SEED = 11


@dataclass(frozen=True)
class Effort:
    """Rounds in which candidates take turns, and attempts while the machine is busy."""

    rounds: int
    attempts: int


FULL, QUICK = Effort(25, 2), Effort(5, 1)


@dataclass(frozen=True)
class Candidate:
    """Work to time: a call on an array, repeated so that a block is long enough."""

    call: Call
    array: Doubles
    repeats: int

    @property
    def work(self) -> int:
        """Points of a block."""
        return self.repeats * self.array.size

    def run(self) -> None:
        """One block."""
        for _ in range(self.repeats):
            self.call(self.array)


@dataclass(frozen=True)
class Timing:
    """Time of a candidate.

    Attributes
    ----------
    seconds
        Per point [s].
    points
        Of an array.
    spread
        Upper over lower quartile of its times.
    rounds
        How often it was timed.
    """

    seconds: float
    points: int
    spread: float
    rounds: int


@dataclass(frozen=True)
class Session:
    """Timings of candidates that took turns.

    Attributes
    ----------
    spread
        Upper over lower quartile of the reference's times.
    attempts
        How often the whole was timed because the machine was busy; the calmest counts.
    """

    timings: tuple[Timing, ...]
    spread: float
    attempts: int

    @property
    def contended(self) -> bool:
        """Whether even the calmest attempt met a busy machine."""
        return self.spread > CONTENDED


def plan(call: Call, sample: Doubles, clock: Clock = CPU) -> Candidate:
    """A block of the whole sample, or of as much of it as one call may take."""
    size, seconds, before = 1, _once(call, sample[:1], clock), math.inf
    # Beyond MOST too while the set-up of a call outweighs its points.
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
    """Time candidates, several times while the machine is busy; the calmest attempt counts."""
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
    """Timings by rounds in shuffled order, and the reference's spread."""
    # A large array made and given back first: before that the C library returns memory
    # after every call, and what is timed is the operating system.
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
    # Where the reference was disturbed, a ratio may come out below any time there was.
    seconds = np.maximum(np.quantile(own / base[:, None], 0.25, axis=0) * usual, own.min(axis=0))
    timings = tuple(
        Timing(float(t) / c.work, c.array.size, float(wide), rounds)
        for c, t, wide in zip(candidates, seconds, high / low, strict=True)
    )
    return timings, float(busy / usual)


def reference() -> Candidate:
    """What every round's times are divided by: exponentials, about a block's worth."""
    x: Any = np.linspace(0.0, 1.0, 10_000)
    return Candidate(np.exp, x, 40)
