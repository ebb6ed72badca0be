"""The report of any paper: derivation, misprints and accuracy."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from derivation.engine.errata.findings import Finding
from derivation.engine.formula.chain import Found
from derivation.engine.report.document import Text
from derivation.engine.report.latex import environment, escape
from derivation.engine.report.pieces import (
    Prose,
    accuracy_tables,
    chain_context,
    finding_context,
    link_context,
)

SECTIONS = ("derivation", "misprints", "accuracy")
"""In the report's order."""


@dataclass(frozen=True)
class Contents:
    """All that the report is a function of.

    Parameters
    ----------
    title, subtitle, abstract
        What the paper is about.
    links
        The chain's links with their formulas.
    findings
        Every printed formula against the derived one.
    check
        The kept measurement of the generated functions.
    prose
        Prose by link, and references.
    version
        Of this program.
    """

    title: str
    subtitle: str
    abstract: str
    links: Found
    findings: Sequence[Finding]
    check: Mapping[str, Any]
    prose: Prose
    version: str


def text(contents: Contents, shown: Sequence[str] = SECTIONS) -> Text:
    """The report's LaTeX, with the named sections."""
    made = environment()
    formulas = {f.name: f for _, found in contents.links for f in found}
    provenance = contents.check["provenance"]
    versions = sorted((k, v) for k, v in provenance.items() if k not in ("digits", "generated"))
    contexts: dict[str, dict[str, Any]] = {
        "front": {
            "title": contents.title,
            "subtitle": contents.subtitle,
            "abstract": contents.abstract,
            "version": contents.version,
            "versions": ", ".join(f"{escape(name)} {escape(value)}" for name, value in versions),
        },
        "derivation": {
            "chain": chain_context(contents.links),
            "links": [
                link_context(name, found, formulas, contents.prose)
                for name, found in contents.links
            ],
        },
        "misprints": {
            "findings": [finding_context(finding) for finding in contents.findings],
            "wrong": sum(finding.is_misprint for finding in contents.findings),
        },
        "accuracy": {
            "tables": [t for t in accuracy_tables(contents.check) if t["rows"]],
            "digits": provenance["digits"],
            "agreed": sum(row["oracles"] for row in contents.check["rows"]),
        },
    }
    front, *sections = (
        made.get_template(f"any/{name}.tex.j2").render(**context)
        for name, context in contexts.items()
        if name == "front" or name in shown
    )
    items = contents.prose.references.items()
    references = made.get_template("references.tex.j2").render(references=items) if items else ""
    return Text(contents.title, front, tuple(sections), references)
