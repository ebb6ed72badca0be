"""Fractions that are printed upside down are explained as one misprint."""

import pytest
import sympy as sp
from pure_numbers import formulas_of

from derivation.engine.errata.compare import diagnose
from derivation.engine.errata.relations import Relations
from derivation.engine.formula.parse import parse

e, E, k, q = sp.symbols("e E k q", positive=True)
DOMAINS = {e: ("e > 0", "e < 1"), E: ("E > 0", "E < 3")}


@pytest.mark.parametrize(
    ("derived", "printed"),
    [
        (sp.atan(sp.sqrt((1 + e) / (1 - e)) * sp.tan(E)), "atan(sqrt((1 - e)/(1 + e))*tan(E))"),
        (k * (1 - e) / (1 + e), "k*(1+e)/(1-e)"),
        (q + k * (1 - e) / (1 + e), "q + k*(1+e)/(1-e)"),
        (k * sp.exp(-(k + q) / e), "k*exp(-e/(k + q))"),
        (sp.log((1 + e) ** 2 / (q + k) ** 2), "log((q + k)**2/(1 + e)**2)"),
    ],
)
def test_a_fraction_upside_down_is_one_misprint(derived: sp.Expr, printed: str) -> None:
    formulas = formulas_of({"f": derived}, DOMAINS)
    result = diagnose("f", parse(printed, formulas["f"].vocabulary), formulas, Relations())
    assert result.verdict == "different"
    assert "two" not in result.kind
    assert result.repaired is not None
    at = {e: 0.3, E: 1.1, k: 0.7, q: 1.9}
    assert float(result.repaired.subs(at)) == pytest.approx(float(derived.subs(at)), rel=1e-12)
