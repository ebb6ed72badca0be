"""The parts of `check`: what each shows, gives as JSON and records, and its exit status."""

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
from derivation.checks.inertia_judged import InertiaRow
from derivation.cli import main
from derivation.engine import build
from derivation.engine.measure import check as measure
from derivation.engine.measure import suite
from derivation.engine.measure.case import read_cases
from derivation.engine.measure.suite import Suite
from derivation.engine.paper import Paper
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
    found: list[dict[str, Any]] = json.loads(path.read_text())["rows"]
    return found


# --- generated functions


@pytest.fixture
def spoilt(monkeypatch: Patch, tmp_path: Path) -> Callable[[float], Path]:
    """Have `check` measure J0 alone, times a factor; gives where that is recorded."""
    path = tmp_path / "check.json"
    monkeypatch.setattr(plate_paper, "PAPER", dataclasses.replace(PAPER, records=tmp_path))

    def of(factor: float) -> Path:
        [right] = [kernel for kernel in generated_kernels() if kernel.name == "bessel_j0"]
        wrong = dataclasses.replace(right, call=lambda x: right.call(x) * x.dtype.type(factor))
        silent = dataclasses.replace(wrong, module="as_printed", budget=None)
        monkeypatch.setattr(
            measure, "check",
            lambda _, digits, progress: plate_judge.check(digits, [wrong, silent], progress),
        )  # fmt: skip
        return path

    return of


def test_a_fresh_measurement_is_recorded_as_it_was(
    spoilt: Callable[[float], Path], capsys: Captured
) -> None:
    every = rows_of(pipeline.measurements() / "check.json")
    committed = [row for row in every if row["kernel"] == "bessel_j0"]
    path = spoilt(1.0)
    assert main(["check", "--json", "-"]) == 0
    first, second = json.loads(capsys.readouterr().out)["rows"]
    assert [first] == committed
    assert (second["passed"], second["double"]["max_ulp"]) == (None, first["double"]["max_ulp"])
    assert not path.exists()
    assert main(["check", "--update"]) == 0
    assert rows_of(path) == [first, second]
    shown = capsys.readouterr().out
    assert "Errors against 50 digits" in shown
    said = [line for line in shown.splitlines() if line.startswith("bessel_j0: ")]
    exact = " ".join(f"{name}={x}" for name, x, _ in committed[0]["double"]["worst"]["arguments"])
    assert said == [f"bessel_j0: {exact}"]  # where nothing is promised, nothing is listed


def test_a_formula_that_is_off_fails_and_the_verdict_names_it(
    spoilt: Callable[[float], Path], capsys: Captured
) -> None:
    path = spoilt(1.0)
    paper = plate_paper.PAPER
    sound = build.check(paper, update=True)
    before = path.read_bytes()
    assert build.verdict(paper, sound) == ["all errors are within their budgets"]
    spoilt(1.0 + 1e-13)
    assert main(["check"]) == 1
    assert "NO" in capsys.readouterr().out
    assert build.verdict(paper, build.check(paper)) == [
        "above their budget: bessel_j0",
        "different from the saved check.json: bessel_j0",
    ]
    assert path.read_bytes() == before
    path.unlink()
    assert build.verdict(paper, sound) == ["all errors are within their budgets"]  # none saved


# --- contact law


@pytest.fixture
def few_contacts(monkeypatch: Patch, tmp_path: Path) -> Path:
    """Forces of a radius alone, in this process; gives where they are recorded."""
    path = tmp_path / "contact.json"
    monkeypatch.setattr(pipeline, "MEASURED_CONTACT", path)
    monkeypatch.setattr(pipeline, "KERNELS", ("force_of_radius", "max_pressure"))
    monkeypatch.setattr(pipeline.os, "cpu_count", lambda: 1)
    return path


def test_contact_law_is_recorded_as_it_was(few_contacts: Path, capsys: Captured) -> None:
    kept = {r["kernel"]: r for r in rows_of(pipeline.measurements() / "contact.json")}
    known = [kept["force_of_radius"], kept["max_pressure"]]
    assert main(["check", "contact-law", "--json", "-"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["rows"] == known
    assert not few_contacts.exists()
    assert main(["check", "contact-law", "--update"]) == 0
    assert json.loads(few_contacts.read_text()) == found
    shown = capsys.readouterr().out
    for row in known:
        assert f"{row['kernel']}: {' '.join(row['worst'])}" in shown
    assert main(["check", "contact-law", "--suggest-budgets", "--json", "-"]) == 0
    suggested = json.loads(capsys.readouterr().out)["suggested_budgets"]
    for name, ulp in suggested.items():
        assert kept[name]["double"]["needed"] < ulp < kept[name]["budget"]


def test_a_contact_law_that_is_off_fails(
    few_contacts: Path, monkeypatch: Patch, capsys: Captured
) -> None:
    right = pipeline.contact_law.max_pressure
    monkeypatch.setattr(
        pipeline, "contact_law",
        SimpleNamespace(
            force_of_radius=lambda *given: math.nan * given[0],
            max_pressure=lambda *given: right(*given),
        ),
    )  # fmt: skip
    assert main(["check", "contact-law", "--json", "-"]) == 1
    wrong, sound = json.loads(capsys.readouterr().out)["rows"]
    assert (wrong["passed"], sound["passed"]) == (False, True)
    assert wrong["max_error"] == "inf"
    assert not few_contacts.exists()


def test_a_law_of_another_shape_is_no_measurement() -> None:
    point = {"max_pressure": [(0.1, 1.0, 1e9, 1e9)]}
    with pytest.raises(ValueError, match="2 results"):
        contact.check({"max_pressure": lambda *_: (1.0, 2.0)}, point)


# --- hard cases


@pytest.fixture
def few_cases(monkeypatch: Patch, tmp_path: Path) -> tuple[Path, list[dict[str, Any]]]:
    """Four hard cases with their committed references, of which only the first stands."""
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


def test_references_are_found_anew_as_they_were(
    few_cases: tuple[Path, list[dict[str, Any]]], monkeypatch: Patch
) -> None:
    path, committed = few_cases
    sought, find = list[str](), Suite.references
    monkeypatch.setattr(
        Suite, "references", lambda self, case: sought.append(case.key) or find(self, case)
    )
    monkeypatch.setattr(suite, "SAVED_EVERY", -1.0)
    assert main(["check", "hard-cases", "--update"]) == 0
    assert json.loads(path.read_text())["cases"] == committed
    assert sought == [row["key"] for row in committed[1:]]  # the first still stands
    assert [p.name for p in path.parent.iterdir()] == ["hard.json"]


def test_a_search_for_references_that_was_stopped_goes_on(
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
    sought = list[str]()
    monkeypatch.setattr(
        Suite, "references", lambda self, case: sought.append(case.key) or find(self, case)
    )
    assert main(["check", "hard-cases", "--update"]) == 0
    assert sought == [row["key"] for row in committed[2:]]
    assert json.loads(path.read_text())["cases"] == committed
    assert not part.exists()


def test_a_hard_case_that_stands_there_twice_is_refused(monkeypatch: Patch) -> None:
    once = tuple(read_cases(hard_suite.WRITTEN))
    monkeypatch.setattr(hard_suite, "cases", lambda: (*once, once[0]))
    with pytest.raises(ValueError, match="twice") as refused:
        hard_suite.suite()
    assert once[0].key in str(refused.value)


# --- bounds in random scenes


def test_references_are_kept_as_they_come(
    monkeypatch: Patch, tmp_path: Path, capsys: Captured
) -> None:
    """Those on record are not sought again, nor lost by a look at fewer, nor by a stop."""
    known = bounds.committed_references()[:7]
    path, sought = tmp_path / "bounds.json", list[Any]()
    monkeypatch.setattr(bounds, "MEASURED", path)
    monkeypatch.setattr(bounds, "KEPT_EVERY", 2)
    reference_values = {bounds.scene(number): true for number, true in enumerate(known)}

    def reference(point: Any) -> Any:
        if len(sought) == 4:
            raise KeyboardInterrupt
        sought.append(point)
        return reference_values[point]

    monkeypatch.setattr(bounds, "reference", reference)
    assert main(["check", "error-bounds", "-n", "7", "--update"]) == 2
    assert "interrupted" in capsys.readouterr().err
    assert bounds.committed_references() == known[:4]
    sought[:] = [None]
    assert main(["check", "error-bounds", "-n", "7", "--update"]) == 0
    assert sought == [None, *map(bounds.scene, range(4, 7))]
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
    assert bounds.committed_references() == []  # of other digits


def test_a_result_that_is_no_number_is_json_all_the_same(
    monkeypatch: Patch, capsys: Captured
) -> None:
    monkeypatch.setattr(bounds, "simulated", lambda _, rtol: ([math.nan] * 4, "hertz", rtol))
    assert main(["check", "error-bounds", "-n", "1", "--json", "-"]) == 1
    [row] = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert (row["ratio"], row["error"]) == ("inf", "inf")


# --- effects, inertia


ONES = [1.0] * 4


def test_effects_are_shown_and_recorded(
    monkeypatch: Patch, tmp_path: Path, capsys: Captured
) -> None:
    """Two of six scenes beyond the models, a tolerance out of reach in one of the others."""
    path, scenes = tmp_path / "effects.json", list[Any]()

    def everything(data: Any) -> Any:
        scenes.append(data)
        return None if len(scenes) in (2, 5) else (ONES, ["hertz", "gravity"])

    def selected(_: Any, rtol: float) -> Any:
        refused = len(scenes) == 3 and rtol == TOLERANCES[-1]
        return None if refused else ([*ONES[1:], 1.0 + rtol / 4], ["hertz"], rtol / 2)

    monkeypatch.setattr(effects_check, "MEASURED", path)
    monkeypatch.setattr(effects_check, "everything", everything)
    monkeypatch.setattr(effects_check, "selected_impact", selected)
    assert main(["check", "effects", "-n", "6", "--update"]) == 0
    assert "6 scenes" in capsys.readouterr().out
    rows = rows_of(path)
    assert [row["rtol"] for row in rows] == list(TOLERANCES)
    assert [row["scenes"] for row in rows] == [4, 4, 4, 3]
    assert [row["refused"] for row in rows] == [0, 0, 0, 1]
    assert [row["ratio"] for row in rows] == pytest.approx([0.25] * 4, rel=1e-5)
    assert [row["tightest"] for row in rows] == pytest.approx([0.5] * 4, rel=1e-5)
    assert {(r["included"], r["applicable"], r["quantity"]) for r in rows} == {
        (0.0, 1.0, "max_contact_radius")
    }
    path.unlink()
    monkeypatch.setattr(
        effects_check, "selected_impact", lambda *_: ([math.nan] * 4, ["hertz"], 1.0)
    )
    assert main(["check", "effects", "-n", "1", "--json", "-"]) == 1
    found = json.loads(capsys.readouterr().out, parse_constant=pytest.fail)
    assert {row["ratio"] for row in found} == {"inf"}
    assert not path.exists()


def test_scenes_that_are_passed_over_are_listed(monkeypatch: Patch, capsys: Captured) -> None:
    passed, solved = iter(["too heavy", "", ""]), iter(["rtol"])
    row = InertiaRow(
        2, 1e-2, "none", True, 1e-3, 0.0, "max_force", 0.0, 1e-3, 0.0, "max_force", 1, 4, 8
    )
    monkeypatch.setattr(inertia_check, "pass_over", lambda _: next(passed))
    monkeypatch.setattr(inertia_check, "solve", lambda *_: next(solved, row))
    assert main(["check", "inertia", "-n", "1"]) == 0
    shown = capsys.readouterr().out
    assert "1 of 3" in shown
    assert "1 rejected: rtol" in shown
    assert "1 skipped: too heavy" in shown
    broken = dataclasses.replace(row, error=0.02)
    monkeypatch.setattr(inertia_check, "pass_over", lambda _: "")
    monkeypatch.setattr(inertia_check, "solve", lambda *_: broken)
    assert main(["check", "inertia", "-n", "1", "--json", "-"]) == 1
    [side] = json.loads(capsys.readouterr().out)["sides"]
    assert side["tightest"] == pytest.approx(20.0)


# --- speed


@pytest.mark.parametrize(("kept", "status"), [(True, 0), (False, 1)])
def test_speed_is_shown_and_recorded(
    kept: bool, status: int, monkeypatch: Patch, tmp_path: Path, capsys: Captured
) -> None:
    given, path = list[Any](), tmp_path / "speed.json"
    timing = SpeedTiming("law over exp", 2.25, "times", 2.0, 1.1, kept)

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
