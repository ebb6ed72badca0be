"""The subcommands of `check`: table, JSON, record and exit status."""

import dataclasses
import json
import math
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from derivation import pipeline
from derivation.checks import bounds
from derivation.checks import effects as effects_check
from derivation.checks import inertia as inertia_check
from derivation.checks.effects import TOLERANCES
from derivation.checks.inertia_rows import InertiaRow
from derivation.cli import main
from derivation.engine import build
from derivation.engine.measure import check as measure
from derivation.engine.measure import suite
from derivation.engine.measure.case import read_cases
from derivation.engine.measure.suite import Suite
from derivation.engine.paper import Paper
from derivation.engine.text import WIDTH
from derivation.plate import judge as plate_judge
from derivation.plate import paper as plate_paper
from derivation.plate.benchmark.speed import SpeedTiming
from derivation.plate.cases import suite as hard_suite
from derivation.plate.contact.cases import check as contact
from derivation.plate.judge import generated_kernels
from derivation.plate.paper import PAPER

Captured = pytest.CaptureFixture[str]
Patch = pytest.MonkeyPatch


def rows_of(path: Path) -> list[dict[str, Any]]:
    actual: list[dict[str, Any]] = json.loads(path.read_text())["rows"]
    return actual


# --- generated functions


@pytest.fixture
def install_j0(monkeypatch: Patch, tmp_path: Path) -> Callable[[float], Path]:
    """Make `check` measure only J0, multiplied by a factor; return the path of the record."""
    path = tmp_path / "check.json"
    monkeypatch.setattr(plate_paper, "PAPER", dataclasses.replace(PAPER, records=tmp_path))

    def install(factor: float) -> Path:
        [exact] = [kernel for kernel in generated_kernels() if kernel.name == "bessel_j0"]
        wrong = dataclasses.replace(exact, call=lambda x: exact.call(x) * x.dtype.type(factor))
        unlimited = dataclasses.replace(wrong, module="as_printed", budget=None)
        monkeypatch.setattr(
            measure, "check",
            lambda _, digits, progress: plate_judge.check(digits, [wrong, unlimited], progress),
        )  # fmt: skip
        return path

    return install


def test_measurement_agrees_with_the_record(
    install_j0: Callable[[float], Path], capsys: Captured
) -> None:
    every = rows_of(pipeline.measurements() / "check.json")
    committed = [row for row in every if row["kernel"] == "bessel_j0"]
    path = install_j0(1.0)
    assert main(["check", "--json", "-"]) == 0
    first, second = json.loads(capsys.readouterr().out)["rows"]
    assert [first] == committed
    assert (second["passed"], second["double"]["max_ulp"]) == (None, first["double"]["max_ulp"])
    assert not path.exists()
    assert main(["check", "--update"]) == 0
    assert rows_of(path) == [first, second]
    shown = capsys.readouterr().out
    assert "Errors against 50 digits" in shown
    listed = [line for line in shown.splitlines() if line.startswith("bessel_j0: ")]
    [(name, exact, _)] = committed[0]["double"]["worst"]["arguments"]
    decimal = f"{float.fromhex(exact)!r} ({exact})"
    assert listed == [f"bessel_j0: {name}={decimal}"]  # a function without a budget is not listed


def test_function_above_its_budget_fails_and_is_named(
    install_j0: Callable[[float], Path], capsys: Captured
) -> None:
    path = install_j0(1.0)
    paper = plate_paper.PAPER
    correct = build.check(paper, update=True)
    before = path.read_bytes()
    assert build.measurement_remarks(paper, correct) == ["all errors are within their budgets"]
    install_j0(1.0 + 1e-13)
    assert main(["check"]) == 1
    assert "NO" in capsys.readouterr().out
    assert build.measurement_remarks(paper, build.check(paper)) == [
        "above their budget: bessel_j0",
        "different from the saved check.json: bessel_j0",
    ]
    assert path.read_bytes() == before
    path.unlink()
    assert build.measurement_remarks(paper, correct) == [
        "all errors are within their budgets"
    ]  # there is no record to compare with


# --- contact law


@pytest.fixture
def few_contacts(monkeypatch: Patch, tmp_path: Path) -> Path:
    """Measure only two functions, in this process; return the path of the record."""
    path = tmp_path / "contact.json"
    monkeypatch.setattr(pipeline, "MEASURED_CONTACT", path)
    monkeypatch.setattr(pipeline, "KERNELS", ("force_of_radius", "max_pressure"))
    monkeypatch.setattr(pipeline.os, "cpu_count", lambda: 1)
    return path


def test_contact_law_agrees_with_the_record(few_contacts: Path, capsys: Captured) -> None:
    recorded = {r["kernel"]: r for r in rows_of(pipeline.measurements() / "contact.json")}
    known = [recorded["force_of_radius"], recorded["max_pressure"]]
    assert main(["check", "contact-law", "--json", "-"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["rows"] == known
    assert not few_contacts.exists()
    assert main(["check", "contact-law", "--update"]) == 0
    assert json.loads(few_contacts.read_text()) == data
    shown = capsys.readouterr().out
    for row in known:
        worst = " ".join(f"{float.fromhex(exact)!r} ({exact})" for exact in row["worst"])
        assert f"{row['kernel']}: {worst}" in " ".join(shown.split())
    assert max(map(len, shown.splitlines())) <= WIDTH
    assert main(["check", "contact-law", "--suggest-budgets", "--json", "-"]) == 0
    suggested = json.loads(capsys.readouterr().out)["suggested_budgets"]
    for name, ulp in suggested.items():
        assert recorded[name]["double"]["needed"] < ulp < recorded[name]["budget"]


def test_contact_law_that_returns_nan_fails(
    few_contacts: Path, monkeypatch: Patch, capsys: Captured
) -> None:
    exact = pipeline.contact_law.max_pressure
    monkeypatch.setattr(
        pipeline, "contact_law",
        SimpleNamespace(
            force_of_radius=lambda *given: math.nan * given[0],
            max_pressure=lambda *given: exact(*given),
        ),
    )  # fmt: skip
    assert main(["check", "contact-law", "--json", "-"]) == 1
    wrong, correct = json.loads(capsys.readouterr().out)["rows"]
    assert (wrong["passed"], correct["passed"]) == (False, True)
    assert wrong["max_error"] == "inf"
    assert not few_contacts.exists()


def test_law_with_two_results_is_rejected() -> None:
    point = {"max_pressure": [(0.1, 1.0, 1e9, 1e9)]}
    with pytest.raises(ValueError, match="2 results"):
        contact.check({"max_pressure": lambda *_: (1.0, 2.0)}, point)


# --- hard cases


@pytest.fixture
def few_cases(monkeypatch: Patch, tmp_path: Path) -> tuple[Path, list[dict[str, Any]]]:
    """Use four hard cases, of which only the first has a valid reference in the record.

    Return the path of the record, and the committed references.
    """
    everything = json.loads(PAPER.hard.read_text())["cases"]
    every = [c for c in hard_suite.cases() if c.kernel == "bessel_j0"]
    wanted = [*(c for c in every if c.expect == "value")][:3]
    wanted += [c for c in every if c.expect == "nan"]
    keys = [case.key for case in wanted]
    rows = sorted((r for r in everything if r["key"] in keys), key=lambda r: keys.index(r["key"]))
    path = tmp_path / "hard.json"
    monkeypatch.setattr(Paper, "hard", path)
    monkeypatch.setattr(hard_suite, "cases", lambda: tuple(wanted))
    path.write_text(json.dumps({"cases": [rows[0], {**rows[1], "origin": "of another formula"}]}))
    return path, rows


def test_missing_references_are_computed_and_equal_the_committed_ones(
    few_cases: tuple[Path, list[dict[str, Any]]], monkeypatch: Patch
) -> None:
    path, committed = few_cases
    computed, find = list[str](), Suite.references
    monkeypatch.setattr(
        Suite, "references", lambda self, case: computed.append(case.key) or find(self, case)
    )
    monkeypatch.setattr(suite, "SAVED_EVERY", -1.0)
    assert main(["check", "hard-cases", "--update"]) == 0
    assert json.loads(path.read_text())["cases"] == committed
    assert computed == [row["key"] for row in committed[1:]]  # the first is still valid
    assert [p.name for p in path.parent.iterdir()] == ["hard.json"]


def test_interrupted_computation_of_references_is_continued(
    few_cases: tuple[Path, list[dict[str, Any]]], monkeypatch: Patch, capsys: Captured
) -> None:
    path, committed = few_cases
    before, find = path.read_bytes(), Suite.references

    def stopped(self: Suite, case: Any) -> Any:
        if case.key == committed[2]["key"]:
            raise KeyboardInterrupt
        return find(self, case)

    monkeypatch.setattr(Suite, "references", stopped)
    assert main(["check", "hard-cases", "--update"]) == 2
    assert "interrupted" in capsys.readouterr().err
    assert path.read_bytes() == before
    part = path.with_suffix(".part.json")
    assert [r["key"] for r in json.loads(part.read_text())["cases"]] == [
        row["key"] for row in committed[:2]
    ]
    computed = list[str]()
    monkeypatch.setattr(
        Suite, "references", lambda self, case: computed.append(case.key) or find(self, case)
    )
    assert main(["check", "hard-cases", "--update"]) == 0
    assert computed == [row["key"] for row in committed[2:]]
    assert json.loads(path.read_text())["cases"] == committed
    assert not part.exists()


def test_repeated_hard_case_is_rejected(monkeypatch: Patch) -> None:
    once = tuple(read_cases(hard_suite.WRITTEN))
    monkeypatch.setattr(hard_suite, "cases", lambda: (*once, once[0]))
    with pytest.raises(ValueError, match="twice") as error:
        hard_suite.suite()
    assert once[0].key in str(error.value)


# --- bounds in random scenes


def test_references_are_saved_while_they_are_computed(
    monkeypatch: Patch, tmp_path: Path, capsys: Captured
) -> None:
    """Recorded references are reused, and kept after an interruption or a shorter run."""
    known = bounds.committed_references()[:7]
    path, computed = tmp_path / "bounds.json", list[Any]()
    monkeypatch.setattr(bounds, "MEASURED", path)
    monkeypatch.setattr(bounds, "SAVE_EVERY", 2)
    reference_values = {
        bounds.scene(number): exact_value for number, exact_value in enumerate(known)
    }

    def reference(point: Any) -> Any:
        if len(computed) == 4:
            raise KeyboardInterrupt
        computed.append(point)
        return reference_values[point]

    monkeypatch.setattr(bounds, "reference", reference)
    assert main(["check", "error-bounds", "-n", "7", "--update"]) == 2
    assert "interrupted" in capsys.readouterr().err
    assert bounds.committed_references() == known[:4]
    computed[:] = [None]
    assert main(["check", "error-bounds", "-n", "7", "--update"]) == 0
    assert computed == [None, *map(bounds.scene, range(4, 7))]
    assert bounds.committed_references() == known
    whole = rows_of(path)
    assert sum(row["runs"] for row in whole) == 7 * len(bounds.TOLERANCES)
    assert main(["check", "error-bounds", "-n", "2", "--update"]) == 0
    assert bounds.committed_references() == known
    assert sum(row["runs"] for row in rows_of(path)) == 2 * len(bounds.TOLERANCES)
    shown = capsys.readouterr().out
    assert "7 scenes" in shown
    assert all(row["method"] in shown for row in whole)
    data = json.loads(path.read_text()) | {"digits": bounds.DIGITS + 1}
    path.write_text(json.dumps(data))
    assert (
        bounds.committed_references() == []
    )  # references with another number of digits are not used


def test_nan_gives_valid_json(monkeypatch: Patch, capsys: Captured) -> None:
    monkeypatch.setattr(bounds, "simulated", lambda _, rtol: ([math.nan] * 4, "hertz", rtol))
    assert main(["check", "error-bounds", "-n", "1", "--json", "-"]) == 1
    [row] = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert (row["ratio"], row["error"]) == ("inf", "inf")


# --- effects, inertia


ONES = [1.0] * 4


def test_check_of_effects_is_printed_and_recorded(
    monkeypatch: Patch, tmp_path: Path, capsys: Captured
) -> None:
    """Two of six scenes are outside the models; one of the others cannot reach one tolerance."""
    path, scenes = tmp_path / "effects.json", list[Any]()

    def everything(data: Any) -> Any:
        scenes.append(data)
        return None if len(scenes) in (2, 5) else (ONES, ["hertz", "gravity"])

    def selected(_: Any, rtol: float) -> Any:
        rejected = len(scenes) == 3 and rtol == TOLERANCES[-1]
        return None if rejected else ([*ONES[1:], 1.0 + rtol / 4], ["hertz"], rtol / 2)

    monkeypatch.setattr(effects_check, "MEASURED", path)
    monkeypatch.setattr(effects_check, "all_effects_impact", everything)
    monkeypatch.setattr(effects_check, "selected_impact", selected)
    assert main(["check", "effects", "-n", "6", "--update"]) == 0
    assert "6 scenes" in capsys.readouterr().out
    rows = rows_of(path)
    assert [row["rtol"] for row in rows] == list(TOLERANCES)
    assert [row["scenes"] for row in rows] == [4, 4, 4, 3]
    assert [row["rejected"] for row in rows] == [0, 0, 0, 1]
    assert [row["error_over_rtol"] for row in rows] == pytest.approx([0.25] * 4, rel=1e-5)
    assert [row["error_over_bound"] for row in rows] == pytest.approx([0.5] * 4, rel=1e-5)
    assert {(r["included"], r["applicable"], r["quantity"]) for r in rows} == {
        (0.0, 1.0, "max_contact_radius")
    }
    path.unlink()
    monkeypatch.setattr(
        effects_check, "selected_impact", lambda *_: ([math.nan] * 4, ["hertz"], 1.0)
    )
    assert main(["check", "effects", "-n", "1", "--json", "-"]) == 1
    actual = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert {row["error_over_rtol"] for row in actual} == {"inf"}
    assert not path.exists()


def test_skipped_and_rejected_scenes_are_listed(monkeypatch: Patch, capsys: Captured) -> None:
    skipped, solved = iter(["too heavy", "", ""]), iter(["rtol"])
    row = InertiaRow(
        2, 1e-2, "none", True, 1e-3, 0.0, "max_force", 0.0, 1e-3, 0.0, "max_force", 1, 4, 8
    )
    monkeypatch.setattr(inertia_check, "reason_to_skip", lambda _: next(skipped))
    monkeypatch.setattr(inertia_check, "solve", lambda *_: next(solved, row))
    assert main(["check", "inertia", "-n", "1"]) == 0
    shown = capsys.readouterr().out
    assert "1 of 3" in shown
    assert "1 rejected: rtol" in shown
    assert "1 skipped: too heavy" in shown
    broken = dataclasses.replace(row, error=0.02)
    monkeypatch.setattr(inertia_check, "reason_to_skip", lambda _: "")
    monkeypatch.setattr(inertia_check, "solve", lambda *_: broken)
    assert main(["check", "inertia", "-n", "1", "--json", "-"]) == 1
    [side] = json.loads(capsys.readouterr().out)["sides"]
    assert side["error_over_bound"] == pytest.approx(20.0)


# --- speed


@pytest.mark.parametrize(("within_limit", "status"), [(True, 0), (False, 1)])
def test_timings_are_printed_and_recorded(
    within_limit: bool, status: int, monkeypatch: Patch, tmp_path: Path, capsys: Captured
) -> None:
    given, path = list[Any](), tmp_path / "speed.json"
    timing = SpeedTiming("law over exp", 2.25, "times", 2.0, 1.1, within_limit)

    def measured(examples: Any, solved: Any, progress: Any, calls: Any) -> list[SpeedTiming]:
        progress("law", 1, 1)
        assert calls
        given.append((examples, solved))
        return [timing]

    monkeypatch.setattr(pipeline.speed, "measure", measured)
    monkeypatch.setattr(pipeline, "MEASURED_SPEED", path)
    assert main(["check", "timing", "--json", "-"]) == status
    shown = json.loads(capsys.readouterr().out)
    assert shown["rows"] == [asdict(timing)]
    assert not path.exists()
    assert main(["check", "timing", "--update"]) == status
    assert "2.25 times" in capsys.readouterr().out
    assert rows_of(path) == shown["rows"]
    examples, solved = given[0]
    assert [path.name for path in examples] == sorted(path.name for path in examples)
    named = {path.stem for path in solved}
    assert {"ball_drop", "membrane", "pad", "soft_layer"} <= named  # wide or steep contacts
    assert not named & {"block", "paper"}
    assert named <= {path.stem for path in examples}
