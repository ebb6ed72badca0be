"""The misprints of the paper, as the comparison of published and derived formulas finds them."""

from derivation.engine.errata.findings import Finding
from derivation.engine.formula.notation import to_markdown
from docs.generators.markdown import table


def text() -> str:
    """Return the table of misprints, then a section for each."""
    import platecontact as pc

    findings = pc.misprints()
    wrong = [finding for finding in findings if finding.is_misprint]
    rows = (
        (f"({f.printed.equation})", f"[`{f.printed.name}`](#{_anchor(f)})", f.kind) for f in wrong
    )
    correct = len(findings) - len(wrong)
    return "\n\n".join(
        [
            f"Of {len(findings)} published formulas, {correct} are correct, {len(wrong)} are not.",
            table(("equation", "formula", "finding"), rows),
            *(_section(finding) for finding in wrong),
        ]
    )


def _section(finding: Finding) -> str:
    said = finding.to_json()
    kind = (
        f"({_anchor(finding)})=\n## Equation ({said['equation']}), `{said['name']}`: {said['kind']}"
    )
    parts = [kind, "As published:", _formula(said["printed_latex"] or "")]
    if said["says"]:
        parts.append(f"The paper says: {to_markdown(finding.printed.says)}.")
    parts += ["As derived:", _formula(said["derived_latex"] or "")]
    parts.append(f"Correction: {to_markdown(finding.repair)}.")
    if said["dimension"]:
        parts.append(f"Dimension: {to_markdown(said['dimension'])}.")
    parts.append(f"The difference was found {said['method']}.")
    return "\n\n".join(parts)


def _anchor(finding: Finding) -> str:
    return f"misprint-{finding.printed.equation}-{finding.printed.name}".lower().replace("_", "-")


def _formula(latex: str) -> str:
    if "\\\\" in latex:
        latex = f"\\begin{{aligned}}{latex}\\end{{aligned}}"
    return f"$$\n{latex}\n$$"
