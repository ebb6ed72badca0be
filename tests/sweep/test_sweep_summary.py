"""Summary of a study as the command prints it."""

import math

import pytest
from studies import QUICK, scene

from derivation.cli import main
from derivation.scene.errors import SceneError
from derivation.sweep.api import sweep
from derivation.sweep.summary import MOST_WARNINGS, Summary


def test_number_of_points_with_warnings_is_stated(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sweep", str(QUICK), "--vary", "impact.speed=-6:1:8"]) == 0
    shown = capsys.readouterr()
    assert shown.err.count("warning: at impact.speed = -") == MOST_WARNINGS
    assert "7 of 8 points have warnings or no result" in shown.err.replace("\n", " ")
    assert "1 finished, 7 rejected" in shown.out


def test_unknown_bound_is_stated_in_words() -> None:
    text = Summary(2, 2, {"finished": 2}, {}, math.inf, (), 0, None).to_text()
    assert text.endswith("Accuracy: no error bound is known at some points")


def test_distribution_without_sample_asks_for_its_size() -> None:
    vary = {"impact.speed": {"distribution": "normal", "mean": 1.0, "std": 0.1}}
    with pytest.raises(SceneError, match="give sample=N"):
        sweep(scene(), vary)
