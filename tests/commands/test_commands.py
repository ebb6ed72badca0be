"""Output of `derive`, `misprints`, `rewrite`, `build`, `report` and `benchmark --dynamic`."""

import json
import math
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from derivation.checks import dynamic_benchmark
from derivation.cli import main
from derivation.engine import build, outputs, report_files
from derivation.engine.files import ROOT, write_files
from derivation.engine.measure.check import Row
from derivation.engine.measure.judge import Errors, Worst
from derivation.engine.package import files_of
from derivation.engine.paper import Paper
from derivation.engine.report import pdf as tex
from derivation.engine.report.document import Plan
from derivation.engine.report.pdf import TexError
from derivation.engine.rewrite import account as rules
from derivation.engine.rewrite.account import Account
from derivation.engine.rewrite.stabilise import Applied
from derivation.plate import paper as plate_paper
from derivation.plate import reporting
from derivation.plate.paper import PAPER
from derivation.plate.report.overview import SHOWN, overview
from derivation.scene import load
from derivation.scene.model import model_of

Captured = pytest.CaptureFixture[str]
Patch = pytest.MonkeyPatch


# --- tables and JSON


@pytest.mark.parametrize("command", ["derive", "misprints"])
def test_table_or_json_is_printed_but_not_both(command: str, capsys: Captured) -> None:
    assert main([command, "--json", "-"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert main([command]) == 0
    shown = capsys.readouterr().out
    names = [row.get("name") or row["quantity"] for row in rows]
    assert len(names) >= 20
    assert all(name in shown for name in names)
    assert not shown.lstrip().startswith("[")


def test_rewrite_prints_code_that_runs(capsys: Captured) -> None:
    assert main(["rewrite", "(1 - cos(x))/x**2"]) == 0
    shown = capsys.readouterr().out
    assert "Each rule: operations" in shown
    names: dict[str, Any] = {}
    exec(compile(shown[shown.index('"""') :], "rewritten", "exec"), names)
    exact = [0.5, 0.5, (1 - math.cos(1.0)), (1 - math.cos(5.0)) / 25]
    assert names["f"]([1e-150, 1e-9, 1.0, 5.0]).tolist() == pytest.approx(exact, rel=1e-15)


def test_rewrite_report_is_written_without_changes(
    monkeypatch: Patch, tmp_path: Path, capsys: Captured
) -> None:
    """The committed rows are read and written again; infinite errors are text in JSON."""
    kept = json.loads(PAPER.rewritten.read_text())["rows"]
    assert any("inf" in applied["worst"] for row in kept for applied in row["applied"])
    actual = tuple(account_of(row) for row in kept)
    path = tmp_path / "rewrite.json"
    monkeypatch.setattr(plate_paper, "PAPER", replace(PAPER, records=tmp_path))
    monkeypatch.setattr(rules, "accounts", lambda *_: actual)
    assert main(["rewrite", "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out)["rows"] == kept
    assert not path.exists()
    assert main(["rewrite", "--update"]) == 0
    assert json.loads(path.read_text())["rows"] == kept
    shown = capsys.readouterr().out
    assert all(f" {row['name']} " in shown for row in kept if row["applied"])


def account_of(row: dict[str, Any]) -> Account:
    """Return the result from which a row of the record was written."""
    applied = (
        Applied(a["rule"], a["cause"], tuple(a["operations"]), tuple(float(x) for x in a["worst"]))  # type: ignore[arg-type]
        for a in row["applied"]
    )
    return Account(row["name"], row["variable"], tuple(applied), row["worst"])


# --- build


def rows_of(passed: bool) -> tuple[Row, ...]:
    worst = Worst((), None, ("", ""), "", 0.1, 1.0)
    errors = Errors(9, 0, 0, 0, 0.6, 0.5, 0.4, 0.2, 0.1, worst, "float64", ())
    return (Row("P", "pressure", 1.0, errors, errors, 2, passed=passed),)


@pytest.mark.parametrize(("within_budget", "pdf"), [(True, True), (False, True), (True, False)])
def test_build_runs_all_stages(
    within_budget: bool, pdf: bool, monkeypatch: Patch, tmp_path: Path, capsys: Captured
) -> None:
    """The package is written before the check; without LaTeX, only the PDF is missing."""
    stages_run = list[str]()

    def checked(_: Paper, update: bool, progress: Any) -> tuple[Row, ...]:
        progress("P", 1, 1)
        stages_run.append("check")
        assert not update  # the record of the plate is committed
        assert (tmp_path / "generated" / "pressure.py").is_file()
        return rows_of(within_budget)

    def reported(_: Paper, out: Path | None, compiled: bool) -> Sequence[Path]:
        stages_run.append("report")
        assert out == tmp_path / "reports"
        assert not compiled
        return write_files({out / "report.tex": "", out / "figures" / "overview.pdf": ""})

    def typeset(source: Path) -> Path:
        if not pdf:
            raise TexError("no latexmk: install texlive")
        return write_files({source.with_suffix(".pdf"): ""})[0]

    monkeypatch.setattr(build, "check", checked)
    monkeypatch.setattr(build, "report", reported)
    monkeypatch.setattr(tex, "compile_pdf", typeset)
    assert main(["build", "--out", str(tmp_path)]) == (0 if within_budget else 1)
    assert stages_run == ["check", "report"]
    written = {path.name: path.read_text() for path in (tmp_path / "generated").iterdir()}
    assert written == files_of(PAPER.chain, PAPER.package())
    output = capsys.readouterr().err
    stages = re.findall(r"✓ (\w+) +[\d.]+ s", output)
    assert stages == ["derive", "rewrite", "generate", "misprints", "check", "report"]
    assert ("the PDF was not written, all other files were: no latexmk" in output) is not pdf
    assert ("above their budget: P" in output) is not within_budget
    assert "different from the saved check.json: P" in output  # the errors above are invented
    listed = output.partition("files written:\n")[2].splitlines()
    code = tmp_path / "generated"
    others = [str(p) for p in tmp_path.rglob("*") if p.is_file() and p.parent != code]
    assert sorted(listed) == sorted([f"{code}: {len(written)} files", *others])


def test_build_needs_a_folder_outside_a_checkout(monkeypatch: Patch, capsys: Captured) -> None:
    monkeypatch.setattr(outputs, "in_checkout", lambda: False)
    monkeypatch.setattr(build, "derive", lambda _: pytest.fail("the formulas were derived"))
    assert main(["build"]) == 2
    assert "add --out DIR" in capsys.readouterr().err


# --- the report


def test_missing_record_is_named_with_its_command(
    monkeypatch: Patch, tmp_path: Path, capsys: Captured
) -> None:
    for path in PAPER.records.glob("*.json"):
        if path.stem != "hard":
            (tmp_path / path.name).write_bytes(path.read_bytes())
    monkeypatch.setattr(reporting, "measurements", lambda: tmp_path)
    assert main(["report", "--check"]) == 2
    assert "hard.json; run `platecontact check hard-cases --update`" in capsys.readouterr().err


def test_complete_report_updates_readme_and_overview(tmp_path: Path) -> None:
    """The measured block of the README is written with the complete report, not with sections."""
    committed = (ROOT / reporting.README).read_text()
    begin, end = reporting.readme.BEGIN, reporting.readme.END
    emptied = committed.partition(begin)[0] + begin + end + committed.partition(end)[2]
    plan = Plan(("speed",), ("code",))
    parts = replace(reporting.report_parts(plan.names), front="")  # it refers to other sections
    short = replace(PAPER.report(), plan=plan, parts=lambda _: parts, figures=dict)
    paper = replace(PAPER, folder=tmp_path, report=lambda: short)
    readme, picture = tmp_path / reporting.README, tmp_path / reporting.README_FIGURE
    readme.write_text(emptied)
    report_files.write(paper, compiled=False, sections=["code"])
    assert readme.read_text() == emptied
    assert not picture.exists()
    written = report_files.write(paper, compiled=False)
    assert readme.read_text() == committed
    assert picture.read_text().startswith("<?xml")
    assert [path.name for path in written] == [
        "report.tex", "appendices.tex", "report.html", "appendices.html", "report.bib",
        "README.md", "overview.svg",
    ]  # fmt: skip


def test_overview_shows_three_models_and_the_fastest_methods() -> None:
    """The half-space curve agrees with Hertz impact theory; the plate lowers and lengthens it."""
    costs = reporting.benchmark_record()
    left, right = overview(load(reporting.GLASS_PANE), costs).axes
    case = model_of(load(reporting.GLASS_PANE))
    half_space, static, dynamic = (np.array(line.get_data()) for line in left.lines)
    peaks = [1e3 * line[1].max() for line in (half_space, static, dynamic)]
    assert peaks[0] > peaks[1] > 0.0
    ends = [line[0].max() for line in (half_space, static)]
    assert ends[0] < ends[1]
    # In Hertz impact theory the contact time is 2.943 delta_max/v0, and by the energy balance
    # delta_max is 5/4 m v0^2/P_max.
    indentation = 1.25 * case.m * case.v0**2 / peaks[0]
    assert 1e-6 * ends[0] == pytest.approx(2.943275 * indentation / case.v0, rel=1e-3)
    assert [line.get_label() for line in right.lines[:-1]] == list(SHOWN.values())
    front = np.array(right.lines[-1].get_data())
    assert (np.diff(front[0]) > 0).all()
    assert (np.diff(front[1]) > 0).all()
    for line in right.lines[:-1]:  # no method is better than the Pareto front
        for seconds, digits in zip(*line.get_data(), strict=True):
            assert digits <= front[1][front[0] <= seconds].max(initial=-math.inf)


# --- benchmark of plates with inertia


def test_dynamic_benchmark_is_measured_and_written(
    monkeypatch: Patch, tmp_path: Path, capsys: Captured
) -> None:
    """Errors are differences from the reference; the timed function is called in each round."""
    calls = list[str]()

    def outcome(name: str, *numbers: float) -> Any:
        def call() -> dynamic_benchmark.CostOutcome:
            calls.append(name)
            return dynamic_benchmark.CostOutcome(numbers, 7, bound=None if name == "slow" else 0.1)

        return call

    def trial(study: str, name: str, *numbers: float) -> list[dynamic_benchmark.Trial]:
        reference = (1.0, 2.0, 4.0)
        return [dynamic_benchmark.Trial(study, name, 3, outcome(name, *numbers), lambda: reference,
                                   dynamic_benchmark.FIRST)]  # fmt: skip

    monkeypatch.setattr(
        dynamic_benchmark, "integrators", lambda: trial("integrator", "slow", 1, 2, 5)
    )
    monkeypatch.setattr(dynamic_benchmark, "modes", lambda: trial("modes", "A0", 1.5, 2, 4))
    monkeypatch.setattr(dynamic_benchmark, "branches", list)
    monkeypatch.setattr(dynamic_benchmark, "tolerances", list)
    path = tmp_path / "moving.json"
    assert main(["benchmark", "--dynamic", "--out", str(path)]) == 0
    data = json.loads(path.read_text())
    first, second = data["rows"]
    assert first["errors"] == {"contact_time": 0.0, "max_force": 0.0, "restitution": 0.25}
    assert second["errors"]["contact_time"] == 0.5
    assert (first["bound"], second["bound"], first["modes"]) == (None, 0.1, 7)
    assert calls.count("slow") > dynamic_benchmark.ROUNDS
    assert str(path) in capsys.readouterr().err.replace("\n", "")
    reported = list[Any]()
    again, written = dynamic_benchmark.record(path, lambda *given: reported.append(given))
    assert written == path
    assert reported == [("integrator: slow", 1, 3), ("modes: A0", 2, 3), ("times", 3, 3)]
    assert [row["errors"] for row in again["rows"]] == [row["errors"] for row in data["rows"]]
    assert (
        dynamic_benchmark.measure()["scene"] == dynamic_benchmark.SCENE
    )  # without reports of progress
    assert data["reference"]["modes"] == dynamic_benchmark.MOST_MODES
