"""Sweeps: each row is the simulation of its value; rejected values do not stop the sweep."""

import csv
import json
import math
import os
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest
from shared_scenes import PAPER

from derivation.cli import main
from derivation.scene import SceneError, load, read, simulate, sweep

Captured = pytest.CaptureFixture[str]


def test_rows_are_the_simulations_of_their_values(tmp_path: Path) -> None:
    path = tmp_path / "rows.csv"
    assert (
        main(["simulate", str(PAPER), "--sweep", "impact.speed=0.5:1.5:3", "--csv", str(path)]) == 0
    )
    with path.open() as stream:
        rows = list(csv.DictReader(stream))
    assert [float(row["impact.speed"]) for row in rows] == [0.5, 1.0, 1.5]
    for row in rows:
        data = load(PAPER).to_json() | {"impact": {"speed": float(row["impact.speed"])}}
        result = simulate(read(data))
        for name in ("contact_time", "max_force", "max_pressure"):
            assert float(row[name]) == getattr(result, name)
        assert row["effects"].split() == [r.name for r in result.effects.rows if r.included]


def test_key_replaces_its_alternative() -> None:
    result = sweep.run(load(PAPER), sweep.parse("plate.thickness=0.2:0.2:1"))
    assert result[0].results["max_force"] == simulate(load(PAPER)).max_force
    heavy = sweep.run(load(PAPER), sweep.parse("sphere.mass=1:2:2"))
    assert heavy[1].results["contact_time"] > heavy[0].results["contact_time"]


def test_sweep_uses_its_tolerance_in_all_simulations() -> None:
    [row] = sweep.run(load(PAPER), sweep.parse("impact.speed=1:1:1"), rtol=0.9)
    result = simulate(load(PAPER), rtol=0.9)
    assert row.results["contact_time"] == result.contact_time
    assert set(row.effects) == result.effects.law.effects
    accurate = simulate(load(PAPER))
    assert result.contact_time != accurate.contact_time
    assert result.accuracy.bound > accurate.accuracy.bound


def test_integers_are_swept_as_integers() -> None:
    plate = {"radius": 0.2, "thickness": 0.01, "material": "aluminium"}
    scene = read({"sphere": {"radius": 0.02, "material": "steel"}, "plate": plate,
                  "impact": {"speed": 1.0}})  # fmt: skip
    few, half, _ = sweep.run(scene, sweep.parse("inertia.modes=6:7:3"))
    assert 'expected "auto" or a whole number' in half.remark
    assert "inertia" in few.effects
    assert few.results


def test_rejected_value_is_a_row_and_the_sweep_continues(capsys: Captured) -> None:
    assert main(["simulate", str(PAPER), "--sweep", "impact.speed=-1:1:3", "--json", "-"]) == 0
    shown = capsys.readouterr()
    rows = json.loads(shown.out)
    assert [bool(row["results"]) for row in rows] == [False, False, True]
    assert "impact.speed: " in rows[0]["remark"]
    assert "at impact.speed = -1, and similarly at 1 other value: " in shown.err
    assert "impact.speed: " in rows[1]["remark"]


def test_sweep_of_only_rejected_values_fails_and_writes_no_file(
    tmp_path: Path, capsys: Captured
) -> None:
    csv_file, json_file = tmp_path / "rows.csv", tmp_path / "rows.json"
    arguments = ["simulate", str(PAPER), "--sweep", "impact.speed=-3:-1:3"]
    assert main([*arguments, "--csv", str(csv_file), "--json", str(json_file)]) == 2
    output = capsys.readouterr().err
    assert "impact.speed = -3" in output
    assert "all 3" in output
    assert list(tmp_path.iterdir()) == []


def test_values_may_be_listed_in_any_order() -> None:
    assert sweep.parse("impact.speed=0.5,3,1e-1").values == (0.5, 3.0, 0.1)
    evenly = sweep.parse("plate.thickness=0.1:0.3:3")
    assert sweep.parse("plate.thickness=0.1,0.2,0.3").values == pytest.approx(evenly.values)


@pytest.mark.parametrize("text", ["impact.sped=1:2:3", "Impact.speeds=1:2:3", "impact=1:2:3"])
def test_similar_key_is_suggested(text: str) -> None:
    with pytest.raises(SceneError, match=r"impact\.speed\?"):
        sweep.parse(text)


@pytest.mark.parametrize(
    "text",
    [
        "", "speed", "speed=1:2:3", "impact.sped=1:2:3", "plate.material=", "plate.material=a,,b",
        "impact.speed=1:2", "impact.speed=1:2:3:4", "impact.speed=1:2:x", "impact.speed=a:2:3",
        "impact.speed=1:2:0", "impact.speed=1:inf:3", "impact.speed=1:2:100001",
        "impact.speed=1,,2", "impact.speed=1,nan", "impact.speed=", "plate.edge=a\nb",
        "accuracy.outputs=max_force", "effects.compare_paper_motion=true", "materials.a.source=b",
    ],
)  # fmt: skip
def test_invalid_sweeps_give_one_message(text: str) -> None:
    with pytest.raises(SceneError, match=r"^sweep: ") as caught:
        sweep.parse(text)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("key", "other"),
    [("plate.E", "plate.youngs_modulus"), ("sphere.diameter", "sphere.radius"),
     ("impact.height", "impact.speed"), ("materials.my ice.rho", "materials.my ice.density")],
)  # fmt: skip
def test_another_name_of_a_key_is_explained_as_in_a_scene(key: str, other: str) -> None:
    """An earlier message asked whether plate.E meant plate.edge."""
    with pytest.raises(SceneError, match=rf"^sweep: {key}: unknown key: .*{other}"):
        sweep.parse(f"{key}=1:2:3")


def test_too_many_values_of_a_key_name_a_way_to_more_points() -> None:
    with pytest.raises(SceneError, match=r"100000 values of a key.*several keys, or --sample N$"):
        sweep.parse("impact.speed=1:2:100000000")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("plate.material=steel,stel", "did you mean steel?"),
        ("plate.material=1:2:3", "expected the name of a material"),
        ("plate.edge=1:2:3", '"simply-supported" or "clamped"'),
        ("effects.bending=0:1:2", "true or false"),
    ],
)
def test_unknown_names_are_rejected_before_a_simulation(
    text: str, message: str, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The message is that of `simulate`."""
    key, wrong = text.split("=")[0], text.split("=")[1].split(",")[-1]
    table, name = key.split(".")
    tables = load(PAPER).to_json()
    for other in ("lame_lambda", "lame_mu") if name == "material" else ():
        del tables["plate"][other]
    with pytest.raises(SceneError) as caught:
        read(tables | {table: tables.get(table, {}) | {name: wrong}})
    assert message in str(caught.value)
    monkeypatch.setattr(sweep, "simulate", None)
    assert main(["simulate", str(PAPER), "--sweep", text]) == 2
    assert str(caught.value).removeprefix("scene: ") in capsys.readouterr().err


def test_rows_of_names_are_the_simulations_of_their_scenes(tmp_path: Path) -> None:
    path = tmp_path / "rows.csv"
    assert (
        main(["simulate", str(PAPER), "--sweep", "plate.material=PMMA, ice", "--csv", str(path)])
        == 0
    )
    with path.open() as stream:
        rows = list(csv.DictReader(stream))
    assert [row["plate.material"] for row in rows] == ["PMMA", "ice"]
    for row in rows:
        data = load(PAPER).to_json()
        plate = {"radius": 1.0, "half_thickness": 0.1, "material": row["plate.material"]}
        assert float(row["max_force"]) == simulate(read(data | {"plate": plate})).max_force


def test_effects_are_switched_by_their_names() -> None:
    rows = sweep.run(load(PAPER), sweep.parse("effects.bending=auto,true,false"))
    assert ["bending" in row.effects for row in rows] == [True, True, False]


def test_plot_of_a_sweep_is_rejected(capsys: Captured) -> None:
    arguments = ["simulate", str(PAPER), "--sweep", "impact.speed=1:2:2", "--plot", "x.pdf"]
    assert main(arguments) == 2
    assert "--sweep" in capsys.readouterr().err


def test_parallel_sweep_gives_the_same_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    scene, span = load(PAPER), sweep.parse("impact.speed=0.5:1:4")
    alone = sweep.run(scene, span)
    monkeypatch.setattr(sweep, "LONG", 0.0)
    assert sweep.run(scene, span, workers=2) == alone


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="signals cannot be blocked")
def test_worker_processes_ignore_ctrl_c() -> None:
    """Ctrl-C is blocked in starting processes, which would otherwise print a traceback."""
    program = "import signal; print(signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, ()))"

    def interrupts_are_blocked() -> str:
        call = [sys.executable, "-c", program]
        return subprocess.run(call, capture_output=True, text=True, check=True).stdout.strip()

    with sweep.unheard_interrupts():
        assert interrupts_are_blocked() == "True"
    assert interrupts_are_blocked() == "False"


def test_killed_worker_process_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweep, "LONG", 0.0)
    monkeypatch.setattr(sweep, "_leave_interrupts", partial(os._exit, 1))
    with pytest.raises(SceneError, match=r"^sweep: .*fewer values"):
        sweep.run(load(PAPER), sweep.parse("impact.speed=0.5:1:4"), workers=2)


def test_each_result_has_its_own_digits_and_an_unknown_one_has_none() -> None:
    known = dict.fromkeys(sweep.UNITS, 1.2345)
    rows = [
        sweep.SweepRow(
            1.0, known | {"max_tensile_stress": math.nan}, (), "", dict.fromkeys(sweep.UNITS, 4)
        ),
        sweep.SweepRow(
            2.0, known, (), "", dict.fromkeys(sweep.UNITS, 4) | {"max_tensile_stress": 2}
        ),
    ]
    table = sweep.to_text(sweep.parse("impact.speed=1:2:2"), rows).splitlines()
    cells = [line.split() for line in table[2:4]]
    assert [row[-1] for row in cells] == ["n/a", "1.2"]
    assert all(row[1] in ("1.234", "1.235") for row in cells)
