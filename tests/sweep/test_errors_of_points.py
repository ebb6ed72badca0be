"""Each point of a study has the error of each result, and plots show it."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import platecontact as pc
import pytest
from matplotlib.collections import PolyCollection

from derivation.scene.result import UNITS
from derivation.sweep import plots

STEEL = {"material": "steel", "yield_stress": 1e9}
TABLES: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.01} | STEEL,
    "plate": {"radius": 0.3, "thickness": 0.02, "edge": "clamped"} | STEEL,
    "impact": {"speed": 1.0},
}
SPEEDS = [0.01, 0.5, 3.0]


@pytest.mark.parametrize(
    "accuracy",
    [{}, {"accuracy": {"rtol": 0.2}}, {"accuracy": {"rtol": 0.1, "outputs": ["max_force"]}}],
)
@pytest.mark.parametrize("inertia", [False, "auto"])
def test_errors_are_those_of_each_simulation(
    accuracy: dict[str, Any], inertia: Any, tmp_path: Path
) -> None:
    tables = TABLES | {"effects": {"inertia": inertia}} | accuracy
    file = tmp_path / "points.csv"
    data = pc.sweep(pc.read(tables), {"impact.speed": SPEEDS}, out=file)
    written = pd.read_csv(file)
    for point, speed in enumerate(SPEEDS):
        one = pc.simulate(pc.read(tables | {"impact": {"speed": speed}}))
        for name in UNITS:
            error = data[f"{name}_error"]
            assert error.attrs["units"] == "1"
            assert error.values[point] == written[f"{name}_error"][point] == one.error_of(name)
    own = data["restitution_error"].values
    together = (data["bound"] + data["model_error"]).values
    assert np.all(own <= together) or "outputs" in accuracy.get("accuracy", {})


def test_error_of_a_static_stress_is_unknown_and_that_of_a_moving_plate_is_not() -> None:
    static = pc.simulate(pc.read(TABLES | {"effects": {"inertia": False}}))
    assert static.error_of("max_tensile_stress") == math.inf
    moving = pc.simulate(pc.read(TABLES))
    assert moving.error_of("max_tensile_stress") < 1.0
    with pytest.raises(pc.SceneError, match="name: expected one of contact_time"):
        static.error_of("speed")


def test_an_incomplete_point_has_no_errors() -> None:
    data = pc.sweep(pc.read(TABLES), {"impact.speed": [-1.0, 0.5]})
    assert all(np.isnan(data[f"{name}_error"].values[0]) for name in UNITS)


def test_plots_show_the_error_of_each_result() -> None:
    data = pc.sweep(pc.read(TABLES | {"effects": {"inertia": False}}), {"impact.speed": SPEEDS})
    panels = dict(zip(UNITS, plots.figure(data, ["impact.speed"], list(UNITS)).axes, strict=False))
    for name, axes in panels.items():
        bands = [each for each in axes.collections if isinstance(each, PolyCollection)]
        heights = [np.ptp(path.vertices[:, 1]) for band in bands for path in band.get_paths()]
        assert any(heights) == bool(np.isfinite(data[f"{name}_error"]).any()), name
    assert np.isfinite(data["max_pressure_error"]).all()


def test_batches_of_an_earlier_version_without_errors_are_computed_again(tmp_path: Path) -> None:
    scene = pc.read(TABLES | {"effects": {"inertia": False}})
    file = tmp_path / "points.csv"
    pc.sweep(scene, {"impact.speed": SPEEDS}, out=file)
    expected = file.read_text()
    for path in (tmp_path / "points.csv.parts").glob("*.parquet"):
        old = pd.read_parquet(path).drop(columns=[f"{name}_error" for name in UNITS])
        old.to_parquet(path)
    file.unlink()
    pc.sweep(scene, {"impact.speed": SPEEDS}, out=file)
    assert file.read_text() == expected
