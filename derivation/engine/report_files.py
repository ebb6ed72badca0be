"""Files of the report (stage 6): LaTeX, HTML and PDF, and fragments of it."""

import json
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from pathlib import Path

from derivation.engine.emit.freshness import Freshness, compare
from derivation.engine.files import expect_folder, write_files
from derivation.engine.outputs import folder_for, writable_folder
from derivation.engine.paper import Paper
from derivation.engine.report import any_report, pdf
from derivation.engine.report.document import Parts, Text, chosen_sections
from derivation.engine.report.figures import figure_file
from derivation.engine.report.fragments import formula_fragments
from derivation.engine.report.html import page


def documents(paper: Paper, sections: Sequence[str] = ()) -> dict[str, Text]:
    """Return the report and its appendices by name, or one document of the named sections.

    Raises
    ------
    FileNotFoundError
        If a measurement is missing.
    ValueError
        If a name is not that of a section.
    """
    plan = paper.report()
    shown = chosen_sections(sections, plan.plan.names)
    wanted = shown or plan.plan.names
    return plan.plan.documents(plan.parts(wanted) if plan.parts else _parts(paper, wanted), shown)


def _parts(paper: Paper, sections: Sequence[str]) -> Parts:
    """Return the report's parts with the sections that suit any paper."""
    if not paper.measured.is_file():
        raise FileNotFoundError(
            f"no measurement in {paper.measured}: run `platecontact check --update` with the same "
            "paper"
        )
    plan = paper.report()
    contents = any_report.ReportContents(
        paper.title,
        plan.subtitle,
        plan.abstract,
        paper.vocabulary,
        paper.chain.derived_steps(),
        paper.errata.findings(paper.chain),
        json.loads(paper.measured.read_text()),
        plan.prose,
        version("platecontact"),
    )
    return any_report.parts(contents, sections)


def committed_files(paper: Paper) -> dict[str, str]:
    """Return the LaTeX files and the bibliography of the report by name."""
    tex = {
        f"{name}.tex": text.document(version("platecontact"))
        for name, text in documents(paper).items()
    }
    return {**tex, "report.bib": paper.report().prose.references.bib()}


def write(
    paper: Paper, out: Path | None = None, compiled: bool = True, sections: Sequence[str] = ()
) -> tuple[Path, ...]:
    """Write the report with its appendices; return the files written.

    Parameters
    ----------
    paper
        The paper.
    out
        Folder of the report; by default that of the paper, where the files of
        `Report.accompanying_files` are written too.
    compiled
        Whether to compile the PDF.
    sections
        Names of the sections of a partial report, which its file name contains; all if empty.

    Raises
    ------
    OSError
        If the folder cannot be written to, or a measurement is missing.
    ValueError
        If a name is not that of a section, or `out` is None and the paper belongs to an installed
        copy.
    derivation.engine.report.html.HtmlError
        If the report cannot be converted to HTML; then nothing is written.
    derivation.engine.report.pdf.TexError
        If LaTeX is not installed or fails; all other files are written nevertheless.
    """
    folder, plan = writable_folder(out, paper.report_folder), paper.report()
    texts = documents(paper, sections)
    shown = {name for text in texts.values() for name in text.figures}
    drawn = {key: draw() for key, draw in plan.figures().items() if key in shown} if shown else {}
    vectors = {key: figure_file(figure, ".svg") for key, figure in drawn.items()}
    with ThreadPoolExecutor() as pool:  # pandoc is another process
        pages = pool.map(lambda text: page(text, text.title, vectors), texts.values())
        drawings = {key: figure_file(figure, ".pdf") for key, figure in drawn.items()}
    contents: dict[Path, str | bytes] = {
        folder / f"{name}.tex": text.document(version("platecontact"))
        for name, text in texts.items()
    }
    contents |= {folder / f"{name}.html": page for name, page in zip(texts, pages, strict=True)}
    contents[folder / "report.bib"] = plan.prose.references.bib()
    contents |= {folder / "figures" / f"{key}.pdf": made for key, made in drawings.items()}
    if out is None and not sections:
        contents.update(plan.accompanying_files(paper.folder))
    write_files(contents)
    return (*contents, *(pdf.compile_all(contents) if compiled else ()))


def freshness(paper: Paper, out: Path | None, remedy: str) -> Freshness:
    """Compare the report with newly made files; `remedy` is the command that writes them."""
    folder = folder_for(out, paper.report_folder)
    return compare(folder, committed_files(paper), remedy, "[ar]*.[tb]*")


def fragments(paper: Paper, names: Sequence[str]) -> str:
    """Return LaTeX of the named formulas, and of all formulas of the named steps.

    Raises
    ------
    ValueError
        If a name is neither a formula nor a step.
    """
    return formula_fragments(names, paper.chain.derived_steps(), paper.report().prose.references)


def write_fragments(
    paper: Paper, names: Sequence[str], out: Path, replace: bool = False
) -> tuple[Path, ...]:
    """Write LaTeX of formulas to ``fragment.tex``, with the bibliography; return the files.

    Raises
    ------
    ValueError
        If a name is neither a formula nor a step, or a file has other content and `replace` is
        false.
    OSError
        If the folder cannot be written to.
    """
    expect_folder(out)
    bibliography = paper.report().prose.references.bib()
    files = {out / "fragment.tex": fragments(paper, names), out / "report.bib": bibliography}
    others = [path for path, text in files.items() if path.exists() and not _has(path, text)]
    if others and not replace:
        raise ValueError(
            f"report: {', '.join(map(str, others))} exists already with other content; add --out "
            "DIR to write into another folder, or --force to replace it"
        )
    return write_files(files)


def _has(path: Path, text: str) -> bool:
    """Return whether a path is a file with this text."""
    return path.is_file() and path.read_bytes() == text.encode()
