"""The first stages, kept until their sources change: proven formulas, misprints, diagnosis."""

import re

import sympy as sp

from derivation.files import cached
from derivation.formula.parse import NAMES, parse
from derivation.formula.parse_latex import parse_latex
from derivation.formula.record import Formula
from derivation.paper.misprints import Finding
from derivation.paper.misprints import misprints as compare_printed
from derivation.paper.text import TextDiagnosis, diagnose_text
from derivation.theory.chain import links, motion_links

GROUND = ("files.py", "derived.py", "formula", "theory")
"""Sources that the formulas depend on."""


def chain() -> tuple[tuple[str, tuple[Formula, ...]], ...]:
    """The links of the derivation with their formulas, proved."""
    return cached("chain", GROUND, lambda: (*links(), *motion_links()))


def formulas() -> dict[str, Formula]:
    """Every formula by name."""
    return {formula.name: formula for _, found in chain() for formula in found}


def misprints() -> tuple[Finding, ...]:
    """What each printed formula turns out to be."""
    return cached("misprints", (*GROUND, "paper"), lambda: compare_printed(formulas()))


def diagnose(
    name: str, text: str, latex: bool = False, at: str = "", digits: int = 50
) -> TextDiagnosis:
    """Judge a formula given as text; `at` is a list like ``phi=2.5,h=0.1``.

    Raises
    ------
    derivation.formula.parse.FormulaError
        For a name, formula, point or number of digits that cannot be used.
    """
    point = parse_point(at)
    # What cannot be read is refused before anything is derived, whatever names it uses.
    anything = {word: sp.Symbol(word) for word in re.findall(r"[A-Za-z]\w*", text)}
    (parse_latex if latex else parse)(text, anything | dict(NAMES))
    return diagnose_text(name, text, formulas(), latex=latex, at=point, digits=digits)


def parse_point(text: str) -> dict[str, str]:
    """Values by symbol name, from ``phi=2.5,h=0.1``.

    Raises
    ------
    ValueError
        If an entry is no name and value.
    """
    point: dict[str, str] = {}
    for entry in filter(None, (part.strip() for part in text.split(","))):
        name, equals, literal = entry.partition("=")
        if not equals or not name.strip() or not literal.strip():
            raise ValueError(f"expected a point like phi=2.5,h=0.1, got {entry!r:.60}")
        point[name.strip()] = literal.strip()
    return point
