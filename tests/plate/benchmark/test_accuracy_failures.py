"""Test failures of methods, benchmark groups, fastest methods, run-time growth and tools."""

import json
import math
import subprocess
import sys
from collections.abc import Callable
from dataclasses import asdict, replace
from functools import partial
from typing import Any

import flint
import numpy as np
import pytest

from derivation import pipeline
from derivation.engine.measure import clock
from derivation.engine.measure.clock import Timing
from derivation.plate.benchmark import (
    catalogue,
    half_space,
    headline,
    panels,
    pareto,
    problems,
    ready_methods,
    scaling,
    sums,
    tools,
)
from derivation.plate.benchmark.arithmetic import (
    DOUBLE,
    HAS_LONG_DOUBLE,
    LONG_DOUBLE,
    Mpmath,
    as_ball,
)
from derivation.plate.benchmark.errors import BenchmarkErrors, digits
from derivation.plate.benchmark.interface import CASES, PAPER, Method, largest_contact_radius
from derivation.plate.benchmark.rows import BenchmarkRow
from derivation.plate.report.accuracy_figures import pareto_front
from derivation.scene.selection.achieved_accuracy import METHODS
from generated.contact_law import indentation

Patch = pytest.MonkeyPatch


# --- failures


@pytest.mark.skipif(not HAS_LONG_DOUBLE, reason="recorded with long doubles")
def test_methods_fail_as_recorded() -> None:
    """Each recorded failure is predicted by the method or was found by evaluating its numbers."""
    rows = json.loads(pipeline.MEASURED_ACCURACY.read_text())["rows"]
    names = "task", "case", "family", "setting", "arithmetic"
    recorded = {tuple(row[name] for name in names): row["fails"] for row in rows}
    reported = 0
    for method in catalogue.methods():
        for case in CASES:
            key = method.task, case.name, method.family, method.setting, method.arithmetic
            known, reason = recorded.pop(key), method.fails(case)
            if reason is None:
                assert known is None or known.startswith(("no correct digit", "gives no number"))
            else:
                assert reason == known
                reported += 1
    assert recorded == {}
    assert reported > 20


@pytest.mark.parametrize("case", CASES, ids=lambda r: r.name)
def test_fast_methods_in_doubles_give_numbers_or_a_reason(case) -> None:
    for method in catalogue.methods(quick=True):
        if method.task != "law" or method.arithmetic != "float64" or method.one_by_one:
            continue
        if method.fails(case) is None and not method.family.startswith(("split sum", "Chebyshev")):
            actual = method.prepared(case)(case.h * np.array([case.low, case.high]))
            assert np.isfinite(actual).all(), method.name


def test_names_are_unique_and_unknown_ones_are_rejected() -> None:
    every = [(m.task, m.name) for m in catalogue.methods()]
    assert len(set(every)) == len(every)
    with pytest.raises(ValueError, match="Levin u transform"):
        catalogue.methods(["Levin"])
    assert {m.family for m in catalogue.methods(["Levin u transform"])} == {"Levin u transform"}


def test_thousand_digits_only_for_the_paper_or_omitted_with_a_reason() -> None:
    deep = [m for m in catalogue.methods() if m.arithmetic.endswith("1000 digits")]
    assert {m.family for m in deep if m.fails(PAPER) is None} == {"series in a/h"}
    for case in CASES:
        if case is not PAPER:
            assert all((m.fails(case) or "").startswith("omitted") for m in deep)
    assert not any(m.arithmetic.endswith("1000 digits") for m in catalogue.methods(quick=True))


def test_without_long_doubles_all_other_methods_are_compared(monkeypatch: Patch) -> None:
    every = [m.name for m in catalogue.methods()]
    monkeypatch.setattr(catalogue, "HAS_LONG_DOUBLE", False)
    assert [m.name for m in catalogue.methods()] == [x for x in every if "long double" not in x]


def test_without_long_doubles_the_headline_uses_doubles(monkeypatch: Patch) -> None:
    """The accuracy of a direct sum in doubles increases with the number of modes."""
    monkeypatch.setattr(headline, "HAS_LONG_DOUBLE", False)
    monkeypatch.setattr(headline, "QUICK_MODES", 1 << 19)
    monkeypatch.setattr(headline, "POINTS", 1000)
    actual = headline.headline(PAPER, quick=True)
    assert actual.digits > 14.0
    reached = [(r.digits, r.modes) for r in actual.direct_sum]
    assert reached == sorted(reached)
    assert {r.truncation for r in actual.direct_sum} == {None}
    assert actual.modes == 1 << 19


@pytest.mark.skipif(not HAS_LONG_DOUBLE, reason="long double is a double")
def test_sums_of_the_headline_agree_with_interval_arithmetic(monkeypatch: Patch) -> None:
    monkeypatch.setattr(headline, "CHUNK", 1024)
    monkeypatch.setattr(headline, "BLOCK", 512)
    a = largest_contact_radius(PAPER)
    for ar, least in ((DOUBLE, 14.5), (LONG_DOUBLE, 17.5)):
        partial, times, _ = headline.direct_sums(PAPER, a, 1536, ar)
        assert len(times) == len(partial) == 4
        (exact,) = sums.direct(1536, Mpmath(40)).prepared(PAPER)(np.array([a]))
        with flint.ctx.workprec(160):
            assert digits(partial[2], as_ball(exact), 30) > least


def test_plate_of_extreme_size_is_not_prepared() -> None:
    with pytest.raises(ValueError, match="ordinary lengths"):
        ready_methods.prepared_law().prepared(replace(PAPER, R=1e-300, h=1e-300, b=1e-299))


# --- benchmark groups


def method(values: Callable[[Any], Any], **others: Any) -> Method:
    """Return a method for the contact law that evaluates `values` at the radii."""
    return Method("law", "m", "", lambda *_: values, split="all", **others)


def generated_law(a: Any) -> Any:
    return indentation(a, PAPER.R, PAPER.h, PAPER.b)


@pytest.fixture
def fewer_digits(monkeypatch: Patch) -> None:
    monkeypatch.setattr(problems, "QUICK_DIGITS", 20)
    monkeypatch.setattr(problems, "ARRAY", 50)
    monkeypatch.setattr(panels, "SLOW_CALL", math.inf)
    monkeypatch.setattr(panels, "QUICK", replace(clock.QUICK, rounds=2))


@pytest.mark.usefixtures("fewer_digits")
def test_failing_methods_are_named_and_not_timed() -> None:
    """A method fails by partial NaN, no correct digit or its own statement.

    If all methods fail without usable numbers, nothing is timed.
    """
    partly = method(lambda a: np.where(a > np.median(a), generated_law(a), np.nan))
    actual = panels.panel(
        "law", PAPER, [partly, method(generated_law, fails=lambda _: "too thin")], True
    )
    assert (actual.vector, actual.single) == (None, None)
    assert [row.fails for row in actual.rows] == [
        "gives no number in part of the case",
        "too thin",
    ]
    assert [row.vector for row in actual.rows] == [None, None]
    [row] = panels.panel("law", PAPER, [method(lambda a: 9.0 * generated_law(a))], True).rows
    assert row.fails == "no correct digit: relative error up to 8"
    assert row.vector is not None  # it is timed because it returns numbers
    assert list(pareto._panel([actual.rows[0]], "vector")) == []


@pytest.mark.usefixtures("fewer_digits")
def test_slow_methods_are_called_once_with_a_shorter_array(monkeypatch: Patch) -> None:
    sizes = list[int]()

    def recording(a: Any) -> Any:
        sizes.append(np.size(a))
        return generated_law(a)

    monkeypatch.setattr(panels, "SLOW_CALL", -1.0)
    monkeypatch.setattr(panels, "SLOW_ARRAY", 7)
    actual = panels.panel("law", PAPER, [method(recording), method(recording, scalar=True)], True)
    assert (actual.vector, actual.single) == (None, None)
    assert sizes.count(7) == 1
    many, alone = actual.rows
    assert many.vector is not None
    assert (many.vector.points, many.vector.rounds) == (7, 1)
    assert alone.vector == alone.single


@pytest.mark.usefixtures("fewer_digits")
def test_scalar_methods_are_timed_with_single_calls() -> None:
    actual = panels.panel("law", PAPER, [method(generated_law, scalar=True)], True)
    assert actual.vector is None
    [row] = actual.rows
    assert row.errors is not None
    assert row.errors.total > 14.0
    assert row.vector == row.single is not None
    assert panels.panel("impact", PAPER, [method(generated_law)], True).rows == ()


# --- winners


def row(family: str, total: float, seconds: float, setting: str = "") -> BenchmarkRow:
    timing, errors = Timing(seconds, 1, 1.0, 1), BenchmarkErrors(total, None, None, "0x0p+0")
    return BenchmarkRow(
        "law", "paper", family, setting, "float64", None, errors, timing, timing, 0.0
    )


def test_simplest_of_equally_fast_methods_wins() -> None:
    rows = [
        row("Chebyshev polynomial", 15.1, 2.0), row("generated code", 15.5, 2.3),
        row("cubic interpolation", 15.9, 2.42), row("split sum", 15.9, 9.0), row("Hertz", 0.1, 0.1),
        row("series in a/h", 3.5, 1.0, "1 term"), row("series in a/h", 6.5, 3.0, "2 terms"),
        replace(row("Levin u transform", 15.0, 0.1), fails="why", vector=None, single=None),
    ]  # fmt: skip
    actual = {w.digits: w for w in pareto.winners(rows) if w.kind == "vector"}
    assert sorted(actual) == [3, 6, 9, 12, 15]
    assert (actual[3].family, actual[3].setting) == ("series in a/h", "1 term")
    assert actual[3].relative == 1
    assert actual[15].family == "generated code"
    assert actual[15].ties == ("Chebyshev polynomial",)
    assert actual[15].near_ties == ("generated code", "cubic interpolation")
    assert actual[15].relative == pytest.approx(2.3)


def test_pareto_front_has_the_undominated_methods() -> None:
    rows = [asdict(row("x", total, t)) for total, t in ((3, 2.0), (5, 1.0), (9, 4.0), (8, 5.0))]
    assert pareto_front(rows, "vector") == [(1.0, 5), (4.0, 9)]


# --- growth of run time


def test_power_law_and_the_end_of_its_range() -> None:
    x = [1.0, 10.0, 100.0, 1000.0, 1e4]
    slope, deviates_at = scaling.line(x, [1 + t for t in x])
    assert slope == pytest.approx(1.0, abs=0.01)
    assert deviates_at == 1.0
    assert scaling.line(x, x)[1] is None


def test_growth_is_measured_with_a_simulated_clock(monkeypatch: Patch) -> None:
    """The run time is the lower quartile of seven calls, or one call if it is slow."""
    now, calls = [0.0], list[float]()
    monkeypatch.setattr(scaling, "CPU", lambda: now[0])

    def work(seconds: float) -> None:
        calls.append(seconds)
        now[0] += seconds * (1.0 if calls.count(seconds) % 2 else 3.0)

    sizes = [1, 10, 100]
    grown = scaling.growth("points", "m", sizes, [partial(work, x / 100) for x in sizes], "why")
    assert [calls.count(x / 100) for x in sizes] == [8, 8, 3]  # last: one call, then memory
    assert grown.seconds == pytest.approx((0.01, 0.1, 3.0))
    assert 8e6 <= scaling.peak(lambda: np.ones(1_000_000)) < 9e6


def test_timed_methods_of_a_study_agree(monkeypatch: Patch) -> None:
    """The methods that a study times agree on their results."""
    monkeypatch.setattr(
        scaling, "growth", lambda name, _, x, calls, reason: (name, x, calls, reason)
    )
    monkeypatch.setattr(scaling, "ARRAY", scaling.SPLIT_POINTS)
    for one, other in (scaling.points(), scaling.thickness_ratios()):
        assert one[1] == other[1]
        for first, second in zip(one[2][:4], other[2][:4], strict=True):
            np.testing.assert_allclose(first(), second(), rtol=1e-12)
    actual = dict(zip(METHODS, scaling.scenes(quick=True), strict=True))
    results = {name: growth[2][1]() for name, growth in actual.items()}
    reference = results["full"].contact_time
    np.testing.assert_allclose(results["coarse"].contact_time, reference, rtol=1e-8)
    for name in ("hertz", "leading"):
        known = [(x, t) for x, t in zip(results[name], reference, strict=True) if x is not None]
        assert known
        assert all(abs(x.contact_time / t - 1) <= x.law + 1e-12 for x, t in known)
    assert list(dict(scaling.studies(quick=True))) == ["points", "b/h", "digits", "scenes"]


# --- other programs


def test_results_of_programs_are_read_or_reported_missing(monkeypatch: Patch) -> None:
    monkeypatch.delenv(tools.VARIABLE, raising=False)
    actual = tools.tools()
    for own in actual[:2]:
        assert own.name == "platecontact"
        assert own.error is not None
        assert own.error < 2e-15
    assert {tool.name for tool in actual[2:]} == set(half_space.PROGRAMS)
    scipy = [tool for tool in actual if tool.name == "SciPy quad"]
    assert min(tool.error for tool in scipy if tool.error is not None) < 1e-13
    assert all(
        "names no Python" in (tool.missing or "") for tool in actual[2:] if tool not in scipy
    )


@pytest.mark.parametrize(
    ("python", "message"),
    [
        (sys.executable, "not installed: ModuleNotFoundError"),
        ("/nowhere/python", "not installed: /nowhere/python: No such file or directory"),
    ],
)
def test_program_that_cannot_start_is_reported_missing(python: str, message: str) -> None:
    assert (tools.run("LAMMPS", {tools.VARIABLE: python})[0].missing or "").startswith(message)


def test_program_that_fails_or_hangs_is_reported_missing(monkeypatch: Patch) -> None:
    given, failed = {tools.VARIABLE: sys.executable}, subprocess.CompletedProcess([], 3, "", "")
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: failed)
    assert tools.run("tamaas", given)[0].missing == "failed: no message"

    def hangs(*_: Any, **__: Any) -> None:
        raise subprocess.TimeoutExpired("x", tools.LIMIT)

    monkeypatch.setattr(subprocess, "run", hangs)
    assert tools.run("tamaas", given)[0].missing == "no result within 120 s"
