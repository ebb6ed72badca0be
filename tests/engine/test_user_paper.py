"""All stages for a paper of the user outside the checkout, each in a separate process."""

import json
import re
import shlex
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest
from forked import command
from guide import apply_examples

from derivation.engine import build
from derivation.engine.errata.findings import CORRECT
from derivation.engine.files import ROOT
from derivation.engine.formula.grid import inside
from derivation.engine.load import PaperError, create_paper, load
from derivation.engine.measure.kernels import generated_kernels
from derivation.plate.paper import PAPER

MISPRINT = r"\frac{\cosh T - 1}{\sinh T - T}"
BUILT = "build.txt"
"""What `build` prints for the paper."""
WORDS = re.compile(r"\b(plates?|spheres?)\b", re.IGNORECASE)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build a paper from the examples of the guide; all commands share a cache next to it."""
    path = tmp_path_factory.mktemp("own") / "my film"
    run("new", str(path), home=path.parent)
    assert apply_examples(path, paper=True) >= 12
    shown = run("build", "--paper", str(path), home=path.parent)
    (path.parent / BUILT).write_text(shown)
    timed = re.findall(r"✓ (\w+) +[\d.]+ s", shown)
    assert timed == ["derive", "rewrite", "generate", "misprints", "check", "report"]
    return path


def run(*arguments: str, home: Path, status: int = 0) -> str:
    """Return what a command prints in a separate process outside the checkout."""
    ended = command(*arguments, folder=home, environment={"XDG_CACHE_HOME": str(home / "cache")})
    assert ended.status == status, ended.err
    return ended.out + ended.err


def test_derive_lists_all_formulas(folder: Path) -> None:
    data = json.loads(
        run("derive", "--paper", str(folder), "--json", "-", home=folder.parent).split("✓")[0]
    )
    assert {row["name"] for row in data} == {
        "w_thin",
        *(f"{letter}_{base}" for letter in "CF" for base in ("bonded", "slipping")),
    }
    assert all(row["proof"]["residuals"] for row in data)


def test_package_is_up_to_date_and_needs_only_numpy(folder: Path, tmp_path: Path) -> None:
    assert "up to date" in run("generate", "--check", "--paper", str(folder), home=folder.parent)
    shutil.copytree(folder / "generated", tmp_path / "elastic_film")
    program = (
        "import sys, elastic_film; print(float(elastic_film.F_bonded(0.4, 2.0)));"
        "assert not {'derivation', 'sympy', 'scipy'} & set(sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    diagnosed = run(
        "diagnose", "F_bonded", "--formula", "F_bonded", "--at", "s=0.4,T=2", "--digits", "15",
        "--paper", str(folder), home=folder.parent,
    )  # fmt: skip
    assert f"{float(done.stdout):.12f}" in diagnosed


def test_algorithm_is_copied_and_needs_only_numpy(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder / "generated", tmp_path / "elastic_film")
    program = (
        "import sys, numpy as np, elastic_film as film; T = np.geomspace(1e-9, 3, 40);"
        "print(np.max(np.abs(film.T_slipping(film.F_slipping(T)) / T - 1)));"
        "assert np.isnan(film.T_slipping(np.array([-0.1, 1.1]))).all();"
        "assert not {'derivation', 'sympy', 'scipy'} & set(sys.modules)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert float(done.stdout) < 1e-14
    original = (folder / "inverse.py").read_text().replace(".generated.", ".").splitlines()
    copy = (folder / "generated" / "inverse.py").read_text().splitlines()
    assert [line for line in copy if not line.startswith("# ")] == original


def test_functions_pass_with_both_references(folder: Path) -> None:
    data = json.loads((folder / "reports" / "check.json").read_text())
    assert [row["kernel"] for row in data["rows"]] == [
        "F_bonded",
        "F_slipping",
        "C_slipping",
        "w_thin",
    ]
    assert all(row["passed"] and row["oracles"] == 2 for row in data["rows"])


def test_misprints_are_found_again_after_an_edit(folder: Path) -> None:
    def findings() -> dict[str, str]:
        shown = run("misprints", "--paper", str(folder), "--json", "-", home=folder.parent)
        return {row["name"]: row["kind"] for row in json.loads(shown.split("✓")[0])}

    misprint = {"w_thin": "constant ratio"}
    assert findings() == {**misprint, "F_bonded": CORRECT, "F_slipping": "sign"}
    printed = folder / "printed.py"
    wrong = printed.read_text()
    try:
        printed.write_text(wrong.replace("(sp.sinh(T) - T)", "(sp.sinh(T) + T)"))
        assert findings() == {**misprint, "F_bonded": CORRECT, "F_slipping": CORRECT}
    finally:
        printed.write_text(wrong)
    theory = folder / "theory.py"
    original = theory.read_text()
    try:
        theory.write_text(original.replace("(sp.sinh(T) + T)", "(sp.sinh(T) + 2 * T)"))
        shown = run("derive", "--paper", str(folder), home=folder.parent, status=1)
        assert "Film, slipping: closed form leaves the residual" in shown
    finally:
        theory.write_text(original)


def test_report_contains_misprints_and_formulas(folder: Path) -> None:
    text = (folder / "reports" / "report.tex").read_text()
    assert MISPRINT in text
    assert "Reverse the sign of the term" in text
    appendices = (folder / "reports" / "appendices.tex").read_text()
    assert r"\label{eq:C_bonded}" in appendices
    assert r"\subsection{Thin film}" in appendices
    page = (folder / "reports" / "report.html").read_text()
    assert "A film on a rigid base" in page
    for name in ("report", "appendices"):
        written = (folder / "reports" / f"{name}.pdf").is_file()
        assert written == (shutil.which("pdflatex") is not None)


def test_report_check_fragment_and_section(folder: Path, tmp_path: Path) -> None:
    paper = "--paper", str(folder)
    assert "up to date" in run("report", "--check", *paper, home=folder.parent)
    fragment = run("report", "--fragment", "F_slipping", *paper, home=folder.parent)
    assert r"\label{eq:F_slipping}" in fragment
    assert "equation~(4) of the paper" in fragment  # the example has no list of sources to cite
    run("report", "--section", "misprints", "--no-pdf", "--out", str(tmp_path), *paper,
        home=folder.parent)  # fmt: skip
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["report-misprints.html", "report-misprints.tex", "report.bib"]
    text = (tmp_path / "report-misprints.tex").read_text()
    assert MISPRINT in text
    assert r"\label{eq:C_bonded}" not in text
    edited = folder / "reports" / "report.tex"
    original = edited.read_text()
    try:
        edited.write_text(original + "% by hand")
        shown = run("report", "--check", *paper, home=folder.parent, status=1)
    finally:
        edited.write_text(original)
    assert f"platecontact report --paper {shlex.quote(str(folder))}" in shown


def test_rewrite_report_is_written(folder: Path) -> None:
    shown = run("rewrite", "--paper", str(folder), "--update", home=folder.parent)
    assert "F_slipping" in shown
    rows = json.loads((folder / "reports" / "rewrite.json").read_text())["rows"]
    assert "F_slipping" in [row["name"] for row in rows]
    kernels = folder / "kernels.py"
    original = kernels.read_text()
    try:
        added = original.replace(
            'REWRITTEN = ("F_slipping"', 'REWRITTEN = ("F_bonded", "F_slipping"'
        )
        kernels.write_text(added)
        shown = run("rewrite", "--paper", str(folder), home=folder.parent)
    finally:
        kernels.write_text(original)
    assert added != original
    assert "F_slipping" in shown  # F_bonded depends on two arguments and has no row
    assert "F_bonded" not in shown


def test_smaller_budgets_are_suggested_but_not_written(folder: Path) -> None:
    before = (folder / "budgets.toml").read_text()
    shown = run("check", "--paper", str(folder), "--suggest-budgets", "--json", "-",
                home=folder.parent)  # fmt: skip
    data = json.loads(shown.split("✓")[0])
    budgets = {row["kernel"]: row["budget"] for row in data["rows"]}
    assert all(ulp < budgets[name] for name, ulp in data["suggested_budgets"].items())
    assert (folder / "budgets.toml").read_text() == before


def test_search_finds_no_error_beyond_the_budgets(folder: Path, tmp_path: Path) -> None:
    out = str(tmp_path / "worst.toml")
    shown = run("check", "search", "--paper", str(folder), "--time", "1s", "--out", out, "--json",
                "-", home=folder.parent)  # fmt: skip
    rows = json.loads(shown[: shown.rindex("}") + 1])["rows"]
    assert {row["kernel"] for row in rows} >= {"F_bonded", "F_slipping", "C_slipping"}
    assert all(row["evaluations"] > 100 and 0.2 < row["ratio"] <= 1 for row in rows)
    # The project's own paper, whose modules cache proofs when they are imported, is not loaded.
    assert not [*(folder.parent / "cache").rglob("derivation.plate*")]


def test_check_and_search_find_a_budget_that_is_too_small(folder: Path, tmp_path: Path) -> None:
    paper = tmp_path / "too small"
    shutil.copytree(folder, paper)
    budgets = (paper / "budgets.toml").read_text()
    (paper / "budgets.toml").write_text(budgets.replace("F_bonded = 6", "F_bonded = 3"))
    run("generate", "--paper", str(paper), home=folder.parent)
    assert "NO" in run("check", "--paper", str(paper), home=folder.parent, status=1)
    search = ["check", "search", "--paper", str(paper), "--function", "F_bonded", "--time", "1s"]
    run(*search, home=folder.parent, status=1)
    assert "F_bonded = {" in (paper / "reports" / "search.toml").read_text()


def test_functions_without_an_independent_reference_are_named(folder: Path, tmp_path: Path) -> None:
    """The report counts only the points at which an independent method was evaluated."""
    said = "No independent reference confirms F_slipping, C_slipping: add one to ROUTES."
    confirmed = "points a second, independent reference gave the same digits"
    every = (folder / "reports" / "report.tex").read_text()
    assert said not in (folder.parent / BUILT).read_text()
    paper = tmp_path / "fewer routes"
    shutil.copytree(folder, paper)
    text = (paper / "route.py").read_text()
    for name in ("F_slipping", "C_slipping"):
        text = re.sub(rf'    "{name}": .*\n', "", text)
    (paper / "route.py").write_text(text)
    assert said in run("build", "--paper", str(paper), home=folder.parent)
    fewer = (paper / "reports" / "report.tex").read_text()
    assert f"At 8 {confirmed}" in every
    assert f"At 4 {confirmed}" in fewer


def test_hard_cases_are_compared_with_recorded_references(folder: Path, tmp_path: Path) -> None:
    paper = tmp_path / "hard"
    shutil.copytree(folder, paper)
    command = "check", "hard-cases", "--paper", str(paper)
    assert "hard-cases --update" in run(*command, home=folder.parent, status=2)
    assert "2 cases, 0 failed" in run(*command, "--update", home=folder.parent)
    assert "2 cases, 0 failed" in run(*command, home=folder.parent)
    code = paper / "generated" / "film.py"
    text = code.read_text()
    code.write_text(text.replace("np.exp(-2 * x)", "np.exp(-2.001 * x)"))
    assert "failed" in run(*command, home=folder.parent, status=1)
    code.write_text(text)
    cases = paper / "hard_cases.toml"
    written = cases.read_text()
    for wrong, message in (
        (written.replace("F_slipping", "F_sliding"), "did you mean F_slipping?"),
        (written.replace("s = 1e-12, ", ""), "F_bonded: expected the arguments T, s, got T"),
    ):
        assert wrong != written
        cases.write_text(wrong)
        said = " ".join(run(*command, home=folder.parent, status=2).split())
        assert message in said.replace("s, T", "T, s")
    judged = paper / "paper.py"
    judged.write_text(judged.read_text().replace(', HERE / "hard_cases.toml"', ""))
    said = run(*command, home=folder.parent, status=2)
    assert "expected a paper with hard cases, got none" in said


def test_invalid_papers_are_rejected(folder: Path, tmp_path: Path) -> None:
    said = run("derive", "--paper", str(tmp_path), home=tmp_path, status=2)
    assert "expected a folder with a file paper.py" in said
    assert "`platecontact new NAME`" in said  # `new` rejects a folder with other files
    assert "expected an empty folder" in run("new", str(folder), home=tmp_path, status=2)
    for text, message in (
        ("import nothing_of_that_name", "paper.py, line 1: ModuleNotFoundError: No module"),
        ("PAPER = 1 +", "cannot be imported: SyntaxError"),
        ("", "AttributeError: .* has no attribute 'PAPER'"),
        ("PAPER = 1", "expected PAPER to be a Paper, got int"),
    ):
        (tmp_path / "paper.py").write_text(text)
        with pytest.raises(PaperError, match=message):
            load(tmp_path)


def test_missing_files_are_named(tmp_path: Path) -> None:
    create_paper(tmp_path / "film")
    paper = load(tmp_path / "film")
    with pytest.raises(FileNotFoundError, match="run `platecontact generate`"):
        build.check(paper)
    with pytest.raises(FileNotFoundError, match="run `platecontact generate`"):
        build.search(paper, "1s")
    with pytest.raises(FileNotFoundError, match="run `platecontact check --update`"):
        build.report(paper)
    with pytest.raises(ValueError, match="no section 'law': expected one of misprints"):
        build.report(paper, sections=["law"])


def test_grids_are_inside_the_domain_and_reproducible(folder: Path) -> None:
    paper = load(folder)
    judge = paper.judge()
    target = paper.package().target
    rows = {row["name"]: row for row in import_module(f"{target}.manifest").KERNELS}
    for kernel in generated_kernels(target):
        least = 10.0 ** -(rows[kernel.name].get("decades") or 50)  # the stated range
        points = judge.grid(kernel.name, kernel.arguments, False)
        assert points == judge.grid(kernel.name, kernel.arguments, False)
        assert all(inside(paper.vocabulary, point.values) for point in points)
        for name in kernel.arguments:
            assert min(point.values[name] for point in points) <= 10 * least


def test_paper_of_the_project_uses_the_same_interface() -> None:
    assert build.formulas(PAPER)["G"].unit == "1"
    assert build.diagnose(PAPER, "G", "G").verdict == "equal"
    assert PAPER.judge().package == PAPER.package().target == "generated"
    assert "law" in PAPER.report().plan.sections


def test_engine_does_not_mention_plate_or_sphere() -> None:
    """This includes its templates."""
    actual = [path for path in (ROOT / "derivation" / "engine").rglob("*") if path.is_file()]
    assert len(actual) > 100
    for path in actual:
        if path.suffix in (".py", ".j2", ".css", ".toml"):
            assert not WORDS.findall(path.read_text()), path
