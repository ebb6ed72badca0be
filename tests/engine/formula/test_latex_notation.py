"""LaTeX is read in the notation that the vocabulary of a paper states for its symbols."""

import pytest
import sympy as sp

from derivation.engine.formula.parse_latex import parse_latex
from derivation.engine.formula.vocabulary import Argument, Vocabulary

NOTATION = {
    "Es": "E^*", "E": "E", "P": "P", "Pl": "P'", "E_inf": r"E_\infty", "dE": r"\Delta E",
    "strain": r"\bar{\epsilon}", "a": "a", "x": "x",
}  # fmt: skip
WORDS = Vocabulary(
    tuple(
        Argument(sp.Symbol(name, positive=True), "1", latex, "a number", ())
        for name, latex in NOTATION.items()
    )
)
Es, E, P, Pl, E_inf, dE, strain, a, x = (argument.symbol for argument in WORDS.arguments)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (r"\frac{4}{3} E^* \sqrt{a}", 4 * Es * sp.sqrt(a) / 3),
        (r"E^{*}a^2 + E a", Es * a**2 + E * a),
        (r"{E^*}^2 a", Es**2 * a),
        (r"\sqrt{E^{\ast}} + E^\star", sp.sqrt(Es) + Es),
        (r"\frac{P'}{E^*} - P", Pl / Es - P),
        (r"P^\prime + P^{\prime} a + P^2", Pl + Pl * a + P**2),
        (r"E_\infty + \Delta E e^{-x}", E_inf + dE * sp.exp(-x)),
        (r"\frac{a}{E_{\infty}} + \Delta E \, E", a / E_inf + dE * E),
        (r"\frac{\bar{\epsilon}}{2} + \bar\epsilon x", strain / 2 + strain * x),
    ],
)
def test_notation_of_the_vocabulary_is_read(text: str, expected: sp.Expr) -> None:
    assert parse_latex(text, WORDS) == expected


@pytest.mark.parametrize("text", [r"a^* + x", r"\DeltaE", "P''"])
def test_other_notation_is_rejected(text: str) -> None:
    with pytest.raises(ValueError, match=r"LaTeX token|unknown name"):
        parse_latex(text, WORDS)
