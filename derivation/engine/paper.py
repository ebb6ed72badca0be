"""The class `Paper`, which contains all data that the engine needs from a paper."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from derivation.engine.errata.errata import Errata
from derivation.engine.formula.chain import Chain
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.package import Package
from derivation.engine.report import any_report
from derivation.engine.report.contexts import Prose
from derivation.engine.report.document import Parts, Plan

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
        Text by step, and references.
    subtitle, abstract
        Subtitle, and a summary in a few sentences.
    plan
        Names of the sections and appendices, in order.
    parts
        Function from the names of the sections to show to their LaTeX; None for the sections of
        `any_report`, which suit any paper.
    figures
        Function that returns for each figure, by name, a function that draws it; those of the
        shown sections are drawn.
    accompanying_files
        Function from the paper's folder to the contents of other files that depend on the same
        data; they are written with the whole report.
    """

    prose: Prose = field(default_factory=Prose)
    subtitle: str = ""
    abstract: str = ""
    plan: Plan = any_report.PLAN
    parts: Callable[[Sequence[str]], Parts] | None = None
    figures: Callable[[], Mapping[str, Callable[[], "Figure"]]] = dict
    accompanying_files: Callable[[Path], Mapping[Path, str | bytes]] = _nothing


@dataclass(frozen=True, eq=False)
class Paper:
    """All data of a paper.

    Parameters
    ----------
    title
        Title of the paper.
    folder
        Parent of the folders `generated` and `reports`.
    records
        Folder of the saved measurements.
    chain
        Vocabulary, steps of the derivation, and the files on which they depend.
    errata
        The published formulas.
    package
        Function that returns the definition of the generated package; its imports are then loaded
        only when needed.
    judge
        Function that returns the references and test points.
    report
        Function that returns the content of the report.
    committed
        Whether measurements are saved only on request. Otherwise every build saves them.
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
        """The symbols of the paper."""
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
        """File with the reference values of the hard cases, and their origin."""
        return self.records / "hard.json"

    @property
    def rewritten(self) -> Path:
        """File with the saved effects of the rewriting rules."""
        return self.records / "rewrite.json"
