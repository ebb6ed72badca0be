"""LaTeX of formulas is read: as the program prints them, as users write them, as published."""

import pytest
import sympy as sp

from derivation.engine.errata.findings import Printed
from derivation.engine.errata.lookup import comparable
from derivation.engine.formula.notation import to_latex
from derivation.engine.formula.parse import FormulaError
from derivation.plate.derived import formulas, misprints
from derivation.plate.elastic import diagnose_text
from derivation.plate.misprints import ERRATA
from derivation.plate.vocabulary import PLATE

CHAIN = formulas()
COMPARED = [
    p
    for p in ERRATA.printed
    if type(p) is Printed and not p.full and not p.says and p.solved is None
]
"""Published equations that are compared as they are, without a statement in words."""
DOTTED = {symbol for symbol, latex in PLATE.latex.items() if r"\dot" in latex}
READABLE = [
    name
    for name in comparable(CHAIN)
    if not CHAIN[name].expression.has(sp.Derivative, sp.Integral, sp.beta, *DOTTED)
]
"""All but derivatives, integrals and the beta function, whose LaTeX is not read."""


@pytest.mark.parametrize("name", READABLE)
def test_printed_latex_is_equal(name: str) -> None:
    """Letters such as xi, gamma and u have several meanings; here those of the formula apply."""
    formula = CHAIN[name]
    text = f"{formula.latex} = {formula.sum_sign}" + to_latex(
        formula.expression, formula.vocabulary
    )
    assert diagnose_text(name, text, CHAIN, latex=True, digits=5).verdict == "equal"


@pytest.mark.parametrize(
    "text",
    [
        r"$\frac{2T+\operatorname{sinh}(2T)}{2(\sinh^2(T) - T^2)}$",
        r"\frac{2 \ln(\mathrm{e}^{T}) + \sinh(2T)}{2(\sinh^2(T) - T^2)}",
    ],
)
def test_usual_notations_of_functions_are_read(text: str) -> None:
    assert diagnose_text("G", text, CHAIN, latex=True).verdict == "equal"


@pytest.mark.parametrize("printed", COMPARED, ids=lambda printed: printed.name)
def test_published_equations_are_read_with_both_sides(printed: Printed) -> None:
    """With both sides, number and punctuation, the result is that of the published expression."""
    formula = CHAIN[printed.name]
    (finding,) = (one.diagnosis.verdict for one in misprints() if one.printed == printed)
    text = rf"$${printed.symbol} = {formula.sum_sign}{printed.latex}, \quad ({printed.equation})$$"
    assert diagnose_text(printed.name, text, CHAIN, latex=True, digits=5).verdict == finding


@pytest.mark.parametrize(
    ("name", "text", "latex"),
    [
        ("G", "G = (2*T + sinh(2*T))/(2*(sinh(T)^2 - T^2))", False),
        ("f_j", "f_j(z) = C1*cosh(phi*z)+C2*sinh(phi*z)+C3*z*cosh(phi*z)+C4*z*sinh(phi*z)", False),
        ("xi_3", r"\xi_{3} &= -\frac{\gamma_3}{\gamma_2^{8/3}}", True),
        (
            "delta_0",
            r"\delta_{0}\left(t\right) = v_0 \sqrt{m/\xi_2} \sin(\sqrt{\xi_2/m} \, t)",
            True,
        ),
    ],
)
def test_equations_are_read(name: str, text: str, latex: bool) -> None:
    assert diagnose_text(name, text, CHAIN, latex=latex).verdict == "equal"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("G_1 = T", r"expected G = \.\.\., got G_1 = "),
        ("G(r)/2 = T", "or only the right-hand side"),
        (" = T", r"expected G = \.\.\., got  = "),
        ("G = ", "nothing: complete it"),
        ("G = T = 2", "2 equals signs"),
        ("G == T", "2 equals signs"),
    ],
)
def test_other_equations_are_rejected(text: str, reason: str) -> None:
    for latex in (False, True):
        with pytest.raises(FormulaError, match=reason):
            diagnose_text("G", text, CHAIN, latex=latex)
