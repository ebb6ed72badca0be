"""LaTeX of expressions in the paper's notation."""

import sympy as sp
from sympy.printing.latex import LatexPrinter

from derivation.formula.symbols import ARGUMENTS

SYMBOL_NAMES = {argument.symbol: argument.latex for argument in ARGUMENTS}


class _Printer(LatexPrinter):
    """SymPy's LaTeX printer with J_0, J_1 as the paper writes them."""

    def _print_BesselJ(self, expr: sp.besselj, exp: str | None = None) -> str:
        order, argument = (self._print(part) for part in expr.args)
        power = f"^{{{exp}}}" if exp is not None else ""
        return rf"J_{{{order}}}{power}\left({argument}\right)"

    _print_besselj = _print_BesselJ


def to_latex(expression: sp.Basic) -> str:
    """LaTeX of an expression, symbols as in the paper."""
    return str(
        _Printer({"symbol_names": SYMBOL_NAMES, "fold_short_frac": False}).doprint(expression)
    )
