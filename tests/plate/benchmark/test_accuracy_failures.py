"""Methods compared: where they fail and why, what panels do with that, what a platform lacks."""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import flint
import numpy as np
import pytest

from derivation import pipeline
from derivation.engine.measure import clock
from derivation.plate.benchmark import (
    catalogue,
    headline,
    law_generated,
    law_sums,
    panels,
    pareto,
    problems,
    reference_law,
    replay,
    run,
    scaling,
    stepping,
)
from derivation.plate.benchmark.arithmetic import DOUBLE, HAS_LONG, LONG
from derivation.plate.benchmark.interface import PAPER, REGIMES, Method
from derivation.plate.benchmark.rows import BenchmarkRow
from derivation.plate.contact.oracle import balls as contact_balls
from generated.contact_law import force, indentation
from generated.impact import impact

BY_NAME = {regime.name: regime for regime in REGIMES}
Patch = pytest.MonkeyPatch


def test_methods_fail_in_the_regimes_recorded_and_for_the_reason_recorded() -> None:
    """What no method says of itself beforehand was found by judging its numbers."""
    rows = json.loads(pipeline.MEASURED_ACCURACY.read_text())["rows"]
    names = "task", "regime", "family", "setting", "arithmetic"
    recorded = {tuple(row[name] for name in names): row["fails"] for row in rows}
    if not HAS_LONG:
        pytest.skip("recorded with long doubles")
    told = 0
    for method in catalogue.methods():
        for regime in REGIMES:
            key = method.task, regime.name, method.family, method.setting, method.arithmetic
            known, reason = recorded.pop(key), method.fails(regime)
            if reason is None:
                assert known is None or known.startswith(("no digit right", "gives no number"))
            else:
                assert reason == known
                told += 1
    assert recorded == {}
    assert told > 20


# --- panels


def method(values: Callable[[Any], Any], *, one_by_one: bool = False, **others: Any) -> Method:
    """A method of the law by a function of the radii."""
    return Method("law", "m", "", lambda _: values, one_by_one=one_by_one, **others)


def right(a: Any) -> Any:
    return indentation(a, PAPER.R, PAPER.h, PAPER.b)


@pytest.fixture
def fewer_digits(monkeypatch: Patch) -> None:
    monkeypatch.setattr(problems, "QUICK_DIGITS", 20)
    monkeypatch.setattr(problems, "ARRAY", 50)
    monkeypatch.setattr(panels, "SLOW", math.inf)
    effort = replace(clock.QUICK, rounds=2)
    monkeypatch.setattr(panels, "QUICK", effort)


@pytest.mark.usefixtures("fewer_digits")
def test_what_fails_is_named_and_not_timed() -> None:
    """NaN in part, no digit, or by its own word; nothing is timed where all of them fail."""
    partly = method(lambda a: np.where(a > np.median(a), right(a), np.nan))
    found = panels.panel("law", PAPER, [partly, method(right, fails=lambda _: "too thin")], True)
    assert (found.vector, found.single) == (None, None)
    assert [row.fails for row in found.rows] == [
        "gives no number in part of the regime",
        "too thin",
    ]
    assert [row.vector for row in found.rows] == [None, None]
    assert found.rows[1].errors is None
    [row] = panels.panel("law", PAPER, [method(lambda a: 9.0 * right(a))], True).rows
    assert row.fails == "no digit right: relative error up to 8"
    assert row.errors is not None
    assert row.vector is not None  # timed all the same: it gives numbers


@pytest.mark.usefixtures("fewer_digits")
def test_what_is_slow_is_called_once_with_a_shorter_array(monkeypatch: Patch) -> None:
    sizes = list[int]()

    def noted(a: Any) -> Any:
        sizes.append(np.size(a))
        return right(a)

    monkeypatch.setattr(panels, "SLOW", -1.0)
    monkeypatch.setattr(panels, "SLOW_ARRAY", 7)
    found = panels.panel("law", PAPER, [method(noted), method(noted, one_by_one=True)], True)
    assert (found.vector, found.single) == (None, None)
    assert sizes.count(7) == 1
    many, alone = found.rows
    assert many.vector is not None
    assert (many.vector.points, many.vector.rounds) == (7, 1)
    assert alone.vector == alone.single
    assert alone.fails is None


@pytest.mark.usefixtures("fewer_digits")
def test_one_by_one_is_timed_alone_and_other_tasks_not_at_all() -> None:
    found = panels.panel("law", PAPER, [method(right, one_by_one=True)], True)
    assert found.vector is None
    assert found.single is not None
    [row] = found.rows
    assert row.errors is not None
    assert row.errors.total > 14.0
    assert row.vector == row.single
    assert panels.panel("impact", PAPER, [method(right)], True) == panels.BenchmarkPanel(
        (), None, None
    )


def test_a_panel_in_which_nothing_was_timed_has_no_winner() -> None:
    row = BenchmarkRow("law", "paper", "m", "", "float64", "why")
    assert list(pareto._panel([row], "vector")) == []


@pytest.mark.usefixtures("fewer_digits")
def test_growth_is_measured_once_for_each_study(monkeypatch: Patch) -> None:
    grown = scaling.Growth("points", "m", (1.0, 2.0), (0.5, 1.0), 1.0, None, "why", None)
    monkeypatch.setattr(scaling, "studies", lambda quick: (("points", lambda: [grown] * quick),))
    monkeypatch.setattr(run, "REGIMES", ())
    monkeypatch.setattr(run, "headline", lambda *_: grown)  # any record will do
    monkeypatch.setattr(run, "tools", list)
    told = list[Any]()
    data = run.measure(quick=True, tell=lambda *given: told.append(given))
    assert [row["slope"] for row in data["scaling"]] == [1.0]
    assert told == [("scaling with points", 1, 3), ("headline", 2, 3), ("other tools", 3, 3)]
    again = run.measure(quick=True)  # with nobody to tell
    assert again["scaling"] == data["scaling"]


# --- laws and sums


@pytest.mark.parametrize("double_exponential", [True, False])
def test_the_side_walls_nodes_by_either_rule_give_its_moments(double_exponential: bool) -> None:
    """int y^n K0/I0 dy by oracle 1; weights are for that over y^3."""
    nodes, weights = law_sums.wall_nodes(64, 16, double_exponential, 120)
    y, w = (np.array([float(x) for x in column]) for column in (nodes, weights))
    for n in (0, 2, 4):
        true = float(contact_balls.kappa(n, 20))
        off = abs((w * y ** (n + 3)).sum() / true - 1)
        assert off < (1e-13 if double_exponential else 1e-8)  # K0's logarithm at 0 is felt


def test_zeros_are_the_same_whether_known_or_by_their_expansion() -> None:
    for begin in (headline.KNOWN_ZEROS - 3, headline.KNOWN_ZEROS, headline.KNOWN_ZEROS + 7):
        j, square = headline.zeros(begin, begin + 10)
        known, slope = DOUBLE.zeros(begin + 10)
        np.testing.assert_allclose(j, known[begin:], rtol=1e-13)
        np.testing.assert_allclose(square, slope[begin:] ** 2, rtol=1e-7)


def test_a_plate_of_no_ordinary_size_is_not_prepared() -> None:
    with pytest.raises(ValueError, match="ordinary lengths"):
        law_generated.prepared().prepare(replace(PAPER, R=1e-300, h=1e-300, b=1e-299))


def test_a_law_beyond_the_oracles_series_is_not_made_up() -> None:
    deep = replace(BY_NAME["large contacts"], speed=1e5)
    with pytest.raises(NotImplementedError, match="series does not reach"):
        reference_law._oracles(deep, 1.05 / deep.eta)
    with pytest.raises(NotImplementedError, match="takes minutes"):
        reference_law._oracles(replace(PAPER, h=1e-6), 1.0)


def test_the_papers_law_is_judged_to_a_thousand_digits(monkeypatch: Patch) -> None:
    """Many digits agree with few ones; other regimes do with fewer."""
    few = problems.problem("law", PAPER, True)
    monkeypatch.setattr(problems, "MANY_DIGITS", 60)
    radii = few.points[:2]
    many = problems._many_digits(radii, PAPER)
    with flint.ctx.workprec(300):
        assert all(abs(x / y - 1) < 1e-44 for x, y in zip(few.truths, many, strict=False))
    asked = list[Any]()
    monkeypatch.setattr(problems, "_many_digits", lambda _, regime: asked.append(regime) or many)
    assert problems.problem("law", PAPER, False).digits == 60
    assert asked == [PAPER]


# --- impacts by steps


@pytest.mark.parametrize("name", ["thick", "thin", "large contacts"])
def test_a_force_in_plain_python_is_the_generated_one(name: str) -> None:
    """Of thick plates one polynomial is enough; a plate not pressed does not push."""
    r = BY_NAME[name]
    top = min(r.high, 5.5) * r.h
    call = stepping.scalar_force(r)
    for share in (1e-3, 0.1, 0.5, 1.0):
        delta = float(indentation(share * top, r.R, r.h, r.b))
        true = float(force(delta, r.R, r.h, r.b, r.lam, r.mu))
        assert call(delta) == pytest.approx(true, rel=1e-13)
    assert call(0.0) == call(-1.0) == 0.0


def test_steps_that_run_out_or_over_give_no_time(monkeypatch: Patch) -> None:
    r = PAPER
    speeds = np.array([r.speed])
    true = float(impact(r.R, r.m, r.speed, r.h, r.b, r.lam, r.mu).contact_time)
    verlet = stepping.verlet(100)
    assert verlet.prepare(r)(speeds)[0] == pytest.approx(true, rel=1e-2)
    monkeypatch.setattr(stepping, "MOST_STEPS", 20)
    assert np.isnan(verlet.prepare(r)(speeds)).all()
    monkeypatch.setattr(stepping, "SAME_STEPS", 20)
    assert verlet.same is not None
    with pytest.raises(NotImplementedError, match="minutes"):
        verlet.same(r)


def test_without_long_doubles_steps_are_not_repeated(monkeypatch: Patch) -> None:
    monkeypatch.setattr(stepping, "HAS_LONG", False)
    stepping._repeated.cache_clear()
    with pytest.raises(NotImplementedError, match="no longer than double"):
        stepping._repeated(PAPER, "DOP853", 1.0, (0.0, 1.0))


@pytest.mark.skipif(not HAS_LONG, reason="long double is a double")
def test_steps_that_end_too_early_are_not_split() -> None:
    with pytest.raises(NotImplementedError, match="does not stop in the last step"):
        stepping._repeated(PAPER, "DOP853", 1.0, (0.0, 1e-5, 2e-5))


@pytest.mark.skipif(not HAS_LONG, reason="long double is a double")
def test_a_sphere_that_does_not_stop_in_the_last_step_has_no_turning_point() -> None:
    law = reference_law.sure_law(PAPER, LONG)
    half = float(impact(PAPER.R, PAPER.m, 1.0, PAPER.h, PAPER.b, PAPER.lam, PAPER.mu)[0]) / 2
    steps = [half * k / 40 for k in range(42)]
    found = replay.turning_time(replay.dop853_step, 1.0, PAPER.m, steps, law.force)
    assert float(found) == pytest.approx(half, rel=1e-8)
    for ends in (steps[:30], [*steps, 1.1 * half, 1.2 * half]):  # too early, too late
        assert np.isnan(replay.turning_time(replay.dop853_step, 1.0, PAPER.m, ends, law.force))


def test_without_long_doubles_all_other_methods_are_compared(monkeypatch: Patch) -> None:
    every = catalogue.methods()
    monkeypatch.setattr(catalogue, "HAS_LONG", False)
    others = catalogue.methods()

    def names(found: list[Method]) -> list[tuple[str, ...]]:
        return [(m.task, m.family, m.setting, m.arithmetic) for m in found]

    wanted = [name for name in names(every) if name[-1] != "long double"]
    assert names(others) == wanted
    if HAS_LONG:
        assert len(wanted) < len(every)


def test_without_long_doubles_the_headline_is_told_in_doubles(monkeypatch: Patch) -> None:
    """What a direct sum reaches is no more than doubles hold, and grows with the modes."""
    monkeypatch.setattr(headline, "HAS_LONG", False)
    monkeypatch.setattr(headline, "QUICK_MODES", 1 << 19)
    monkeypatch.setattr(headline, "POINTS", 1000)
    found = headline.headline(PAPER, quick=True)
    assert found.digits > 14.0
    reached = [(r.digits, r.modes) for r in found.reached]
    assert reached == sorted(reached)
    assert reached[-1][0] <= 16
    assert found.modes == 1 << 19
