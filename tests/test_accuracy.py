"""What accuracy costs: interface, errors, clock, winners, data and commands; never how fast."""

import json
import math
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from dataclasses import asdict, replace
from itertools import cycle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derivation import pipeline
from derivation.cli import main
from derivation.files import ROOT
from derivation.measure.accuracy import (
    clock,
    law_series,
    run,
    scaling,
    tools,
)
from derivation.measure.accuracy.catalogue import methods
from derivation.measure.accuracy.clock import Candidate, Effort, Timing
from derivation.measure.accuracy.errors import Errors
from derivation.measure.accuracy.interface import PAPER, REGIMES
from derivation.measure.accuracy.pareto import winners
from derivation.measure.accuracy.rows import Row
from derivation.report import readme
from derivation.report.accuracy import accuracy_context, duration, reasons
from derivation.report.accuracy_figures import as_pdf, pareto_front, work_precision
from derivation.report.accuracy_figures import scaling as scaling_figure
from derivation.scene import choice

# --- interface


@pytest.mark.parametrize("regime", REGIMES, ids=lambda r: r.name)
def test_every_quick_method_gives_numbers_or_says_why(regime) -> None:
    for method in methods(quick=True):
        if method.certified or method.one_by_one or method.arithmetic != "float64":
            continue
        if method.task == "law" and not method.family.startswith(("split", "Chebyshev")):
            reason = method.fails(regime)
            if reason is None:
                found = method.prepare(regime)(regime.h * np.array([regime.low, regime.high]))
                assert np.isfinite(np.asarray(found, dtype=float)).all(), method.name
            else:
                assert reason


def test_names_are_unique_and_unknown_ones_are_refused() -> None:
    every = [(m.task, m.name) for m in methods()]
    assert len(set(every)) == len(every)
    with pytest.raises(ValueError, match="Levin u"):
        methods(["Levin"])
    assert {m.family for m in methods(["Levin u"])} == {"Levin u"}


# --- clock


class FakeClock:
    """A clock that work moves on."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now

    def work(self, seconds: float) -> Callable[[Any], None]:
        def call(array: Any) -> None:  # noqa: ARG001
            self.now += seconds

        return call


def test_times_are_per_point_and_relative_to_the_reference(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fake, array = FakeClock(), np.zeros(10)
    monkeypatch.setattr(clock, "reference", lambda: Candidate(fake.work(1.0), array, 1))
    candidates = [Candidate(fake.work(2.0), array, 3), Candidate(fake.work(5.0), array, 1)]
    found = clock.session(candidates, Effort(9, 3), fake)
    assert [t.seconds for t in found.timings] == pytest.approx([0.2, 0.5])
    assert (found.attempts, found.contended, found.spread) == (1, False, 1.0)


def test_a_busy_machine_is_tried_again_and_noted(monkeypatch: pytest.MonkeyPatch) -> None:
    fake, array, load = FakeClock(), np.zeros(1), cycle([1.0] * 6 + [9.0] * 6)

    def slower(array: Any) -> None:  # noqa: ARG001
        fake.now += next(load)

    monkeypatch.setattr(clock, "reference", lambda: Candidate(slower, array, 1))
    found = clock.session([Candidate(fake.work(1.0), array, 1)], Effort(4, 3), fake)
    assert found.attempts == 3
    assert (found.contended, found.spread) == (True, 9.0)
    hopeless = clock.session([Candidate(fake.work(1.0), array, 1)], Effort(4, 1), fake)
    assert hopeless.attempts == 1


def test_no_time_is_below_the_least_there_was(monkeypatch: pytest.MonkeyPatch) -> None:
    fake, array, load = FakeClock(), np.zeros(1), cycle([1.0] * 3 + [100.0] * 9)

    def disturbed(array: Any) -> None:  # noqa: ARG001
        fake.now += next(load)

    monkeypatch.setattr(clock, "reference", lambda: Candidate(disturbed, array, 1))
    found = clock.session([Candidate(fake.work(2.0), array, 1)], Effort(8, 1), fake)
    assert found.timings[0].seconds == 2.0


def test_spread_is_upper_over_lower_quartile(monkeypatch: pytest.MonkeyPatch) -> None:
    fake, array, load = FakeClock(), np.zeros(1), cycle([1.0, 1.0, 3.0, 3.0])

    def uneven(array: Any) -> None:  # noqa: ARG001
        fake.now += next(load)

    monkeypatch.setattr(clock, "reference", lambda: Candidate(fake.work(1.0), array, 1))
    found = clock.session([Candidate(uneven, array, 1)], Effort(8, 1), fake)
    assert found.timings[0].seconds == 1.0
    assert found.timings[0].spread == 3.0


def test_rounds_are_shuffled_and_repeat(monkeypatch: pytest.MonkeyPatch) -> None:
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


def test_a_block_grows_with_the_array_until_it_is_dear() -> None:
    fake, sample = FakeClock(), np.zeros(10_000)

    def linear(array: Any) -> None:
        fake.now += 1e-4 * array.size

    assert 200 <= clock.plan(linear, sample, fake).array.size <= 1024
    assert clock.plan(fake.work(1e-3), sample, fake).array.size == sample.size
    assert clock.plan(fake.work(1e-4), sample, fake).repeats == 20
    assert clock.plan(fake.work(0.1), sample, fake).array.size == sample.size


# --- winners


def row(family: str, total: float, seconds: float, setting: str = "") -> Row:
    timing = Timing(seconds, 1, 1.0, 1)
    errors = Errors(total, None, None, "0x0p+0")
    return Row("law", "paper", family, setting, "float64", None, errors, timing, timing, 0.0)


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
    assert list(found) == list(choice.METHODS)
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


# --- data and report


@pytest.fixture(scope="module")
def committed() -> dict[str, Any]:
    return pipeline.measured_accuracy()


def test_data_have_rows_of_every_kind(committed: dict[str, Any]) -> None:
    assert {"generated", "numpy", "python"} <= committed["provenance"].keys()
    assert [r["name"] for r in committed["regimes"]] == [r.name for r in REGIMES]
    for entry in committed["rows"]:
        assert entry.keys() == set(Row.__dataclass_fields__)
        assert entry["fails"] or (entry["errors"] and entry["vector"] and entry["single"])
        # Of no method that works is truncation not told from rounding.
        assert entry["fails"] or entry["errors"]["rounding"] is not None
    assert {entry["task"] for entry in committed["rows"]} == {"law", "inversion", "impact"}
    assert {g["what"] for g in committed["scaling"]} == {"points", "b/h", "digits", "scenes"}
    assert committed["headline"]["reached"]
    assert committed["tools"]


def test_production_beats_direct_summation_a_thousandfold(committed: dict[str, Any]) -> None:
    found = committed["headline"]
    assert found["digits"] >= 15
    best = found["reached"][-1]
    assert best["digits"] >= 9
    assert best["seconds"] / found["called"] > 1000


def test_figures_repeat_byte_for_byte(committed: dict[str, Any]) -> None:
    first, second = (as_pdf(work_precision(committed, "inversion", "single")) for _ in range(2))
    assert first == second
    assert as_pdf(scaling_figure(committed)).startswith(b"%PDF")


def test_the_section_names_every_failure(committed: dict[str, Any]) -> None:
    found = accuracy_context(committed)
    failing = {(r["task"], r["family"], r["regime"]) for r in committed["rows"] if r["fails"]}
    assert len(found["failures"]) == len(failing)
    assert duration(1.5e-9) == r"1.5\,ns"
    assert duration(0.0012) == r"1.2\,ms"


def test_the_readme_shows_what_was_measured(committed: dict[str, Any]) -> None:
    text = pipeline.README.read_text()
    assert readme.renewed(text, committed) == text, "to mend: platecontact report"


def test_the_readmes_block_follows_the_data_and_nothing_else(committed: dict[str, Any]) -> None:
    head = {"digits": 15.52, "called": 4e-9, "reached": [
        {"digits": 6, "modes": 10, "seconds": 1.0}, {"digits": 12, "modes": 2000, "seconds": 0.2},
    ]}  # fmt: skip
    won = {
        "task": "law", "regime": "paper", "kind": "vector", "digits": 9, "family": "split",
        "setting": "8 nodes", "ties": ["Levin u"], "seconds": 2.5e-6,
    }  # fmt: skip
    others = [won | {"kind": "single"}, won | {"digits": 30}, won | {"regime": "thin"}]
    grown = {"what": "scenes", "method": "hertz", "x": [1, 10_000], "seconds": [5e-6, 0.03]}
    data = committed | {"headline": head, "pareto": [won, *others], "scaling": [grown]}
    text = f"above\n{readme.BEGIN}\nold numbers\n{readme.END}\nbelow"
    found = readme.renewed(text, data)
    prose = " ".join(found.split())
    assert "15.5 digits in 4 ns a point" in prose
    assert "2,000 modes and 200 ms for 12 digits, 5e+07 times as long" in prose
    assert found.count("| 9 | split, 8 nodes (or Levin u) | 2.5 us |") == 1
    assert "| 30 |" not in found
    assert "| hertz | 5 us | 3 us | 10,000 |" in found
    assert found.startswith("above\n")
    assert found.endswith("\nbelow")
    assert "old" not in found
    assert readme.renewed(found, data) == found
    for bad in ("no markers", text + text, text.replace(readme.END, "")):
        with pytest.raises(ValueError, match="once each"):
            readme.renewed(bad, data)


# --- commands


@pytest.fixture
def brief(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out what takes seconds and is tested above."""
    monkeypatch.setattr(run, "tools", list)
    monkeypatch.setattr(scaling, "studies", lambda quick: ())  # noqa: ARG005
    monkeypatch.setattr(run, "REGIMES", (PAPER,))
    monkeypatch.setattr(run, "TASKS", ("law",))
    monkeypatch.setattr("derivation.measure.accuracy.problems.QUICK_DIGITS", 20)
    monkeypatch.setattr("derivation.measure.accuracy.headline.QUICK_MODES", 1 << 19)
    monkeypatch.setattr("derivation.measure.accuracy.headline.POINTS", 1000)


@pytest.mark.usefixtures("brief")
def test_command_writes_data_of_the_methods_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "accuracy.json"
    scene = ROOT / "derivation" / "scene" / "examples" / "paper.toml"
    arguments = ["--quick", "--method", "table of cubics", "--scene", str(scene)]
    assert main(["accuracy", *arguments, "--out", str(out)]) == 0
    data = json.loads(out.read_text())
    assert {r["family"] for r in data["rows"]} == {"table of cubics"}
    assert [r["name"] for r in data["regimes"]] == ["scene"]
    assert data["regimes"][0]["low"] < 0.1342 < data["regimes"][0]["high"]
    assert "direct sum" in capsys.readouterr().out


@pytest.mark.usefixtures("brief")
def test_a_contact_too_small_for_a_direct_sum_is_measured_all_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paper = ROOT / "derivation" / "scene" / "examples" / "paper.toml"
    slow, out = tmp_path / "slow.toml", tmp_path / "accuracy.json"
    slow.write_text(paper.read_text().replace("speed = 1.0", "speed = 1e-9"))
    arguments = ["--quick", "--method", "table of cubics", "--scene", str(slow)]
    assert main(["accuracy", *arguments, "--out", str(out)]) == 0
    assert json.loads(out.read_text())["headline"]["reached"] == []
    assert "direct sum of 524288 modes to fewer than 6 digits" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--method", "nonsense"], "nonsense"),
        (["--scene", "/nowhere/scene.toml"], "/nowhere/scene.toml"),
        (["--out", "/proc/nowhere/x.json"], "/proc/nowhere/x.json"),
    ],
)
def test_bad_input_is_one_message(
    arguments: list[str], says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = [] if "--out" in arguments else ["--out", str(tmp_path / "x.json")]
    assert main(["accuracy", *arguments, *out]) == 2
    message = capsys.readouterr().err
    assert says in message
    assert "Traceback" not in message
    assert list(tmp_path.iterdir()) == []


def test_a_scene_beyond_the_law_is_refused() -> None:
    with pytest.raises(ValueError, match="lower the speed"):
        run.scene_regime(0.13, 72.2, 1e6, 0.1, 1.0, 0.36e9, 0.43e9)


def test_an_interrupted_run_keeps_what_was_there(tmp_path: Path) -> None:
    program = """
import sys, time
from derivation import cli
from derivation.measure.accuracy import run
def endless(*arguments):
    print("measuring", flush=True)
    time.sleep(300)
run.panel = endless
sys.exit(cli.main(["accuracy", "--quick", "--out", sys.argv[1]]))
"""
    out = tmp_path / "accuracy.json"
    out.write_text("old")
    process = subprocess.Popen(
        [sys.executable, "-c", program, str(out)], cwd=ROOT, env={**os.environ},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert process.stdout is not None
    assert process.stdout.readline() == "measuring\n"
    process.send_signal(signal.SIGINT)
    _, message = process.communicate(timeout=60)
    assert process.returncode == 2
    assert "interrupted" in message
    assert [path.name for path in tmp_path.iterdir()] == ["accuracy.json"]
    assert out.read_text() == "old"


def test_report_names_what_is_not_split_with_the_reason_and_what_is_with_its_remark() -> None:
    """A reason once, with families and regimes; rows that fail, or have none, are not named."""
    why = "no long J0 here"
    row = {"family": "a_b", "regime": "thin", "fails": None, "errors": {"unsplit": why}}
    rows = [
        row,
        row | {"regime": "thick"},
        row | {"family": "c", "fails": "overflow"},
        row | {"family": "d", "errors": {"unsplit": None}},
        row | {"family": "e", "errors": None},
    ]
    assert list(reasons({"rows": rows}, "unsplit")) == [
        r"no long $J_{0}$ here: a\_b (thin, thick)."
    ]
    assert list(reasons({"rows": rows}, "remark")) == []
    rows[3]["errors"]["remark"] = "an estimate"
    assert list(reasons({"rows": rows}, "remark")) == ["an estimate: d (thin)."]
