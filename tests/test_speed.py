"""Timing: what counts, what is recorded; never how fast this machine is."""

import json
import time
from itertools import count

import numpy as np
import pytest

from derivation.measure import speed


def test_candidates_take_turns_and_the_lower_quartile_counts(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock, order = [0.0], []
    durations = {"one": iter([1.0, 2.0, 3.0, 4.0, 100.0]), "two": iter([10.0] * 5)}
    monkeypatch.setattr(time, "perf_counter", lambda: clock[0])

    def work(name: str) -> None:
        order.append(name)
        clock[0] += next(durations[name])

    times, spread = speed.interleaved((lambda: work("one"), lambda: work("two")), 5)
    assert order == ["one", "two"] * 5
    assert times == [2.0, 10.0]
    assert spread == 2.0


def test_a_ratio_beyond_its_limit_is_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    ticks = count()
    monkeypatch.setattr(time, "perf_counter", lambda: float(next(ticks)))
    assert speed.ratio("x", lambda: None, lambda: None, 1.0).kept
    assert not speed.ratio("x", lambda: None, lambda: None, 0.99).kept


def test_scenes_are_different_and_within_the_law() -> None:
    found = speed.impact(**speed.scenes(0.01, 5.9, 200))
    reached = found.max_contact_radius / speed.scenes(0.01, 5.9, 200)["h"]
    assert np.isfinite(np.stack(found)).all()
    assert np.unique(reached).size == 200
    assert reached.max() > 3.0


def test_data_names_the_machine() -> None:
    data = speed.as_data([speed.Timing("x", 2.0, "times", 3.0, 1.1, True)])
    assert json.loads(json.dumps(data)) == data
    assert data["machine"]["numpy"] == np.__version__
    assert data["rows"][0]["kept"] is True
