"""LaTeX of expressions in the paper's notation, and sentences as Markdown."""

import re

import sympy as sp
from sympy.printing.latex import LatexPrinter

from derivation.engine.formula.vocabulary import Vocabulary


class PaperPrinter(LatexPrinter):
    """SymPy's LaTeX printer with J_0, J_1 as the paper writes them, and I_0, I_1 likewise."""

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
    """The terms of a sum with those that carry a minus sign last, as written by hand."""
    return sorted(terms, key=lambda term: bool(term.could_extract_minus_sign()))


def to_latex(expression: sp.Basic, vocabulary: Vocabulary) -> str:
    """LaTeX of an expression, symbols as in the paper."""
    settings = {"symbol_names": vocabulary.latex, "fold_short_frac": False}
    return str(PaperPrinter(settings).doprint(expression))


def to_markdown(text: str) -> str:
    """A sentence with its stars and underscores as they are, which would be emphasis."""
    return re.sub(r"([*_])", r"\\\1", text)
