"""Run time against accuracy for plates with inertia: three integrators, and the shown table."""

import json
import math
from pathlib import Path

import pytest

from derivation.checks import dynamic_benchmark
from derivation.cli import main
from derivation.plate.report.dynamic_benchmark import benchmark_rows
from derivation.plate.report.dynamic_benchmark import dynamic_benchmark_figure as drawn
from derivation.scene.scene import OUTPUTS


@pytest.fixture(autouse=True)
def _few_modes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dynamic_benchmark, "COMPARED_MODES", 10)


def test_three_integrators_agree() -> None:
    """Collocation agrees with a Runge-Kutta method (order 8) and equal steps (order 2)."""
    elements = dynamic_benchmark.by_time_elements(16, 1e-11).numbers
    assert dynamic_benchmark.by_time_elements(8, 1e-11).numbers == pytest.approx(
        elements, rel=1e-12
    )
    assert dynamic_benchmark.by_runge_kutta(1e-11).numbers == pytest.approx(elements, rel=2e-12)
    rough, fine = (
        [
            abs(x / y - 1)
            for x, y in zip(dynamic_benchmark.by_verlet(n).numbers, elements, strict=True)
        ]
        for n in (256, 1024)
    )
    assert max(rough) < 1e-4
    assert max(fine) < max(rough) / 10


def test_reference_and_rows_have_the_same_results() -> None:
    trials = [
        *dynamic_benchmark.modes(),
        *dynamic_benchmark.branches(),
        *dynamic_benchmark.tolerances(),
    ]
    assert all(trial.names == OUTPUTS for trial in trials)
    few = next(trial for trial in trials if (trial.study, trial.setting) == ("modes", 10))
    more = next(trial for trial in trials if (trial.study, trial.setting) == ("modes", 40))
    errors = []
    for trial in (few, more):
        pairs = zip(trial.call().numbers, trial.reference(), strict=True)
        errors.append(max(abs(x / y - 1) for x, y in pairs))
        assert trial.call().modes == trial.setting  # with A0 only, although "auto" may add branches
    assert 0.0 < errors[1] < errors[0] < 1e-3


def test_tolerance_is_met_and_its_bound_stated() -> None:
    [trial] = [t for t in dynamic_benchmark.tolerances() if (t.method, t.setting) == ("A0", 5e-3)]
    result = trial.call()
    assert result.bound is not None
    pairs = zip(result.numbers, trial.reference(), strict=True)
    assert max(abs(x / y - 1) for x, y in pairs) < result.bound <= trial.setting


def test_recorded_benchmark_is_reported() -> None:
    data = json.loads(dynamic_benchmark.MEASURED.read_text())
    rows = list(benchmark_rows(data))
    assert len(rows) == len(data["rows"]) == len(dynamic_benchmark.cells(data))
    assert {row["study"] for row in data["rows"]} == {"integrator", "modes", "branches", "rtol"}
    for row in data["rows"]:
        assert row["seconds"] > 0.0
        assert all(math.isfinite(error) for error in row["errors"].values())
        if row["bound"] is not None:
            assert max(row["errors"].values()) <= row["bound"] <= row["setting"]
    left, right = drawn(data).axes
    assert (len(left.lines), len(right.lines)) == (4, 3)


def test_other_options_are_rejected_with_dynamic(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["benchmark", "--dynamic", "--quick"]) == 2
    assert "--dynamic" in capsys.readouterr().err
    assert main(["benchmark", "--dynamic", "--out", str(tmp_path)]) == 2
    assert "expected a file, got a folder" in capsys.readouterr().err
