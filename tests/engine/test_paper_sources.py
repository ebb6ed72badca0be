"""Sources of a paper: a proof is repeated if any file that the paper imports has changed."""

import re
from pathlib import Path

import pytest

from derivation.cli import main
from derivation.engine.files import files_of_paper

RIGHT, WRONG = "(sp.sinh(T) + T)", "(sp.sinh(T) + 2 * T)"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A paper with its theory in a subfolder."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    folder = tmp_path / "film"
    assert main(["new", str(folder)]) == 0
    (folder / "steps").mkdir()
    (folder / "steps" / "__init__.py").touch()
    theory = (folder / "theory.py").read_text()
    (folder / "steps" / "theory.py").write_text(theory.replace("from .voc", "from ..voc"))
    (folder / "theory.py").unlink()
    paper = (folder / "paper.py").read_text()
    (folder / "paper.py").write_text(paper.replace("from .theory", "from .steps.theory"))
    return folder


def test_a_false_formula_in_a_subfolder_is_found_after_a_cached_proof(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    derive = ["derive", "--paper", str(folder)]
    assert main(derive) == 0
    theory = folder / "steps" / "theory.py"
    text = theory.read_text()
    assert text.count(RIGHT) == 1
    theory.write_text(text.replace(RIGHT, WRONG))
    capsys.readouterr()
    assert main(derive) == 1
    assert "Film, slipping: closed form leaves the residual" in capsys.readouterr().err


def test_a_data_file_is_a_source(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    derive = ["derive", "--paper", str(folder)]
    factor = folder / "steps" / "factor.csv"
    factor.write_text("1")
    theory = folder / "steps" / "theory.py"
    read = 'Path(__file__).with_name("factor.csv").read_text()'
    read = f"(sp.sinh(T) + sp.Integer({read}) * T)"
    text = theory.read_text().replace(RIGHT, read)
    theory.write_text(text.replace("import sympy", "from pathlib import Path\n\nimport sympy"))
    assert main(derive) == 0
    factor.write_text("2")
    capsys.readouterr()
    assert main(derive) == 1
    assert "Film, slipping: closed form leaves the residual" in capsys.readouterr().err


def test_generated_files_are_no_sources(folder: Path) -> None:
    before = files_of_paper(folder)
    for name in ("generated", "reports", ".hidden", "__pycache__"):
        (folder / name).mkdir()
        (folder / name / "file.py").touch()
    assert files_of_paper(folder) == before
    assert {path.name for path in before} >= {"budgets.toml", "paper.py", "theory.py"}


@pytest.mark.parametrize("place", ["subfolder", "another folder"])
def test_a_file_that_is_not_one_of_the_sources_is_rejected(
    place: str,
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    paper = folder / "paper.py"
    if place == "subfolder":
        text = paper.read_text()
        assert text.count("*files_of_paper(HERE)") == 1
        paper.write_text(text.replace("*files_of_paper(HERE)", '*sorted(HERE.glob("*.py"))'))
    else:
        other = folder.parent / "other"
        other.mkdir()
        (other / "shared_mechanics.py").touch()
        monkeypatch.syspath_prepend(str(other))
        paper.write_text(f"{paper.read_text()}\nimport shared_mechanics\n")
    capsys.readouterr()
    assert main(["derive", "--paper", str(folder)]) == 2
    said = " ".join(capsys.readouterr().err.split())
    file = "__init__" if place == "subfolder" else "shared_mechanics"
    assert re.search(rf"film imports .*{file}\.py, which is not one of its sources; write", said)
