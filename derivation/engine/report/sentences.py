"""Sentences that contain formulas as code, converted to LaTeX with typeset formulas."""

import re
from collections.abc import Iterator
from functools import partial

from sympy.printing.latex import greek_letters_set

from derivation.engine.formula.notation import convert_parts, to_latex
from derivation.engine.formula.parse import FormulaError, parse
from derivation.engine.formula.vocabulary import Vocabulary
from derivation.engine.report.latex import prose, unit

_SIGNS = ("+", "-")
GREEK = greek_letters_set | {"Gamma", "Lambda", "Omega", "Phi", "Psi", "Theta"}
INDEX = re.compile(r"([A-Za-z]{1,2}|\d+)$")
"""An index of a letter in a sentence: one or two letters, or a number."""
MINUS = re.compile(r"(?<= )-(?= )|(?<=[ (])-(?=[A-Za-z\d(]|$)")
"""A hyphen in a sentence that stands for a minus sign."""
SYMBOL = re.compile(r"(?<!\w)([A-Za-z]\w*|\d+(?=\^))(?:\^(-?\d+|\([^()]*\)|[A-Za-z]\b))?")
"""A word, and its power if there is one; a number with a power."""


def typeset_sentence(text: str, vocabulary: Vocabulary) -> str:
    """Return a sentence as LaTeX; code that can be parsed is typeset as a formula, like units."""

    def words(text: str) -> str:
        before, said, after = re.split(r"^(\s*)(.*?)(\s*)$", text, flags=re.DOTALL)[1:-1]
        pieces = (_piece(piece, vocabulary) for piece in sentence_pieces(said))
        return f"{before}{' '.join(pieces)}{after}"

    typeset = convert_parts(text, words, "${}$".format)
    return convert_parts(typeset, partial(MINUS.sub, "$-$"), "${}$".format)


def with_large_fractions(typeset: str) -> str:
    """Return LaTeX whose fractions within a sentence are as large as in a displayed formula.

    Fractions in braces, that is in exponents and in other fractions, keep their size.
    """
    parts, depth = re.split(r"([{}]|\\frac(?![a-z]))", typeset), 0
    for index, part in enumerate(parts):
        depth += (part == "{") - (part == "}")
        if part == r"\frac" and not depth:
            parts[index] = r"\dfrac"
    return "".join(parts)


def sentence_pieces(text: str) -> Iterator[str]:
    """Yield pieces of a sentence: words, or code.

    Code is a word that contains a star, followed by the words up to the closing bracket. A sum of
    such parts is one piece.
    """
    words, index, said = text.split(" "), 0, list[str]()
    while index < len(words):
        end = index + 1
        if "*" not in words[index]:
            said.append(words[index])
        else:
            end = _end(words, index)
            while end + 1 < len(words) and words[end] in _SIGNS and _begins(words[end + 1]):
                end = _end(words, end + 1)
            yield from filter(None, (" ".join(said), " ".join(words[index:end])))
            said = []
        index = end
    yield from filter(None, (" ".join(said),))


def _begins(word: str) -> bool:
    """Return whether a word may be a term of a sum in code."""
    return "*" in word or "(" in word


def _end(words: list[str], index: int) -> int:
    """Return the position after the term of code that begins at a word."""
    end = index + 1
    while end < len(words) and _open(words[index:end]):
        end += 1
    return end


def _open(words: list[str]) -> bool:
    joined = " ".join(words)
    return joined.count("(") > joined.count(")")


def _piece(text: str, vocabulary: Vocabulary) -> str:
    """Return a piece as LaTeX; code that can be parsed becomes a formula, with punctuation."""
    match = re.fullmatch(r"(?P<code>.*\*.*?)(?P<end>[.,:;]?)", text, re.DOTALL)
    if match is not None:
        try:
            return f"${to_latex(parse(match['code'], vocabulary), vocabulary)}${match['end']}"
        except FormulaError:
            return prose(text)
    parts = re.split(r"(\[[^\]]*\])", text)
    return "".join(
        unit(part) if part.startswith("[") else prose(_named(part, vocabulary)) for part in parts
    )


def _named(text: str, vocabulary: Vocabulary) -> str:
    """Return words with symbols as formulas: Greek names, and letters with index or power."""

    def symbol(match: re.Match[str]) -> str:
        name, power = match[1], (match[2] or "").strip("()")
        known = vocabulary.names.get(name)
        latex = vocabulary.latex[known] if known is not None else ""
        if not latex.startswith("\\"):
            letter, _, index = name.partition("_")
            greek = letter in GREEK
            indexed = index and (greek or len(letter) == 1) and INDEX.match(index)
            if not (power or indexed or name in GREEK):
                return match[0]
            base = f"\\{letter}" if greek else letter
            latex = (
                f"{base}_{index}" if len(index) == 1 else f"{base}_{{{index}}}" if index else base
            )
        return f"${latex}^{{{power}}}$" if power else f"${latex}$"

    def words(text: str) -> str:
        return re.sub(r"\)\^(\d+)", r")$^{\1}$", SYMBOL.sub(symbol, text))

    return convert_parts(text, words, "${}$".format)
