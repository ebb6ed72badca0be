"""The record of finite-element impacts: its update, its comparison and its part of the report."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from derivation.checks import elastodynamics as elastodynamics_check
from derivation.checks.elastodynamics import COLUMNS, cells, compare, compared, simulated
from derivation.checks.finite_elements import cases, record
from derivation.checks.finite_elements.cases import ElementCase
from derivation.checks.finite_elements.impact import Sphere
from derivation.checks.finite_elements.mesh import Grading
from derivation.checks.finite_elements.plate import Plate
from derivation.checks.finite_elements.record import RESULTS, ElementSetting, read, solve_impact
from derivation.cli import main
from derivation.plate import reporting
from derivation.plate.report.elastodynamics import (
    elastodynamics_context,
    elastodynamics_figure,
    from_exact,
)
from derivation.scene.scene import SceneError
from derivation.scene.scene import read as read_scene

COARSE = ElementSetting(Grading(contact=5, thickness=1.0, far=2.0, edge=0), 100)
CASE = ElementCase("one", "group", Plate(0.1, 0.02, 70e9, 0.3, 2700.0), Sphere(0.01, 0.002, 5.0))
PLATE = Plate(1.0, 0.1, 1.0, 0.3, 1.0)


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Replace the record by two cases and one plate, and list the rows that are requested."""
    made: list[str] = []

    def row(case: ElementCase) -> dict[str, Any]:
        made.append(case.name)
        return record.inputs(case) | {"contacts": 1}

    def plate(plate: Plate) -> dict[str, Any]:
        made.append("plate")
        return record.plate_inputs(plate)

    other = replace(CASE, name="two", sphere=replace(CASE.sphere, speed=2.0))
    monkeypatch.setattr(cases, "impacts", lambda: (CASE, other))
    monkeypatch.setattr(cases, "plates", lambda: (PLATE,))
    monkeypatch.setattr(record, "impact_row", row)
    monkeypatch.setattr(record, "plate_row", plate)
    return made


def test_only_missing_cases_are_computed(
    few: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "elastodynamics.json"
    whole = record.compute_missing(path)
    assert few == ["one", "two", "plate"]
    assert read(path) == json.loads(path.read_text()) == json.loads(json.dumps(whole))
    data = read(path)
    data["impacts"][0]["program"] = {"kept": True}
    del data["impacts"][1]
    path.write_text(record.to_json(data))
    few.clear()
    record.compute_missing(path)
    assert few == ["two"]
    assert read(path)["impacts"][0]["program"] == {"kept": True}
    monkeypatch.setattr(record, "source_hash", lambda: "of other code")
    few.clear()
    record.compute_missing(path)
    assert few == ["one", "two", "plate"]


def test_record_is_written_after_each_case(few: list[str], tmp_path: Path) -> None:
    path, seen = tmp_path / "elastodynamics.json", []
    record.compute_missing(path, lambda *_: seen.append(len(read(path)["impacts"])))
    assert seen == [0, 1, 2]
    assert few


def test_cases_are_distinct() -> None:
    impacts = cases.impacts()
    assert len({case.name for case in impacts}) == len(impacts) >= 40
    for case in impacts:
        read_scene(record.inputs(case)["scene"])  # raises an error for an invalid scene


def test_row_has_results_and_errors(monkeypatch: pytest.MonkeyPatch) -> None:
    """A row has each result with its error; the fine mesh grows until it covers the contact."""
    for name in ("BEST", "COARSER", "LONGER"):
        monkeypatch.setattr(record, name, COARSE)
    monkeypatch.setattr(record, "REACH_FACTORS", (0.6, 2.0))
    row = record.impact_row(CASE)
    assert row["elements"].keys() == row["errors"].keys() == set(RESULTS)
    assert all(0.0 < row["errors"][name] < 0.1 for name in RESULTS)
    assert row["errors"]["max_indentation"] == record.LEAST_ERROR  # three equal settings
    assert abs(row["energy_error"]) < 1e-3
    assert (row["contacts"], row["scene"]["plate"]["edge"]) == (1, "paper")


def test_program_agrees_with_finite_elements() -> None:
    """For the paper's edge the program agrees with a coarse finite-element mesh within 0.2 %."""
    pane = cases.impacts()[0]
    assert pane.plate.edge == "paper"
    setting = ElementSetting(Grading(contact=6, thickness=1.0, far=3.0, edge=0), 150)
    impact, _ = solve_impact(pane, setting, until_end=False)
    result = simulated(record.inputs(pane))
    for name in ("contact_time", "max_indentation", "max_force", "restitution"):
        assert result["values"][name] == pytest.approx(getattr(impact, name), rel=2e-3), name
    stress = result["values"]["max_tensile_stress"]
    assert stress == pytest.approx(impact.max_tensile_stress, rel=1e-2)
    assert (result["branches"], result["contacts"], impact.contacts) == ("all", 1, 1)


def row(name: str, contact_time: float, bound: float = 1e-3) -> dict[str, Any]:
    """Return a row in which only the contact time differs between program and elements."""
    elements = dict.fromkeys(RESULTS, 1.0)
    program = {"values": elements | {"contact_time": contact_time}, "bound": bound,
               "model_error": 1e-3, "stress_error": 2e-3, "contacts": 1,
               "rtol": 1e-3}  # fmt: skip
    return record.inputs(CASE) | {
        "name": name, "elements": elements, "errors": dict.fromkeys(RESULTS, 5e-4),
        "contacts": 1, "edge_echo": 2.0, "program": program,
    }  # fmt: skip


def test_difference_is_accepted_up_to_the_stated_error() -> None:
    within, beyond = compared(row("a", 1.0024)), compared(row("b", 1.0026))
    assert within.passed
    assert not beyond.passed
    assert beyond.worst == "contact_time"
    assert len(cells(beyond)) == len(COLUMNS)
    assert (cells(within)[-1], cells(beyond)[-1]) == ("yes", "NO")


def test_stress_is_compared_with_its_own_error() -> None:
    """The bound is 1e-3, the error of the stress 2e-3 and that of the elements 5e-4."""
    for stress, passes in ((1.0034, True), (1.0036, False)):
        given = row("a", 1.0)
        given["program"]["values"]["max_tensile_stress"] = stress
        case = compared(given)
        assert (case.worst, case.passed) == ("max_tensile_stress", passes)
    given["program"]["values"]["max_tensile_stress"] = None
    assert compared(given).passed
    given["program"]["values"]["max_tensile_stress"], given["errors"]["max_tensile_stress"] = 2, 0.2
    assert "max_tensile_stress" not in compared(given).differences


def test_rejected_scene_is_reported(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = tmp_path / "elastodynamics.json"
    path.write_text(record.to_json({"impacts": [row("one", 1.0)], "plates": []}))

    def rejects(*_: object) -> None:
        raise SceneError("rtol: expected at least 8.8e-03, got 1e-09")

    monkeypatch.setattr(elastodynamics_check, "simulate", rejects)
    [case] = compare(path, save=True)
    assert case.rejected
    assert case.passed
    assert len(cells(case)) == len(COLUMNS)
    assert read(path)["impacts"][0]["program"] == {"rejected": case.rejected}
    context = elastodynamics_context(read(path))
    assert (context["cases"], context["rejected"], context["rows"]) == (0, 1, [])


def test_missing_record_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "none.json"
    with pytest.raises(ValueError, match="expected recorded cases, got none; run `python -m"):
        compare(path)


def test_command_compares_cases_and_fails_for_a_large_difference(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "elastodynamics.json"
    path.write_text(record.to_json({"impacts": [row("good", 1.0), row("bad", 2.0)], "plates": []}))
    shown = {item["name"]: item["program"] for item in read(path)["impacts"]}
    monkeypatch.setattr(elastodynamics_check, "simulated", lambda item: shown[item["name"]])
    monkeypatch.setattr(compare, "__defaults__", (path,))
    assert main(["check", "finite-elements"]) == 1
    out = capsys.readouterr().out
    assert "good" in out
    assert "NO" in out
    path.write_text(record.to_json({"impacts": [row("good", 1.0)], "plates": []}))
    assert main(["check", "finite-elements", "--json", "-"]) == 0
    [case] = json.loads(capsys.readouterr().out)
    assert case["differences"]["contact_time"] == 0.0
    assert main(["check", "finite-elements", "--seed", "1"]) != 0


def test_report_contains_the_record() -> None:
    data = json.loads(reporting.measurement()["elastodynamics"])
    rows = [*data["impacts"][:3], row("a & b", 1.001), row("c", 1.0)]
    shown = elastodynamics_context(data | {"impacts": rows})
    assert shown["within"] <= shown["cases"]
    assert shown["rows"][-2].startswith(r"a \& b & 1/1 & $+1.00$ (0.50)")
    assert len(elastodynamics_figure(data | {"impacts": rows}).axes) == 2


def test_record_is_accurate() -> None:
    """The recorded errors are small, and frequencies for the paper's edge are the exact ones."""
    data = read()
    assert len(data["impacts"]) >= 40
    for item in data["impacts"]:
        own = item["errors"]
        assert own["max_indentation"] < 2e-3, item["name"]
        assert own["restitution"] < 2e-2, item["name"]
    assert from_exact(data["plates"]) < 5e-6
    hinged = [item for item in data["impacts"] if item["scene"]["plate"]["edge"] == "paper"]
    assert len(hinged) >= 10
    for plate in data["plates"]:
        assert max(plate["errors"]) < 1e-4
