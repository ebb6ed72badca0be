"""Test the benchmark of run time and accuracy: committed data, report, README, commands."""

import json
from pathlib import Path
from typing import Any

import pytest
from interrupted import interrupted

from derivation import pipeline
from derivation.cli import main
from derivation.engine.files import ROOT
from derivation.engine.report.figures import figure_file
from derivation.plate import reporting
from derivation.plate.benchmark import run, scaling
from derivation.plate.benchmark.interface import CASES, PAPER
from derivation.plate.benchmark.rows import BenchmarkRow
from derivation.plate.report import readme
from derivation.plate.report.accuracy import accuracy_context, duration, reasons
from derivation.plate.report.accuracy_figures import scaling as scaling_figure
from derivation.plate.report.accuracy_figures import work_precision

# --- data and report


@pytest.fixture(scope="module")
def committed() -> dict[str, Any]:
    return reporting.benchmark_record()


def test_data_have_rows_of_every_kind(committed: dict[str, Any]) -> None:
    assert {"generated", "numpy", "python"} <= committed["provenance"].keys()
    assert [r["name"] for r in committed["cases"]] == [r.name for r in CASES]
    for entry in committed["rows"]:
        assert entry.keys() == set(BenchmarkRow.__dataclass_fields__)
        assert entry["fails"] or (entry["errors"] and entry["vector"] and entry["single"])
        # For every method that works, the rounding error is known separately.
        assert entry["fails"] or entry["errors"]["rounding"] is not None
    assert {entry["task"] for entry in committed["rows"]} == {"law", "inversion", "impact"}
    assert {g["quantity"] for g in committed["scaling"]} == {"points", "b/h", "digits", "scenes"}
    assert committed["headline"]["direct_sum"]
    assert committed["tools"]


def test_generated_law_is_a_thousand_times_as_fast_as_direct_summation(
    committed: dict[str, Any],
) -> None:
    actual = committed["headline"]
    assert actual["digits"] >= 15
    best = actual["direct_sum"][-1]
    assert best["digits"] >= 9
    assert best["seconds"] / actual["seconds_with_setup"] > 1000


def test_figures_are_reproducible(committed: dict[str, Any]) -> None:
    first, second = (
        figure_file(work_precision(committed, "inversion", "single"), ".pdf") for _ in range(2)
    )
    assert first == second
    assert figure_file(scaling_figure(committed), ".pdf").startswith(b"%PDF")


def test_section_lists_every_failure(committed: dict[str, Any]) -> None:
    context = accuracy_context(committed)
    failing = {(r["task"], r["family"], r["case"]) for r in committed["rows"] if r["fails"]}
    assert len(context["failures"]) == len(failing)
    assert duration(1.5e-9) == r"1.5\,ns"
    assert duration(0.0012) == r"1.2\,ms"


def test_readme_agrees_with_the_record(committed: dict[str, Any]) -> None:
    text = (ROOT / reporting.README).read_text()
    assert readme.updated_readme(text, committed) == text, "to correct: platecontact report"


def test_block_of_the_readme_is_found_by_its_markers(committed: dict[str, Any]) -> None:
    text = f"above\n{readme.BEGIN}\nold numbers\n{readme.END}\nbelow"
    actual = readme.updated_readme(text, committed)
    assert actual.startswith("above\n")
    assert actual.endswith("\nbelow")
    assert "old" not in actual
    for bad in ("no markers", text + text, text.replace(readme.END, "")):
        with pytest.raises(ValueError, match="once each"):
            readme.updated_readme(bad, committed)


# --- commands


@pytest.fixture
def brief(monkeypatch: pytest.MonkeyPatch) -> None:
    """Disable slow parts of the benchmark that other tests cover."""
    monkeypatch.setattr(run, "tools", list)
    monkeypatch.setattr(scaling, "studies", lambda quick: ())  # noqa: ARG005
    monkeypatch.setattr(run, "CASES", (PAPER,))
    monkeypatch.setattr(run, "TASKS", ("law",))
    monkeypatch.setattr("derivation.plate.benchmark.problems.QUICK_DIGITS", 20)
    monkeypatch.setattr("derivation.plate.benchmark.headline.QUICK_MODES", 1 << 19)
    monkeypatch.setattr("derivation.plate.benchmark.headline.POINTS", 1000)


@pytest.mark.usefixtures("brief")
def test_command_writes_results_of_the_named_methods(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "accuracy.json"
    scene = ROOT / "derivation" / "scene" / "examples" / "paper.toml"
    arguments = ["--quick", "--method", "cubic interpolation", "--scene", str(scene)]
    assert main(["accuracy", *arguments, "--out", str(out)]) == 0
    data = json.loads(out.read_text())
    assert {r["family"] for r in data["rows"]} == {"cubic interpolation"}
    assert [r["name"] for r in data["cases"]] == ["scene"]
    assert data["cases"][0]["low"] < 0.1342 < data["cases"][0]["high"]
    assert "direct sum" in capsys.readouterr().out


@pytest.mark.usefixtures("brief")
def test_record_is_replaced_only_with_update(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    committed = tmp_path / "accuracy.json"
    committed.write_text("committed")
    monkeypatch.setattr(pipeline, "MEASURED_ACCURACY", committed)
    measured = {"rows": []}
    monkeypatch.setattr(pipeline.accuracy_run, "measure", lambda *_: measured)
    for options in (("--quick",), ("--method", "cubic interpolation"), ()):
        assert pipeline.accuracy(options[1:], quick=bool(options)) == (measured, None)
    assert committed.read_text() == "committed"
    for other in (["--method", "cubic interpolation"], ["--out", str(tmp_path / "x.json")]):
        assert main(["benchmark", "--update", *other]) == 2
        assert "--update" in capsys.readouterr().err
    assert committed.read_text() == "committed"
    assert pipeline.accuracy(update=True) == (measured, committed)
    assert json.loads(committed.read_text()) == measured


@pytest.mark.usefixtures("brief")
def test_contact_too_small_for_a_direct_sum_is_measured(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paper = ROOT / "derivation" / "scene" / "examples" / "paper.toml"
    slow, out = tmp_path / "slow.toml", tmp_path / "accuracy.json"
    slow.write_text(paper.read_text().replace("speed = 1.0", "speed = 1e-9"))
    arguments = ["--quick", "--method", "cubic interpolation", "--scene", str(slow)]
    assert main(["accuracy", *arguments, "--out", str(out)]) == 0
    assert json.loads(out.read_text())["headline"]["direct_sum"] == []
    assert "direct sum of 524288 modes to fewer than 6 digits" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--method", "nonsense"], "nonsense"),
        (["--scene", "/nowhere/scene.toml"], "/nowhere/scene.toml"),
        (["--out", "/proc/nowhere/x.json"], "/proc/nowhere/x.json"),
    ],
)
def test_invalid_input_gives_one_message(
    arguments: list[str], expected: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = [] if "--out" in arguments else ["--out", str(tmp_path / "x.json")]
    assert main(["accuracy", *arguments, *out]) == 2
    message = capsys.readouterr().err
    assert expected in message
    assert "Traceback" not in message
    assert list(tmp_path.iterdir()) == []


def test_scene_beyond_the_law_is_rejected() -> None:
    with pytest.raises(ValueError, match=r"^impact\.speed: "):
        run.scene_case(0.13, 72.2, 1e6, 0.1, 1.0, 0.36e9, 0.43e9)


def test_interrupted_run_keeps_the_old_file(tmp_path: Path) -> None:
    program = """
import sys, time
from derivation import cli
from derivation.plate.benchmark import run
def wait(*arguments):
    print("measuring", flush=True)
    time.sleep(300)
run.panel = wait
sys.exit(cli.main(["accuracy", "--quick", "--out", sys.argv[1]]))
"""
    out = tmp_path / "accuracy.json"
    out.write_text("old")
    interrupted(program, out, "measuring")
    assert [path.name for path in tmp_path.iterdir()] == ["accuracy.json"]
    assert out.read_text() == "old"


def test_report_lists_reasons_and_remarks_on_separated_errors() -> None:
    """Each reason is listed once with families and test cases; other rows are not listed."""
    why = "no long J0 here"
    row = {"family": "a_b", "case": "thin", "fails": None, "errors": {"unsplit": why}}
    rows = [
        row,
        row | {"case": "thick"},
        row | {"family": "c", "fails": "overflow"},
        row | {"family": "d", "errors": {"unsplit": None}},
        row | {"family": "e", "errors": None},
    ]
    assert list(reasons({"rows": rows}, "unsplit")) == [r"no long J0 here: a\_b (thin, thick)."]
    assert list(reasons({"rows": rows}, "remark")) == []
    rows[3]["errors"]["remark"] = "an estimate"
    assert list(reasons({"rows": rows}, "remark")) == ["an estimate: d (thin)."]
