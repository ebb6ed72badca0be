"""The class `Paper`, which contains everything the engine needs from a paper."""

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
    """Content of the report in addition to formulas, findings and measurements.

    Parameters
    ----------
    prose
        Text by link, and references.
    subtitle, abstract
        Below the title, and in a few sentences what the report is about.
    plan
        Names of its sections and appendices, in order.
    parts
        The report's LaTeX, from the names of the sections to show; None for the sections that
        suit any paper.
    figures
        Function for every figure by name; only figures of the shown sections are drawn.
    beside
        Function from the paper's folder to other files that depend on the same data and are
        written with the whole report.
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
    """All data of a paper.

    Parameters
    ----------
    title
        Its title.
    folder
        Parent folder of its package `generated` and its `reports`.
    records
        Folder of the saved measurements.
    chain
        Its vocabulary, the links of its derivation, and the files on which they depend.
    errata
        The published formulas.
    package
        The generated package. It is a function, so that its imports are loaded when needed.
    judge
        References and points; likewise a function.
    report
        The report; likewise a function.
    committed
        Whether measurements are updated only on request, and a build compares with them.
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
        """File with the saved measurement of the generated functions."""
        return self.records / "check.json"

    @property
    def hard(self) -> Path:
        """File with the references of the hard cases, and their origin."""
        return self.records / "hard.json"

    @property
    def rewritten(self) -> Path:
        """File with the saved effect of the rules."""
        return self.records / "rewrite.json"
