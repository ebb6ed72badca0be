"""Cached results of the first stages: proved formulas, misprints, comparisons of formulas."""

from derivation.engine.errata.findings import Finding
from derivation.engine.errata.point import GivenPoint
from derivation.engine.errata.text import TextDiagnosis, diagnose_limited
from derivation.engine.formula.chain import Chain, DerivationStep
from derivation.plate.chain import MOTION_STEPS, STEPS
from derivation.plate.elastic import RELATIONS
from derivation.plate.misprints import ERRATA
from derivation.plate.vocabulary import PLATE, Formula, PlateRoot

GROUND = (
    "engine/cache.py",
    "engine/formula",
    "plate/*.py",
    "plate/*/theory*",
    "plate/printed",
    "mathematics",
)
"""Sources on which the formulas depend."""
CHAIN = Chain(
    "plate",
    PLATE,
    tuple(DerivationStep(name, derive) for name, derive in (*STEPS, *MOTION_STEPS)),
    GROUND,
    (Formula, PlateRoot),
)
chain, formulas = CHAIN.derived_steps, CHAIN.formulas


def misprints() -> tuple[Finding, ...]:
    """Return the comparison of each published formula with the derived one."""
    return ERRATA.findings(CHAIN)


def diagnose(
    name: str, text: str, latex: bool = False, at: GivenPoint = "", digits: int = 50
) -> TextDiagnosis:
    """Compare a formula given as text with the derived one.

    Parameters
    ----------
    name, text, latex, digits
        As for `derivation.engine.errata.text.diagnose_text`.
    at
        Values of symbols in SI units, a list like ``phi=2.5,h=0.1``, or a mapping.

    Raises
    ------
    derivation.engine.formula.parse.FormulaError
        If a name, formula, point or number of digits is not valid.
    """
    return diagnose_limited(CHAIN, RELATIONS, name, text, latex=latex, at=at, digits=digits)
