"""The right-hand side of a formula that is given as an equation, such as ``K_j = ...``."""

import re
from collections.abc import Mapping

from derivation.engine.formula.latex_tokens import without_display
from derivation.engine.formula.parse import FormulaError
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import names_by_latex

_OPENING, _CLOSING = "([{", ")]}"
_LAYOUT = re.compile(
    r"\\(?:left|right|displaystyle|q?quad|mathrm|text|operatorname)(?![A-Za-z])"
    r"|\\[,;:!]|[\\{}&\s]"
)
_ARGUMENTS = re.compile(r"\(([A-Za-z]\w*(?:,[A-Za-z]\w*)*)\)$")


def right_hand_side(text: str) -> str:
    """Return what follows the equals sign of an equation, or a text without one unchanged.

    Raises
    ------
    FormulaError
        If there are several equals signs outside brackets, or nothing follows.
    """
    return _sides(text)[1]


def checked_right_hand_side(text: str, formula: Record) -> str:
    """Return the right-hand side, if the left-hand side is the name or symbol of the formula.

    The arguments may be left out: ``f_j`` or ``f_j(z)``.

    Raises
    ------
    FormulaError
        If the left-hand side denotes anything else, or as for `right_hand_side`.
    """
    left, right = _sides(text)
    names = {plain for name in (formula.name, formula.latex) for plain in _plain(name)}
    if left is not None and names.isdisjoint(_plain(left)):
        raise FormulaError(
            f"expected {formula.name} = ..., got {left.strip():.60} = ...: give the name of the "
            "other formula, or only the right-hand side"
        )
    return right


def arguments_by_name(formulas: Mapping[str, Record]) -> dict[str, tuple[str, ...]]:
    """Return the arguments that the symbols of formulas show, such as t of ``delta_0(t)``."""
    shown = ((name, _ARGUMENTS.search(_plain(f.latex)[0])) for name, f in formulas.items())
    return {name: tuple(match[1].split(",")) for name, match in shown if match}


def arguments_on_the_left(text: str, formula: Record) -> dict[str, tuple[str, ...]]:
    """Return the arguments of the left-hand side, such as t of ``P(t) =``, by each symbol.

    The symbols of the formula may be written as functions of the same arguments. There are none if
    the formula itself depends on one of them, which may then be a factor in brackets.
    """
    match = _ARGUMENTS.search(_plain(_sides(text)[0] or "")[0])
    arguments = tuple(match[1].split(",")) if match else ()
    letters = names_by_latex(formula.arguments)
    return {} if letters.keys() & arguments else dict.fromkeys(letters, arguments)


def _sides(text: str) -> tuple[str | None, str]:
    """Return both sides of an equation; None for the left-hand side if there is none."""
    text, places, depth = without_display(text), [], 0
    for place, mark in enumerate(text):
        depth += (mark in _OPENING) - (mark in _CLOSING)
        if mark == "=" and not depth:
            places.append(place)
    if not places:
        return None, text
    if len(places) > 1:
        raise FormulaError(
            f"expected one formula, got {len(places)} equals signs: give one right-hand side"
        )
    left, right = text[: places[0]], text[places[0] + 1 :]
    if not right.strip():
        raise FormulaError("expected a formula after the equals sign, got nothing: complete it")
    return left, right


def _plain(name: str) -> tuple[str, str]:
    """Return a name without LaTeX layout, and the same without arguments."""
    plain = _LAYOUT.sub("", name)
    return plain, _ARGUMENTS.sub("", plain)
