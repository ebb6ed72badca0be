"""The report of any paper: misprints, symbols and accuracy; the derivation in the appendices."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from derivation.engine.errata.findings import Finding
from derivation.engine.formula.chain import Found
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.report.contexts import (
    Prose,
    accuracy_tables,
    derivation_context,
    misprints_context,
    symbols_context,
)
from derivation.engine.report.document import Parts, Plan
from derivation.engine.report.latex import environment, escape

PLAN = Plan(("misprints", "symbols", "accuracy"), ("derivation", "published"))


@dataclass(frozen=True)
class ReportContents:
    """All data on which the report depends.

    Parameters
    ----------
    title, subtitle, abstract
        Title, subtitle, and a summary in a few sentences.
    vocabulary
        The symbols.
    steps
        The steps of the derivation with their formulas.
    findings
        The comparison of each published formula with the derived one.
    check
        The saved measurement of the generated functions, content of ``check.json``.
    prose
        Text by step, and references.
    version
        Version of this program.
    """

    title: str
    subtitle: str
    abstract: str
    vocabulary: Vocabulary
    steps: Found
    findings: Sequence[Finding]
    check: Mapping[str, Any]
    prose: Prose
    version: str


def parts(contents: ReportContents, shown: Sequence[str] = PLAN.names) -> Parts:
    """Return the report's LaTeX with the named sections."""
    made = environment()
    provenance = contents.check["provenance"]
    versions = sorted((k, v) for k, v in provenance.items() if k not in ("digits", "generated"))
    front = {
        "title": contents.title,
        "subtitle": contents.subtitle,
        "abstract": contents.abstract,
        "version": contents.version,
        "versions": ", ".join(f"{escape(name)} {escape(value)}" for name, value in versions),
    }
    return Parts(
        contents.title,
        made.get_template("any/front.tex.j2").render(**front),
        {
            name: made.get_template(f"any/{name}.tex.j2").render(**CONTEXTS[name](contents))
            for name in shown
        },
        contents.prose.references,
    )


def _accuracy(contents: ReportContents) -> dict[str, Any]:
    check = contents.check
    return {
        "tables": [t for t in accuracy_tables(check) if t["rows"]],
        "digits": check["provenance"]["digits"],
        "agreed": sum(row["oracles"] for row in check["rows"]),
    }


CONTEXTS: dict[str, Callable[[ReportContents], dict[str, Any]]] = {
    "misprints": lambda c: misprints_context(c.findings),
    "symbols": lambda c: symbols_context(c.vocabulary),
    "accuracy": _accuracy,
    "derivation": lambda c: derivation_context(c.steps, c.prose),
    "published": lambda c: misprints_context(c.findings),
}
"""Functions for the context of `templates/any/NAME.tex.j2`, by name."""
