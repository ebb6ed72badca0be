"""The report's sections in order, and what each one's template is filled with."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from derivation.engine.errata.findings import Finding
from derivation.engine.formula.record import Record
from derivation.engine.report import pieces
from derivation.engine.report.arithmetic import arithmetic_context
from derivation.engine.report.document import Text
from derivation.engine.report.hard import hard_context
from derivation.engine.report.latex import environment
from derivation.engine.report.numbers import number, rounded
from derivation.engine.rewrite.account import ENDS
from derivation.plate.budgets import counted
from derivation.plate.contact.cases.grid import RATIOS, THICKNESSES
from derivation.plate.report import content
from derivation.plate.report.accuracy import accuracy_context
from derivation.plate.report.consequence import Consequences, misprints_context
from derivation.plate.report.elastodynamics import elastodynamics_context
from derivation.plate.report.figures import motion_context
from derivation.plate.report.front import SUBTITLE, TITLE, front_context
from derivation.plate.report.inertia import inertia_context
from derivation.plate.report.listings import listings_context
from derivation.plate.report.moving import moving_context
from derivation.plate.report.prose import ABOUT, FACTOR, REFERENCES
from derivation.plate.report.reproducibility import reproducibility_context
from derivation.plate.report.scenes import effects_context
from derivation.plate.report.validity import law_context
from derivation.scene.model import Model
from derivation.scene.scene import Scene


@dataclass(frozen=True)
class Material:
    """All that the report is a function of.

    Attributes
    ----------
    links
        The chain's links with their formulas.
    findings
        Every printed formula against the derived one.
    data
        Contents of the committed measurements' files by name.
    measured
        The same, read.
    case
        The paper's case.
    scenes
        Example scenes by name.
    sources
        Text of the generated modules by name.
    version, citation
        Of this program, and the paper's title.
    """

    links: Sequence[tuple[str, Sequence[Record]]]
    findings: Sequence[Finding]
    data: Mapping[str, bytes]
    measured: Mapping[str, Mapping[str, Any]]
    case: Model
    scenes: Mapping[str, Scene]
    sources: Mapping[str, str]
    version: str
    citation: str

    @cached_property
    def formulas(self) -> dict[str, Record]:
        """Every formula by name."""
        return {formula.name: formula for _, found in self.links for formula in found}


def _derivation(material: Material) -> dict[str, Any]:
    return {
        "navier": content.navier(),
        "chain": pieces.chain_context(material.links),
        "links": [
            pieces.link_context(name, found, material.formulas, PROSE)
            for name, found in material.links
        ],
        "roots": content.roots_context(material.formulas),
    }


def _misprints(material: Material) -> dict[str, Any]:
    cost = Consequences(material.case, material.formulas)
    return misprints_context(material.findings, cost)


def _accuracy(material: Material) -> dict[str, Any]:
    check, contact = material.measured["check"], material.measured["contact"]
    return {
        "moving": inertia_context(material.measured["inertia"]),
        "elements": elastodynamics_context(material.measured["elastodynamics"]),
        "tables": list(pieces.accuracy_tables(check)),
        "digits": check["provenance"]["digits"],
        "contact_rows": [content.contact_row(row) for row in contact["rows"]],
        "contact_digits": contact["provenance"]["digits"],
        "contact_limit": number(contact["limit"]),
        "contact_impacts": content.contact_impacts(contact["rows"]),
        "grid": {
            "thinnest": rounded(min(THICKNESSES)),
            "thickest": rounded(max(THICKNESSES)),
            "smallest": rounded(min(RATIOS)),
            "largest": rounded(max(RATIOS)),
        },
    }


def _rewriting(material: Material) -> dict[str, Any]:
    rows = material.measured["rewrite"]["rows"]
    return {
        "rewrites": [line for row in rows for line in pieces.rewrite_rows(row)],
        "ends": [rounded(end) for end in ENDS],
    }


def _speed(material: Material) -> dict[str, Any]:
    timed = material.measured["speed"]
    rows = [
        row | {"value": rounded(row["value"]), "limit": rounded(row["limit"])}
        for row in timed["rows"]
    ]
    return {"timings": rows, "machine": sorted(timed["machine"].items())}


TEMPLATES = Path(__file__).parent / "templates"
PROSE = pieces.Prose(ABOUT, REFERENCES, FACTOR)
SECTIONS: dict[str, Callable[[Material], dict[str, Any]]] = {
    "derivation": _derivation,
    "misprints": _misprints,
    "law": lambda m: {"law": law_context(m.formulas)},
    "motion": lambda m: {"motion": motion_context(m.case)},
    "rewriting": _rewriting,
    "code": lambda m: {
        "code": listings_context(m.sources, m.formulas),
        "arithmetic": arithmetic_context(counted(m.sources)),
    },
    "accuracy": _accuracy,
    "hard": lambda m: {"hard": hard_context(m.measured["hard"])},
    "speed": _speed,
    "work-precision": lambda m: {
        "cost": accuracy_context(m.measured["accuracy"]),
        "moving": moving_context(m.measured["moving"]),
    },
    "effects": lambda m: {"effects": effects_context(m.scenes)},
    "reproducibility": lambda m: {"reproducibility": reproducibility_context(m.data, m.measured)},
    "cases": lambda m: {"hard": hard_context(m.measured["hard"])},
}
"""What fills `templates/sections/NAME.tex.j2`, by name, in the report's order."""


def text(material: Material, shown: Sequence[str]) -> Text:
    """The named sections' LaTeX, a pure function of theory, generated code and measurements."""
    made = environment(TEMPLATES)
    front = made.get_template("front.tex.j2").render(
        title=TITLE,
        subtitle=SUBTITLE,
        version=material.version,
        citation=material.citation,
        front=front_context(material.links, material.findings, material.measured, material.sources),
    )
    sections = (
        made.get_template(f"sections/{name}.tex.j2").render(**SECTIONS[name](material), shown=shown)
        for name in shown
    )
    references = made.get_template("references.tex.j2").render(references=REFERENCES.items())
    return Text(TITLE, front, tuple(sections), references)
