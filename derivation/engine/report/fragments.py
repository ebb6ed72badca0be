"""Formulas of the report as LaTeX to be pasted into another document."""

from collections.abc import Iterator, Sequence

from derivation.engine.formula.record import Record
from derivation.engine.nearest import did_you_mean
from derivation.engine.report.latex import prose
from derivation.engine.report.pieces import formula_context
from derivation.engine.report.references import References

FIT = r"\fit"
HEAD = r"""% Packages: \usepackage{amsmath,amssymb}
% Sources: \bibliography{report}, with report.bib beside it
"""
WIDE = r"""% What is too wide for the line is scaled down to it, by \usepackage{graphicx} and
\newsavebox{\wide}
\newcommand{\fit}[2][0.9]{\sbox{\wide}{$\displaystyle #2$}%
  \ifdim\wd\wide>#1\linewidth\resizebox{#1\linewidth}{!}{\usebox{\wide}}\else\usebox{\wide}\fi}
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
    text = "\n".join(dict.fromkeys(pieces))
    return HEAD + (WIDE if FIT in text else "") + "\n" + text


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
    """A sentence, the formula as an equation with a label, and what it rests on."""
    body = formula_context(formula)["body"]
    body = rf"{FIT}{{{body}}}" if "aligned" in body else body
    of = rf", equation~({formula.equation}) of~\cite{{paper}}" if formula.equation else ""
    sources = [key for key in references.cited(link) if key != "paper"]
    see = rf"; see~\cite{{{','.join(sources)}}}" if sources else ""
    came = f", from {', '.join(formula.sources)}" if formula.sources else ""
    meaning = prose(formula.meaning[0].upper() + formula.meaning[1:])
    return (
        f"% {formula.name} [{formula.unit}]{came}; proved: {formula.proof.step}\n"
        f"{meaning}{of}{see}:\n"
        f"\\begin{{equation}}\\label{{eq:{formula.name}}}\n{body}\n\\end{{equation}}\n"
    )
