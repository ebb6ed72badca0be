"""Tables and figures of a report with missing data have empty cells or omit rows."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
import sympy as sp
from matplotlib.figure import Figure

from derivation.engine.files import measurements
from derivation.plate import reporting
from derivation.plate.report.accuracy import duration, factor, tool_rows, winner_cells
from derivation.plate.report.accuracy_figures import draw_panel
from derivation.plate.report.consequence import evaluated
from derivation.plate.report.front import checks
from derivation.plate.vocabulary import R, a


def test_missing_values_give_empty_cells() -> None:
    assert duration(None) == factor("nan") == ""
    assert winner_cells(None) == ("", "", "")
    assert duration(2.5e-3) == r"2.5\,ms"
    assert (factor(2.0), factor("1.5")) == ("2", "1.5")
    actual = {"family": "split sum", "setting": "8 nodes", "seconds": 1.0, "relative": "nan",
             "ties": ["a_b", "split sum"], "near_ties": ["a_b", "c"]}  # fmt: skip
    name, time, relative = winner_cells(actual)
    assert name == r"split sum, 8 nodes (tie: a\_b?, c?)"
    assert (time, relative) == (r"1\,s", "")


def test_row_of_a_missing_tool_states_the_reason() -> None:
    tool = {"name": "Some", "version": "2", "problem": "a law", "setting": "8 x 8", "error": 1e-3,
            "seconds": 1.0, "limitation": "plates", "missing": None}  # fmt: skip
    absent = tool | {"name": "Other_one", "version": "", "missing": "not installed: 100 %"}
    first, second, third = tool_rows([tool, absent, tool])
    assert second == r"Other\_one & \multicolumn{5}{l}{not installed}"
    assert first.startswith("Some 2 & a law & ")
    assert first.endswith(" & plates")
    assert third.startswith(" & a law & ")  # the name is printed in the first row only
    assert third.endswith(" & ")


def test_checks_without_a_record_are_omitted() -> None:
    measured: dict[str, Any] = {k: json.loads(v) for k, v in reporting.measurement().items()}
    every = dict(checks(measured))
    for name in ("bounds", "effects"):
        fewer = dict(checks({key: data for key, data in measured.items() if key != name}))
        [omitted] = every.keys() - fewer.keys()
        assert omitted.endswith(f"{name}}}")
        assert fewer.items() <= every.items()


def test_leftover_of_an_interrupted_update_is_no_measurement(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(measurements(), tmp_path, dirs_exist_ok=True)
    known = reporting.measurement()
    (tmp_path / "hard.part.json").write_text("{")
    monkeypatch.setattr(reporting, "measurements", lambda: tmp_path)
    assert reporting.measurement() == known


def test_panel_without_timings_is_empty() -> None:
    axes = Figure().subplots()
    draw_panel(axes, [], "vector", {})
    assert not axes.lines
    assert not axes.collections


def test_error_message_names_a_symbol_without_a_value() -> None:
    point = {a: 0.5}
    assert evaluated(sp.sqrt(a), point) == pytest.approx(0.5**0.5, rel=1e-15)
    with pytest.raises(ValueError, match="value of R"):
        evaluated(a / R, point)
