"""The sections of the report in order, and the values for their templates."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from derivation.engine.errata.findings import Finding
from derivation.engine.formula.record import Record
from derivation.engine.report import contexts
from derivation.engine.report.arithmetic import arithmetic_context
from derivation.engine.report.document import Parts, Plan
from derivation.engine.report.hard import hard_context
from derivation.engine.report.latex import environment
from derivation.engine.report.numbers import number, rounded
from derivation.engine.rewrite.account import ENDS
from derivation.plate.budgets import counted_modules
from derivation.plate.contact.cases.grid import RATIOS, THICKNESSES
from derivation.plate.report import content
from derivation.plate.report.accuracy import accuracy_context
from derivation.plate.report.consequence import Consequences, misprint_names, misprints_context
from derivation.plate.report.dynamic_benchmark import dynamic_benchmark_context
from derivation.plate.report.elastodynamics import elastodynamics_context
from derivation.plate.report.figures import motion_context
from derivation.plate.report.front import TITLE, front_context
from derivation.plate.report.inertia import inertia_context
from derivation.plate.report.listings import listings_context
from derivation.plate.report.prose import ABOUT, FACTOR, REFERENCES
from derivation.plate.report.reproducibility import reproducibility_context
from derivation.plate.report.scenes import effects_context
from derivation.plate.report.validity import law_context
from derivation.plate.vocabulary import PLATE
from derivation.scene.model import Model
from derivation.scene.scene import Scene


@dataclass(frozen=True)
class Material:
    """The input of the report.

    Attributes
    ----------
    steps
        The derivation steps with their formulas.
    findings
        The comparison of each published formula with the derived one.
    data
        Contents of the files of recorded measurements by name.
    measured
        The same, parsed.
    case
        The example of the paper.
    scenes
        Example scenes by name.
    sources
        Text of the generated modules by name.
    version, citation
        Version of this program, and title of the paper.
    """

    steps: Sequence[tuple[str, Sequence[Record]]]
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
        """All formulas by name."""
        return {formula.name: formula for _, records in self.steps for formula in records}

    @cached_property
    def effects(self) -> dict[str, Any]:
        """All effects, and their selection for each example scene."""
        return effects_context(self.scenes)


def _derivation(material: Material) -> dict[str, Any]:
    return {
        "navier": content.navier(),
        "roots": content.roots_context(material.formulas),
        **contexts.derivation_context(material.steps, PROSE),
    }


def _misprints(material: Material) -> dict[str, Any]:
    cost = Consequences(material.case, material.formulas)
    return {
        **misprints_context(material.findings, cost),
        "motion": motion_context(material.case),
        "cancellation": list(
            content.cancellation_rows(
                material.measured["check"]["rows"], misprint_names(material.findings)
            )
        ),
    }


def _effects(material: Material) -> dict[str, Any]:
    return {
        "effects": material.effects,
        "moving": inertia_context(material.measured["inertia"]),
        "elements": elastodynamics_context(material.measured["elastodynamics"]),
    }


def _stability(material: Material) -> dict[str, Any]:
    contact = material.measured["contact"]
    return {
        "rules": list(content.rule_rows(material.measured["rewrite"]["rows"])),
        "modules": list(content.module_rows(material.measured["check"]["rows"])),
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
        "hard": hard_context(material.measured["hard"], PLATE),
    }


def _accuracy(material: Material) -> dict[str, Any]:
    check = material.measured["check"]
    return {
        "elements": elastodynamics_context(material.measured["elastodynamics"]),
        "tables": list(contexts.accuracy_tables(check)),
        "digits": check["provenance"]["digits"],
    }


def _rewriting(material: Material) -> dict[str, Any]:
    rows = material.measured["rewrite"]["rows"]
    return {
        "rewrites": [line for row in rows for line in contexts.rewrite_rows(row)],
        "ends": [rounded(end) for end in ENDS],
    }


def _methods(material: Material) -> dict[str, Any]:
    return {
        "cost": accuracy_context(material.measured["accuracy"]),
        "moving": dynamic_benchmark_context(material.measured["moving"]),
    }


def _speed(material: Material) -> dict[str, Any]:
    timed = material.measured["speed"]
    rows = [
        row | {"value": rounded(row["value"]), "limit": rounded(row["limit"])}
        for row in timed["rows"]
    ]
    return {"timings": rows, "machine": sorted(timed["machine"].items())}


TEMPLATES = Path(__file__).parent / "templates"
PROSE = contexts.Prose(ABOUT, REFERENCES, FACTOR)
CONTEXTS: dict[str, Callable[[Material], dict[str, Any]]] = {
    "misprints": _misprints,
    "symbols": lambda _: contexts.symbols_context(PLATE),
    "law": lambda m: {"law": law_context(m.formulas)},
    "motion": lambda m: {"motion": motion_context(m.case)},
    "effects": _effects,
    "work-precision": _methods,
    "stability": _stability,
    "derivation": _derivation,
    "published": lambda m: contexts.misprints_context(m.findings),
    "scenes": lambda m: {"effects": m.effects},
    "rewriting": _rewriting,
    "code": lambda m: {
        "code": listings_context(m.sources, m.formulas),
        "arithmetic": arithmetic_context(counted_modules(m.sources)),
    },
    "accuracy": _accuracy,
    "methods": _methods,
    "speed": _speed,
    "reproducibility": lambda m: {"reproducibility": reproducibility_context(m.data, m.measured)},
    "cases": lambda m: {"hard": hard_context(m.measured["hard"], PLATE)},
}
"""Functions for the values of `templates/sections/NAME.tex.j2`, in the order of the report."""
PLAN = Plan(tuple(CONTEXTS)[:7], tuple(CONTEXTS)[7:])


def parts(material: Material, shown: Sequence[str]) -> Parts:
    """Return the LaTeX of the named sections; it depends on theory, code and measurements only."""
    templates = environment(TEMPLATES)
    front = templates.get_template("front.tex.j2").render(
        title=TITLE,
        version=material.version,
        citation=material.citation,
        front=front_context(
            material.steps, material.findings, material.measured, material.sources, material.case
        ),
    )
    sections = {
        name: templates.get_template(f"sections/{name}.tex.j2").render(**CONTEXTS[name](material))
        for name in shown
    }
    return Parts(TITLE, front, sections, REFERENCES)
