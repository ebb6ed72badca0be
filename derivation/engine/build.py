"""The stages of the main job on a paper, in their order.

1 derive     links -> proven formulas
2 rewrite    formulas -> stable forms, proved equal
3 generate   forms -> the NumPy package
4 misprints  printed formulas against derived ones
5 check      generated code against both references
6 report     LaTeX, HTML and PDF
"""

import importlib
import json
import sys
from collections.abc import Callable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

from derivation.engine import package
from derivation.engine.emit.freshness import Freshness
from derivation.engine.errata.findings import Finding
from derivation.engine.errata.text import TextDiagnosis, diagnosed
from derivation.engine.files import write_file, write_files
from derivation.engine.formula.chain import Found
from derivation.engine.formula.record import Record
from derivation.engine.paper import Paper
from derivation.engine.rewrite.form import Form

if TYPE_CHECKING:
    from derivation.engine.measure.check import Row
    from derivation.engine.rewrite.account import Account

Progress = Callable[[str, int, int], None]


def derive(paper: Paper) -> Found:
    """Stage 1: the links with their formulas."""
    return paper.chain.found()


def formulas(paper: Paper) -> dict[str, Record]:
    """Every formula by name."""
    return paper.chain.formulas()


def diagnose(
    paper: Paper, name: str, text: str, latex: bool = False, at: str = "", digits: int = 50
) -> TextDiagnosis:
    """Compare a formula given as text with the derived one, see `derivation.diagnose`."""
    relations = paper.errata.relations
    return diagnosed(paper.chain, relations, name, text, latex=latex, at=at, digits=digits)


def rewrite(paper: Paper) -> tuple[Form, ...]:
    """Stage 2: the stable forms."""
    return package.forms_of(paper.chain, paper.package())


def account(paper: Paper, tell: Progress | None = None) -> "tuple[Account, ...]":
    """What the rules did to each formula, measured without and with every one of them."""
    from derivation.engine.rewrite.account import accounts

    return accounts(formulas(paper), paper.package().rewritten, paper.package().scales, tell)


def generate(paper: Paper, out: Path | None = None) -> tuple[Path, ...]:
    """Stage 3: write the package; returns the files written."""
    return package.write(paper.chain, paper.package(), out)


def check_generated(paper: Paper, out: Path | None, mend: str) -> Freshness:
    """Compare the package with what would be written; `mend` is the command that writes it."""
    folder = paper.package().folder if out is None else out
    return package.freshness_of(paper.chain, paper.package(), folder, mend)


def misprints(paper: Paper) -> tuple[Finding, ...]:
    """Stage 4: what each printed formula turns out to be."""
    return paper.errata.found(paper.chain)


def check(
    paper: Paper, digits: int = 50, update: bool = False, tell: Progress | None = None
) -> "tuple[Row, ...]":
    """Stage 5: compare the generated functions with both references; keep the result if asked.

    Raises
    ------
    derivation.engine.oracle.agreement.OracleError
        If the two references contradict each other.
    FileNotFoundError
        If nothing is generated.
    """
    # Only now, as these load much, and references may import what has just been generated.
    from derivation.engine.measure import check as measure
    from derivation.engine.measure.record import to_json

    own = paper.package()
    if not (own.folder / "manifest.py").is_file():
        raise FileNotFoundError(
            f"no package in {own.folder}: run `platecontact generate` with the same paper"
        )
    _forget(own.target)
    rows = measure.check(paper.judge(), digits, progress=tell)
    if update:
        write_file(paper.report().measured, to_json(rows, digits, own.target))
    return rows


def report(
    paper: Paper, out: Path | None = None, compiled: bool = True, sections: Sequence[str] = ()
) -> tuple[Path, ...]:
    """Stage 6: write the report and, if asked, its PDF; returns the files written.

    Raises
    ------
    FileNotFoundError
        If no measurement was kept.
    ValueError
        If sections are chosen of a report that has no own ones.
    derivation.engine.report.pdf.TexError
        If LaTeX is missing or refuses the text: all else is there all the same.
    """
    from derivation.engine.report import any_report, pdf
    from derivation.engine.report.html import page

    own = paper.report()
    if own.write is not None:
        return own.write(out, compiled, sections)
    if sections:
        raise ValueError("--section: expected a report with sections of its own; leave it out")
    if not own.measured.is_file():
        raise FileNotFoundError(
            f"no measurement in {own.measured}: run `platecontact check --update` with the same "
            "paper"
        )
    contents = any_report.Contents(
        paper.title, own.subtitle, own.abstract, derive(paper), misprints(paper),
        json.loads(own.measured.read_text()), own.prose, version("platecontact"),
    )  # fmt: skip
    text = any_report.text(contents)
    folder = own.folder if out is None else out
    written = write_files(
        {
            folder / "report.tex": text.document(version("platecontact")),
            folder / "report.html": page(text, paper.title, {}, own.prose.references),
            folder / "report.bib": own.prose.references.bib(),
        }
    )
    return (*written, *([pdf.compile_pdf(folder / "report.tex")] if compiled else []))


def _forget(target: str) -> None:
    """Let a package that was written anew be read anew."""
    for name in [name for name in sys.modules if name == target or name.startswith(f"{target}.")]:
        del sys.modules[name]
    importlib.invalidate_caches()
