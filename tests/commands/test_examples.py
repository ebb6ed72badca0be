"""The command `examples`: the list, copies of the files, and protection of existing files."""

import json
import tomllib
from pathlib import Path

import pytest

from derivation.cli import main
from derivation.engine.files import ROOT
from derivation.scene import load
from derivation.scene.input.example_scenes import FOLDER, examples

Captured = pytest.CaptureFixture[str]
NAMES = sorted(path.stem for path in FOLDER.glob("*.toml"))


def test_each_example_is_listed_with_its_first_comment(capsys: Captured) -> None:
    assert len(NAMES) >= 9
    assert main(["examples"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert all(len(line) <= 80 for line in lines)
    for name in NAMES:
        [line] = [line for line in lines if line.startswith(f"{name} ")]
        description = line.removeprefix(name).strip()
        assert description.endswith("."), "not a complete sentence"
        assert (FOLDER / f"{name}.toml").read_text().startswith(f"# {description}\n")


def test_json_names_files_that_load(capsys: Captured) -> None:
    assert main(["examples", "--json", "-"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["name"] for row in rows] == NAMES
    for row in rows:
        load(Path(row["file"]))


def test_copies_equal_the_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert main(["examples", *NAMES, "--out", str(tmp_path / "new" / "scenes")]) == 0
    monkeypatch.chdir(tmp_path)
    assert main(["examples", "paper.toml"]) == 0
    for name in NAMES:
        copied = tmp_path / "new" / "scenes" / f"{name}.toml"
        assert copied.read_bytes() == (FOLDER / copied.name).read_bytes()
    assert Path("paper.toml").read_bytes() == (FOLDER / "paper.toml").read_bytes()


def test_existing_file_is_kept_without_force(tmp_path: Path, capsys: Captured) -> None:
    (tmp_path / "paper.toml").write_text("mine")
    both = ["examples", "block", "paper", "--out", str(tmp_path)]
    assert main(both) == 2
    assert str(tmp_path / "paper.toml") in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["paper.toml"], (
        "only some files were written"
    )
    assert (tmp_path / "paper.toml").read_text() == "mine"
    assert main([*both, "--force"]) == 0
    assert load(tmp_path / "paper.toml") == load(FOLDER / "paper.toml")


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["glas_pane"], "glass_pane?"),
        (["block", "qqqq"], "`platecontact examples` lists them"),
        (["../examples/block"], "../examples/block"),
        (["--out", "."], "--out"),
    ],
)
def test_unknown_name_gives_one_line_and_writes_no_file(
    arguments: list[str], expected: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: Captured,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(["examples", *arguments]) == 2
    [line] = capsys.readouterr().err.strip().splitlines()
    assert expected in line
    assert list(tmp_path.iterdir()) == []


def test_examples_are_in_the_package_data() -> None:
    """Examples and `py.typed` files match the patterns of the package data."""
    data = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    package = ROOT / "derivation"
    included = {
        path for pattern in data["package-data"]["derivation"] for path in package.glob(pattern)
    }
    assert {example.file for example in examples().values()} <= included
    assert all("py.typed" in data["package-data"][name] for name in ("derivation", "platecontact"))
