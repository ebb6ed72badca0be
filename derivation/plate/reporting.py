"""The report on the plate: its measurements, text and figures, and accompanying files."""

import json
from collections.abc import Callable, Sequence
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from derivation.engine.files import PACKAGE, measurements
from derivation.engine.paper import Report
from derivation.engine.report.document import Parts
from derivation.engine.report.figures import figure_file
from derivation.plate import CITATION
from derivation.plate.derived import chain, misprints
from derivation.plate.report import readme
from derivation.plate.report.accuracy_figures import accuracy_figures
from derivation.plate.report.consequence import Consequences
from derivation.plate.report.dynamic_benchmark import dynamic_benchmark_figure
from derivation.plate.report.elastodynamics import elastodynamics_figure
from derivation.plate.report.figures import figures
from derivation.plate.report.front import SUBTITLE
from derivation.plate.report.overview import overview
from derivation.plate.report.reproducibility import UPDATE_COMMANDS
from derivation.plate.report.sections import PLAN, PROSE, Material, parts
from derivation.scene.impact import simulate
from derivation.scene.model import Model, model_of
from derivation.scene.scene import load
from generated import contact_law

README, README_FIGURE = Path("README.md"), Path("reports/overview.svg")
"""Files in the project's folder that are written together with the report."""
EXAMPLES = PACKAGE / "scene" / "examples"
PAPER, GLASS_PANE = EXAMPLES / "paper.toml", EXAMPLES / "glass_pane.toml"
REQUIRED_MEASUREMENTS = (
    "accuracy", "check", "contact", "elastodynamics", "hard", "inertia", "moving",
    "rewrite", "speed",
)  # fmt: skip
"""Measurements that the report requires."""


def measurement() -> dict[str, bytes]:
    """Return the files of the committed measurements by name.

    Raises
    ------
    FileNotFoundError
        If a measurement that the report requires is missing.
    """
    folder = measurements()
    # An interrupted update leaves a file such as `hard.part.json`, which is no measurement.
    complete = (path for path in sorted(folder.glob("*.json")) if "." not in path.stem)
    contents = {path.stem: path.read_bytes() for path in complete}
    for name in REQUIRED_MEASUREMENTS:
        if name not in contents:
            raise FileNotFoundError(
                f"no measurements in {folder / name}.json; run `{UPDATE_COMMANDS[name]}`"
            )
    return contents


def benchmark_record() -> dict[str, Any]:
    """Return the committed benchmark of accuracy against run time.

    Raises
    ------
    FileNotFoundError
        If it is missing.
    """
    record: dict[str, Any] = json.loads(measurement()["accuracy"])
    return record


def paper_case() -> Model:
    """Return the paper's example as its example scene defines it."""
    return model_of(load(PAPER))


def material() -> Material:
    """Return theory, comparison with the published formulas, measurements, examples and code."""
    data = measurement()
    modules = sorted(Path(contact_law.__file__).parent.glob("*.py"))
    return Material(
        steps=chain(),
        findings=misprints(),
        data=data,
        measured={name: json.loads(content) for name, content in data.items()},
        case=paper_case(),
        scenes={path.stem: load(path) for path in sorted(EXAMPLES.glob("*.toml"))},
        sources={path.stem: path.read_text() for path in modules},
        version=version("platecontact"),
        citation=CITATION,
    )


def report_parts(shown: Sequence[str]) -> Parts:
    """Return the report's LaTeX in parts, with the named sections.

    Raises
    ------
    FileNotFoundError
        If committed measurements are missing.
    """
    return parts(material(), shown)


def report_figures() -> dict[str, Callable[[], Figure]]:
    """Return functions that draw the figures of the report, by name."""
    data = {name: json.loads(content) for name, content in measurement().items()}
    formulas = {formula.name: formula for _, records in chain() for formula in records}
    case = paper_case()
    gamma_2 = Consequences(case, formulas).value(formulas["gamma_2"].expression)
    return (
        figures(case, simulate(load(PAPER)), gamma_2)
        | accuracy_figures(data["accuracy"])
        | {"moving": partial(dynamic_benchmark_figure, data["moving"])}
        | {"elastodynamics": partial(elastodynamics_figure, data["elastodynamics"])}
    )


def accompanying_files(folder: Path) -> dict[Path, str | bytes]:
    """Return the README with its measured numbers, and its picture."""
    costs = benchmark_record()
    return {
        folder / README: readme.updated_readme((folder / README).read_text(), costs),
        folder / README_FIGURE: figure_file(overview(load(GLASS_PANE), costs), ".svg"),
    }


REPORT = Report(
    PROSE,
    SUBTITLE,
    plan=PLAN,
    parts=report_parts,
    figures=report_figures,
    accompanying_files=accompanying_files,
)
