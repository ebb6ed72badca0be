"""The six stages of a build of a paper.

1 derive     steps -> proved formulas
2 rewrite    formulas -> stable forms, proved equal
3 generate   forms -> the NumPy package
4 misprints  published formulas compared with derived ones
5 check      generated code against both references
6 report     LaTeX, HTML and PDF
"""

import importlib
import json
import sys
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from derivation.engine import package
from derivation.engine.activity import Progress, quiet
from derivation.engine.emit.freshness import Freshness
from derivation.engine.errata.findings import Finding
from derivation.engine.errata.point import GivenPoint
from derivation.engine.errata.text import TextDiagnosis, diagnose_limited
from derivation.engine.files import write_file
from derivation.engine.formula.chain import Found
from derivation.engine.formula.record import Record
from derivation.engine.outputs import (
    expect_recordable,
    folder_for,
    plain_rows,
    sorted_json,
    writable_folder,
)
from derivation.engine.paper import Paper
from derivation.engine.rewrite.form import Form

if TYPE_CHECKING:
    from derivation.engine.measure.check import Row
    from derivation.engine.measure.hard import HardRow
    from derivation.engine.measure.search import Progress as SearchProgress
    from derivation.engine.measure.search import Search
    from derivation.engine.measure.search_record import SearchRecord
    from derivation.engine.rewrite.account import Account

Timed = Callable[[str], AbstractContextManager[Progress]]
"""Context that shows the named stage and its duration, and yields a function for its progress."""


@dataclass(frozen=True)
class BuildResult:
    """Result of a build.

    Parameters
    ----------
    passed
        Whether no error exceeds its budget.
    notes
        Remarks on the result.
    files
        The files written.
    """

    passed: bool
    notes: tuple[str, ...]
    files: tuple[Path, ...]


def build(paper: Paper, out: Path | None, timed: Timed) -> BuildResult:
    """Run all six stages on a paper.

    Parameters
    ----------
    paper
        The paper.
    out
        Parent of the folders `generated` and `reports`; by default the paper's own folder.
    timed
        Context that shows each stage.

    Returns
    -------
    BuildResult
        Whether all errors are within their budgets, remarks, and the files written.

    Raises
    ------
    derivation.engine.failed.FailedError
        If a proof fails, or the two references contradict each other.
    ValueError
        If `out` is None and the paper belongs to an installed copy.
    OSError
        If a folder cannot be written to.
    """
    generated, reports = (out / name if out else None for name in ("generated", "reports"))
    writable_folder(generated, paper.package_folder)
    writable_folder(reports, paper.report_folder)
    with timed("derive"):
        derive(paper)
    with timed("rewrite"):
        rewrite(paper)
    with timed("generate"):
        written = generate(paper, generated)
    with timed("misprints"):
        misprints(paper)
    with timed("check") as progress:
        rows = check(paper, update=not paper.committed, progress=progress)
    with timed("report"):
        reported, missing = _report_as_far_as_possible(paper, reports)
    measured = () if paper.committed else (paper.measured,)
    return BuildResult(
        all(row.passed is not False for row in rows),
        (*missing, *measurement_remarks(paper, rows)),
        (*written, *measured, *reported),
    )


# --- the stages


def derive(paper: Paper) -> Found:
    """Return the steps with their proved formulas (stage 1).

    Raises
    ------
    derivation.engine.formula.proof.ProofError
        If a proof fails.
    """
    return paper.chain.derived_steps()


def rewrite(paper: Paper) -> tuple[Form, ...]:
    """Return the stable forms, proved equal to the formulas (stage 2)."""
    return package.forms_of(paper.chain, paper.package())


def generate(paper: Paper, out: Path | None = None) -> tuple[Path, ...]:
    """Write the NumPy package, and return the files written (stage 3).

    Parameters
    ----------
    paper
        The paper.
    out
        Folder of the package; by default that of the paper.

    Raises
    ------
    ValueError
        If `out` is None and the paper belongs to an installed copy.
    OSError
        If the folder cannot be written to.
    """
    folder, settings = writable_folder(out, paper.package_folder), paper.package()
    written = package.write(paper.chain, settings, folder)
    if folder == paper.package_folder:
        _unload(settings.target)
    return written


def misprints(paper: Paper) -> tuple[Finding, ...]:
    """Return the comparison of each published formula with the derived one (stage 4)."""
    return paper.errata.findings(paper.chain)


def expect_package(paper: Paper) -> None:
    """Raise FileNotFoundError if the code of a paper has not been generated."""
    if not (paper.package_folder / "manifest.py").is_file():
        raise FileNotFoundError(
            f"no package in {paper.package_folder}: run `platecontact generate` with the same paper"
        )


def check(
    paper: Paper, digits: int = 50, update: bool = False, progress: Progress = quiet
) -> "tuple[Row, ...]":
    """Compare the generated functions with both references (stage 5).

    Parameters
    ----------
    paper
        The paper.
    digits
        Number of correct digits of the reference values, at least 20.
    update
        Whether to save the result as the paper's measurement, `Paper.measured`.
    progress
        Called for each function before it is measured.

    Returns
    -------
    tuple of Row
        Errors, budget and result of each function.

    Raises
    ------
    derivation.engine.oracle.agreement.OracleError
        If the two references contradict each other.
    FileNotFoundError
        If there is no generated package.
    """
    # Imported late: these modules are slow to load, and references may import the new package.
    from derivation.engine.measure import check as measure
    from derivation.engine.measure.record import to_json

    if update:
        expect_recordable(paper.measured)
    expect_package(paper)
    rows = measure.check(paper.judge(), digits, progress=progress)
    if update:
        write_file(paper.measured, to_json(rows, digits, paper.package().target))
    return rows


def check_hard(
    paper: Paper, update: bool = False, progress: Progress = quiet
) -> "tuple[HardRow, ...]":
    """Compare the functions with recorded reference values at the hard cases (stage 5).

    Parameters
    ----------
    paper
        The paper.
    update
        Whether to compute missing and outdated reference values, which takes minutes, and to record
        all. If such a run is interrupted, the next one continues it.
    progress
        Called after each reference value.

    Returns
    -------
    tuple of HardRow
        Error and result of each case.

    Raises
    ------
    FileNotFoundError
        If no reference values are recorded.
    ValueError
        If a case has no reference value, or the paper has no hard cases.
    """
    from derivation.engine.measure import hard
    from derivation.engine.measure.suite import find_references

    if update:
        expect_recordable(paper.hard)
    make_suite = paper.judge().hard
    if make_suite is None:
        raise ValueError(
            "expected a paper with hard cases, got none: pass a file with them to `domain_judge`"
        )
    suite = make_suite()
    if not update:
        if not paper.hard.is_file():
            raise FileNotFoundError(f"no references in {paper.hard}: run `{hard.COMMAND}`")
        return hard.check(
            suite, hard.committed_references(json.loads(paper.hard.read_text()), suite.cases)
        )
    part = paper.hard.with_suffix(".part.json")
    rows = hard.check(suite, find_references(suite, paper.hard, part, progress))
    write_file(paper.hard, hard.to_json(rows, paper.package().target))
    part.unlink()
    return rows


def search(
    paper: Paper,
    duration: str,
    seed: int = 1,
    functions: Sequence[str] = (),
    out: Path | None = None,
    progress: "SearchProgress | None" = None,
) -> "tuple[Search, SearchRecord]":
    """Search for larger errors for some time, and write each new worst case to a file.

    Parameters
    ----------
    paper
        The paper.
    duration, seed, functions, out, progress
        As for `derivation.pipeline.search_worse`.

    Raises
    ------
    FileNotFoundError
        If there is no generated package.
    ValueError
        If the duration or a function name is invalid, or the file is not one of worst cases.
    OSError
        If the file cannot be written.
    """
    from derivation.engine.measure.domain_search import domain_targets
    from derivation.engine.measure.search_record import recorded, search_and_record, seconds_of

    seconds = seconds_of(duration)
    expect_package(paper)
    chosen = domain_targets(paper.judge(), paper.chain, functions)
    path = folder_for(None, paper.report_folder) / "search.toml" if out is None else out
    return search_and_record(chosen, recorded(paper.measured), seconds, seed, path, progress)


def report(
    paper: Paper, out: Path | None = None, compiled: bool = True, sections: Sequence[str] = ()
) -> tuple[Path, ...]:
    """Write the report and, with `compiled`, its PDF (stage 6); see `report_files.write`."""
    # Imported late, because it may import the new package.
    from derivation.engine import report_files

    return report_files.write(paper, out, compiled, sections)


# --- parts of a stage


def formulas(paper: Paper) -> dict[str, Record]:
    """Return every formula by name."""
    return paper.chain.formulas()


def diagnose(
    paper: Paper, name: str, text: str, latex: bool = False, at: GivenPoint = "", digits: int = 50
) -> TextDiagnosis:
    """Compare a formula given as text with the derived one; see `derivation.diagnose`."""
    relations = paper.errata.relations
    return diagnose_limited(paper.chain, relations, name, text, latex=latex, at=at, digits=digits)


def rewriting_effects(
    paper: Paper, update: bool = False, progress: Progress = quiet
) -> "tuple[Account, ...]":
    """Return the effect of each rewriting rule on each formula; with `update`, save it."""
    from derivation.engine.rewrite.account import accounts

    if update:
        expect_recordable(paper.rewritten)
    package = paper.package()
    effects = accounts(formulas(paper), package.rewritten, package.scales, progress)
    if update:
        write_file(paper.rewritten, sorted_json({"rows": plain_rows(effects)}))
    return effects


def check_generated(paper: Paper, out: Path | None, remedy: str) -> Freshness:
    """Compare the package with newly generated files; `remedy` is the command that writes them."""
    folder = folder_for(out, paper.package_folder)
    return package.freshness_of(paper.chain, paper.package(), folder, remedy)


def measurement_remarks(paper: Paper, rows: "Sequence[Row]") -> list[str]:
    """Return remarks on a new measurement, and on differences from the saved one."""
    from derivation.engine.measure.record import to_json, unconfirmed

    failed = [row.kernel for row in rows if row.passed is False]
    lines = (
        [f"above their budget: {', '.join(failed)}"]
        if failed
        else ["all errors are within their budgets"]
    )
    lines += unconfirmed(rows)
    if paper.measured.is_file():
        kept, new = (
            {(row["kernel"], row["module"]): row for row in json.loads(text)["rows"]}
            for text in (paper.measured.read_text(), to_json(rows, 50, paper.package().target))
        )
        moved = sorted(
            {name for name, module in new if new[name, module] != kept.get((name, module))}
        )
        if moved:
            lines.append(f"different from the saved {paper.measured.name}: {', '.join(moved)}")
    return lines


def _report_as_far_as_possible(
    paper: Paper, out: Path | None
) -> tuple[tuple[Path, ...], tuple[str, ...]]:
    """Write the report, without the PDF if LaTeX fails or is not installed.

    Returns
    -------
    tuple of Path, tuple of str
        The files written, and a remark if there is no PDF.
    """
    from derivation.engine.report.pdf import TexError, compile_all

    written = report(paper, out, compiled=False)
    try:
        return (*written, *compile_all(written)), ()
    except TexError as error:
        return written, (f"the PDF was not written, all other files were: {error}",)


def _unload(target: str) -> None:
    """Unload the modules of a package whose files have changed."""
    for name in [name for name in sys.modules if name == target or name.startswith(f"{target}.")]:
        del sys.modules[name]
    importlib.invalidate_caches()
