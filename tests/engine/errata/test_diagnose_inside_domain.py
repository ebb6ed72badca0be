"""Formulas that are equal inside the domain only: functions have other branches outside."""

import mpmath
import pytest
import sympy as sp
from pure_numbers import formulas_of

from derivation.engine.errata.compare import Diagnosis, diagnose
from derivation.engine.errata.relations import Relations
from derivation.engine.formula.parse import parse

v, c, Q, m, N = SYMBOLS = sp.symbols("v c Q m N", positive=True)
x = sp.Symbol("x", real=True)
DERIVED = {
    "rapidity": sp.log(sp.sqrt((1 + v / c) / (1 - v / c))),
    "displacement": 1 - (1 - Q / (m * N)) ** sp.Rational(2, 3),
    # The exponent of Haaland's friction factor.
    "friction": sp.log((v / 3) ** sp.Rational(111, 100) + 7 / c),
}
DERIVED |= {"slope": x / (1 + x**2), "kernel": (sp.cosh(m) - 1) / (sp.sinh(m) + m)}
FORMULAS = formulas_of(DERIVED, {v: ("v > 0", "v < c"), Q: ("Q > 0", "Q < m*N"), x: ("x < 9",)})
WORDS = FORMULAS["rapidity"].vocabulary


def diagnosed(name: str, text: str) -> Diagnosis:
    return diagnose(name, parse(text, WORDS), FORMULAS, Relations())


@pytest.mark.parametrize(
    ("name", "text"),
    [("rapidity", "atanh(v/c)"), ("displacement", "1 - ((1 - Q/(m*N))**2)**(1/3)")],
)
def test_formulas_that_are_equal_inside_the_domain_are_equal(name: str, text: str) -> None:
    assert diagnosed(name, text).verdict == "equal"
    inside = {v: 0.3, c: 0.7, Q: 0.2, m: 0.5, N: 0.9}
    outside = inside | {v: 0.9, Q: 0.8}
    difference = sp.lambdify(SYMBOLS, parse(text, WORDS) - DERIVED[name], "mpmath")
    assert abs(difference(*map(mpmath.mpf, inside.values()))) < 1e-14
    assert abs(difference(*map(mpmath.mpf, outside.values()))) > 0.1


@pytest.mark.parametrize(
    ("name", "text", "where"),
    [
        ("slope", "abs(x)/(1 + x**2)", "x = -"),
        ("kernel", "tanh(2000*m)*(cosh(m) - 1)/(sinh(m) + m)", "m = "),
        ("kernel", "erf(90*m)*(cosh(m) - 1)/(sinh(m) + m)", "m = "),
    ],
)
def test_formulas_that_are_equal_in_only_a_part_of_the_domain_are_different(
    name: str, text: str, where: str
) -> None:
    result = diagnosed(name, text)
    assert result.verdict == "different"
    assert result.ratio is None
    assert result.repair.startswith(f"equal at usual points, not at {where}")
    assert diagnosed("kernel", "tanh(m/2)/(1 + m/sinh(m))").verdict == "equal"


def test_a_misprint_is_found_inside_the_domain() -> None:
    """Outside, a power of a negative number has another branch."""
    result = diagnosed("displacement", "1 - (1 - Q/(m*N))**(3/2)")
    assert result.verdict == "different"
    assert result.repair == "read (1 - Q/(N*m))**(2/3) instead of (1 - Q/(N*m))**(3/2)"


def test_the_exponent_of_an_empirical_formula_is_corrected() -> None:
    """The exponent 1.11 is printed as 1.1."""
    result = diagnosed("friction", "log((v/3)**1.1 + 7/c)")
    assert result.kind == "wrong exponent"
    assert result.repaired is not None
    assert result.repaired.equals(DERIVED["friction"])
