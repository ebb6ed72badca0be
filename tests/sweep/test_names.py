"""Studies over names, such as those of materials: each point is the simulation of its scene."""

import json
from collections.abc import Mapping
from itertools import pairwise, product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import platecontact as pc
import pytest
import xarray as xr
from studies import counts, journal, parts

from derivation.cli import main
from derivation.scene.input.keys import OF_MATERIAL
from derivation.scene.result import UNITS
from derivation.scene.rows import rows as many
from derivation.sweep import plan, plots
from derivation.sweep.distributions import load_distributions, read_distributions

Captured = pytest.CaptureFixture[str]
ODD = ["float glass, 6 mm", "_a/b $x^2$ = 'c' \"d\"", "Glas ü 木", " #1;\tNA "]
"""Names of own materials."""
OWN = {
    name: {"youngs_modulus": (60 + i) * 1e9, "poissons_ratio": 0.2, "density": 2400.0 + i}
    for i, name in enumerate(ODD)
}
TABLES: dict[str, dict[str, Any]] = {
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {"radius": 0.3, "thickness": 0.05, "material": "glass"},
    "impact": {"speed": 0.5},
    "effects": {"inertia": False},
    "materials": OWN,
}
STATIC = pc.read(TABLES)


def simulated(keys: Mapping[str, Any], tables: Mapping[str, Any] = TABLES) -> pc.Result:
    """Simulate the scene in which some keys, all of which exist, have other values."""
    changed = {name: dict(table) for name, table in tables.items()}
    for key, value in keys.items():
        table, name = key.split(".")
        changed[table][name] = value
    return pc.simulate(pc.read(changed))


def check(data: xr.Dataset, tables: Mapping[str, Any] = TABLES) -> None:
    """Assert that each point is the simulation of its scene, to the last bit."""
    points = [key for key in data.coords if key not in ("result", "key")]
    flat = data.stack(point=data["status"].dims)
    for number in range(flat.sizes["point"]):
        one = flat.isel(point=number)
        expected = simulated({str(key): one[key].item() for key in points}, tables)
        assert one["status"].item() == "finished"
        assert one["effects"].item().split() == list(expected.effects.included)
        assert one["reason"].item() == "; ".join(expected.warnings)
        assert one["bound"].item() == expected.accuracy.bound
        for name in UNITS:
            assert one[name].item() == getattr(expected, name)


def test_points_of_names_and_numbers_are_their_simulations() -> None:
    vary = {
        "impact.speed": [0.3, 0.5],
        "plate.material": ["PMMA", *ODD],
        "sphere.material": "steel",
    }
    data = pc.sweep(STATIC, vary)
    assert data["plate.material"].values.tolist() == ["PMMA", *ODD]
    assert data["plate.material"].attrs == {"long_name": "plate material"}
    check(data)


def test_static_and_dynamic_points_and_points_that_yield() -> None:
    tables = TABLES | {
        "plate": TABLES["plate"] | {"edge": "paper", "thickness": 0.03},
        "effects": {"inertia": "auto"},
        "materials": {"soft": OWN[ODD[0]] | {"yield_stress": 3e8}},
    }
    vary = {"plate.material": ["glass", "soft"], "plate.edge": ["paper", "clamped"],
            "effects.inertia": [False, "auto"]}  # fmt: skip
    data = pc.sweep(pc.read(tables), vary)
    assert data["effects.inertia"].values.tolist() == ["false", "auto"]
    check(data.assign_coords({"effects.inertia": np.array([False, "auto"], object)}), tables)
    effects = " ".join(data["effects"].values.ravel())
    assert all(name in effects for name in ("inertia", "plasticity", "edge"))


def test_static_points_are_computed_in_one_call_for_each_name(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    calls, models_of = [], many.models_of
    monkeypatch.setattr(many, "simulate", None)
    monkeypatch.setattr(many, "models_of", lambda *x: calls.append(x) or models_of(*x))
    speeds = np.tile(np.linspace(0.1, 0.5, 20), 3)
    names = np.array(["glass", "steel", "PMMA"]).repeat(20)[
        np.random.default_rng(1).permutation(60)
    ]
    made = many.solve(STATIC, {"plate.material": names, "impact.speed": speeds})
    assert (made.status == "finished").all()
    assert len(calls) == 3
    monkeypatch.undo()
    for row in (0, 7, 33, 59):
        one = simulated({"plate.material": str(names[row]), "impact.speed": speeds[row]})
        assert made.results["max_force"][row] == one.max_force


def test_a_batch_that_takes_long_ends_at_its_first_missing_row() -> None:
    names = np.array(["glass", "PMMA", "glass", "PMMA"])
    columns = {"plate.material": names, "impact.speed": np.array([0.5, -1.0, -1.0, 0.5])}
    assert many.solve(STATIC, columns, seconds=-1.0).status.tolist() == ["finished"]


@pytest.mark.parametrize("suffix", [".nc", ".zarr", ".parquet", ".csv"])
@pytest.mark.parametrize("sample", [None, 9])
def test_files_contain_the_names(tmp_path: Path, suffix: str, sample: int | None) -> None:
    out, names = tmp_path / f"rows{suffix}", ["steel", *ODD]
    vary: dict[str, Any] = {"plate.material": names, "impact.speed": [0.4, 0.5]}
    if sample:
        vary = {key: {"distribution": "choice", "values": values} for key, values in vary.items()}
    made = pc.sweep(STATIC, vary, sample=sample, out=out)
    if suffix in (".nc", ".zarr"):
        actual = xr.load_dataset(out) if suffix == ".nc" else xr.open_zarr(out).load()
        xr.testing.assert_identical(actual, made)
        if not sample:
            assert actual["max_force"].sel({"plate.material": ODD[1]}).shape == (2,)
        return
    read = pd.read_csv(out) if suffix == ".csv" else pd.read_parquet(out)
    frame = made.to_dataframe().reset_index()
    for name in ("plate.material", "impact.speed", "max_force"):
        assert read[name].tolist() == frame[name].tolist()


def test_finished_points_are_not_repeated(tmp_path: Path) -> None:
    out, vary = (
        tmp_path / "rows.csv",
        {"plate.material": ["glass", "steel"], "impact.speed": "1:2:9"},
    )
    pc.sweep(STATIC, vary, out=out)
    once = out.read_bytes()
    parts(out)[1].unlink()
    pc.sweep(STATIC, vary, out=out)
    assert (counts(out, 18) == 1).all()
    assert journal(out, 18).max() == 2
    assert out.read_bytes() == once
    for other in (["steel", "glass"], ["glass", "steal"], ["glass"]):
        with pytest.raises(pc.SceneError, match=r"another one|did you mean steel"):
            pc.sweep(STATIC, vary | {"plate.material": other}, out=out)


@pytest.mark.parametrize(
    ("vary", "message"),
    [
        ({"plate.material": ["glass", "stel"]}, "did you mean steel?"),
        ({"sphere.material": ["tennis ball"]}, "which is hollow"),
        ({"plate.edge": "clampt"}, 'write for example `edge = "clamped"`'),
        ({"plate.material": ["Glass", "glass"]}, "which mean the same"),
        ({"plate.material": ["glass", "glass"]}, "got one twice"),
        ({"plate.material": []}, "expected names"),
        ({"plate.material": [1.0, "glass"]}, "expected names"),
        ({"plate.material": ["glass"], "plate.youngs_modulus": "1e9:2e9:3"}, "replace each other"),
        ({"plate.colour": ["red"]}, "numbers or names"),
        ({"impact.speed": ["fast"]}, "expected finite numbers"),
        ({"impact.speed": []}, "at least one, got []; give a list such as"),
    ],
)
def test_invalid_names_are_rejected_before_the_computation(
    vary: dict[str, Any], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("derivation.sweep.run.solve", None)
    with pytest.raises(pc.SceneError) as error:
        pc.sweep(STATIC, vary)
    assert message in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("key", OF_MATERIAL)
def test_a_constant_of_one_material_is_not_used_for_all(key: str) -> None:
    """Steel with the density of glass is rejected as a mistake, unless the density varies too."""
    table, name = key.split(".")
    body, other = ("sphere", "plate") if table == "sphere" else ("plate", "sphere")
    value = {"yield_stress": 5e9, "retardation_time": 1e-6, "restitution": 0.9}.get(name, 0.5)
    more = {"solve_for": "retardation_time"} if table == "measured" else {}
    given = pc.read(TABLES | {table: TABLES.get(table, {}) | {name: value} | more})
    vary = {f"{body}.material": ["glass", "steel"]}
    with pytest.raises(pc.SceneError, match=rf"without {key}, .* or vary it too"):
        pc.sweep(given, vary)
    for free in ({f"{other}.material": ["glass", "steel"]}, {key: [value]} | vary):
        assert (pc.sweep(given, free, rtol=0.1)["status"] != "rejected").any()
    alone = getattr(given, body).material.upper()
    assert pc.sweep(given, {f"{body}.material": alone}, rtol=0.1).sizes == {f"{body}.material": 1}


def test_quoted_names_may_contain_commas_and_equals_signs(tmp_path: Path, capsys: Captured) -> None:
    """A comma belongs to a name in double quotes; an equals sign may be part of a name."""
    made = plan.grid(['plate.material="float glass, 6 mm" , steel,"a ""b"" c",x = y'])
    assert made.axes == {"plate.material": ("float glass, 6 mm", "steel", 'a "b" c', "x = y")}
    made = plan.grid(["materials.a,=b.c.youngs_modulus=1,2", "impact.speed=3"])
    assert made.axes == {"materials.a,=b.c.youngs_modulus": (1.0, 2.0), "impact.speed": (3.0,)}
    scene, out = tmp_path / "scene.toml", tmp_path / "rows.csv"
    own = "youngs_modulus = 1e10\npoissons_ratio = 0.3\ndensity = 2e3\n"
    scene.write_text(
        '[sphere]\nradius = 0.01\nmaterial = "steel"\n[plate]\nradius = 0.3\nthickness = 0.05\n'
        'material = "a, b"\n[impact]\nspeed = 0.5\n[effects]\ninertia = false\n'
        f'[materials."a, b"]\n{own}'
    )
    vary = ["--vary", 'plate.material="a, b",steel', "--vary", "materials.a, b.density=2e3,3e3"]
    assert main(["sweep", str(scene), *vary, "--out", str(out)]) == 0
    read = pd.read_csv(out)
    assert read["plate.material"].tolist() == ["a, b"] * 2 + ["steel"] * 2
    assert read["materials.a, b.density"].tolist() == [2e3, 3e3] * 2
    assert main(["sweep", str(scene), "--vary", "plate.material=a, b"]) == 2
    assert "a, b" in capsys.readouterr().err


def test_choices_are_equally_probable_and_reproducible(tmp_path: Path) -> None:
    path = tmp_path / "vary.toml"
    path.write_text(
        '[vary]\n"plate.material" = {distribution = "choice", values = ["glass", "ice", "steel"]}\n'
        '"plate.thickness" = {distribution = "choice", values = [4e-3, 6e-3]}\n'
    )
    made = plan.sample(load_distributions(path), 600, 1, "latin-hypercube")
    points = made.points(0, 600)
    names, numbers = np.unique(points["plate.material"], return_counts=True)
    assert dict(zip(names, numbers, strict=True)) == dict.fromkeys(("glass", "ice", "steel"), 200)
    assert np.unique(points["plate.thickness"], return_counts=True)[1].tolist() == [300, 300]
    np.testing.assert_array_equal(
        made.points(7, 50)["plate.material"], points["plate.material"][7:50]
    )


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"plate.material": {"distribution": "uniform", "low": 0, "high": 1}}, "choice for names"),
        ({"plate.material": {"distribution": "choice", "values": "glass"}}, "expected names"),
        ({"plate.material": {"distribution": "choice", "values": []}}, "expected names"),
        ({"plate.material": {"distribution": "choice"}}, "expected values of choice"),
        ({"plate.material": ["glass", "steel"]}, '= {distribution = "choice", values = ["glass"'),
        ({"impact.speed": {"distribution": "choice", "values": ["a"]}}, "finite numbers"),
        ({"impact.speed": {"distribution": "choice", "values": [1, np.nan]}}, "finite numbers"),
        ({"impact.speed": {"distribution": "choice", "values": [1, 1]}}, "got one twice"),
        ({"impact.speed": {"distribution": "chioce", "values": [1]}}, "did you mean choice?"),
        ({"impact.speed": {"distribution": ["uniform"], "low": 1, "high": 2}}, "got an array"),
        ({"impact.speed": {"distribution": "lognormal", "mean": 1.0, "std": 1e200}}, "1e+100 mean"),
        ({"sphere.mass": {"distribution": "choice", "values": [1]},
          " sphere.mass": {"distribution": "choice", "values": [2]}},
         "got it twice"),
    ],
)  # fmt: skip
def test_invalid_choices_are_rejected(given: dict[str, Any], message: str) -> None:
    with pytest.raises(pc.SceneError) as error:
        pc.sweep(STATIC, given, sample=4)
    assert message in str(error.value)


def test_sensitivities_to_names_are_those_of_all_combinations() -> None:
    """With choices only, the variances follow from a few simulations, without a sample."""
    names, speeds = ["glass", "steel", "PMMA"], [0.3, 0.4, 0.5, 0.6]
    force = np.array([
        simulated({"plate.material": name, "impact.speed": speed}).max_force
        for name, speed in product(names, speeds)
    ]).reshape(3, 4)  # fmt: skip
    first = np.array([force.mean(1).var(), force.mean(0).var()]) / force.var()
    total = 1.0 - first[::-1]
    vary = {
        "plate.material": {"distribution": "choice", "values": names},
        "impact.speed": {"distribution": "choice", "values": speeds},
    }
    data = pc.sweep(STATIC, vary, sample=512, sensitivity=True).sel(result="max_force")
    assert data["key"].values.tolist() == list(vary)
    np.testing.assert_allclose(data["first_order"], first, atol=0.02)
    np.testing.assert_allclose(data["total_order"], total, atol=0.02)


def ticks(axes: Any) -> list[str]:
    """Return the labels below an axis."""
    return [text.get_text() for text in axes.get_xticklabels()]


def test_names_are_labelled_points_or_curves() -> None:
    data = pc.sweep(STATIC, {"plate.material": ["steel", "_a/b $x^2$ = 'c' \"d\""]})
    [axes] = plots.figure(data, ["plate.material"], ["max_force"]).axes
    assert ticks(axes) == ["steel", " _a/b \\$x^2\\$ = 'c' \"d\""]
    assert axes.lines[0].get_linestyle() == "None"
    data = pc.sweep(STATIC, {"plate.material": ["steel", "PMMA"], "impact.speed": "2:4:3"})
    made = plots.figure(data, ["plate.material", "impact.speed"], ["max_force"])
    [axes], [legend] = made.axes, made.legends
    assert [text.get_text() for text in legend.get_texts()] == ["steel", "PMMA"]
    for line, name in zip(axes.lines, ["steel", "PMMA"], strict=True):
        np.testing.assert_allclose(line.get_xdata(), [2.0, 3.0, 4.0])
        expected = data["max_force"].sel({"plate.material": name}).values
        ratios = line.get_ydata() / expected  # the unit of the axis
        np.testing.assert_allclose(ratios, ratios[0])
    data = pc.sweep(STATIC, {"plate.edge": "paper,clamped", "plate.material": "steel,PMMA,ice"})
    made = plots.figure(data, ["plate.edge", "plate.material"], ["max_force"])
    assert ticks(made.axes[0]) == ["paper", "clamped"]
    assert len(made.legends[0].get_texts()) == 3


def test_an_unknown_error_is_not_drawn_as_zero() -> None:
    data = pc.sweep(STATIC, {"plate.material": ["steel", "PMMA"]})
    data["bound"][1] = data["max_force_error"][1] = np.inf
    made = plots.figure(data, ["plate.material"], ["max_force"])
    [bars] = made.axes[0].containers[0].lines[2]
    assert [len(ends) for ends in bars.get_segments()] == [2, 0]
    assert made.get_suptitle() == "1 of 2 points have no error bound"


def test_points_of_a_sample_are_not_connected() -> None:
    vary = read_distributions({
        "plate.material": {"distribution": "choice", "values": ["steel", "PMMA"]},
        "impact.speed": {"distribution": "uniform", "low": 0.2, "high": 0.5},
    })  # fmt: skip
    data = pc.sweep(STATIC, vary, sample=8, method="sobol")
    made = plots.figure(data, list(vary), ["max_force", "contact_time"])
    assert {line.get_linestyle() for line in made.axes[0].lines} == {"None"}
    assert plots.render(data, list(vary), ["max_force"], ".png").startswith(b"\x89PNG")


def test_maps_have_no_legend() -> None:
    vary = {"impact.speed": [0.5, 1.0], "plate.thickness": [0.05, 0.1]}
    made = plots.figure(pc.sweep(STATIC, vary), list(vary), ["max_force"])
    assert not made.legends


def test_forecast_includes_every_name(tmp_path: Path) -> None:
    scene, path = tmp_path / "scene.toml", tmp_path / "forecast.json"
    scene.write_text(
        '[sphere]\nradius = 0.01\nmaterial = "steel"\n[plate]\nradius = 0.3\nthickness = 0.05\n'
        'material = "glass"\n[impact]\nspeed = 0.5\n[effects]\ninertia = false\n'
    )
    vary = ["--vary", "plate.edge=paper,clamped,simply-supported", "--vary", "impact.speed=1:2:100"]
    assert main(["sweep", str(scene), *vary, "--explain", "--json", str(path)]) == 0
    data = json.loads(path.read_text())
    assert (data["points"], data["probes"], data["effects"]["edge"]) == (300, 6, 4)


@pytest.mark.parametrize("speeds", ["0.01:30:8:log", "1:5:3:log", "0.2:40:4:log", "1e-4:1e4:9:log"])
def test_numbers_of_a_logarithmic_axis_do_not_overlap(speeds: str) -> None:
    data = pc.sweep(STATIC, {"impact.speed": speeds})
    made = plots.figure(data, ["impact.speed"], ["max_force", "restitution", "contact_time"])
    made.canvas.draw()
    for axes in made.axes:
        boxes = [text.get_window_extent() for text in axes.get_xticklabels() if text.get_text()]
        left, right = axes.bbox.x0 - 1.0, axes.bbox.x1 + 1.0
        seen = [box for box in boxes if left <= 0.5 * (box.x0 + box.x1) <= right]
        assert len(seen) >= 2
        assert all(one.x1 < other.x0 for one, other in pairwise(seen))
