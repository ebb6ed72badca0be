"""The main job, stage by stage; a stage's result is kept until its sources change.

1 derive     equilibrium equations -> proven formulas
2 rewrite    formulas -> stable forms, proved equal
3 generate   forms -> the NumPy package
4 misprints  printed formulas against derived ones
5 check      generated code against both oracles
6 report     LaTeX and PDF
"""

import json
from importlib.metadata import version
from pathlib import Path

from derivation.derived import GROUND, chain, formulas, misprints
from derivation.emit.freshness import Freshness, compare
from derivation.emit.render import CITATION, render
from derivation.files import PACKAGE, ROOT, cached, in_checkout, write_file
from derivation.measure.check import Progress, Row
from derivation.measure.check import check as measure
from derivation.measure.record import to_json
from derivation.report import pdf as compiler
from derivation.report.content import tex
from derivation.report.figures import figures, motion_context
from derivation.rewrite.form import Form
from derivation.rewrite.forms import stable_forms
from derivation.scene.model import Model, model_of
from derivation.scene.scene import load

GENERATED = ROOT / "generated"
REPORTS = ROOT / "reports"
MEASURED = REPORTS / "data" / "check.json"


def forms() -> tuple[Form, ...]:
    """Stage 2: stable forms, proved equal to the formulas."""
    return cached("forms", (*GROUND, "rewrite"), lambda: stable_forms(formulas()))


def package() -> dict[str, str]:
    """Stage 3: the files of the generated package by name."""
    rooms = (*GROUND, "rewrite", "paper", "emit", "budgets.toml")
    return cached("package", rooms, lambda: render(formulas(), forms()))


def folder_for(out: Path | None, own: Path) -> Path:
    """Folder to write to: `out`, or the checkout's own.

    Raises
    ------
    ValueError
        If this is an installed copy and no folder is given.
    """
    if out is None and not in_checkout():
        raise ValueError("expected a folder, as this is an installed copy: add --out DIR")
    return own if out is None else out


def generate(out: Path | None = None) -> tuple[Path, ...]:
    """Write the generated package; returns the files written.

    Raises
    ------
    OSError
        If the folder cannot be written to.
    """
    folder = folder_for(out, GENERATED)
    return _write(folder, package())


def check_generated(out: Path | None = None) -> Freshness:
    """Compare the generated package with what would be written."""
    mend = "platecontact generate" + (f" --out {out}" if out else "")
    return compare(folder_for(out, GENERATED), package(), mend)


def check(digits: int = 50, record: bool = False, tell: Progress | None = None) -> tuple[Row, ...]:
    """Stage 5: measure the generated package against both oracles; keep the result if asked.

    Raises
    ------
    derivation.reference.routes.OracleError
        If the two oracles contradict each other.
    """
    rows = measure(digits, progress=tell)
    if record:
        folder_for(None, REPORTS)
        write_file(MEASURED, to_json(rows, digits))
    return rows


def verdict(rows: tuple[Row, ...]) -> list[str]:
    """What a fresh measurement says, and whether it repeats the committed one."""
    failed = [row.kernel for row in rows if row.passed is False]
    lines = [f"beyond their budget: {', '.join(failed)}"] if failed else ["all budgets kept"]
    if MEASURED.is_file():
        kept = {(r["kernel"], r["module"]): r for r in json.loads(MEASURED.read_text())["rows"]}
        fresh = {(r["kernel"], r["module"]): r for r in json.loads(to_json(rows, 50))["rows"]}
        moved = sorted({n for n, m in fresh if fresh[n, m] != kept.get((n, m))})
        if moved:
            lines.append(f"not as committed in {MEASURED.name}: {', '.join(moved)}")
    return lines


def report_files() -> dict[str, str]:
    """The report's LaTeX by file name, from the theory and the committed measurements.

    Raises
    ------
    FileNotFoundError
        If there are no committed measurements.
    """
    if not MEASURED.is_file():
        raise FileNotFoundError(f"no measurements in {MEASURED}: run `platecontact check --record`")
    measured = json.loads(MEASURED.read_text())
    motion = motion_context(paper_case())
    text = tex(chain(), misprints(), measured, motion, version("platecontact"), CITATION)
    return {"report.tex": text}


def paper_case() -> Model:
    """The paper's example, as the example scene states it."""
    return model_of(load(PACKAGE / "scene" / "examples" / "paper.toml"))


def report(out: Path | None = None, pdf: bool = True) -> tuple[Path, ...]:
    """Write the report and, if asked, its PDF; returns the files written.

    Raises
    ------
    OSError
        If the folder cannot be written to, or there are no measurements.
    derivation.report.pdf.TexError
        If LaTeX is missing or refuses the text; the .tex is there all the same.
    """
    folder = folder_for(out, REPORTS)
    for name, figure in figures(paper_case()).items():
        write_file(folder / "figures" / name, figure)
    written = _write(folder, report_files())
    return (*written, *(compiler.compile_pdf(path) for path in written if pdf))


def check_report(out: Path | None = None) -> Freshness:
    """Compare the report's LaTeX with what would be written."""
    return compare(folder_for(out, REPORTS), report_files(), "platecontact report", "*.tex")


def _write(folder: Path, files: dict[str, str]) -> tuple[Path, ...]:
    for name, text in files.items():
        write_file(folder / name, text)
    return tuple(folder / name for name in files)
