"""Output of a sweep: each point equals its simulation in each format; none is repeated."""

import csv
import gc
import json
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import platecontact as pc
import pytest
import xarray as xr
from studies import NORMAL, QUICK, UNIFORM, counts, journal, parts, scene

from derivation.cli import main
from derivation.scene.result import UNITS
from derivation.scene.rows.rows import Rows
from derivation.scene.scene import Scene
from derivation.sweep import dataset, plan, run, store, write
from derivation.sweep.dataset import data_set
from derivation.sweep.distributions import read_distributions
from derivation.sweep.store import NUMBERS
from derivation.sweep.study import Study

Captured = pytest.CaptureFixture[str]
GRID = {"impact.speed": [0.8, 1.0, 1.3], "plate.thickness": "0.15:0.25:2"}


class Formula:
    """Replacement of the simulation: fast, with known values and failures; counts points."""

    def __init__(self) -> None:
        self.calls = 0
        self.broken = True

    def __call__(self, _: Scene, columns: Mapping[str, np.ndarray], *__: object) -> Rows:
        first, second = (*columns.values(), 0.0)[:2]
        self.calls += len(first)
        value = np.asarray(first + 2 * np.asarray(second))
        wrong = (np.round(value * 1e6).astype(int) % 7 == 0) & self.broken
        numbers = {name: np.where(wrong, np.nan, value * i) for i, name in enumerate(UNITS, 1)}
        bound = np.full(len(first), 1e-12)
        status = np.where(wrong, "rejected", "finished")
        reason = np.array(['no, "so"\nnot' if w else "" for w in wrong], dtype=object)
        effects = np.array(["hertz bending"] * len(first), dtype=object)
        return Rows(numbers, dict.fromkeys(UNITS, bound), bound, 0 * bound, status, reason, effects)


@pytest.fixture
def formula(monkeypatch: pytest.MonkeyPatch) -> Formula:
    made = Formula()
    monkeypatch.setattr(run, "solve", made)
    return made


def test_every_point_equals_its_simulation() -> None:
    data = pc.sweep(scene(), GRID)
    for speed in GRID["impact.speed"]:
        for thickness in (0.15, 0.25):
            given = scene().to_json()
            given["plate"].pop("half_thickness")
            given["plate"]["thickness"] = thickness
            given["impact"]["speed"] = speed
            expected = pc.simulate(pc.read(given))
            actual = data.sel({"impact.speed": speed, "plate.thickness": thickness})
            for name, unit in UNITS.items():
                assert float(actual[name]) == getattr(expected, name)
                assert actual[name].units == unit
            assert actual["status"].item() == "finished"
            assert actual["effects"].item().split() == list(expected.effects.included)
            assert float(actual["bound"]) == expected.accuracy.bound
    assert data["impact.speed"].units == "m/s"
    assert data["plate.thickness"].long_name == "plate thickness"
    assert json.loads(data.attrs["scene"]) == scene().to_json()


def opened(path: Path) -> xr.Dataset:
    """Return the Dataset stored in a file."""
    if path.suffix == ".nc":
        return xr.load_dataset(path)
    return xr.open_zarr(path).load()


@pytest.mark.parametrize("sample", [None, 50])
@pytest.mark.parametrize("suffix", [".nc", ".zarr"])
def test_files_contain_the_dataset(
    formula: Formula, tmp_path: Path, suffix: str, sample: int | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    monkeypatch.setattr(write, "BLOCK", 7)
    vary = {"plate.thickness": UNIFORM, "impact.speed": NORMAL} if sample else {
        "impact.speed": "1:3:5", "plate.thickness": "0.1:0.3:4", "sphere.radius": "0.1:0.2:3"
    }  # fmt: skip
    out = tmp_path / f"rows{suffix}"
    made = pc.sweep(scene(), vary, sample=sample, out=out, rtol=0.5)
    actual = opened(out)
    assert set(actual.coords) == set(made.coords)
    assert actual.attrs == made.attrs
    assert actual.attrs["rtol"] == 0.5
    assert actual.attrs.get("seed") == (1 if sample else None)
    for name in made.variables:
        assert actual[name].dims == made[name].dims
        assert actual[name].attrs == made[name].attrs
        np.testing.assert_array_equal(actual[name].astype(made[name].dtype), made[name])
    assert {"finished", "rejected"} == set(made["status"].values.ravel())
    assert np.isnan(made["max_force"].values[made["status"].values == "rejected"]).all()
    assert formula.calls == made["max_force"].size


@pytest.mark.usefixtures("formula")
@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
def test_tables_contain_every_point(
    tmp_path: Path, suffix: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    import pandas as pd

    monkeypatch.setattr(write, "BLOCK", 7)
    out = tmp_path / f"rows{suffix}"
    made = pc.sweep(scene(), {"impact.speed": "1:3:5", "sphere.radius": "1:2:9"}, out=out)
    actual = pd.read_csv(out) if suffix == ".csv" else pd.read_parquet(out)
    frame = made.to_dataframe().reset_index()
    for name in frame:
        if frame[name].dtype == float:
            np.testing.assert_array_equal(actual[name], frame[name])
        else:
            assert actual[name].fillna("").tolist() == frame[name].tolist()
    if suffix == ".csv":
        with out.open() as stream:
            assert len(list(csv.reader(stream))) == 46


def test_second_call_computes_nothing_and_writes_the_same_files(
    formula: Formula, tmp_path: Path
) -> None:
    out = tmp_path / "rows.csv"
    for wanted in (40, 40):
        pc.sweep(scene(), {"impact.speed": "1:3:40"}, out=out)
        assert formula.calls == wanted
    once = out.read_bytes()
    parts(out)[1].unlink()
    missing = int((counts(out, 40) == 0).sum())
    pc.sweep(scene(), {"impact.speed": "1:3:40"}, out=out)
    assert formula.calls == 40 + missing
    assert out.read_bytes() == once


def test_batches_of_other_points_are_ignored(formula: Formula, tmp_path: Path) -> None:
    out = tmp_path / "rows.csv"
    pc.sweep(scene(), {"impact.speed": "1:3:40"}, out=out)
    wrong = parts(out)[0]
    wrong.rename(wrong.with_name(wrong.name[:22] + "0" * 20 + ".parquet"))
    pc.sweep(scene(), {"impact.speed": "1:3:40"}, out=out)
    assert formula.calls == 40 + run.FIRST_BATCH


def test_retry_computes_only_the_failures(formula: Formula, tmp_path: Path) -> None:
    out, vary = tmp_path / "rows.nc", {"impact.speed": "1:3:400"}
    failed = int((pc.sweep(scene(), vary, out=out)["status"] != "finished").sum())
    assert failed > 20
    formula.broken = False
    data = pc.sweep(scene(), vary, out=out, retry=True)
    assert formula.calls == 400 + failed
    assert (data["status"] == "finished").all()
    np.testing.assert_array_equal(data["contact_time"], data["impact.speed"])
    assert (opened(out)["status"] == "finished").all()


def test_interrupted_write_leaves_the_old_file(
    formula: Formula, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out, vary = tmp_path / "rows.csv", {"impact.speed": "1:3:40"}

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(store.Store, "tables", stop)
        with pytest.raises(KeyboardInterrupt):
            pc.sweep(scene(), vary, out=out)
    assert not out.exists()
    pc.sweep(scene(), vary, out=out)
    assert formula.calls == 40
    assert out.exists()


@pytest.mark.parametrize(
    ("arguments", "output"),
    [
        (["--out", "rows.xls"], ".xls"),
        (["--sample", "10"], "--vary"),
        (["--plot", "rows.doc"], "rows.doc"),
        (["--result", "max_forc", "--plot", "rows.png"], "max_force?"),
        (["--result", "max_force"], "--plot"),
        (["--rtol", "2"], "1e-13"),
        (["--vary", "plate.radius=1:2:2", "--vary", "sphere.radius=1:2:2", "--plot", "a.png"],
         "--plot: "),
    ],
)  # fmt: skip
def test_invalid_studies_are_rejected_before_the_computation(
    formula: Formula, tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch,
    arguments: list[str], output: str,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(["sweep", str(QUICK), "--vary", "impact.speed=1:2:3", *arguments]) == 2
    assert output in capsys.readouterr().err
    assert not formula.calls
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", write.SUFFIXES)
def test_command_writes_each_format(formula: Formula, tmp_path: Path, suffix: str) -> None:
    out = tmp_path / f"rows{suffix}"
    assert main(["sweep", str(QUICK), "--vary", "impact.speed=1:2:3", "--out", str(out)]) == 0
    assert (out.exists(), formula.calls) == (True, 3)


def test_outputs_of_another_study_are_rejected(
    formula: Formula, tmp_path: Path, capsys: Captured
) -> None:
    out = tmp_path / "rows.csv"
    begin = ["sweep", str(QUICK), "--out", str(out), "--vary"]
    assert main([*begin, "impact.speed=1:2:3"]) == 0
    once = out.read_bytes()
    assert main([*begin, "impact.speed=1:2:4"]) == 2
    assert "rows.csv.parts" in capsys.readouterr().err
    (tmp_path / "rows.csv.parts").rename(tmp_path / "elsewhere")
    assert main([*begin, "impact.speed=1:2:3"]) == 2
    assert "rows.csv" in capsys.readouterr().err
    assert (out.read_bytes(), formula.calls) == (once, 3)


def test_study_of_only_rejected_points_fails(tmp_path: Path, capsys: Captured) -> None:
    out = tmp_path / "rows.csv"
    assert main(["sweep", str(QUICK), "--vary", "impact.speed=-3:-1:3", "--out", str(out)]) == 2
    assert "impact.speed: " in capsys.readouterr().err
    assert not out.exists()


@pytest.mark.parametrize("keys", [1, 2])
def test_study_is_plotted(formula: Formula, tmp_path: Path, keys: int) -> None:
    path = tmp_path / "rows.png"
    vary = ["--vary", "impact.speed=1:3:9:log", "--vary", "plate.thickness=0.1:0.2:4"][: 2 * keys]
    assert main(["sweep", str(QUICK), *vary, "--plot", str(path)]) == 0
    assert path.read_bytes().startswith(b"\x89PNG")
    assert formula.calls


def test_explain_computes_only_a_few_points(
    formula: Formula, capsys: Captured, tmp_path: Path
) -> None:
    path = tmp_path / "forecast.json"
    vary = ["--vary", "impact.speed=1:3:1000", "--vary", "plate.thickness=0.1:0.2:1000"]
    assert main(["sweep", str(QUICK), *vary, "--explain", "--json", str(path)]) == 0
    assert "1,000,000 points" in capsys.readouterr().out
    data = json.loads(path.read_text())
    assert data["probes"] == 4
    assert data["effects"]["hertz"] == 4
    assert data["seconds"] > 0
    assert not formula.calls


@pytest.fixture
def collected() -> Iterator[None]:
    """Run the garbage collector often, because its schedule depends on Python's version."""
    usual = gc.get_threshold()
    gc.set_threshold(200, 2, 2)
    yield
    gc.set_threshold(*usual)


@pytest.mark.usefixtures("collected")
@pytest.mark.parametrize("suffix", [".nc", ".zarr", ".csv", ".parquet"])
def test_memory_does_not_grow_with_the_study(
    formula: Formula, tmp_path: Path, suffix: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Peak memory of Python, NumPy and pyarrow does not grow with the number of points.

    The first study is not compared, because it imports the modules that write the file. The larger
    one is run twice, because other threads of the process may allocate memory during one.
    """
    import tracemalloc

    import pyarrow as pa

    monkeypatch.setattr(write, "BLOCK", 2**9)
    monkeypatch.setattr(run, "LARGEST_BATCH", 2**9)
    peaks = []
    for number, size in enumerate((2**10, 2**11, 2**13, 2**13)):
        made = plan.sample(read_distributions({"impact.speed": NORMAL}), size, 1, "random")
        batches = store.Store(Study(scene(), made, None), tmp_path / f"{number}.parts")
        pa.default_memory_pool().release_unused()
        tracemalloc.start()
        arrow = [pa.total_allocated_bytes()]
        run.compute(batches, 1, None, False, lambda *_: None)
        write.write(
            batches,
            tmp_path / f"{number}{suffix}",
            lambda *_, arrow=arrow: arrow.append(pa.total_allocated_bytes()),
        )
        peaks.append(tracemalloc.get_traced_memory()[1] + max(arrow) - arrow[0])
        tracemalloc.stop()
        assert data_set(batches).sizes == {"sample": size}
    assert min(peaks[2:]) < 1.5 * peaks[1]
    assert journal(tmp_path / "3", 2**13).max() == 1
    assert formula.calls == 2**10 + 2**11 + 2 * 2**13


@pytest.mark.parametrize("suffix", [".nc", ".zarr", ".parquet"])
def test_repeated_texts_take_little_space(suffix: str, tmp_path: Path) -> None:
    """Long warnings at each point hardly add to the bytes of its numbers: 48 at most."""
    wide = scene().model_copy(update={"plate": pc.Plate(radius=1.0, thickness=0.01,
        lame_lambda=0.36e9, lame_mu=0.43e9)})  # fmt: skip
    out = tmp_path / f"rows{suffix}"
    made = pc.sweep(wide, {"impact.speed": "0.5:1:5000"}, out=out)
    lengths = [len(text) for text in made["reason"].values]
    assert min(lengths) > 150
    assert len(set(made["reason"].values)) > 100
    files = out.rglob("*") if out.is_dir() else [out]
    size = sum(file.stat().st_size for file in files)
    assert size < 5000 * (8 * (1 + len(NUMBERS)) + 48)  # with the speed
    if suffix != ".parquet":
        assert opened(out)["reason"].values.tolist() == made["reason"].values.tolist()


@pytest.mark.parametrize("suffix", [".nc", ".zarr"])
def test_more_points_than_fit_in_memory_are_read_from_the_file(
    suffix: str, formula: Formula, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without a file that can be read in blocks, they are rejected before any is computed."""
    in_memory = pc.sweep(scene(), GRID)
    calls = formula.calls
    monkeypatch.setattr(dataset, "MOST_IN_MEMORY", 5)
    for out in (None, tmp_path / "rows.csv"):
        with pytest.raises(pc.SceneError, match=r"at most 5 points .*\.nc or \.zarr"):
            pc.sweep(scene(), GRID, out=out)
    assert formula.calls == calls
    with pc.sweep(scene(), GRID, out=tmp_path / f"rows{suffix}") as read:
        assert all(array.chunks for array in read.data_vars.values())
        assert read.sizes == in_memory.sizes
        for name in in_memory.variables:
            if name in UNITS or name in in_memory.coords:
                np.testing.assert_array_equal(read[name], in_memory[name])
                assert read[name].units == in_memory[name].units
            else:
                assert read[name].values.tolist() == in_memory[name].values.tolist()
