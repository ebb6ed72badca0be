"""Files of the report (stage 6): LaTeX, HTML and PDF, and fragments of it."""

import json
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from derivation.engine.emit.freshness import Freshness, compare
from derivation.engine.files import expect_folder, write_files
from derivation.engine.outputs import folder_for, writable_folder
from derivation.engine.paper import Paper
from derivation.engine.report import any_report, pdf
from derivation.engine.report.document import Text, chosen
from derivation.engine.report.figures import saved
from derivation.engine.report.fragments import pasted
from derivation.engine.report.html import page


def text(paper: Paper, sections: Sequence[str] = ()) -> Text:
    """Return the report's LaTeX in parts: the named sections, or all of them.

    Raises
    ------
    FileNotFoundError
        If a measurement is missing.
    ValueError
        If there is no section of a name.
    """
    own = paper.report()
    shown = chosen(sections, own.sections)
    if own.text is not None:
        return own.text(shown)
    if not paper.measured.is_file():
        raise FileNotFoundError(
            f"no measurement in {paper.measured}: run `platecontact check --update` with the same "
            "paper"
        )
    contents = any_report.Contents(
        paper.title,
        own.subtitle,
        own.abstract,
        paper.chain.found(),
        paper.errata.found(paper.chain),
        json.loads(paper.measured.read_text()),
        own.prose,
        version("platecontact"),
    )
    return any_report.text(contents, shown)


def committed_files(paper: Paper) -> dict[str, str]:
    """Return the report's files that can be compared byte by byte, by name."""
    document = text(paper).document(version("platecontact"))
    return {"report.tex": document, "report.bib": paper.report().prose.references.bib()}


def write(
    paper: Paper, out: Path | None = None, compiled: bool = True, sections: Sequence[str] = ()
) -> tuple[Path, ...]:
    """Write the report and, on request, its PDF; return the files written.

    Files with selected sections are named after them. The whole report in the paper's own folder is
    written together with its accompanying files.

    Raises
    ------
    OSError
        If the folder cannot be written to, or a measurement is missing.
    ValueError
        If there is no section of a name.
    derivation.engine.report.pdf.TexError
        If LaTeX is missing or fails; everything else is written nevertheless.
    """
    folder, own = writable_folder(out, paper.report_folder), paper.report()
    name = "-".join(["report", *(chosen(sections, own.sections) if sections else ())])
    parts = text(paper, sections)
    drawn = {key: figure for key, figure in own.figures().items() if parts.shows(key)}
    vectors = {key: saved(figure, ".svg") for key, figure in drawn.items()}
    references = own.prose.references
    files = {
        f"{name}.tex": parts.document(version("platecontact")),
        f"{name}.html": page(parts, paper.title, vectors),
        "report.bib": references.bib(),
    }
    written = tuple(folder / name for name in files)
    contents: dict[Path, str | bytes] = dict(zip(written, files.values(), strict=True))
    for key, figure in drawn.items():
        contents[folder / "figures" / f"{key}.pdf"] = saved(figure, ".pdf")
    if out is None and not sections:
        contents.update(own.beside(paper.folder))
    write_files(contents)
    return (*contents, *([pdf.compile_pdf(written[0])] if compiled else []))


def freshness(paper: Paper, out: Path | None, mend: str) -> Freshness:
    """Compare the report with what would be written; `mend` is the command that writes it."""
    folder = folder_for(out, paper.report_folder)
    return compare(folder, committed_files(paper), mend, "report.[tb]*")


def fragments(paper: Paper, names: Sequence[str]) -> str:
    """Return LaTeX of formulas, or of all formulas of a link, ready to be pasted.

    Raises
    ------
    ValueError
        If a name is neither a formula nor a link.
    """
    return pasted(names, paper.chain.found(), paper.report().prose.references)


def write_fragments(paper: Paper, names: Sequence[str], out: Path) -> tuple[Path, ...]:
    """Write the same as a file, with the bibliography.

    Raises
    ------
    ValueError
        If a name is neither a formula nor a link.
    OSError
        If the folder cannot be written to.
    """
    expect_folder(out)
    bibliography = paper.report().prose.references.bib()
    return write_files(
        {out / "fragment.tex": fragments(paper, names), out / "report.bib": bibliography}
    )
