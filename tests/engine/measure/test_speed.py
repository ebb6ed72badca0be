"""The timing commands: method, recorded data and limits, with a simulated clock."""

import json
import subprocess
import time
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derivation.plate.benchmark import speed
from derivation.plate.modes.naive import FIELDS, naive_field


def test_lower_quartile_of_interleaved_times_is_used(
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


def test_ratio_is_compared_with_its_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    ticks = count()
    monkeypatch.setattr(time, "perf_counter", lambda: float(next(ticks)))
    assert speed.ratio("x", lambda: None, lambda: None, 1.0).passed
    assert not speed.ratio("x", lambda: None, lambda: None, 0.99).passed


def test_random_impacts_are_distinct_and_valid() -> None:
    result = speed.impact(**speed.scenes(0.01, 5.9, 200))
    reached = result.max_contact_radius / speed.scenes(0.01, 5.9, 200)["h"]
    assert np.isfinite(np.stack(result)).all()
    assert np.unique(reached).size == 200
    assert reached.max() > 3.0


def test_data_contain_the_machine() -> None:
    data = speed.as_data([speed.SpeedTiming("x", 2.0, "times", 3.0, 1.1, True)])
    assert json.loads(json.dumps(data)) == data
    assert data["machine"]["numpy"] == np.__version__
    assert data["rows"][0]["passed"] is True


# --- published and stable forms


@pytest.mark.parametrize("name", speed.NAIVE)
def test_published_and_stable_forms_agree(name: str) -> None:
    """They agree to rounding, apart from the extra factor 1/phi in two published formulas."""
    stable, naive = speed.NAIVE[name]
    x = np.linspace(*speed.NAIVE_RANGE, speed.NAIVE_POINTS)
    if name in FIELDS:  # compared at one value of x and all depths
        x[:] = 3.0
    ours, theirs = stable(x), naive(x)
    theirs = theirs * x if name in ("Omega_3", "Omega_4") else theirs
    assert ours.dtype == theirs.dtype == np.float64
    assert np.abs(ours - theirs).max() < 2e-15 * np.abs(ours).max()
    assert np.ptp(ours) > 0.0


def test_published_fields_are_nan_where_the_stable_ones_are() -> None:
    for name in FIELDS:
        for z, phi, mu in ((1.1, 1.0, 1.0), (0.0, -1.0, 1.0), (0.0, 1.0, -1.0)):
            given = (z, phi, 1.0, 1.2, mu, -1.0)
            assert np.isnan(naive_field(name, *given))
            assert np.isnan(getattr(speed.mode_shapes, name)(*given))


# --- plan of the measurement


def test_every_example_is_timed_and_only_the_block_against_hertz_alone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each example has its limit; other comparisons occur once; progress counts all of them."""

    def recorder(kind: str) -> Any:
        def timing(*given: Any) -> tuple[Any, ...]:
            return (kind, *given)

        return timing

    for kind in ("law_over_exp", "impact_rate", "cold_start", "hertz_alone", "stable_over_naive"):
        monkeypatch.setattr(speed, kind, recorder(kind))
    block, pad, reported = Path("block.toml"), Path("pad.toml"), list[Any]()
    actual: list[Any] = speed.measure([block, pad], [pad], lambda *given: reported.append(given))
    assert actual == speed.measure([block, pad], [pad])
    assert [number for _, number, _ in reported] == list(range(1, len(actual) + 1))
    assert {total for *_, total in reported} == {len(actual)}
    assert [row[1:] for row in actual if row[0] == "cold_start"] == [
        ("simulate", block, speed.START), ("explain", block, speed.EXPLAIN_START),
        ("simulate", pad, speed.PLATE_START), ("explain", pad, speed.EXPLAIN_START),
    ]  # fmt: skip
    assert [row[1:] for row in actual if row[0] == "hertz_alone"] == [(block, 1.2)]
    assert [row[1] for row in actual if row[0] == "stable_over_naive"] == list(speed.NAIVE)
    assert not [row for row in speed.measure([pad]) if row[0] == "hertz_alone"]  # type: ignore[index]


def test_rates_and_cold_starts_time_the_intended_work(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """The clock advances by 1 with each call; processes are recorded instead of started."""
    ticks, started, impacts = count(), list[Any](), list[int]()
    monkeypatch.setattr(time, "perf_counter", lambda: float(next(ticks)))
    monkeypatch.setattr(speed, "impact", lambda **given: impacts.append(given["R"].size))
    rate = speed.impact_rate(0.01, 2.9, float(speed.SCENES))
    assert (rate.value, rate.unit, rate.passed) == (float(speed.SCENES), "1/s", True)
    assert set(impacts) == {speed.SCENES}
    assert not speed.impact_rate(0.01, 2.9, speed.SCENES + 1.0).passed

    monkeypatch.setattr(
        subprocess, "run", lambda call, **_: started.append([Path(x).name for x in call[2:]])
    )
    scene = tmp_path / "block.toml"
    scene.write_text("# a block\n")
    assert speed.cold_start("explain", scene, 1.0).passed
    command = [speed.COMMAND, "explain", "block.toml", "--json", "-"]
    assert started == [command, [speed.LIBRARIES]] * speed.COLD_ROUNDS
    switched = list[str]()
    monkeypatch.setattr(
        subprocess, "run", lambda call, **_: switched.append(Path(call[4]).read_text())
    )
    speed.hertz_alone(scene, 1.2)
    auto, off = switched[:2]
    assert auto == scene.read_text()
    assert off.startswith(auto)
    assert off.count(" = false") == len(speed.SWITCHES)
    assert switched == [auto, off] * speed.COLD_ROUNDS


def test_process_writes_bytecode_and_its_failure_raises_an_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")
    speed.process("import os, sys; assert sys.argv[1:] == ['x'] and not sys.dont_write_bytecode",
                  "x")()  # fmt: skip
    with pytest.raises(subprocess.CalledProcessError):
        speed.process("raise SystemExit(1)")()
