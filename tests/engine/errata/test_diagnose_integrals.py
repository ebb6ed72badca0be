"""Printed integrals are compared with derived ones, and changes inside them are found."""

import pytest
import sympy as sp

from derivation.engine.errata.compare import diagnose
from derivation.engine.errata.relations import Relations
from derivation.engine.formula.parse import FormulaError, parse
from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary

a, r, E, s = sp.symbols("a r E s", positive=True)
CONTACT = Vocabulary(
    (
        Argument(a, "m", "a", "contact radius", ("a >= 1e-9",)),
        Argument(r, "m", "r", "radius", ("r >= 0", "r < a")),
        Argument(E, "Pa", "E", "modulus", ("E >= 1",)),
        Argument(s, "m", "s", "radius", ("s >= 0",)),
    )
)


class Formula(Record):
    """A formula of the contact."""

    vocabulary = CONTACT


INTEGRAL = sp.Integral(E * s / sp.sqrt(s**2 - r**2), (s, r, a))
CLOSED = E * sp.sqrt(a**2 - r**2)
PROOF = prove("Abel", "The transform of 1.", {"closed form": INTEGRAL - CLOSED})


@pytest.mark.parametrize("derived", [INTEGRAL, CLOSED])
@pytest.mark.parametrize(
    ("printed", "repair"),
    [
        ("Integral(E*s/sqrt(s**2 - r**2), (s, r, a))", "no correction needed"),
        ("Integral(2*E*s/sqrt(s**2 - r**2), (s, r, a))", "by 1/2"),
        ("Integral(E*s/sqrt(s**2 - r**2), (s, 0, a))", "the lower limit r"),
        ("2*Integral(E*s/sqrt(s**2 - r**2), (s, 0, a))/2", "the lower limit r"),
        ("Integral(E*s**2/sqrt(s**2 - r**2), (s, r, a))", "leave out the factor s"),
        ("Integral(E/sqrt(s**2 - r**2), (s, r, a))", "missing factor s"),
        ("Integral(E*s/(a*sqrt(s**2 - r**2)), (s, r, a))", "factor a in the denominator"),
        ("Integral(E*s/sqrt(s**2 + r**2), (s, r, a))", "reverse the sign"),
    ],
)
def test_correction_of_a_printed_integral(derived: sp.Expr, printed: str, repair: str) -> None:
    formula = Formula("A", "A", "transform", derived, "N/m", "1", (), PROOF)
    found = diagnose("A", parse(printed, CONTACT), {"A": formula}, Relations())
    assert repair in found.repair
    assert found.repaired is not None


def test_integral_without_value_is_rejected_with_a_remedy() -> None:
    formula = Formula("A", "A", "transform", CLOSED, "N/m", "1", (), PROOF)
    with pytest.raises(FormulaError, match=r"no value at random points: .*substitute"):
        diagnose("A", parse("Integral(E/s, (s, 0, r))", CONTACT), {"A": formula}, Relations())


@pytest.mark.parametrize("text", ["Integral(E)", "Integral(E, s)", "Integral(E, (s, 0))"])
def test_integral_without_limits_is_rejected(text: str) -> None:
    with pytest.raises(FormulaError, match=r"write Integral\(f, \(x, a, b\)\)"):
        parse(text, CONTACT)
