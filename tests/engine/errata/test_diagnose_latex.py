"""LaTeX that the program prints for a formula is read back as that formula."""

import pytest
import sympy as sp

from derivation.engine.errata.lookup import comparable
from derivation.engine.formula.notation import to_latex
from derivation.plate.derived import formulas
from derivation.plate.elastic import diagnose_text
from derivation.plate.vocabulary import PLATE

CHAIN = formulas()
DOTTED = {symbol for symbol, latex in PLATE.latex.items() if r"\dot" in latex}
READ = [
    name
    for name in comparable(CHAIN)
    if not CHAIN[name].expression.has(sp.Derivative, sp.Integral, sp.beta, *DOTTED)
]
"""All but derivatives, integrals and the beta function, whose LaTeX is not read."""


@pytest.mark.parametrize("name", READ)
def test_printed_latex_is_equal(name: str) -> None:
    """Letters such as xi, gamma and u have several meanings; here they mean the formula's own."""
    formula = CHAIN[name]
    text = formula.sum_sign + to_latex(formula.expression, formula.vocabulary)
    assert diagnose_text(name, text, CHAIN, latex=True, digits=5).verdict == "equal"


@pytest.mark.parametrize(
    "text",
    [
        r"$\frac{2T+\operatorname{sinh}(2T)}{2(\sinh^2(T) - T^2)}$",
        r"\frac{2 \ln(\mathrm{e}^{T}) + \sinh(2T)}{2(\sinh^2(T) - T^2)}",
    ],
)
def test_usual_ways_to_write_functions_are_read(text: str) -> None:
    assert diagnose_text("G", text, CHAIN, latex=True).verdict == "equal"
