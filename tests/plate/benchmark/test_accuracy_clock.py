"""Times of methods: the cheapest, how cost grows, other tools; never how fast."""

import json
import math
import sys
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derivation.engine.measure.clock import Timing
from derivation.plate.benchmark import law_series, scaling, tools
from derivation.plate.benchmark.errors import BenchmarkErrors
from derivation.plate.benchmark.pareto import winners
from derivation.plate.benchmark.rows import BenchmarkRow
from derivation.plate.report.accuracy_figures import pareto_front
from derivation.scene import method_selection

# --- winners


def row(family: str, total: float, seconds: float, setting: str = "") -> BenchmarkRow:
    timing = Timing(seconds, 1, 1.0, 1)
    errors = BenchmarkErrors(total, None, None, "0x0p+0")
    return BenchmarkRow(
        "law", "paper", family, setting, "float64", None, errors, timing, timing, 0.0
    )


def test_the_simplest_of_the_ties_wins_and_the_rest_are_named() -> None:
    rows = [
        row("Chebyshev surrogate", 15.1, 2.0), row("production", 15.5, 2.3),
        row("table of cubics", 15.9, 2.42), row("split", 15.9, 9.0), row("Hertz", 0.1, 0.1),
        row("small-a series", 3.5, 1.0, "1 terms"), row("small-a series", 6.5, 3.0, "2 terms"),
        replace(row("Levin u", 15.0, 0.1), fails="why", vector=None, single=None),
    ]  # fmt: skip
    found = {w.digits: w for w in winners(rows) if w.kind == "vector"}
    assert sorted(found) == [3, 6, 9, 12, 15]
    assert (found[3].family, found[3].setting, found[3].relative) == (
        "small-a series",
        "1 terms",
        1,
    )
    assert found[15].family == "production"
    assert found[15].ties == ("Chebyshev surrogate",)
    assert found[15].doubtful == ("production", "table of cubics")
    assert found[15].relative == pytest.approx(2.3)


def test_the_front_holds_what_nothing_beats() -> None:
    rows = [asdict(row("x", total, t)) for total, t in ((3, 2.0), (5, 1.0), (9, 4.0), (8, 5.0))]
    assert pareto_front(rows, "vector") == [(1.0, 5), (4.0, 9)]


# --- scaling and tools


def test_a_line_and_where_it_is_left() -> None:
    x = [1.0, 10.0, 100.0, 1000.0, 1e4]
    slope, leaves = scaling.line(x, [1 + t for t in x])
    assert slope == pytest.approx(1.0, abs=0.01)
    assert leaves == 1.0
    assert scaling.line(x, x)[1] is None


def test_scenes_grow_by_each_of_simulates_methods(monkeypatch: pytest.MonkeyPatch) -> None:
    def brief(what: str, method: str, x: Any, calls: Any, why: str) -> tuple[str, Any]:  # noqa: ARG001
        assert len(x) == len(calls)
        return method, calls[1]()

    monkeypatch.setattr(scaling, "growth", brief)
    found = dict(scaling.scenes(quick=True))
    assert list(found) == list(method_selection.METHODS)
    true = found["full"].contact_time
    np.testing.assert_allclose(found["coarse"].contact_time, true, rtol=1e-8)
    for name in ("hertz", "leading"):
        known = [(x, t) for x, t in zip(found[name], true, strict=True) if x is not None]
        assert known
        assert all(abs(x.contact_time / t - 1) <= x.law + 1e-12 for x, t in known)
        assert all((x.quadrature > 0) == (name == "leading") for x, _ in known)


def test_digits_grow_to_a_thousand(monkeypatch: pytest.MonkeyPatch) -> None:
    asked, method = [], law_series.small_contacts(2)

    def noted(terms: int, ar: Any) -> Any:
        asked.append(ar.digits)
        # So many terms give so many digits at the point that is timed.
        assert terms * 2 * math.log10(4 / 0.3) > ar.digits
        return method

    monkeypatch.setattr(law_series, "small_contacts", noted)
    monkeypatch.setattr(scaling, "growth", lambda *arguments: arguments)
    scaling.digits(quick=False)
    assert max(asked) == 1000
    asked.clear()
    scaling.digits(quick=True)
    assert max(asked) == 100


def test_memory_of_a_call_is_traced() -> None:
    assert 8e6 <= scaling.peak(lambda: np.ones(1_000_000)) < 9e6


def test_a_tool_is_read_or_said_to_be_missing(tmp_path: Path) -> None:
    script = tmp_path / "some_tool.py"
    cell = {"problem": "p", "setting": "s", "error": 0.1, "seconds": 1.0}
    said = {"name": "Some", "version": "1", "cannot": "much", "rows": [cell]}
    script.write_text(f"print({json.dumps(json.dumps(said))})")
    python = {tools.VARIABLE: sys.executable}
    [found] = tools.run(script, python)
    assert (found.name, found.error, found.missing) == ("Some", 0.1, None)
    [absent] = tools.run(script, {})
    assert absent.missing is not None
    assert absent.missing.startswith("not installed")
    script.write_text("import no_such_module")
    assert "no_such_module" in (tools.run(script, python)[0].missing or "")
    script.write_text("raise ValueError('x')")
    assert (tools.run(script, python)[0].missing or "").startswith("failed")


def test_scripts_of_tools_import_nothing_of_the_project() -> None:
    for script in tools.SCRIPTS.glob("*.py"):
        assert "derivation" not in script.read_text()
        assert "generated" not in script.read_text()


def test_a_tool_that_says_nothing_or_cannot_be_started_is_missing(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    script, python = tmp_path / "mute.py", {tools.VARIABLE: sys.executable}
    script.write_text("raise SystemExit(3)")
    assert tools.run(script, python)[0].missing == "failed: no message"
    nowhere = str(tmp_path / "no_python")
    missing = tools.run(script, {tools.VARIABLE: nowhere})[0].missing
    assert missing == f"not installed: {nowhere}: No such file or directory"
    script.write_text("import time; time.sleep(60)")
    monkeypatch.setattr(tools, "LIMIT", 0.2)
    assert tools.run(script, python)[0].missing == "no result within 0.2 s"


def test_own_results_are_hertzs_beside_every_tools(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a half-space the generated code is right to rounding; each script is asked once."""
    monkeypatch.delenv(tools.VARIABLE, raising=False)
    indentation, duration, *others = tools.tools()
    for own in (indentation, duration):
        assert own.name == "platecontact"
        assert own.error is not None
        assert own.error < 2e-15
        assert own.seconds is not None
        assert own.seconds > 0.0
    assert {tool.name.replace(" ", "_") for tool in others} == {
        script.stem for script in tools.SCRIPTS.glob("*.py")
    }
    assert all("names no Python" in (tool.missing or "") for tool in others)


def test_growth_is_of_calls_on_a_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lower quartile of seven, of one alone where that takes long; the slope of both."""
    now, calls = [0.0], list[float]()
    monkeypatch.setattr(scaling, "CPU", lambda: now[0])

    def work(seconds: float) -> None:
        calls.append(seconds)
        now[0] += seconds * (1.0 if calls.count(seconds) % 2 else 3.0)

    sizes = [1, 10, 100]
    grown = scaling.growth("points", "m", sizes, [partial(work, x / 100) for x in sizes], "why")
    assert [calls.count(x / 100) for x in sizes] == [8, 8, 3]  # the last is traced too
    assert grown.seconds[:2] == pytest.approx((0.01, 0.1))
    assert grown.seconds[2] == pytest.approx(3.0)
    assert (grown.what, grown.method, grown.why) == ("points", "m", "why")
    assert 0.9 < grown.slope < 1.4


def test_the_law_over_thinness_is_of_one_sphere_on_ever_thinner_plates(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Called and split in modes agree on each of them, and so do calls and what is prepared."""
    monkeypatch.setattr(scaling, "growth", lambda *given: given)
    monkeypatch.setattr(scaling, "ARRAY", scaling.SPLIT_POINTS)
    called, split = scaling.thinness()
    assert called[2] == split[2] == [10.0**k for k in range(5)]
    for one, other in zip(called[3][:3], split[3][:3], strict=True):
        np.testing.assert_allclose(one(), other(), rtol=1e-12)
    whole, ready = scaling.points()
    assert whole[2] == ready[2]
    for count, one, other in zip(whole[2][:4], whole[3][:4], ready[3][:4], strict=True):
        np.testing.assert_allclose(one(), other(), rtol=1e-14)
        assert np.size(one()) == count
    studies = dict(scaling.studies(quick=True))
    assert list(studies) == ["points", "b/h", "digits", "scenes"]
