"""Old names of scene keys and values: read with one notice each, and never written."""

import json
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from shared_scenes import EXAMPLES, changed

from derivation.cli import main
from derivation.scene import Scene, SceneError, load, read, simulate, sweep
from derivation.scene.input.old_names import KEYS, REMOVED, VALUES, OldNameWarning
from derivation.scene.scene import TABLES

Tables = dict[str, dict[str, Any]]
GIVEN = {
    "plate.tensile_strength": 1e8,
    "plate.retardation_time": 1e-6,
    "effects.compare_paper_motion": True,
    "effects.finite_radius": True,
    "effects.non_hertzian_pressure": True,
    "effects.spherical_profile": True,
    "inertia.coupling": "pointwise",
    "inertia.extent": "infinite",
}
"""A value other than the default for each key that has an old name."""
OLD = [(old, new, GIVEN[new], GIVEN[new]) for old, new in KEYS.items()] + [
    (new, new, value, known) for (new, value), known in VALUES.items()
]
"""Old key, new key, value under the old key, value under the new key."""
IDS = [f"{old} {value}" for old, _, value, _ in OLD]


def scene(key: str, value: object) -> Tables:
    """Return tables with a key, with plate inertia if the key is in `inertia`."""
    table, name = key.split(".")
    tables = changed(effects={"spherical_profile": None, "non_hertzian_pressure": None})
    if table == "inertia":
        tables["plate"]["density"] = 2000.0
        tables["effects"] = {"inertia": True, "edge": False}
    tables.setdefault(table, {})[name] = value
    return tables


def notices(of: list[warnings.WarningMessage]) -> list[str]:
    return [str(item.message) for item in of if issubclass(item.category, OldNameWarning)]


@pytest.mark.parametrize(("old", "new", "value", "known"), OLD, ids=IDS)
def test_former_name_gives_the_same_scene_and_one_warning(
    old: str, new: str, value: object, known: object
) -> None:
    plain = read(scene(new, known))
    with pytest.warns(OldNameWarning) as caught:
        actual = read(scene(old, value))
    assert actual == plain
    assert actual.to_json() == plain.to_json()
    [notice] = notices(list(caught))
    assert old in notice
    assert new in notice
    assert notice.endswith(REMOVED)
    assert caught[0].filename == __file__


def test_only_new_names_are_keys() -> None:
    for old, new in KEYS.items():
        (table, name), (new_table, known) = old.split("."), new.split(".")
        assert table == new_table
        assert known in TABLES[table].model_fields
        assert name not in TABLES[table].model_fields


@pytest.mark.parametrize(("old", "new"), KEYS.items())
def test_both_names_together_are_rejected(old: str, new: str) -> None:
    tables = scene(new, GIVEN[new])
    table, name = old.split(".")
    tables[table][name] = GIVEN[new]
    with pytest.raises(SceneError, match=rf"{new}: .*{old}"):
        read(tables)


def test_former_value_of_a_former_key_gives_one_warning() -> None:
    with pytest.warns(OldNameWarning) as caught:
        actual = read(scene("inertia.plate", "modes"))
    assert actual == read(scene("inertia.extent", "finite"))
    assert len(notices(list(caught))) == 1


def test_other_problems_are_reported_with_both_names() -> None:
    tables = scene("plate.retardation_time", 1e-6)
    tables["plate"] |= {"viscous_time": 1e-6, "strength": -1.0, "colour": "red"}
    with pytest.warns(OldNameWarning), pytest.raises(SceneError) as caught:
        read(tables)
    for part in ("3 problems", "plate.viscous_time", "plate.tensile_strength", "plate.colour"):
        assert part in str(caught.value)


OLD_FILE = """
[sphere]
radius = 0.02
material = "steel"
[plate]
radius = 0.1
thickness = 0.03
youngs_modulus = 4e6
poissons_ratio = 0.45
viscous_time = 1e-3
strength = 1e6
edge = "soft-hinge"
[impact]
speed = 1.0
[effects]
pressure = false
curvature = false
side_wall = true
perturbation = true
inertia = false
"""
NEW_FILE = (
    OLD_FILE.replace("viscous_time", "retardation_time")
    .replace("strength", "tensile_strength").replace("soft-hinge", "paper")
    .replace("pressure", "non_hertzian_pressure").replace("curvature", "spherical_profile")
    .replace("side_wall", "finite_radius").replace("perturbation", "compare_paper_motion")
)  # fmt: skip


def test_file_with_former_names_gives_the_same_output(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shown = []
    for name, text in (("old", OLD_FILE), ("new", NEW_FILE)):
        (tmp_path / f"{name}.toml").write_text(text)
        assert main(["simulate", str(tmp_path / f"{name}.toml"), "--json", "-"]) == 0
        shown.append(capsys.readouterr())
    assert shown[0].out == shown[1].out
    assert json.loads(shown[0].out)["scene"]["plate"]["edge"] == "paper"
    notes = [line for line in shown[0].err.splitlines() if REMOVED in line]
    assert len(notes) == len(set(notes)) == 7
    assert all(line.startswith("note: ") for line in notes)
    assert REMOVED not in shown[1].err


def test_sweep_of_a_former_key_uses_the_new_key(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "scene.toml").write_text(NEW_FILE)
    rows = []
    for key in ("plate.viscous_time", "plate.retardation_time"):
        out = tmp_path / "rows.csv"
        command = ["simulate", str(tmp_path / "scene.toml"), "--sweep", f"{key}=1e-4:1e-3:2"]
        assert main([*command, "--csv", str(out)]) == 0
        rows.append((out.read_text(), capsys.readouterr().err.count(REMOVED)))
    assert rows[0][0] == rows[1][0]
    assert [count for _, count in rows] == [1, 0]
    with pytest.warns(OldNameWarning):
        assert sweep.parse("plate.strength=1:2:2").key == "plate.tensile_strength"


def test_load_gives_one_warning_for_former_names(tmp_path: Path) -> None:
    (tmp_path / "old.toml").write_text(OLD_FILE.replace("side_wall = true\n", ""))
    with pytest.warns(OldNameWarning) as caught:
        load(tmp_path / "old.toml")
    assert {item.filename for item in caught} == {__file__}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert main(["explain", str(tmp_path / "old.toml")]) == 0


def keys_and_values(actual: object) -> Iterator[tuple[str, object]]:
    """Yield each key of a JSON value with its value, at any depth."""
    if isinstance(actual, dict):
        for key, value in actual.items():
            yield key, value
            yield from keys_and_values(value)
    elif isinstance(actual, list):
        for value in actual:
            yield from keys_and_values(value)


def old_names_in(tables: object) -> list[str]:
    """Return the old keys and values in the tables of a scene."""
    assert isinstance(tables, dict)
    given = {f"{t}.{key}": value for t, keys in tables.items() for key, value in keys.items()}
    texts = {key: value for key, value in given.items() if isinstance(value, str)}
    return [k for k in given if k in KEYS] + [k for k, v in texts.items() if (k, v) in VALUES]


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
@pytest.mark.filterwarnings("error")
def test_examples_use_no_former_name(path: Path) -> None:
    load(path)


def test_results_contain_no_former_name() -> None:
    tables = scene("inertia.plate", "infinite")
    tables["effects"] |= {"perturbation": True, "curvature": False, "pressure": False}
    tables["plate"] |= {"strength": 1e8, "edge": "soft-hinge"}
    with pytest.warns(OldNameWarning):
        actual: Scene = read(tables)
    made = json.loads(json.dumps(simulate(actual).to_json()))
    assert old_names_in(made["scene"]) == []
    names = {old.partition(".")[2] for old in KEYS} - {"plate"}  # a key of the energy balance
    assert not {key for key, _ in keys_and_values(made)} & names
    assert not {row["name"] for row in made["effects"]} & names
