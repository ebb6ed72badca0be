"""Formulas that are sums over modes: the contribution of one mode is compared."""

import ast
import re
from collections.abc import Mapping

import sympy as sp

from derivation.engine.formula.parse import FormulaError, parse
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.printable import one_line

_LATEX_SUM = (
    r"(?P<factor>[^+]*?)\\sum(?:\\limits)?\s*_\s*(?:\{{\s*{index}\s*(?:=\s*1\s*)?\}}|{index})"
    r"\s*(?:\^\s*(?:\{{\s*\\infty\s*\}}|\\infty))?(?P<term>.*)"
)
_ONE_SUM = (
    "expected no sum within another sum, because the formula is one sum over the modes: give one "
    "term of it, without a summation sign"
)


def note(formula: Record) -> str | None:
    """Return a note on the comparison of a sum over the modes; None for other formulas."""
    if not formula.summed:
        return None
    j = formula.vocabulary.indices[0]
    return f"the contribution of one mode {j}; {formula.name} is the sum of it over {j} = 1, 2, ..."


def without_latex_sum(text: str, vocabulary: Vocabulary) -> str:
    r"""Return LaTeX of one mode's term, from ``\sum_{j=1}^{\infty} ...`` or from the term alone.

    Raises
    ------
    FormulaError
        If there are several sums, or one that is not over all modes.
    """
    count = len(re.findall(r"\\sum(?![A-Za-z])", text))
    if count > 1:
        raise FormulaError(_ONE_SUM)
    match = re.fullmatch(_LATEX_SUM.format(index=_index(vocabulary)), text, re.DOTALL)
    if count and (match is None or match["term"].lstrip().startswith("^")):
        raise FormulaError(
            f"expected a sum over all modes, got {one_line(text.strip(), 60)}: give one term of "
            r"the sum, or write c \sum_{j=1}^{\infty} and the term"
        )
    if match is None:
        return text
    return f"{match['factor']} ({match['term'].strip().rstrip('.,;')})"


def _index(vocabulary: Vocabulary) -> str:
    """Return a pattern of the letters that count the terms; without letters it matches nothing."""
    return f"(?:{'|'.join(vocabulary.indices)})" if vocabulary.indices else "(?!)"


def parse_contribution(text: str, vocabulary: Vocabulary, also: Mapping[str, sp.Basic]) -> sp.Expr:
    """Return the term of one mode, from ``c*Sum(..., (j, 1, oo))`` or from the term alone.

    Raises
    ------
    FormulaError
        If it cannot be read, is not linear in its sums, or contains a sum within a sum.
    """
    plain = " ".join(text.split())
    calls = _sums(plain)
    if not calls:
        return parse(text, vocabulary, also)
    if any(_contains(call, other) for call in calls for other in calls):
        raise FormulaError(_ONE_SUM)
    marks = {f"summand_{index}": sp.Symbol(f"summand_{index}") for index in range(len(calls))}
    outer, terms = plain, {}
    for (name, mark), call in zip(marks.items(), calls, strict=True):
        source = plain[call.col_offset : call.end_col_offset]
        _check_limits(call, source, vocabulary)
        body = call.args[0]
        terms[mark] = parse(plain[body.col_offset : body.end_col_offset], vocabulary, also)
        outer = outer.replace(source, name, 1)
    whole = parse(outer, vocabulary, {**also, **marks})
    factors = [whole.diff(mark) for mark in terms]
    rest = whole.xreplace(dict.fromkeys(terms, sp.Integer(0)))
    if rest != 0 or any(f.free_symbols & (set(terms) | vocabulary.per_term) for f in factors):
        raise FormulaError(
            "expected sums over the modes times factors that are equal for all modes: "
            "write everything that depends on the mode inside Sum(...)"
        )
    return whole.xreplace(terms)


def _sums(plain: str) -> list[ast.Call]:
    """Return the calls of Sum, in order; empty if the text cannot be parsed."""
    if "Sum" not in plain:
        return []
    try:
        tree = ast.parse(plain, mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return []
    return sorted(
        (
            node
            for node in ast.walk(tree)
            if isinstance(node, ast.Call)
            and isinstance(node.func, ast.Name)
            and node.func.id == "Sum"
        ),
        key=lambda node: node.col_offset,
    )


def _contains(call: ast.Call, other: ast.Call) -> bool:
    """Return whether a call contains another one."""
    return call is not other and any(node is other for node in ast.walk(call))


def _check_limits(call: ast.Call, source: str, vocabulary: Vocabulary) -> None:
    limits = [ast.unparse(argument) for argument in call.args[1:]]
    if (
        len(limits) != 1
        or re.fullmatch(rf"\({_index(vocabulary)}, 1, oo\)", limits[0]) is None
        or call.keywords
    ):
        raise FormulaError(
            f"expected a sum over all modes, got {one_line(source, 60)}: write Sum(..., (j, 1, oo))"
        )


def check_sum(formula: Record, text: str, latex: bool) -> None:
    """Reject a sum over the modes if the formula is not one: its term would be compared.

    Raises
    ------
    FormulaError
        If the text contains such a sum.
    """
    has_sum = re.search(r"\\sum(?![A-Za-z])", text) if latex else _sums(" ".join(text.split()))
    if has_sum and not formula.summed:
        raise FormulaError(
            f"{formula.name} is not a sum over the modes: give the formula without a sum, "
            "or the name of another one"
        )


def check_references(formula: Record, given: sp.Expr, formulas: Mapping[str, Record]) -> None:
    """Reject names of sums over the modes in a formula that is not one.

    A name alone is compared with each formula.

    Raises
    ------
    FormulaError
        If the expression contains such names; their expressions are those of one mode.
    """
    names = {symbol.name for symbol in given.free_symbols} - formula.vocabulary.by_name.keys()
    sums = sorted(name for name in names & formulas.keys() if formulas[name].summed)
    if sums and not formula.summed and not given.is_Symbol:
        raise FormulaError(
            f"{formula.name} is not a sum over the modes, but {', '.join(sums)} is: compare a "
            "formula without it"
        )


def check_contribution(formula: Record, given: sp.Expr) -> None:
    """Reject an expression that cannot be the term of one mode, such as the whole sum.

    Raises
    ------
    FormulaError
        If no symbol of the given formula depends on the mode.
    """
    per_term = formula.vocabulary.per_term
    if formula.summed and not given.free_symbols & per_term:
        per_mode = ", ".join(sorted(s.name for s in formula.expression.free_symbols & per_term))
        raise FormulaError(
            f"{formula.name} is a sum over the modes j: expected the contribution of one mode, "
            f"which depends on {per_mode}, got {given!s:.60}; give one term of the sum"
        )
