"""Formulas of the report as LaTeX to be pasted into another document."""

from collections.abc import Iterator, Sequence

from derivation.engine.formula.record import Record
from derivation.engine.nearest import did_you_mean
from derivation.engine.report.equations import COLUMN, body
from derivation.engine.report.latex import prose
from derivation.engine.report.references import References

HEAD = r"""% Packages: \usepackage{amsmath,amssymb}
% Sources: \bibliography{report}, with report.bib beside it
"""
NEAR = 3
"""Names suggested for one that is not known."""


def pasted(
    names: Sequence[str], links: Sequence[tuple[str, Sequence[Record]]], references: References
) -> str:
    """LaTeX of formulas by their names, or of all of a link by its.

    Raises
    ------
    ValueError
        If there is neither formula nor link of a name.
    """
    pieces = [piece for name in names for piece in _pieces(name, links, references)]
    return HEAD + "\n" + "\n".join(dict.fromkeys(pieces))


def _pieces(
    name: str, links: Sequence[tuple[str, Sequence[Record]]], references: References
) -> Iterator[str]:
    found = [
        (link, formula)
        for link, formulas in links
        for formula in formulas
        if name in (link, formula.name)
    ]
    if not found:
        known = [title for title, _ in links] + [f.name for _, held in links for f in held]
        near = did_you_mean(name, known, most=NEAR)
        raise ValueError(
            f"--fragment: no formula or derivation step {name!r}: {near}`platecontact derive` "
            "lists the formulas, `platecontact derive NAME` shows the derivation step of one"
        )
    for link, formula in found:
        yield fragment(link, formula, references)


def fragment(link: str, formula: Record, references: References) -> str:
    """A sentence, the formula as an equation with a label, and what it rests on.

    The lines fit a column of a paper in two columns, and no command of LaTeX is defined.
    """
    of = rf", equation~({formula.equation}) of~\cite{{paper}}" if formula.equation else ""
    sources = [key for key in references.cited(link) if key != "paper"]
    see = rf"; see~\cite{{{','.join(sources)}}}" if sources else ""
    came = f", from {', '.join(formula.sources)}" if formula.sources else ""
    lines = body(formula, room=COLUMN)
    meaning = prose(formula.meaning[0].upper() + formula.meaning[1:])
    return (
        f"% {formula.name} [{formula.unit}]{came}; verified: {formula.proof.step}\n"
        f"{meaning}{of}{see}:\n"
        f"\\begin{{equation}}\\label{{eq:{formula.name}}}\n{lines}\n\\end{{equation}}\n"
    )
