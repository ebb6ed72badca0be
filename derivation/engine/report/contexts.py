"""Values for the report's templates, from formulas, findings and measurements of any paper."""

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import zip_longest
from typing import Any

from derivation.engine.errata.findings import Finding
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.report.equations import body, function_by_name, right_side
from derivation.engine.report.latex import escape, unit
from derivation.engine.report.numbers import number
from derivation.engine.report.references import References
from derivation.engine.report.sentences import typeset_sentence, with_large_fractions

NO_REFERENCES = References()
COLUMNS = (
    "[ULP]: number of points, largest error, error that 99\\,\\% of the points stay below, root "
    "mean square, error budget, and the largest error relative to what is allowed, which is the "
    "budget plus half the sum of the condition numbers."
)
"""Description of the columns of a table of errors."""


@dataclass(frozen=True)
class Prose:
    """Text about the steps of a derivation.

    Parameters
    ----------
    about
        A few sentences for each step, by its name.
    references
        The sources.
    factor
        Name of a formula that is shown by its name in other formulas; empty if there is none.
    """

    about: Mapping[str, str] = field(default_factory=dict)
    references: References = NO_REFERENCES
    factor: str = ""


def chain_context(steps: Sequence[tuple[str, Sequence[Record]]]) -> dict[str, Any]:
    """Return the summary of the derivation: each step, the steps it uses, number of formulas."""
    home = {f.name: place for place, (_, records) in enumerate(steps, 1) for f in records}
    rows = []
    for place, (name, records) in enumerate(steps, start=1):
        built = {home[name] for f in records for name in f.sources if name in home} - {place}
        on = ", ".join(str(n) for n in sorted(built)) or "--"
        equations = sorted({f.equation for f in records if f.equation}, key=_equation_order)
        printed = ", ".join(f"({e})" for e in equations)
        rows.append(f"{place} & {escape(name)} & {on} & {len(records)} & {printed}")
    decided = Counter(f.proof.method for _, records in steps for f in records)
    return {
        "verified": verified(decided),
        "rows": rows,
    }


def verified(methods: Mapping[str, int]) -> str:
    """Return how many formulas were verified by which method, as a sentence without full stop."""
    count = sum(methods.values())
    if len(methods) == 1:
        return f"All {count} formulas were verified {next(iter(methods))}"
    parts = ", ".join(f"{some} were verified {how}" for how, some in methods.items())
    return f"Of the {count} formulas, {parts}"


def _equation_order(text: str) -> tuple[int, str]:
    digits = re.match(r"\d+", text)
    return (int(digits[0]) if digits else 0, text)


def derivation_context(
    steps: Sequence[tuple[str, Sequence[Record]]], prose: Prose
) -> dict[str, Any]:
    """Return the summary of the derivation, and the context of each step."""
    formulas = {f.name: f for _, records in steps for f in records}
    return {
        "chain": chain_context(steps),
        "steps": [step_context(name, records, formulas, prose) for name, records in steps],
    }


def symbols_context(vocabulary: Vocabulary) -> dict[str, Any]:
    """Return the table of symbols with meaning and unit, two symbols in a row."""
    cells = [
        f"${symbol.latex}$ & {typeset_sentence(symbol.meaning, vocabulary)} & {unit(symbol.unit)}"
        for symbol in vocabulary.arguments
    ]
    half = (len(cells) + 1) // 2
    pairs = zip_longest(cells[:half], cells[half:], fillvalue=" & & ")
    return {"symbols": [" & ".join(pair) for pair in pairs]}


def step_context(
    name: str, formulas: Sequence[Record], shown: Mapping[str, Record], said: Prose
) -> dict[str, Any]:
    """Return a step's context: its formulas, with references to `shown`, and each proof once."""
    proofs = {f.proof.step: (f.proof, f.vocabulary) for f in formulas}
    return {
        "title": name[0].upper() + name[1:],
        "about": said.about.get(name, ""),
        "cited": said.references.cited(name),
        "formulas": [formula_context(formula, shown, said.factor) for formula in formulas],
        "proofs": [
            {
                "step": typeset_sentence(proof.step, vocabulary),
                "argument": typeset_sentence(proof.argument, vocabulary),
                "method": proof.method,
                "residuals": typeset_sentence(", ".join(proof.residuals), vocabulary),
            }
            for proof, vocabulary in proofs.values()
        ],
    }


def formula_context(
    formula: Record, known: Mapping[str, Record] | None = None, named: str = ""
) -> dict[str, Any]:
    """Return the context of a formula, with the formulas from which it follows.

    Those in `known` are cited with their equation number. The formula `named` is shown by its name.
    """
    known = known or {}
    whole, factor = right_side(formula), known.get(named)
    sources = [reference(source, known) for source in formula.sources]
    if factor and whole.free_symbols == factor.expression.free_symbols:
        factor = None  # the factor is not named in its own step
    if factor and function_by_name(whole, factor) != whole and named not in formula.sources:
        sources.append(f"with {reference(named, known)}")
    return {
        "name": formula.name,
        "meaning": typeset_sentence(formula.meaning, formula.vocabulary),
        "unit": unit(formula.unit),
        "equation": formula.equation,
        "sources": ", ".join(sources),
        "body": body(formula, factor),
    }


def reference(name: str, known: Collection[str]) -> str:
    """Return a formula's name as LaTeX, with a reference to its equation if it is known."""
    place = rf"~(\ref{{eq:{name}}})" if name in known else ""
    return rf"\texttt{{{escape(name)}}}{place}"


def misprints_context(findings: Sequence[Finding]) -> dict[str, Any]:
    """Return the comparisons of published formulas with derived ones, and number of misprints."""
    return {
        "findings": [finding_context(finding) for finding in findings],
        "wrong": sum(finding.is_misprint for finding in findings),
    }


def finding_context(finding: Finding) -> dict[str, Any]:
    """Return the context of a comparison."""
    printed, diagnosis = finding.printed, finding.diagnosis
    formula = finding.formula
    return {
        "equation": printed.equation,
        "name": printed.name,
        "says": printed.says,
        "printed": as_printed(printed.symbol, printed.full or printed.latex),
        "derived": body(formula),
        "equal": not finding.is_misprint,
        "kind": finding.kind[0].upper() + finding.kind[1:],
        "repair": with_large_fractions(
            typeset_sentence(
                finding.repair[0].upper() + finding.repair[1:].rstrip("."), formula.vocabulary
            )
        ),
        "dimension": typeset_sentence(diagnosis.dimension or "", formula.vocabulary),
        "method": diagnosis.method,
        "consequence": "",
    }


def as_printed(left: str, right: str) -> str:
    """Return a published equation as LaTeX, with the line breaks of the paper."""
    right = right.rstrip(". ")
    if "&" in right:
        return rf"\begin{{aligned}} {left} ={{}}& {right} \end{{aligned}}"
    return f"{left} = {right}"


def accuracy_tables(check: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the tables of errors: generated functions, then the formulas as published."""
    stated_limits = [row for row in check["rows"] if row["passed"] is not None]
    printed = [row for row in check["rows"] if row["passed"] is None]
    for subject, rows in (
        ("Errors of the generated functions", stated_limits),
        ("Errors of the formulas evaluated as published, at the same points", printed),
    ):
        yield {"caption": f"{subject} {COLUMNS}", "rows": [accuracy_row(row) for row in rows]}


def accuracy_row(row: Mapping[str, Any]) -> str:
    """Return the cells of a function; the error of a result that is not finite is infinite."""
    errors = row["double"]
    cells = [
        rf"\texttt{{{escape(row['kernel'])}}}",
        str(errors["points"]),
        number(errors["max_ulp"]) if not errors["not_finite"] else r"$\infty$",
        number(errors["p99_ulp"]),
        number(errors["rms_ulp"]),
        "" if row["budget"] is None else f"{row['budget']:g}",
        "" if errors["ratio"] is None else number(errors["ratio"]),
    ]
    return " & ".join(cells)


def rewrite_rows(row: Mapping[str, Any]) -> Iterator[str]:
    """Yield the cells of each rule of a formula: operations and error without and with it."""
    for index, applied in enumerate(row["applied"]):
        name = rf"\texttt{{{escape(row['name'])}}}" if index == 0 else ""
        (fewer, more), (without, within) = applied["operations"], applied["worst"]
        cells = [name, escape(applied["rule"]), escape(applied["cause"]), str(fewer), str(more)]
        yield " & ".join([*cells, number(without), number(within)])
