"""Decimal numbers of a formula: correctly rounded ones, and wrong ones with their error."""

import pytest
import sympy as sp

from derivation.engine.errata.compare import DIFFERENT, Diagnosis, diagnose
from derivation.engine.errata.decimals import NUMBER, ROUNDED
from derivation.engine.errata.relations import Relations
from derivation.engine.formula.parse import FormulaError
from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary

a, b = sp.symbols("a b", positive=True)


class Number(Record):
    """A formula of two numbers."""

    vocabulary = Vocabulary(tuple(Argument(v, "1", str(v), "a number", ("a > 0",)) for v in (a, b)))


EXACT = sp.sqrt(a) * (2 + sp.pi * a * b / 3 - sp.sqrt(2) * b**2)


def compared(given: sp.Expr, exact: sp.Expr = EXACT) -> Diagnosis:
    proof = prove("Given", "Given.", {"nothing": sp.Integer(0)})
    formula = Number("f", "f", "a number", exact, "1", "", (), proof)
    return diagnose("f", given, {"f": formula}, Relations(lambda *_: {}))


def with_numbers(first: str, second: str) -> sp.Expr:
    return sp.sqrt(a) * (2 + sp.Rational(first) * a * b - sp.Rational(second) * b**2)


def test_rounded_numbers_are_recognised() -> None:
    found = compared(with_numbers("1.047", "1.414"))
    assert (found.verdict, found.kind, found.edits) == (DIFFERENT, ROUNDED, 2)
    assert found.repaired is not None
    assert sp.simplify(found.repaired - EXACT) == 0
    assert "1.047 is the correctly rounded 1.04720" in found.repair


@pytest.mark.parametrize("second", ["1.41", "1.415", "1.4", "1.441"])
def test_each_number_is_compared_to_its_digits(second: str) -> None:
    found = compared(with_numbers("1.05", second))
    correct = abs(float(second) - 2**0.5) <= 0.5 * 10.0 ** (2 - len(second))
    assert found.kind == (ROUNDED if correct else NUMBER)
    assert "1.05 is the correctly rounded" in found.repair
    assert (f"instead of -{second}, which is off by" in found.repair) != correct


def test_the_error_of_a_number_is_stated() -> None:
    found = compared(with_numbers("1.1", "1.41"))
    assert "read 1.04720 instead of 1.1, which is off by +5 %" in found.repair


@pytest.mark.parametrize(
    "given",
    [
        with_numbers("1.05", "1.41") * b,
        with_numbers("1.05", "1.41") + sp.sin(a),
        sp.sqrt(a) * (2 + (sp.Rational("1.1") * a + sp.Rational("1.2")) ** 2),
    ],
)
def test_other_differences_are_not_explained_by_numbers(given: sp.Expr) -> None:
    assert compared(given).kind not in (ROUNDED, NUMBER)


def test_the_exact_number_may_be_an_integral() -> None:
    """The exact number is sqrt(pi)/2 = 0.8862269."""
    gauss = sp.Integral(sp.exp(-(b**2)), (b, 0, sp.oo))
    assert compared(a + sp.Rational("0.886") * a**2, a + gauss * a**2).kind == ROUNDED
    found = compared(a + sp.Rational("0.885") * a**2, a + gauss * a**2)
    assert "read 0.886227 instead of 0.885" in found.repair


def test_a_float_is_rejected_with_the_remedy() -> None:
    with pytest.raises(FormulaError, match=r'got 1.05; write sp.Rational\("1.05"\)'):
        compared(sp.sqrt(a) * sp.Float("1.05"))
