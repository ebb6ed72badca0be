"""The object `PAPER`, which the program loads."""

from pathlib import Path

from derivation.engine.errata.errata import Errata
from derivation.engine.files import files_of_paper
from derivation.engine.formula.chain import Chain, DerivationStep
from derivation.engine.measure.domain_grid import domain_judge
from derivation.engine.measure.point import Point
from derivation.engine.package import Package
from derivation.engine.paper import Paper, Report
from derivation.engine.report.contexts import Prose

from . import prose
from .kernels import PACKAGE, REWRITTEN
from .printed import PRINTED, RELATIONS
from .route import ROUTES
from .theory import film
from .vocabulary import FILM, Formula

HERE = Path(__file__).resolve().parent
STEPS = {
    "film": film,
}
"""The steps of the derivation, in order."""
TARGET = f"{__package__}.generated"
CHAIN = Chain(
    "film",
    FILM,
    tuple(DerivationStep(name, derive) for name, derive in STEPS.items()),
    ("engine/cache.py", "engine/formula", *files_of_paper(HERE)),
    (Formula,),
)


def easy(point: Point) -> bool:
    """Return whether the second reference method is fast: for films neither thin nor thick."""
    v = point.values
    thickness = v.get("T", 2 * v.get("k", 0.5) * v.get("H", 1.0))
    return ("k" not in v and "T" not in v) or 1e-3 < thickness < 20


PAPER = Paper(
    title=prose.TITLE,
    folder=HERE,
    records=HERE / "reports",
    chain=CHAIN,
    errata=Errata(PRINTED, RELATIONS),
    package=lambda: Package(
        TARGET,
        PACKAGE.forms,
        PACKAGE.files,
        rewritten=REWRITTEN,
    ),
    judge=lambda: domain_judge(
        CHAIN, ROUTES, TARGET, PACKAGE.blocks, easy, HERE / "hard_cases.toml"
    ),
    report=lambda: Report(Prose(prose.ABOUT), prose.SUBTITLE, prose.ABSTRACT),
)
