"""Stage 6 of the main job: the report as LaTeX, PDF and HTML, and pieces of it."""

import json
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from derivation.engine.emit.freshness import Freshness, compare
from derivation.engine.files import PACKAGE, ROOT, expect_folder, measurements, write_files
from derivation.engine.report import pdf as compiler
from derivation.engine.report.document import Text
from derivation.engine.report.fragments import pasted
from derivation.engine.report.html import page
from derivation.plate.derived import chain, misprints
from derivation.plate.package_pipeline import folder_for, writable_folder
from derivation.plate.render import CITATION
from derivation.plate.report import readme
from derivation.plate.report.accuracy_figures import accuracy_figures
from derivation.plate.report.elastodynamics import elastodynamics_figure
from derivation.plate.report.figures import figures, saved
from derivation.plate.report.front import TITLE
from derivation.plate.report.moving import moving_costs
from derivation.plate.report.overview import overview
from derivation.plate.report.prose import REFERENCES
from derivation.plate.report.reproducibility import RENEWED
from derivation.plate.report.sections import Material, chosen, text
from derivation.scene.impact import simulate
from derivation.scene.model import Model, model_of
from derivation.scene.scene import load
from generated import contact_law

REPORTS, README = ROOT / "reports", ROOT / "README.md"
EXAMPLES = PACKAGE / "scene" / "examples"
PAPER, PANE = EXAMPLES / "paper.toml", EXAMPLES / "glass_pane.toml"
PICTURE = REPORTS / "overview.svg"
NEEDED = (
    "accuracy", "check", "contact", "elastodynamics", "hard", "inertia", "moving",
    "rewrite", "speed",
)  # fmt: skip
"""Measurements without which there is no report."""


def measured() -> dict[str, bytes]:
    """The committed measurements' files by name.

    Raises
    ------
    FileNotFoundError
        If one is missing without which there is no report.
    """
    folder = measurements()
    found = {path.stem: path.read_bytes() for path in sorted(folder.glob("*.json"))}
    for name in NEEDED:
        if name not in found:
            raise FileNotFoundError(
                f"no measurements in {folder / name}.json: run `{RENEWED[name]}`"
            )
    return found


def measured_accuracy() -> dict[str, Any]:
    """The committed measurement of what accuracy costs.

    Raises
    ------
    FileNotFoundError
        If there is none.
    """
    found: dict[str, Any] = json.loads(measured()["accuracy"])
    return found


def paper_case() -> Model:
    """The paper's example, as the example scene states it."""
    return model_of(load(PAPER))


def material() -> Material:
    """Theory, comparison with the print, measurements, examples and generated code."""
    data = measured()
    modules = sorted(Path(contact_law.__file__).parent.glob("*.py"))
    return Material(
        links=chain(),
        findings=misprints(),
        data=data,
        measured={name: json.loads(content) for name, content in data.items()},
        case=paper_case(),
        scenes={path.stem: load(path) for path in sorted(EXAMPLES.glob("*.toml"))},
        sources={path.stem: path.read_text() for path in modules},
        version=version("platecontact"),
        citation=CITATION,
    )


def report_text(sections: Sequence[str] = ()) -> Text:
    """The report's LaTeX in parts.

    Raises
    ------
    FileNotFoundError
        If there are no committed measurements.
    ValueError
        If there is no section of a name.
    """
    chosen(sections)  # before anything is derived
    return text(material(), sections)


def report_files() -> dict[str, str]:
    """The committed files of the report by name."""
    document = report_text().document(version("platecontact"))
    return {"report.tex": document, "report.bib": REFERENCES.bib()}


def report_figures() -> dict[str, Figure]:
    """Every figure of the report by name."""
    data = {name: json.loads(content) for name, content in measured().items()}
    return (
        figures(paper_case(), simulate(load(PAPER)))
        | accuracy_figures(data["accuracy"])
        | {"moving": moving_costs(data["moving"])}
        | {"elastodynamics": elastodynamics_figure(data["elastodynamics"])}
    )


def report(
    out: Path | None = None, pdf: bool = True, sections: Sequence[str] = ()
) -> tuple[Path, ...]:
    """Write the report and, if asked, its PDF; returns the files written.

    Files of chosen sections are named after them. The checkout's own whole report takes the
    README's measured numbers and its picture along.

    Raises
    ------
    OSError
        If the folder cannot be written to, or there are no measurements.
    ValueError
        If there is no section of a name.
    derivation.engine.report.pdf.TexError
        If LaTeX is missing or refuses the text; all else is there all the same.
    """
    folder = writable_folder(out, REPORTS)
    name = "-".join(["report", *(chosen(sections) if sections else ())])
    parts = report_text(sections)
    drawn = {key: figure for key, figure in report_figures().items() if parts.shows(key)}
    vectors = {key: saved(figure, ".svg") for key, figure in drawn.items()}
    files = {
        f"{name}.tex": parts.document(version("platecontact")),
        f"{name}.html": page(parts, TITLE, vectors, REFERENCES),
        "report.bib": REFERENCES.bib(),
    }
    written = tuple(folder / name for name in files)
    contents: dict[Path, str | bytes] = dict(zip(written, files.values(), strict=True))
    for key, figure in drawn.items():
        contents[folder / "figures" / f"{key}.pdf"] = saved(figure, ".pdf")
    if out is None and not sections:
        costs = measured_accuracy()
        contents[README] = readme.renewed(README.read_text(), costs)
        contents[PICTURE] = saved(overview(load(PANE), costs), ".svg")
    write_files(contents)
    return (*written, *([compiler.compile_pdf(written[0])] if pdf else []))


def check_report(out: Path | None = None) -> Freshness:
    """Compare the report's committed files with what would be written."""
    return compare(folder_for(out, REPORTS), report_files(), "platecontact report", "report.[tb]*")


def fragments(names: Sequence[str]) -> str:
    """LaTeX of formulas, or of all of a link of the chain, ready to be pasted.

    Raises
    ------
    ValueError
        If there is neither formula nor link of a name.
    """
    return pasted(names, chain(), REFERENCES)


def write_fragments(names: Sequence[str], out: Path) -> tuple[Path, ...]:
    """The same as a file of a folder, and the bibliography beside it.

    Raises
    ------
    ValueError
        If there is neither formula nor link of a name.
    OSError
        If the folder cannot be written to.
    """
    expect_folder(out)
    return write_files(
        {out / "fragment.tex": fragments(names), out / "report.bib": REFERENCES.bib()}
    )
