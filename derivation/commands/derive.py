"""The command `platecontact derive`: a table of all formulas, or the details of one formula."""

from textwrap import wrap
from typing import TYPE_CHECKING, Annotated

import typer

from derivation.commands.options import PaperFolder, chosen_paper
from derivation.engine.console import OUT, Json, stage, write_json_output
from derivation.engine.nearest import did_you_mean
from derivation.engine.text import WIDTH, aligned, paragraph

if TYPE_CHECKING:
    from derivation.engine.formula.record import Record
    from derivation.engine.formula_details import FormulaDetails

HEADS = ("formula", "unit", "eq.", "meaning")
NEAR = 3
"""Largest number of names suggested for an unknown name."""


def derive(
    name: Annotated[
        str | None, typer.Argument(metavar="NAME", help="Show the details of this formula.")
    ] = None,
    paper: PaperFolder = None,
    json: Json = None,
) -> None:
    """Derive all formulas from the equilibrium equations.

    Prints each formula with its unit, the number of its equation in the paper and its meaning. With
    NAME, prints one formula: expression, LaTeX, proof, and the formulas that it follows from.

    Example: platecontact derive K_j
    """
    from derivation.engine import build
    from derivation.engine.formula_details import formula_details

    chosen = chosen_paper(paper)
    with stage("derive"):
        formulas = build.formulas(chosen)
    if name is None:
        if write_json_output(lambda: [formula.to_json() for formula in formulas.values()], json):
            OUT.say(_table(list(formulas.values())))
            OUT.say("\nTo show one formula: platecontact derive NAME")
        return
    if name not in formulas:
        suggestion = did_you_mean(name, formulas, most=NEAR)
        raise ValueError(
            f"no formula {name!r}: {suggestion}`platecontact derive` lists all formulas"
        )
    of = formula_details(chosen, name)
    if write_json_output(of.to_json, json):
        OUT.say(_one(of))


def _table(formulas: "list[Record]") -> str:
    """Return the table of formulas, at most 80 columns wide; long meanings are wrapped."""
    from derivation.engine.formula.notation import to_plain

    starts = [(f.name, f.unit, f.equation) for f in formulas]
    columns = zip(HEADS[:3], zip(*starts, strict=True), strict=True)
    taken = sum(max(len(text) for text in (head, *cells)) + 2 for head, cells in columns)
    rows = []
    for start, formula in zip(starts, formulas, strict=True):
        first, *others = wrap(to_plain(formula.meaning), WIDTH - taken) or [""]
        rows.append((*start, first))
        rows += [("", "", "", line) for line in others]
    return aligned(HEADS, rows)


def _one(of: "FormulaDetails") -> str:
    """Return the details of a formula; equations are not wrapped, so that they can be copied."""
    formula, shown = of.formula, of.formula.to_json()
    proof = formula.proof
    equation = f"equation ({formula.equation}) of the paper" if formula.equation else ""
    index = formula.vocabulary.indices[:1]
    summed = (
        [f"The quantity is the sum of this expression over {index} = 1, 2, ..."]
        if formula.summed
        else []
    )
    symbols = [f"{x.name} [{x.unit}]: {meaning}" for x, meaning in of.arguments]
    parts = {
        "Derivation step": [of.step],
        "Arguments": symbols,
        "Domain": [", ".join(formula.domain)] if formula.domain else [],
        f"Verified {proof.method}": [f"{proof.step}. {of.argument}"],
        "Residuals reduced to zero": list(proof.residuals),
        "Follows from": [", ".join(formula.sources) or "nothing before it"],
        "Used by": [", ".join(of.used_by) or "no other formula"],
        "Sources": list(of.references),
    }
    lines = [
        paragraph(f"{formula.name} [{formula.unit}]: {shown['meaning']}"),
        *([paragraph(equation)] if equation else []),
        "",
        f"{formula.name} = {shown['expression']}",
        *summed,
        "",
        str(shown["latex"]),
        "",
    ]
    for title, texts in parts.items():
        if len(texts) == 1:
            lines.append(paragraph(f"{title}: {texts[0]}"))
        elif texts:
            lines += [f"{title}:", *(f"  {paragraph(text, 4)}" for text in texts)]
    return "\n".join(lines)
