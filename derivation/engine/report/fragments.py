"""LaTeX of formulas, to be pasted into another document."""

from collections.abc import Iterator, Sequence

from derivation.engine.formula.record import Record
from derivation.engine.nearest import did_you_mean
from derivation.engine.report.equations import COLUMN, body
from derivation.engine.report.latex import prose
from derivation.engine.report.references import References

HEAD = r"""% Packages: \usepackage{amsmath,amssymb}
% Sources: \bibliography{report}, with report.bib in the same folder
"""
NEAR = 3
"""Largest number of names suggested for an unknown name."""


def formula_fragments(
    names: Sequence[str], steps: Sequence[tuple[str, Sequence[Record]]], references: References
) -> str:
    """Return LaTeX of the named formulas, and of all formulas of the named steps.

    Raises
    ------
    ValueError
        If a name is neither a formula nor a step.
    """
    pieces = [piece for name in names for piece in _pieces(name, steps, references)]
    return HEAD + "\n" + "\n".join(dict.fromkeys(pieces))


def _pieces(
    name: str, steps: Sequence[tuple[str, Sequence[Record]]], references: References
) -> Iterator[str]:
    chosen = [
        (step, formula)
        for step, formulas in steps
        for formula in formulas
        if name in (step, formula.name)
    ]
    if not chosen:
        known = [title for title, _ in steps] + [f.name for _, held in steps for f in held]
        suggestion = did_you_mean(name, known, most=NEAR)
        raise ValueError(
            f"--fragment: no formula or derivation step {name!r}: {suggestion}"
            "`platecontact derive` lists the formulas, `platecontact derive NAME` shows the "
            "derivation step of one"
        )
    for step, formula in chosen:
        yield fragment(step, formula, references)


def fragment(step: str, formula: Record, references: References) -> str:
    """Return a formula as LaTeX: its meaning, an equation with a label, and comments.

    The comments state the formulas from which it follows, the step that verified it, and the
    symbols. Lines fit a column of a two-column paper, and the LaTeX needs no definitions of its
    own.
    """
    paper = r"~\cite{paper}" if "paper" in references.entries else " the paper"
    of = f", equation~({formula.equation}) of{paper}" if formula.equation else ""
    sources = [key for key in references.cited(step) if key != "paper"]
    see = rf"; see~\cite{{{','.join(sources)}}}" if sources else ""
    came = f", from {', '.join(formula.sources)}" if formula.sources else ""
    lines = body(formula, room=COLUMN)
    used = formula.shown.free_symbols
    symbols = "".join(
        f"% ${argument.latex}$ [{argument.unit}]: {argument.meaning}\n"
        for argument in formula.vocabulary.arguments
        if argument.symbol in used
    )
    meaning = prose(formula.meaning[0].upper() + formula.meaning[1:])
    return (
        f"% {formula.name} [{formula.unit}]{came}; verified: {formula.proof.step}\n{symbols}"
        f"{meaning}{of}{see}:\n"
        f"\\begin{{equation}}\\label{{eq:{formula.name}}}\n{lines}\n\\end{{equation}}\n"
    )
