"""Summary of a study as the command prints it."""

import io
import json
import math
from pathlib import Path

import numpy as np
import pytest
from studies import QUICK, scene

from derivation.cli import main
from derivation.engine import console
from derivation.engine.text import wording
from derivation.scene import load, read, simulate
from derivation.scene.errors import SceneError
from derivation.scene.input.keys import varied
from derivation.scene.quantity import up_to
from derivation.scene.result import UNITS
from derivation.scene.rows.rows import Rows
from derivation.scene.scene import OUTPUTS
from derivation.sweep import run
from derivation.sweep.api import sweep
from derivation.sweep.plots import figure
from derivation.sweep.summary import Summary


def test_number_of_points_with_warnings_is_stated(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", str(QUICK), "--vary", "impact.speed=-6:1:8"]) == 0
    shown = capsys.readouterr()
    said = " ".join(shown.err.split())
    assert said.count("expected a positive number") == 1
    assert "at impact.speed = -6 (rejected), and similarly at 6 other points: " in said
    assert "7 of 8 points have warnings or no result" in said
    assert "1 finished, 7 rejected" in shown.out


def test_a_sweep_shows_warnings_that_differ_in_numbers_once(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """An earlier version printed 145 lines for forty values, whose warnings had other numbers."""
    assert main(["simulate", str(QUICK), "--sweep", "impact.speed=-3,1,-2,-1"]) == 0
    said = " ".join(capsys.readouterr().err.split())
    assert said.count("expected a positive number") == 1
    assert "at impact.speed = -3, and similarly at 2 other values: rejected: " in said
    assert wording("at 1.2e-05 m, -3 of 7 c1") == "at # m, # of # c1"


@pytest.mark.parametrize(
    ("vary", "disabled"),
    [("impact.speed=1,2", "inertia"), ("effects.inertia=true,false", "")],
)
def test_effects_that_the_scene_disables_are_named(
    vary: str, disabled: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["sweep", str(QUICK), "--vary", vary]) == 0
    line = capsys.readouterr().out.partition("not included in this bound: ")[2]
    assert line.strip().endswith(disabled)
    assert ("inertia" in line) == bool(disabled)


def test_unknown_bound_is_stated_in_words() -> None:
    text = Summary(2, 2, {"finished": 2}, {}, math.inf, 0.0, (), 0, None).to_text()
    assert text.endswith("Accuracy: no error bound is known at some points")


@pytest.mark.parametrize(
    ("status", "bound", "text"),
    [
        ("finished", np.inf, "no error bound is known"),
        ("incomplete", np.nan, "no point has a result"),
    ],
)
def test_missing_bounds_are_no_bounds_of_zero(
    status: str, bound: float, text: str, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path,
) -> None:  # fmt: skip
    one, none = np.ones(1), np.array([""], dtype=object)
    results = {name: one * bound if np.isnan(bound) else one for name in UNITS}
    rows = Rows(
        results,
        dict.fromkeys(UNITS, one * bound),
        one * bound,
        one * bound,
        np.array([status]),
        none,
        none,
    )
    monkeypatch.setattr(run, "solve", lambda *_: rows)
    path = tmp_path / "summary.json"
    assert main(["sweep", str(QUICK), "--vary", "impact.speed=1", "--json", str(path)]) == 0
    assert f"Accuracy: {text}" in capsys.readouterr().out
    assert json.loads(path.read_text())["largest_bound"] is None


def test_largest_model_error_is_stated(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """The fastest impact deflects the plate most, and has the largest model error by stretching."""
    path = tmp_path / "summary.json"
    command = ["sweep", str(QUICK), "--vary", "impact.speed=0.5:2:4", "--json", str(path)]
    assert main(command) == 0
    fastest = simulate(read(varied(load(QUICK), {"impact.speed": 2.0})))
    assert json.loads(path.read_text())["largest_model_error"] == fastest.model_error > 0.0
    assert f"model error {up_to(fastest.model_error)}" in capsys.readouterr().out


def test_distribution_without_sample_asks_for_its_size() -> None:
    vary = {"impact.speed": {"distribution": "normal", "mean": 1.0, "std": 0.1}}
    with pytest.raises(SceneError, match="give sample=N"):
        sweep(scene(), vary)


def test_bound_is_that_of_the_outputs_of_the_scene() -> None:
    """An earlier version stated that the force is exact because the restitution is."""
    accuracy = {"rtol": 1e-3, "outputs": ["restitution"]}
    some = read(scene().to_json() | {"accuracy": accuracy})
    data = sweep(some, {"impact.speed": [0.5, 1.0]})
    assert data.attrs["outputs"] == "restitution"
    exact = sweep(scene(), {"impact.speed": [0.5, 1.0]}, rtol=1e-9)
    for name in OUTPUTS:
        assert (np.abs(data[name] / exact[name] - 1.0) <= data[f"{name}_error"]).all()
    assert (data["max_force_error"] > 20.0 * data["restitution_error"]).all()
    for name in ("restitution", "max_force"):
        [axes] = figure(data, ["impact.speed"], [name]).axes
        assert axes.get_legend_handles_labels()[1] == ["error: bound and model"]
    text = Summary(2, 2, {"finished": 2}, {}, 1e-3, 0.0, (), 0, None, ("restitution",)).to_text()
    assert text.endswith("Accuracy: relative error of restitution at most 1.0e-03")


@pytest.mark.parametrize("terminal", [True, False])
def test_a_short_study_in_python_shows_its_progress_on_a_terminal_only(
    terminal: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = io.StringIO()
    notes = console.Screen(file=shown, force_terminal=terminal, width=80)
    monkeypatch.setattr(console, "NOTES", notes)
    sweep(scene(), {"impact.speed": [0.5, 1.0]})
    assert ("2/2" in shown.getvalue()) == terminal
    assert bool(shown.getvalue()) == terminal
