"""Timing per point, relative to a reference workload, and detection of a busy machine."""

from collections.abc import Callable, Iterator
from itertools import cycle
from typing import Any

import numpy as np
import pytest

from derivation.engine.measure import clock
from derivation.engine.measure.clock import Candidate, Effort


class FakeClock:
    """A clock that advances only while simulated work runs."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now

    def work(self, seconds: float) -> Callable[[Any], None]:
        def call(array: Any) -> None:  # noqa: ARG001
            self.now += seconds

        return call

    def work_in_turn(self, seconds: Iterator[float]) -> Callable[[Any], None]:
        def call(array: Any) -> None:  # noqa: ARG001
            self.now += next(seconds)

        return call


def test_times_are_per_point_and_relative_to_the_reference(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fake, array = FakeClock(), np.zeros(10)
    monkeypatch.setattr(clock, "reference", lambda: Candidate(fake.work(1.0), array, 1))
    candidates = [Candidate(fake.work(2.0), array, 3), Candidate(fake.work(5.0), array, 1)]
    timing = clock.session(candidates, Effort(9, 3), fake)
    assert [t.seconds for t in timing.timings] == pytest.approx([0.2, 0.5])
    assert (timing.attempts, timing.contended, timing.spread) == (1, False, 1.0)


def test_timing_on_a_busy_machine_is_repeated_and_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    fake, array, load = FakeClock(), np.zeros(1), cycle([1.0] * 6 + [9.0] * 6)

    monkeypatch.setattr(clock, "reference", lambda: Candidate(fake.work_in_turn(load), array, 1))
    timing = clock.session([Candidate(fake.work(1.0), array, 1)], Effort(4, 3), fake)
    assert timing.attempts == 3
    assert (timing.contended, timing.spread) == (True, 9.0)
    once = clock.session([Candidate(fake.work(1.0), array, 1)], Effort(4, 1), fake)
    assert once.attempts == 1


def test_reported_time_is_not_below_the_shortest_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    fake, array, load = FakeClock(), np.zeros(1), cycle([1.0] * 3 + [100.0] * 9)

    monkeypatch.setattr(clock, "reference", lambda: Candidate(fake.work_in_turn(load), array, 1))
    timing = clock.session([Candidate(fake.work(2.0), array, 1)], Effort(8, 1), fake)
    assert timing.timings[0].seconds == 2.0


def test_spread_is_upper_over_lower_quartile(monkeypatch: pytest.MonkeyPatch) -> None:
    fake, array, load = FakeClock(), np.zeros(1), cycle([1.0, 1.0, 3.0, 3.0])

    monkeypatch.setattr(clock, "reference", lambda: Candidate(fake.work(1.0), array, 1))
    timing = clock.session([Candidate(fake.work_in_turn(load), array, 1)], Effort(8, 1), fake)
    assert timing.timings[0].seconds == 1.0
    assert timing.timings[0].spread == 3.0


def test_order_of_the_rounds_is_random_but_reproducible(monkeypatch: pytest.MonkeyPatch) -> None:
    fake, array, order = FakeClock(), np.zeros(1), []

    def named(name: int) -> Candidate:
        def call(array: Any) -> None:  # noqa: ARG001
            order.append(name)
            fake.now += 1

        return Candidate(call, array, 1)

    monkeypatch.setattr(clock, "reference", lambda: named(0))
    clock.interleaved([named(1), named(2), named(3)], 6, fake)
    first, order[:] = list(order), []
    clock.interleaved([named(1), named(2), named(3)], 6, fake)
    assert order == first
    assert len({tuple(first[k : k + 6]) for k in range(0, 36, 6)}) > 1
    assert sorted(first[:6]) == [0, 0, 0, 1, 2, 3]


def test_array_is_as_large_as_the_time_limit_allows() -> None:
    fake, sample = FakeClock(), np.zeros(10_000)

    def linear(array: Any) -> None:
        fake.now += 1e-4 * array.size

    assert 200 <= clock.plan(linear, sample, fake).array.size <= 1024
    assert clock.plan(fake.work(1e-3), sample, fake).array.size == sample.size
    assert clock.plan(fake.work(1e-4), sample, fake).repeats == 20
    assert clock.plan(fake.work(0.1), sample, fake).array.size == sample.size
