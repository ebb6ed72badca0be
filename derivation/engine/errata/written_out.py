"""Sums over a number, such as k of ``a_k x^k``: their terms are written out.

A derived formula has finitely many terms. Of a given sum without end those terms are compared whose
symbols, such as a_2 and a_3, occur in that formula.
"""

import ast
import re
from collections.abc import Mapping, Set
from dataclasses import dataclass
from itertools import count, takewhile
from types import MappingProxyType

from derivation.engine.formula.parse import MAX_TEXT, FormulaError
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Vocabulary, names_by_latex
from derivation.engine.nearest import one_of

MOST_TERMS = 100
"""Largest number of terms of a sum with an end."""
_LATEX_SUM = re.compile(
    r"\\sum(?![A-Za-z])(?:\s*\\limits)?\s*_\s*\{\s*([A-Za-z])\s*=\s*(\d+)\s*\}"
    r"\s*\^\s*(?:\{\s*(\\infty|\d+)\s*\}|(\\infty|\d))"
)
_SIGN = re.compile(r"\\(?:right|[bB]igg?r?)\s*$")
"""The size of a bracket, before the bracket that closes a sum."""


@dataclass(frozen=True)
class _Sum:
    """A sum in a text: its place, index, ends and term; `last` is None without an end."""

    start: int
    end: int
    index: str
    first: int
    last: int | None
    term: str

    @property
    def bases(self) -> set[str]:
        """The symbols with the index, without backslashes, such as a of ``a_k``."""
        return set(re.findall(rf"([A-Za-z]+)\s*_\s*\{{?\s*{self.index}(?![A-Za-z0-9_])", self.term))

    def can_be_written_out(self, vocabulary: Vocabulary) -> bool:
        """Return whether the number of terms is known, and the sum is none over the modes."""
        return self.index not in vocabulary.indices and bool(self.bases or self.last is not None)


def written_out(
    text: str,
    vocabulary: Vocabulary,
    *,
    latex: bool,
    formula: Record | None = None,
    formulas: Mapping[str, Record] = MappingProxyType({}),
) -> tuple[str, str | None]:
    """Return a formula with the terms of its sums over a number, and a note; None without one.

    Parameters
    ----------
    text
        The formula, in LaTeX or in SymPy syntax.
    vocabulary
        The paper's symbols; sums over its indices, the modes, remain, and so do sums without end
        and without a symbol that has their index.
    formula
        The derived formula. Without it, a sum without end has one term.
    formulas
        All derived formulas, which a message may name.

    Raises
    ------
    FormulaError
        If the derived formula has no term of a sum without end, or the sum has too many terms.
    """
    find, at = (_latex_sum, _in_latex) if latex else (_plain_sum, _in_plain)
    if not latex:
        text = " ".join(text.split())
    notes = []
    while (found := find(text, vocabulary)) is not None:
        numbers = _numbers(found, latex, formula, formulas)
        terms = " + ".join(f"({at(found.term, found.index, n)})" for n in numbers)
        text = f"{text[: found.start]}({terms}){text[found.end :]}"
        if len(text) > MAX_TEXT:
            raise FormulaError(
                f"expected sums whose terms have at most {MAX_TEXT} characters, got {len(text)}: "
                "shorten them"
            )
        if found.last is None:
            ends = f"{numbers[0]} to {numbers[-1]}" if len(numbers) > 1 else f"{numbers[0]}"
            notes.append(f"the terms {found.index} = {ends} of the sum, as in the derived formula")
    return text, "; ".join(notes) or None


def _numbers(
    found: _Sum, latex: bool, formula: Record | None, formulas: Mapping[str, Record]
) -> list[int]:
    """Return the numbers of the terms that are written out."""
    if found.last is not None:
        if not 0 <= found.last - found.first < MOST_TERMS:
            raise FormulaError(
                f"expected a sum of 1 to {MOST_TERMS} terms, got one from {found.first} to "
                f"{found.last}: change its ends"
            )
        return list(range(found.first, found.last + 1))
    if formula is None:
        return [found.first]

    def occurs(number: int, record: Record) -> bool:
        """Return whether all symbols of a term occur in a formula."""
        return {f"{base}_{number}" for base in found.bases} <= _letters(record, latex)

    numbers = list(takewhile(lambda number: occurs(number, formula), count(found.first)))
    if not numbers:
        symbols = ", ".join(sorted(f"{base}_{found.first}" for base in found.bases))
        others = [name for name, other in formulas.items() if occurs(found.first, other)]
        raise FormulaError(
            f"expected a sum over {found.index} with symbols of {formula.name}, got {symbols}: "
            + (f"name a formula that contains them, {one_of(others)}" if others else "change them")
        )
    return numbers


def _letters(formula: Record, latex: bool) -> Set[str]:
    """Return the symbols of a formula as they are written."""
    arguments = formula.arguments
    return names_by_latex(arguments).keys() if latex else {a.name for a in arguments}


def _latex_sum(text: str, vocabulary: Vocabulary) -> _Sum | None:
    """Return the first sum over a number in LaTeX."""
    for match in _LATEX_SUM.finditer(text):
        index, first, *ends = match.groups()
        last = None if r"\infty" in ends else int(ends[0] or ends[1])
        end = _end(text, match.end())
        found = _Sum(match.start(), end, index, int(first), last, text[match.end() : end])
        if found.can_be_written_out(vocabulary):
            return found
    return None


def _end(text: str, start: int) -> int:
    """Return where a summand ends: at a closing bracket, or at a sign after a factor."""
    depth = 0
    for place in range(start, len(text)):
        mark = text[place]
        depth += (mark in "([{") - (mark in ")]}")
        if depth < 0 or (depth == 0 and mark in "+-" and text[start:place].strip()):
            size = _SIGN.search(text[start:place])
            return start + size.start() if size else place
    return len(text.rstrip(" .,;"))


def _in_latex(term: str, index: str, number: int) -> str:
    """Return a term in LaTeX for one number."""
    term = re.sub(rf"_\s*(?:\{{\s*{index}\s*\}}|{index})", f"_{{{number}}}", term)
    return re.sub(
        rf"\\[A-Za-z]+|{index}", lambda m: m[0] if m[0] != index else f"{{{number}}}", term
    )


def _plain_sum(text: str, vocabulary: Vocabulary) -> _Sum | None:
    """Return the first sum over a number in SymPy syntax."""
    if "Sum" not in text:
        return None
    try:
        tree = ast.parse(text, mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Call) and ast.unparse(node.func) == "Sum"):
            continue
        limits = re.fullmatch(
            r"\((\w+), (\d+), (oo|\d+)\)", ", ".join(map(ast.unparse, node.args[1:]))
        )
        if limits is None:
            continue
        body, last = node.args[0], None if limits[3] == "oo" else int(limits[3])
        term = text[body.col_offset : body.end_col_offset]
        end = node.end_col_offset or 0
        found = _Sum(node.col_offset, end, limits[1], int(limits[2]), last, term)
        if found.can_be_written_out(vocabulary):
            return found
    return None


def _in_plain(term: str, index: str, number: int) -> str:
    """Return a term in SymPy syntax for one number."""
    term = re.sub(rf"(?<=[A-Za-z0-9])_{index}\b", f"_{number}", term)
    return re.sub(rf"(?<![\w.]){index}(?!\w)", f"({number})", term)
