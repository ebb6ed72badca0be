"""The command `examples`: every example in a line, copies that load, nothing replaced unasked."""

import json
import tomllib
from pathlib import Path

import pytest

from derivation.cli import main
from derivation.engine.files import ROOT
from derivation.scene import load
from derivation.scene.example_scenes import FOLDER, examples

Captured = pytest.CaptureFixture[str]
NAMES = sorted(path.stem for path in FOLDER.glob("*.toml"))


def test_each_example_is_a_line_with_its_first_comment(capsys: Captured) -> None:
    assert len(NAMES) >= 9
    assert main(["examples"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert all(len(line) <= 80 for line in lines)
    for name in NAMES:
        [line] = [line for line in lines if line.startswith(f"{name} ")]
        description = line.removeprefix(name).strip()
        assert description.endswith("."), "a whole sentence"
        assert (FOLDER / f"{name}.toml").read_text().startswith(f"# {description}\n")


def test_json_names_files_that_load(capsys: Captured) -> None:
    assert main(["examples", "--json", "-"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["name"] for row in rows] == NAMES
    for row in rows:
        load(Path(row["file"]))


def test_copies_are_the_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert main(["examples", *NAMES, "--out", str(tmp_path / "new" / "scenes")]) == 0
    monkeypatch.chdir(tmp_path)
    assert main(["examples", "paper.toml"]) == 0
    for name in NAMES:
        copied = tmp_path / "new" / "scenes" / f"{name}.toml"
        assert copied.read_bytes() == (FOLDER / copied.name).read_bytes()
    assert Path("paper.toml").read_bytes() == (FOLDER / "paper.toml").read_bytes()


def test_a_file_that_exists_is_kept_unless_forced(tmp_path: Path, capsys: Captured) -> None:
    (tmp_path / "paper.toml").write_text("mine")
    both = ["examples", "block", "paper", "--out", str(tmp_path)]
    assert main(both) == 2
    assert str(tmp_path / "paper.toml") in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["paper.toml"], "all or none"
    assert (tmp_path / "paper.toml").read_text() == "mine"
    assert main([*both, "--force"]) == 0
    assert load(tmp_path / "paper.toml") == load(FOLDER / "paper.toml")


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["glas_pane"], "glass_pane?"),
        (["block", "qqqq"], "`platecontact examples` lists them"),
        (["../examples/block"], "../examples/block"),
        (["--out", "."], "--out"),
    ],
)
def test_a_wrong_name_is_one_line_and_writes_nothing(
    arguments: list[str], says: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: Captured,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(["examples", *arguments]) == 2
    [line] = capsys.readouterr().err.strip().splitlines()
    assert says in line
    assert list(tmp_path.iterdir()) == []


def test_an_installed_copy_has_them() -> None:
    """The patterns of the package data reach the examples and the markers of types."""
    data = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    package = ROOT / "derivation"
    taken = {
        path for pattern in data["package-data"]["derivation"] for path in package.glob(pattern)
    }
    assert {example.file for example in examples().values()} <= taken
    assert all("py.typed" in data["package-data"][name] for name in ("derivation", "platecontact"))
