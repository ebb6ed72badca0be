"""The misprints of the paper, as the comparison of published and derived formulas finds them."""

import pypandoc

from derivation.engine.errata.findings import Finding
from derivation.engine.formula.notation import to_markdown
from derivation.engine.report.contexts import finding_context
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
    parts += _typeset(finding)
    parts.append(f"The difference was found {said['method']}.")
    return "\n\n".join(parts)


def _typeset(finding: Finding) -> list[str]:
    """Return the correction and the dimensions as Markdown, with typeset formulas."""
    typeset = finding_context(finding)
    said = f"Correction: {typeset['repair']}."
    if typeset["dimension"]:
        said += f"\n\nDimension: {typeset['dimension']}."
    wide = ["--wrap=none"]
    return [pypandoc.convert_text(said, "commonmark_x", format="latex", extra_args=wide)]


def _anchor(finding: Finding) -> str:
    return f"misprint-{finding.printed.equation}-{finding.printed.name}".lower().replace("_", "-")


def _formula(latex: str) -> str:
    if "\\\\" in latex:
        latex = f"\\begin{{aligned}}{latex}\\end{{aligned}}"
    return f"$$\n{latex}\n$$"
