"""The commands `simulate` and `indent`: files, exit status, messages, and imported modules."""

import csv
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from shared_scenes import PAPER

from derivation.cli import main
from derivation.scene import load, schema, simulate
from derivation.scene.output.answer import quantities
from derivation.scene.output.plot import figure, render, scaled

SIGNATURES = {b"\x89PNG": ".png", b"%PDF": ".pdf", b"<?xml": ".svg"}
MODULES = """
import json, sys
from derivation.cli import main
status = main(sys.argv[1:])
print(json.dumps([status, sorted({name.split(".")[0] for name in sys.modules})]))
"""
Captured = pytest.CaptureFixture[str]


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "scene.toml"
    path.write_bytes(PAPER.read_bytes())
    return path


def test_simulate_prints_the_result(scene: Path, capsys: Captured) -> None:
    assert main(["simulate", str(scene)]) == 0
    shown = capsys.readouterr()
    result = simulate(load(scene))
    assert shown.out == f"{result}\n"
    for name, value, unit in quantities(result):
        assert re.search(rf"^{re.escape(name)} +{re.escape(value)} ?{unit}$", shown.out, re.M)
    assert shown.err == ""


def test_printed_json_equals_the_python_result(scene: Path, capsys: Captured) -> None:
    assert main(["simulate", str(scene), "--json", "-"]) == 0
    assert json.loads(capsys.readouterr().out) == simulate(load(scene)).to_json()


def test_simulate_writes_all_files(scene: Path) -> None:
    folder = scene.parent / "out"
    names = ["--json", f"{folder}/r.json", "--csv", f"{folder}/r.csv", "--plot", f"{folder}/r.svg"]
    assert main(["simulate", str(scene), *names]) == 0
    assert sorted(path.name for path in folder.iterdir()) == ["r.csv", "r.json", "r.svg"]
    result = simulate(load(scene))
    assert json.loads((folder / "r.json").read_text()) == result.to_json()
    with (folder / "r.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert list(rows[0]) == ["time", "indentation", "velocity", "contact_radius", "force"]
    for name, column in result.history()._asdict().items():
        np.testing.assert_array_equal([float(row[name]) for row in rows], column)


def test_schema_is_written_and_printed(tmp_path: Path, capsys: Captured) -> None:
    assert main(["schema", "--out", str(tmp_path / "scene.schema.json")]) == 0
    assert main(["schema"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed == json.loads((tmp_path / "scene.schema.json").read_text()) == schema()


@pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf", ".PNG"])
def test_plot_is_reproducible(suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    result = simulate(load(PAPER))
    for name, time in (("one", "0"), ("two", "1000000000")):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", time)
        (tmp_path / f"{name}{suffix}").write_bytes(render(result, suffix))
    content = (tmp_path / f"one{suffix}").read_bytes()
    assert content == (tmp_path / f"two{suffix}").read_bytes()
    assert [kind for signature, kind in SIGNATURES.items() if content.startswith(signature)] == [
        suffix.lower()
    ]


def test_plot_shows_the_computed_curves() -> None:
    result = simulate(load(PAPER))
    axes = figure(result).axes
    labels = [(panel.get_xlabel(), panel.get_ylabel()) for panel in axes]
    assert [(x.split(" [")[0], y.split(" [")[0]) for x, y in labels] == [
        ("time $t$", r"indentation $\delta$"),
        ("time $t$", "sphere velocity $v$"),
        ("time $t$", "contact force $P$"),
        (r"indentation $\delta$", "contact force $P$"),
        ("distance from the axis $r$", "contact pressure $p$"),
    ]
    assert labels[0] == ("time $t$ [ms]", r"indentation $\delta$ [mm]")
    x, y = axes[3].lines[0].get_data()
    np.testing.assert_allclose(np.max(x), 1e3 * result.max_indentation, rtol=1e-4)
    np.testing.assert_allclose(np.max(y), 1e-3 * result.max_force, rtol=1e-4)


@pytest.mark.parametrize(
    ("value", "factor", "label"),
    [
        (0.0, 1, "x [m]"),
        (0.999, 1e3, "x [mm]"),
        (1.0, 1, "x [m]"),
        (-2e4, 1e-3, "x [km]"),
        (3e-6, 1e6, "x [µm]"),
        (1e-30, 1e9, "x [nm]"),
        (1e30, 1e-9, "x [Gm]"),
    ],
)
def test_labels_have_a_unit_with_a_suitable_prefix(value: float, factor: float, label: str) -> None:
    values, scaled_label = scaled(np.array([0.0, value]), "x", "m")
    assert scaled_label == label
    assert values[1] == pytest.approx(value * factor, rel=1e-15)


@pytest.mark.parametrize(
    "values",
    [
        ["--force", "10", "100", "1e3"],
        ["--force", "10,100,1e3"],
        ["--force", "10", "--force", "100", "--force", "1e3"],
        ["--force=10", "100,1e3"],
    ],
)
def test_indent_accepts_several_values(values: list[str], scene: Path, capsys: Captured) -> None:
    assert main(["indent", str(scene), *values, "--json", "-"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["force"] for row in rows] == [10, 100, 1000]
    assert list(rows[0]) == [
        "contact_radius", "indentation", "force", "stiffness", "max_pressure", "model_error",
        "warnings", "force_error", "stretched",
    ]  # fmt: skip


def test_indent_accepts_the_scene_as_last_argument(scene: Path, capsys: Captured) -> None:
    assert main(["indent", "--json", "-", "--force", "10", str(scene)]) == 0
    assert [row["force"] for row in json.loads(capsys.readouterr().out)] == [10]


@pytest.mark.parametrize("option", ["contact-radius", "indentation"])
def test_indent_prints_a_table(option: str, scene: Path, capsys: Captured) -> None:
    assert main(["indent", str(scene), f"--{option}", "0.00125"]) == 0
    assert "0.00125" in capsys.readouterr().out


def test_warnings_are_printed_in_addition_to_the_result(scene: Path, capsys: Captured) -> None:
    scene.write_text(scene.read_text().replace("half_thickness = 0.1", "half_thickness = 0.01"))
    assert main(["simulate", str(scene), "--json", "-"]) == 0
    shown = capsys.readouterr()
    warnings = json.loads(shown.out)["warnings"]
    assert "a/H" in warnings[0]
    assert shown.err.startswith("warning: ")
    assert main(["indent", str(scene), "--contact-radius", "0.01", "0.0101"]) == 0
    assert capsys.readouterr().err.count("a/H") == 2


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["simulate", "absent.toml"], "absent.toml: "),
        (["simulate"], "SCENE.toml"),
        (["simulate", "bad.toml"], "plate.radius: "),
        (["simulate", "fast.toml"], "impact.speed: "),
        (["simulate", "scene.toml", "--plot", "x.gif"], ".gif"),
        (["simulate", "scene.toml", "--plot", "x"], ".svg"),
        (["simulate", "scene.toml", "--csv", "scene.toml"], "scene.toml: "),
        (["simulate", "scene.toml", "--json", "./scene.toml"], "scene.toml: "),
        (["simulate", "scene.toml", "--csv", "x.txt", "--json", "x.txt"], "x.txt: "),
        (["simulate", "scene.toml", "--csv", "x.svg"], "suffix .csv"),
        (["simulate", "scene.toml", "--json", "."], "got a folder"),
        (["simulate", "scene.toml", "--csv", "/proc/nowhere/x.csv"], "/proc/nowhere"),
        (["simulate", "scene.toml", "--csv", "-"], "--json"),
        (["simulate", "scene.toml", "extra"], "extra"),
        (["simulate", "scene.toml", "--rtol", "1e-14"], "reference SCENE.toml --digits N"),
        (["simulate", "scene.toml", "--rtol", "nan"], "rtol: "),
        (["simulate", "scene.toml", "--rtol", "0"], "rtol: "),
        (["simulate", "scene.toml", "--rtol", "1.5"], "rtol: "),
        (["simulate", "scene.toml", "--rtol", "fine"], "'--rtol'"),
        (["indent", "scene.toml"], "--contact-radius, --force and --indentation"),
        (["indent", "scene.toml", "5"], "--contact-radius, --force and --indentation"),
        (
            ["indent", "scene.toml", "--force", "1", "--indentation", "1"],
            "--force and --indentation",
        ),
        (["indent", "scene.toml", "--force", "-5"], "got -5"),
        (["indent", "scene.toml", "--force", "nan"], "got nan"),
        (["indent", "scene.toml", "--force", "ten"], "--force: "),
        (["indent", "scene.toml", "--contact-radius", "1,"], "--contact-radius: "),
        (["indent", "scene.toml", "--contact-radius", "1"], "min(b, R) = 0.13 m"),
        (["indent", "scene.toml", "--force", "5", "--json", "scene.toml"], "scene.toml: "),
    ],
)
def test_invalid_input_gives_one_message_and_changes_no_file(
    arguments: list[str],
    expected: str,
    scene: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: Captured,
) -> None:
    monkeypatch.chdir(scene.parent)
    Path("bad.toml").write_text(PAPER.read_text().replace("radius = 1.0", "radius = -1.0"))
    Path("fast.toml").write_text(PAPER.read_text().replace("speed = 1.0", "speed = 1e9"))
    before = {path: path.read_bytes() for path in Path().iterdir()}
    outputs = ["--json", "out.json"] if "--json" not in arguments else []
    assert main([*arguments, *outputs]) == 2
    shown = capsys.readouterr()
    assert expected in shown.err
    assert shown.err.startswith("platecontact: ")
    assert "Traceback" not in shown.err
    assert {path: path.read_bytes() for path in Path().iterdir()} == before


@pytest.mark.parametrize(
    "arguments",
    [
        ["simulate", str(PAPER), "--json", "-"],
        ["simulate", str(PAPER), "--json", "-", "--rtol", "1e-3"],
        ["indent", str(PAPER), "--force", "10", "--json", "-"],
        ["simulate", str(PAPER), "--csv", "history.csv"],
    ],
)
def test_simulation_does_not_import_slow_packages(arguments: list[str], tmp_path: Path) -> None:
    loaded = _modules(arguments, tmp_path)
    assert not loaded & {"sympy", "flint", "mpmath", "jinja2", "matplotlib", "scipy"}
    assert {"numpy", "pydantic", "generated"} <= loaded


def test_plot_imports_matplotlib_but_not_sympy(tmp_path: Path) -> None:
    loaded = _modules(["simulate", str(PAPER), "--plot", "x.svg"], tmp_path)
    assert "matplotlib" in loaded
    assert not loaded & {"sympy", "flint", "mpmath", "jinja2"}


def test_help_does_not_import_the_scene_package(tmp_path: Path) -> None:
    assert not _modules(["--help"], tmp_path) & {"numpy", "pydantic", "generated"}


def _modules(arguments: list[str], folder: Path) -> set[str]:
    """Return the packages that a new interpreter has imported after a command."""
    run = subprocess.run(
        [sys.executable, "-c", MODULES, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
    )
    status, loaded = json.loads(run.stdout.splitlines()[-1])
    assert status == 0
    return set(loaded)
