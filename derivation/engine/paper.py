"""A paper: the one object through which everything about it reaches the engine."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from derivation.engine.errata.errata import Errata
from derivation.engine.formula.chain import Chain
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.package import Package
from derivation.engine.report import any_report
from derivation.engine.report.document import Parts, Plan
from derivation.engine.report.pieces import Prose

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from derivation.engine.measure.check import Judge


def _nothing(_: Path) -> dict[Path, str | bytes]:
    return {}


@dataclass(frozen=True, eq=False)
class Report:
    """What the report says beyond formulas, findings and measurements.

    Parameters
    ----------
    prose
        Prose by link, and references.
    subtitle, abstract
        Below the title, and in a few sentences what the report is about.
    plan
        Names of its sections and appendices, in order.
    parts
        The report's LaTeX, from the names of the sections to show; None for the sections that
        suit any paper.
    figures
        Every figure by name; those are drawn that a section shows.
    beside
        From the paper's folder, other files that follow from the same data and are written with
        the whole report.
    """

    prose: Prose = field(default_factory=Prose)
    subtitle: str = ""
    abstract: str = ""
    plan: Plan = any_report.PLAN
    parts: Callable[[Sequence[str]], Parts] | None = None
    figures: Callable[[], Mapping[str, "Figure"]] = dict
    beside: Callable[[Path], Mapping[Path, str | bytes]] = _nothing


@dataclass(frozen=True, eq=False)
class Paper:
    """All of a paper.

    Parameters
    ----------
    title
        Its title.
    folder
        Where its package `generated` and its `reports` are written.
    records
        Folder of the measurements that are kept.
    chain
        Its vocabulary, the links of its derivation, and the files that they follow from.
    errata
        The printed formulas.
    package
        The generated package. A function, so that what it imports is loaded when it is needed.
    judge
        References and points; likewise.
    report
        The report; likewise.
    committed
        Whether the measurements are renewed on demand alone, and a build compares with them.
    """

    title: str
    folder: Path
    records: Path
    chain: Chain
    errata: Errata
    package: Callable[[], Package]
    judge: "Callable[[], Judge]"
    report: Callable[[], Report]
    committed: bool = False

    @property
    def vocabulary(self) -> Vocabulary:
        """Its symbols."""
        return self.chain.vocabulary

    @property
    def package_folder(self) -> Path:
        """Folder of the generated package."""
        return self.folder / "generated"

    @property
    def report_folder(self) -> Path:
        """Folder of the report."""
        return self.folder / "reports"

    @property
    def measured(self) -> Path:
        """File with the kept measurement of the generated functions."""
        return self.records / "check.json"

    @property
    def hard(self) -> Path:
        """File with the references of the hard cases, and how they were kept."""
        return self.records / "hard.json"

    @property
    def rewritten(self) -> Path:
        """File with the kept account of the rules that were applied."""
        return self.records / "rewrite.json"
