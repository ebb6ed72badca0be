"""Studies with unusual arguments and outputs: equal results, or one message."""

import errno
import os
from pathlib import Path
from typing import Any

import numpy as np
import platecontact as pc
import pytest
import xarray as xr
from studies import QUICK, UNIFORM, journal, parts, scene

from derivation.cli import main
from derivation.sweep import plan, run
from derivation.sweep.store import open_store
from derivation.sweep.study import Study

SPEEDS = {"impact.speed": "1:2:9"}
SAMPLE = {"plate.thickness": UNIFORM}


@pytest.mark.parametrize(
    ("vary", "options", "message"),
    [
        (None, {}, "vary: expected a mapping"),
        ("impact.speed=1:2:3", {}, "vary: expected a mapping"),
        (["impact.speed=1:2:3"], {"sample": 4}, "vary: expected a mapping"),
        ([3], {}, "got '3'"),
        ({3: [1.0]}, {}, "got '3'"),
        ({"impact.speed": np.ma.array([1.0, 2.0], mask=[0, 1])}, {}, "expected finite numbers"),
        ({"impact.speed": np.array(["2020-01-01"], "M8[D]")}, {}, "expected finite numbers"),
        ({"impact.speed": [True]}, {}, "expected finite numbers"),
        ({"impact.speed": [10**400]}, {}, "expected finite numbers"),
        ({"impact.speed": [1.0, None]}, {}, "expected finite numbers"),
        (SPEEDS, {"workers": 0}, "workers: expected a whole number from 1"),
        (SPEEDS, {"workers": "2"}, "workers: expected a whole number from 1"),
        (SPEEDS, {"method": "sobol"}, "method: expected none for a grid"),
        (SPEEDS, {"out": 3}, "out: expected a file name"),
        (SPEEDS, {"rtol": [1e-3]}, "rtol: expected a relative tolerance"),
        (SAMPLE, {"sample": 1.5}, "sample: expected a whole number from 1, got 1.5"),
        (SAMPLE, {"sample": "4"}, "sample: expected a whole number from 1"),
        (SAMPLE, {"sample": True}, "sample: expected a whole number from 1"),
        (SAMPLE, {"sample": 4, "seed": None}, "seed: expected a whole number from 0"),
        (SAMPLE, {"sample": 4, "method": None}, "method: expected random"),
        ({"materials.absent.density": [1e3]}, {}, "expected a material that the scene defines"),
    ],
)
def test_invalid_arguments_give_one_message(
    vary: Any, options: dict[str, Any], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("derivation.sweep.run.solve", None)
    with pytest.raises(pc.SceneError) as error:
        pc.sweep(scene(), vary, **options)
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_numbers_of_numpy_and_whole_floats_are_accepted() -> None:
    made = pc.sweep(scene(), SAMPLE, sample=4, seed=3, rtol=0.5)
    other = pc.sweep(scene(), SAMPLE, sample=4.0, seed=np.int64(3), rtol=np.float32(0.5))  # type: ignore[arg-type]
    xr.testing.assert_identical(made, other)
    one = pc.sweep(scene(), {"impact.speed": np.float32(0.5)})
    assert one["impact.speed"].values.tolist() == [0.5]


@pytest.mark.parametrize("suffix", [".csv", ".zarr"])
def test_a_link_stays_and_its_target_is_written(tmp_path: Path, suffix: str) -> None:
    (tmp_path / "disk").mkdir()
    target, link = tmp_path / "disk" / f"target{suffix}", tmp_path / f"link{suffix}"
    link.symlink_to(target)
    for _ in range(2):
        pc.sweep(scene(), SPEEDS, out=link)
    assert link.is_symlink()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["disk", link.name]
    assert target.exists()
    assert journal(target, 9).max() == 1


def test_the_distributions_are_not_overwritten(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "vary.toml"
    path.write_text('[vary]\n"impact.speed" = {distribution = "uniform", low = 1, high = 2}\n')
    once = path.read_text()
    command = ["sweep", str(QUICK), "--distributions", str(path), "--sample", "2"]
    assert main([*command, "--json", str(path)]) == 2
    assert "got the file of the distributions" in capsys.readouterr().err
    assert path.read_text() == once


VARY = """
[vary]
"impact.speed" = {distribution = "uniform", low = 0.5, high = 1.5}
"""


def test_distributions_in_the_scene_equal_those_in_a_file(tmp_path: Path) -> None:
    """Other commands read the same scene as without the table."""
    together, apart = tmp_path / "both.toml", tmp_path / "vary.toml"
    together.write_text(QUICK.read_text() + VARY)
    apart.write_text(VARY)
    sample = ["--sample", "4", "--seed", "3", "--out"]
    one, other = tmp_path / "one.csv", tmp_path / "other.csv"
    assert main(["sweep", str(together), *sample, str(one)]) == 0
    assert main(["sweep", str(QUICK), "--distributions", str(apart), *sample, str(other)]) == 0
    assert one.read_bytes() == other.read_bytes()
    assert pc.load(together) == pc.load(QUICK)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[vary]\nimpact.speed = {distribution = "uniform", low = 1, high = 2}', "in quotes"),
        ("[vary]", "add one of the two"),
        ("", "a table [vary] of the scene"),
        ('vary = "speed"', "vary: expected distributions"),
    ],
)
def test_unusable_distributions_of_a_scene_are_rejected(
    text: str, message: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(f"{text}\n{QUICK.read_text()}" if "=" in text[:6] else QUICK.read_text() + text)
    assert main(["sweep", str(path), "--sample", "4"]) == 2
    assert message in " ".join(capsys.readouterr().err.split())
    with pytest.raises(pc.SceneError, match="vary: expected distributions only in a scene file"):
        pc.read(scene().to_json() | {"vary": {}})


def test_an_output_in_use_is_rejected(tmp_path: Path) -> None:
    out = tmp_path / "rows.csv"
    study = Study(scene(), plan.grid(["impact.speed=1:2:9"]), None)
    with open_store(study, out) as store:
        (store.folder / "x.temporary").touch()
        with pytest.raises(pc.SceneError, match="no other run is writing"):
            pc.sweep(scene(), SPEEDS, out=out)
        assert (store.folder / "x.temporary").exists()
    pc.sweep(scene(), SPEEDS, out=out)
    assert out.exists()


@pytest.mark.parametrize("size", [0, 100, -50])
def test_a_damaged_batch_is_computed_again(
    tmp_path: Path, size: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run, "FIRST_BATCH", 1)  # so that there are several
    out = tmp_path / "rows.csv"
    pc.sweep(scene(), SPEEDS, out=out)
    once = out.read_bytes()
    with parts(out)[1].open("r+b") as stream:
        stream.truncate(size % stream.seek(0, os.SEEK_END))
    pc.sweep(scene(), SPEEDS, out=out)
    assert out.read_bytes() == once
    assert journal(out, 9).max() == 2


def test_a_full_disk_gives_one_message(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match=r"cannot write .*rows.csv.parts: No space .*; free some"):
        pc.sweep(scene(), SPEEDS, out=tmp_path / "rows.csv")
    assert not list((tmp_path / "rows.csv.parts").iterdir())


@pytest.mark.parametrize("name", ["a/b", "a\\b", "é" * 130])
def test_keys_that_a_format_does_not_allow_are_rejected(tmp_path: Path, name: str) -> None:
    own = {name: pc.Material(youngs_modulus=1e9, poissons_ratio=0.3, density=1e3)}
    plate = pc.Plate(radius=1.0, thickness=0.2, material=name)
    given = scene().model_copy(update={"materials": own, "plate": plate})
    vary = {f"materials.{name}.density": [1e3, 2e3]}
    for suffix in (".nc", ".zarr"):
        with pytest.raises(pc.SceneError, match=r"rename the material, or write a \.parquet"):
            pc.sweep(given, vary, out=tmp_path / f"rows{suffix}")
    pc.sweep(given, vary, out=tmp_path / "rows.parquet")
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "rows.parquet",
        "rows.parquet.parts",
    ]
