"""Stable forms of formulas in several variables whose factors depend on one product each."""

import mpmath
import pytest
import sympy as sp

from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary
from derivation.engine.rewrite.doubles import run
from derivation.engine.rewrite.every_variable import measured_error
from derivation.engine.rewrite.form import form
from derivation.engine.rewrite.products import of_products
from derivation.engine.rewrite.terms import UnreachableError

a, b, c, x = symbols = sp.symbols("a b c x", positive=True)
r = sp.Symbol("r", nonnegative=True)
SOLID = Vocabulary(
    (
        *(Argument(s, "1", str(s), "a length", (f"{s} >= 1e-30",)) for s in symbols),
        Argument(r, "1", "r", "a distance from the axis", ("r >= 0", "r < a")),
    )
)
FORMULAS = {
    "an exponential": c**2 * (1 - sp.exp(-a * b / c)),
    "a root": sp.sqrt(a**2 + b) - a,
    "a root that may vanish": a - sp.sqrt(a**2 - r**2),
    "a difference of fractions": 1 / (a + x) - 1 / x,
    "a series": (a * b - sp.sin(a * b)) / a**2,
    "two factors": (sp.sqrt(a * b + 1) - 1) * (sp.exp(c) - 1 - c) / x,
    "broken powers": sp.sqrt(a) * b ** sp.Rational(3, 2) * sp.log(1 + c / b),
    "powers alone": sp.pi * a**2 * b / (3 * c),
}


class SolidFormula(Record):
    """A formula of lengths."""

    vocabulary = SOLID


def formula(value: sp.Expr) -> SolidFormula:
    proof = prove("Given", "Given.", {"nothing": sp.Integer(0)})
    return SolidFormula("f", "f", "a number", value, "1", "", (), proof)


@pytest.mark.parametrize("name", FORMULAS)
def test_form_is_equal_and_accurate_in_every_variable(name: str) -> None:
    given = formula(FORMULAS[name])
    actual = of_products(given, lambda made: (made, 0.0))
    steps, value, own = actual.steps, actual.value, actual.blocks
    blocks = {block.name: block for block in own}
    form("f", "module", given.expression, steps, value, {}, own)  # proves that they are equal
    assert measured_error(given, steps, value, blocks).error <= 4.0
    at = {a: 3e-9, b: 2e-11, c: 5e-7, x: 0.7, r: 1e-9}
    exact = sp.lambdify(list(at), given.expression, "mpmath")
    with mpmath.workdps(60):
        expected = exact(*map(mpmath.mpf, at.values()))
    assert run(steps, value, at, blocks) == pytest.approx(float(expected), rel=1e-14)


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        (a * sp.exp(-b) + c, "depends on several dimensionless products"),
        (a * sp.besselj(0, c), "no rule applies to the function besselj"),
    ],
)
def test_other_formulas_are_rejected(value: sp.Expr, reason: str) -> None:
    with pytest.raises(UnreachableError, match=reason):
        of_products(formula(value), lambda made: (made, 0.0))


def test_a_product_does_not_take_the_name_of_an_argument() -> None:
    actual = of_products(formula(1 / (a + x) - 1 / x), lambda made: (made, 0.0))
    assert x not in {step.symbol for step in actual.steps}
