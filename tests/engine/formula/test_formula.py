"""Dimensions, hyperbolic form, interval evaluation, proofs, units and vocabulary."""

from fractions import Fraction

import flint
import pytest
import sympy as sp
from sympy.codegen.cfunctions import log1p

from derivation.engine.formula import ball as ball_module
from derivation.engine.formula.ball import Exact, PrecisionError, evaluate, refine, to_ball
from derivation.engine.formula.dimension import LENGTH, STRESS, DimensionError, dimension, unit
from derivation.engine.formula.hyperbolic import to_hyperbolic
from derivation.engine.formula.parse_latex import parse_latex
from derivation.engine.formula.proof import BY_BALLS, SYMBOLIC, Proof, decide_zero, prove
from derivation.engine.formula.vocabulary import Argument, Vocabulary
from derivation.plate.vocabulary import ARGUMENTS, Formula, a, h, lam, mu, phi

KNOWN = {x.symbol: unit(x.unit) for x in ARGUMENTS}
x = sp.Symbol("x", positive=True)


def test_dimension_follows_from_those_of_the_symbols() -> None:
    assert dimension(lam + 2 * mu, KNOWN) == STRESS
    assert dimension(sp.sqrt(a * h), KNOWN) == LENGTH
    assert dimension(a * sp.sin(a * phi), KNOWN) == LENGTH


@pytest.mark.parametrize(
    ("expression", "names"),
    [(lam + a, r"lam.*a|a.*lam"), (sp.sin(a), "a in sin"), (sp.exp(phi), "phi in exp")],
)
def test_inconsistent_dimensions_are_rejected_and_the_part_is_named(
    expression: sp.Expr, names: str
) -> None:
    with pytest.raises(DimensionError, match=names):
        dimension(expression, KNOWN)


def test_formula_rejects_a_wrong_unit_and_an_unknown_symbol() -> None:
    proof = Proof("", "", (), "")
    with pytest.raises(DimensionError, match=r"\[m\], expected \[Pa\]"):
        Formula("f", "f", "", a, "Pa", "", (), proof)
    with pytest.raises(KeyError, match="x"):
        Formula("f", "f", "", x, "m", "", (), proof)


def test_a_formula_has_an_expression_that_its_proof_determines() -> None:
    """An expression is also rejected if it is half of the proved one, or is only displayed."""
    proof = prove("area", "", lambda f: {"slope": sp.diff(f, a) - 2 * a, "0": f.subs(a, 0)}, a**2)
    assert Formula("f", "f", "", a**2, "m^2", "", (), proof).expression == a**2
    with pytest.raises(ValueError, match="f: expected an expression that the proof 'area' determ"):
        Formula("f", "f", "", a**2 / 2, "m^2", "", (), proof)
    with pytest.raises(ValueError, match=r"got stated=a\*h; give it to `prove` as a claim"):
        Formula("f", "f", "", a**2, "m^2", "", (), proof, stated=a * h)


@pytest.mark.parametrize(
    "expression",
    [
        (sp.exp(2 * x) - 1) / (sp.exp(2 * x) + 1),
        sp.exp(x)
        * (x * (sp.exp(2 * x) - 1) + sp.exp(2 * x) + 1)
        / (sp.exp(4 * x) - 4 * x * sp.exp(2 * x) - 1),
        sp.sinh(3 * x) / sp.cosh(x),
    ],
)
def test_hyperbolic_form_is_equal_and_free_of_exponentials(expression: sp.Expr) -> None:
    rewritten = to_hyperbolic(expression, x)
    assert not rewritten.has(sp.exp)
    for at in ("0.37", "2.6"):
        difference = (rewritten - expression).subs(x, sp.Rational(at)).evalf(30)
        assert abs(difference) < 1e-25


def test_expression_without_hyperbolic_form_is_rejected() -> None:
    with pytest.raises(ValueError, match="remains"):
        to_hyperbolic(sp.exp(x) * (sp.exp(2 * x) + 1), x)


def test_evaluation_raises_the_precision_until_cancellation_is_resolved() -> None:
    """At x = 1e-20, sin x - x cos x is x^3/3 to forty digits; in double precision it is 0."""
    ball = evaluate(sp.sin(x) - x * sp.cos(x), {x: 1e-20}, 50)
    with flint.ctx.workprec(400):
        exact = flint.arb(1e-20) ** 3 / 3
        assert abs(ball / exact - 1) < flint.arb("1e-39")
    assert ball.rel_accuracy_bits() >= 166


def test_evaluation_of_an_exact_zero_is_rejected() -> None:
    with pytest.raises(PrecisionError, match="no 20 digits of sin"):
        evaluate(sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1, {x: 0.5}, 20)


def test_formula_is_not_printed_for_an_error_that_is_not_shown() -> None:
    """Printing took longer than all evaluations of a formula."""

    class Formula:
        def __str__(self) -> str:
            raise AssertionError

    with pytest.raises(PrecisionError):
        refine(flint.arb.nan, 20, Formula())


@pytest.mark.parametrize(
    "undefined",
    [
        sp.acosh(x), sp.log(-x), log1p(-2 * x), sp.sqrt(1 - 2 * x), sp.asin(2 * x), sp.acos(2 * x),
        sp.atanh(2 * x),
    ],
)  # fmt: skip
def test_precision_is_not_raised_at_a_point_without_a_real_value(
    undefined: sp.Expr, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Logarithms with 65536 bits took half of the time in which a formula was rewritten."""
    precisions = []

    def recorded(number: Exact) -> flint.arb:
        precisions.append(flint.ctx.prec)
        return to_ball(number)

    monkeypatch.setattr(ball_module, "to_ball", recorded)
    with pytest.raises(PrecisionError, match="no 20 digits of"):
        evaluate(undefined - sp.log(3 * x), {x: 0.75}, 20)
    assert max(precisions) < 200


def test_root_of_a_number_that_may_be_negative_is_evaluated_with_more_bits() -> None:
    """With few bits, the ball of the number contains negative ones."""
    value = evaluate(sp.sqrt((1 + x) - sp.cos(x)), {x: Fraction(1, 2**300)}, 20)
    assert float(value) == 2.0**-150


def test_zero_is_recognised_and_small_values_are_not() -> None:
    assert decide_zero(sp.sinh(2 * x) - 2 * sp.sinh(x) * sp.cosh(x)) == SYMBOLIC
    assert decide_zero(sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1) == BY_BALLS
    assert decide_zero(sp.sinh(2 * x) - 2 * sp.sinh(x)) is None
    assert decide_zero(sp.sin(x) - x + sp.Rational(1, 10**60)) is None


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1", "1"),
        ("Pa/m", "m^-2 kg s^-2"),
        ("kg m/s^2", "m kg s^-2"),
        ("J/(kg m)", "m s^-2"),
        ("1/m^2", "m^-2"),
        ("m/N^(5/3)", "m^-2/3 kg^-5/3 s^10/3"),
        ("N/m^(11/3)", "m^-8/3 kg s^-2"),
        ("W/(m K)", "m kg s^-3 K^-1"),
        ("V/m", "m kg s^-3 A^-1"),
        ("J/(mol K)", "m^2 kg s^-2 K^-1 mol^-1"),
    ],
)
def test_units_are_parsed(text: str, expected: str) -> None:
    assert str(unit(text)) == expected


@pytest.mark.parametrize(
    "text", ["", "q", "m^", "m^-1", "m/s/s", "J/kg m", "m//s", "1/", "/m", "(m)", "m  s", "m^(1/2"]
)
def test_invalid_units_are_rejected(text: str) -> None:
    with pytest.raises(ValueError, match="use the units 1, rad, m, kg, s, N"):
        unit(text)


def test_vocabulary_finds_symbols_by_their_latex() -> None:
    vocabulary = Vocabulary(
        (
            Argument(a, "m", "a_0", "", ()),
            Argument(mu, "1", r"\varkappa", "", ()),
            Argument(h, "m", r"H_{1}^{(j)}", "", ()),
        ),
        indices="j",
    )
    assert vocabulary.name_of_latex == {"a_0": "a", "varkappa": "mu", "H_1": "h"}
    read = parse_latex(r"a_0 \varkappa + H_1^{(j)}", vocabulary)
    assert read == a * mu + h
    assert vocabulary.numbers == {mu}
    with pytest.raises(KeyError, match="without unit and domain: lam"):
        vocabulary.arguments_of(a * lam)
