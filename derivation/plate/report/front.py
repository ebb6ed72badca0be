"""The first page of the report: main findings, results of each stage, and versions."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from derivation.engine.errata.findings import Finding
from derivation.engine.formula.record import Record
from derivation.engine.measure.record import generated_hash
from derivation.engine.report.hard import error as power
from derivation.engine.report.latex import code, escape
from derivation.plate.judge import PACKAGE
from derivation.plate.report.accuracy import digits, duration
from derivation.plate.report.consequence import misprint_names
from derivation.plate.report.content import loses, published_errors
from derivation.plate.report.figures import TRUNCATIONS, corrected_impact, linear_impact
from derivation.scene.model import Model
from generated.manifest import KERNELS

ENDS = (TRUNCATIONS[0], TRUNCATIONS[-1])
"""Smallest and largest number of modes of the published sums in the summary."""
TITLE = "Contact of a rigid sphere with an elastic plate"
SUBTITLE = "Misprints of the paper, corrected contact law, accuracy"
Data = Mapping[str, Any]


def front_context(
    steps: Sequence[tuple[str, Sequence[Record]]],
    findings: Sequence[Finding],
    measured: Mapping[str, Data],
    sources: Mapping[str, str],
    case: Model,
) -> dict[str, Any]:
    """Return the values of the template."""
    provenance = measured["check"]["provenance"]
    versions = sorted((k, v) for k, v in provenance.items() if k not in ("digits", "generated"))
    return {
        "subtitle": SUBTITLE,
        "stages": [" & ".join(row) for row in stages(steps, findings, measured, sources)],
        "versions": ", ".join(f"{escape(name)} {escape(value)}" for name, value in versions),
        "generated": generated_hash(PACKAGE)[:16],
        **_misprints_in_short(findings, case),
        **_stability_in_short(findings, measured["check"]["rows"]),
        **_cost_in_short(measured["accuracy"]["headline"]),
    }


def _misprints_in_short(findings: Sequence[Finding], case: Model) -> dict[str, Any]:
    """Return the number of misprints, and their effect on the example of the paper."""
    corrected, first, last = corrected_impact(case), *(linear_impact(case, n) for n in ENDS)
    return {
        "wrong": sum(finding.is_misprint for finding in findings),
        "compared": len(findings),
        "few": ENDS[0],
        "many": ENDS[1],
        "short": f"{1e3 * first.contact_time:.2f}",
        "long": f"{1e3 * last.contact_time:.2f}",
        "time": f"{1e3 * corrected.contact_time:.2f}",
        "strong": f"{1e-3 * first.force:.1f}",
        "weak": f"{1e-3 * last.force:.1f}",
        "force": f"{1e-3 * corrected.force:.1f}",
    }


def _stability_in_short(findings: Sequence[Finding], rows: Sequence[Data]) -> dict[str, Any]:
    """Return the number of formulas that lose digits as published, and the budget used [%]."""
    published = list(published_errors(rows, misprint_names(findings)))
    used = max(row["double"]["ratio"] for row in rows if row["passed"] is not None)
    lost = [loses(row) and not loses(generated) for row, generated in published]
    return {"unstable": sum(lost), "evaluated": len(lost), "used": f"{100 * used:.0f}"}


def _cost_in_short(winners: Data) -> dict[str, Any]:
    """Return digits and run time of the generated law, and of the best direct sum."""
    best = winners["direct_sum"][-1]
    return {
        "called": duration(winners["seconds_with_setup"]),
        "digits": digits(winners["digits"]),
        "best": best["digits"],
        "ratio": power(best["seconds"] / winners["seconds_with_setup"]),
    }


def stages(
    steps: Sequence[tuple[str, Sequence[Record]]],
    findings: Sequence[Finding],
    measured: Mapping[str, Data],
    sources: Mapping[str, str],
) -> Iterator[tuple[str, str]]:
    """Yield table rows: each command with the numbers of its result."""
    formulas = [formula for _, records in steps for formula in records]
    residuals = {(f.proof.step, name) for f in formulas for name in f.proof.residuals}
    yield (
        code("derive"),
        (
            f"{len(formulas)} formulas in {len(steps)} steps, each verified; {len(residuals)} "
            "residuals reduced to zero"
        ),
    )
    applied = [rule for row in measured["rewrite"]["rows"] for rule in row["applied"]]
    yield (
        code("rewrite"),
        (
            f"{len(measured['rewrite']['rows'])} formulas made stable by {len(applied)} rules, "
            "each kept because the form without it is less accurate or longer"
        ),
    )
    yield (
        code("generate"),
        f"{len(sources)} NumPy modules, {len(KERNELS)} of their functions with one formula each",
    )
    wrong = sum(finding.is_misprint for finding in findings)
    yield code("misprints"), f"{len(findings)} published formulas compared, {wrong} differ"
    yield from checks(measured)


def checks(measured: Mapping[str, Data]) -> Iterator[tuple[str, str]]:
    """Yield table rows of the checks: number of comparisons, and largest fraction of a limit."""
    rows = [row for row in measured["check"]["rows"] if row["passed"] is not None]
    yield (
        code("check"),
        (
            f"{len(rows)} functions at {sum(row['double']['points'] for row in rows)} points, "
            + used(max(row["double"]["ratio"] for row in rows))
        ),
    )
    rows = measured["contact"]["rows"]
    yield (
        code("check contact-law"),
        (
            f"contact law and impact at {sum(row['points'] for row in rows)} points, "
            + used(max(row["double"]["ratio"] for row in rows))
        ),
    )
    cases = measured["hard"]["cases"]
    failed = sum(not case["passed"] for case in cases)
    yield code("check hard-cases"), f"{len(cases)} hard cases, {failed or 'none'} failed"
    if "bounds" in measured:
        runs = sum(row["runs"] for row in measured["bounds"]["rows"])
        worst = max(float(row["ratio"]) for row in measured["bounds"]["rows"])
        yield code("check error-bounds"), f"{runs} impacts of random scenes, {used(worst, 'bound')}"
    if "effects" in measured:
        worst = max(float(row["error_over_rtol"]) for row in measured["effects"]["rows"])
        yield (
            code("check effects"),
            (f"{measured['effects']['drawn']} random scenes, {used(worst, 'bound')}"),
        )
    moving = measured["inertia"]
    worst = max(float(side["error_over_bound"]) for side in moving["sides"])
    yield (
        code("check inertia"),
        f"{len(moving['rows'])} impacts on plates with inertia, {used(worst, 'bound')}",
    )
    rows = measured["speed"]["rows"]
    kept = sum(row["passed"] for row in rows)
    yield code("check timing"), f"{len(rows)} times measured, {kept} within their limits"
    rows = measured["accuracy"]["rows"]
    methods = {(row["task"], row["family"]) for row in rows}
    yield (
        code("benchmark"),
        (
            f"{len(methods)} methods in {len(measured['accuracy']['cases'])} cases, "
            f"{len(rows)} settings"
        ),
    )
    if "moving" in measured:
        yield code("benchmark --dynamic"), f"{len(measured['moving']['rows'])} settings"


def used(ratio: float, what: str = "allowed error") -> str:
    """Return the used fraction of a limit as text."""
    return f"at most {100 * ratio:.0f}" + rf"\,\% of the {what} used"
