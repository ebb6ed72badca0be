"""The generated package of a paper: stable forms and files, cached until sources change."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from derivation.engine.emit.freshness import Freshness, compare
from derivation.engine.files import real, write_folder
from derivation.engine.formula.chain import Chain
from derivation.engine.formula.record import Record
from derivation.engine.rewrite.form import Block, Branch, Form, Step, Switch
from derivation.engine.rewrite.scales import Scales
from derivation.engine.staging import recover

Formulas = Mapping[str, Record]


@dataclass(frozen=True, eq=False)
class Package:
    """Definition of the generated package.

    Parameters
    ----------
    target
        Import name of the package.
    forms
        Function from the formulas by name to their stable forms, proved equal to them.
    files
        Function from formulas and forms to the contents of the files by name.
    sources
        Files on which it depends in addition to the formulas: parts of this package by name, others
        by path.
    rewritten
        Names of the formulas whose forms are found by the rewriting rules.
    scales
        Dimensionless variables of these formulas.
    """

    target: str
    forms: Callable[[Formulas], tuple[Form, ...]]
    files: Callable[[Formulas, tuple[Form, ...]], dict[str, str]]
    sources: tuple[str | Path, ...] = ()
    rewritten: tuple[str, ...] = ()
    scales: Scales = field(default_factory=Scales)


def forms_of(chain: Chain, package: Package) -> tuple[Form, ...]:
    """Return the stable forms, proved equal to the formulas."""
    kinds = (Form, Block, Step, Branch, Switch)
    rooms = ("engine/rewrite", "engine/emit", *package.sources)
    return chain.cached_result("forms", lambda: package.forms(chain.formulas()), *kinds, also=rooms)


def files_of(chain: Chain, package: Package) -> dict[str, str]:
    """Return the contents of the package's files by name."""
    folders = ("engine/rewrite", "engine/errata", "engine/emit", "engine/runtime")
    rooms = (*folders, *package.sources)

    def compute() -> dict[str, str]:
        return package.files(chain.formulas(), forms_of(chain, package))

    return chain.cached_result("package", compute, also=rooms)


def write(chain: Chain, package: Package, folder: Path) -> tuple[Path, ...]:
    """Write the package into a folder; return the files written.

    Raises
    ------
    OSError
        If the folder cannot be written to.
    """
    return write_folder(folder, files_of(chain, package))


def freshness_of(chain: Chain, package: Package, folder: Path, remedy: str) -> Freshness:
    """Compare a folder with the files of the package; `remedy` is the command that writes them."""
    recover(real(folder))
    return compare(folder, files_of(chain, package), remedy)
