"""Formulas that are equal inside the domain only: functions have other branches outside."""

import mpmath
import pytest
import sympy as sp

from derivation.engine.errata.compare import diagnose
from derivation.engine.errata.relations import Relations
from derivation.engine.formula.parse import parse
from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary

v, c, Q, m, N = SYMBOLS = sp.symbols("v c Q m N", positive=True)
DOMAINS = {v: ("v > 0", "v < c"), Q: ("Q > 0", "Q < m*N")}
WORDS = Vocabulary(
    tuple(Argument(s, "1", s.name, "a number", DOMAINS.get(s, (f"{s} > 0",))) for s in SYMBOLS)
)
PROOF = prove("given", "typed", {"identity": sp.Integer(0)})


class Formula(Record):
    """A formula of pure numbers."""

    vocabulary = WORDS


DERIVED = {
    "rapidity": sp.log(sp.sqrt((1 + v / c) / (1 - v / c))),
    "slip": 1 - (1 - Q / (m * N)) ** sp.Rational(2, 3),
}
FORMULAS = {
    name: Formula(name, name[0], name, expression, "1", "", (), PROOF)
    for name, expression in DERIVED.items()
}


def diagnosed(name: str, text: str) -> tuple[str, str]:
    given = parse(text, WORDS)
    result = diagnose(name, given, FORMULAS, Relations())
    return result.verdict, result.repair


@pytest.mark.parametrize(
    ("name", "text"),
    [("rapidity", "atanh(v/c)"), ("slip", "1 - ((1 - Q/(m*N))**2)**(1/3)")],
)
def test_formulas_that_are_equal_inside_the_domain_are_equal(name: str, text: str) -> None:
    assert diagnosed(name, text)[0] == "equal"
    inside = {v: 0.3, c: 0.7, Q: 0.2, m: 0.5, N: 0.9}
    outside = inside | {v: 0.9, Q: 0.8}
    difference = sp.lambdify(SYMBOLS, parse(text, WORDS) - DERIVED[name], "mpmath")
    assert abs(difference(*map(mpmath.mpf, inside.values()))) < 1e-14
    assert abs(difference(*map(mpmath.mpf, outside.values()))) > 0.1


def test_a_misprint_is_found_inside_the_domain() -> None:
    """Outside, a power of a negative number has another branch."""
    verdict, repair = diagnosed("slip", "1 - (1 - Q/(m*N))**(3/2)")
    assert verdict == "different"
    assert repair == "read (1 - Q/(N*m))**(2/3) instead of (1 - Q/(N*m))**(3/2)"


def test_the_exponent_of_an_empirical_formula_is_corrected() -> None:
    """The exponent 1.11 of Haaland's formula is printed as 1.1."""
    expression = sp.log((v / 3) ** sp.Rational(111, 100) + 7 / c)
    formula = Formula("friction", "f", "friction", expression, "1", "", (), PROOF)
    given = parse("log((v/3)**1.1 + 7/c)", WORDS)
    result = diagnose("friction", given, {"friction": formula}, Relations())
    assert result.kind == "wrong exponent"
    assert result.repaired is not None
    assert result.repaired.equals(expression)
