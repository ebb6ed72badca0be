"""A paper: the one object through which everything about it reaches the engine."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from derivation.engine.errata.errata import Errata
from derivation.engine.formula.chain import Chain
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.package import Package
from derivation.engine.report.pieces import Prose

if TYPE_CHECKING:
    from derivation.engine.measure.check import Judge


@dataclass(frozen=True, eq=False)
class Report:
    """What the report says beyond formulas, findings and measurements.

    Parameters
    ----------
    folder
        Where the report is written.
    measured
        File with the kept measurement of the generated functions.
    prose
        Prose by link, and references.
    subtitle, abstract
        Below the title, and in a few sentences what the report is about.
    write
        Writes the report of a paper that has sections of its own, from the folder (if not
        `folder`), whether to compile it, and the names of the chosen sections.
    """

    folder: Path
    measured: Path
    prose: Prose = field(default_factory=Prose)
    subtitle: str = ""
    abstract: str = ""
    write: Callable[[Path | None, bool, Sequence[str]], tuple[Path, ...]] | None = None


@dataclass(frozen=True, eq=False)
class Paper:
    """All of a paper.

    Parameters
    ----------
    title
        Its title.
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
    """

    title: str
    chain: Chain
    errata: Errata
    package: Callable[[], Package]
    judge: "Callable[[], Judge]"
    report: Callable[[], Report]

    @property
    def vocabulary(self) -> Vocabulary:
        """Its symbols."""
        return self.chain.vocabulary
