"""Expressions as LaTeX in the paper's notation; sentences as Markdown and as plain text."""

import re
from collections.abc import Callable

import sympy as sp
from sympy.printing.latex import LatexPrinter

from derivation.engine.formula.vocabulary import Vocabulary

PLAIN = {
    "le": "<=", "ge": ">=", "to": "->", "pm": "+-", "infty": "oo", "ldots": "...",
    "varepsilon": "eps",
}  # fmt: skip
"""Plain text of LaTeX commands, except for those with the same name."""


class PaperPrinter(LatexPrinter):
    """SymPy's LaTeX printer, with Bessel functions as J_0, J_1, I_0 and I_1."""

    def _print_BesselJ(self, expr: sp.besselj, exp: str | None = None) -> str:
        return self._bessel("J", expr, exp)

    def _print_BesselI(self, expr: sp.besseli, exp: str | None = None) -> str:
        return self._bessel("I", expr, exp)

    def _bessel(self, letter: str, expr: sp.Function, exp: str | None) -> str:
        order, argument = (self._print(part) for part in expr.args)
        power = f"^{{{exp}}}" if exp is not None else ""
        return rf"{letter}_{{{order}}}{power}\left({argument}\right)"

    _print_besselj, _print_besseli = _print_BesselJ, _print_BesselI

    def _as_ordered_terms(self, expr: sp.Add, order: str | None = None) -> list[sp.Expr]:
        return positive_first(super()._as_ordered_terms(expr, order=order))


def positive_first(terms: list[sp.Expr]) -> list[sp.Expr]:
    """Return the terms of a sum with those that have a minus sign last."""
    return sorted(terms, key=lambda term: bool(term.could_extract_minus_sign()))


def to_latex(expression: sp.Basic, vocabulary: Vocabulary) -> str:
    """Return the LaTeX of an expression, with symbols as in the paper."""
    settings = {"symbol_names": vocabulary.latex, "fold_short_frac": False}
    return str(PaperPrinter(settings).doprint(expression))


def convert_parts(text: str, words: Callable[[str], str], mathematics: Callable[[str], str]) -> str:
    """Convert a sentence with mathematics between dollars, by one function for each kind of part.

    Raises
    ------
    ValueError
        If a dollar has no partner.
    """
    pieces = text.split("$")
    if len(pieces) % 2 == 0:
        raise ValueError(f"expected dollars in pairs, got {text!r}")
    return "".join((mathematics if n % 2 else words)(piece) for n, piece in enumerate(pieces))


def to_markdown(text: str) -> str:
    """Return a sentence as Markdown, with its stars and underscores escaped."""
    return convert_parts(text, lambda words: re.sub(r"([*_])", r"\\\1", words), "${}$".format)


def to_plain(text: str) -> str:
    r"""Return a sentence for a terminal: `$\phi_j^{2/3} \le 1$` as `phi_j^(2/3) <= 1`."""
    return convert_parts(text, str, _plain)


def _plain(latex: str) -> str:
    text = re.sub(r"\\operatorname\{(\w+)\}", r"\1", latex).replace("^*", "*")
    text = re.sub(r"\\([A-Za-z]+)", lambda m: PLAIN.get(m[1], m[1]), text)
    text = re.sub(r"\b([IJ])_([01])\b", r"\1\2", text)  # Bessel functions, as code calls them
    text = re.sub(r"_\{(\w+)\}", r"_\1", text)
    return text.translate({ord("{"): "(", ord("}"): ")"})
