"""`diagnose` accepts every comparable quantity; rejected input gives a message, not a traceback."""

import random
from collections.abc import Mapping
from fractions import Fraction

import mpmath
import pytest
import sympy as sp

from derivation.cli import main
from derivation.engine.errata.lookup import comparable
from derivation.engine.errata.point import default_value, exact_values, parse_point
from derivation.engine.formula.domain import holds, violated_conditions
from derivation.engine.formula.parse import FormulaError
from derivation.plate.derived import formulas as derived_formulas
from derivation.plate.elastic import RELATIONS, diagnose_text, lame, relations
from derivation.plate.vocabulary import ARGUMENTS, PLATE, A_j, E, Formula, P, a, b, lam, mu, nu

CHAIN: Mapping[str, Formula] = derived_formulas()
COMPARABLE = [n for n in comparable(CHAIN) if not CHAIN[n].expression.has(sp.Integral)]


@pytest.mark.parametrize("name", COMPARABLE)
def test_quantity_equals_its_own_expression(name: str) -> None:
    diagnosis = diagnose_text(name, str(CHAIN[name].expression), CHAIN)
    assert diagnosis.verdict == "equal"
    assert diagnosis.given_value == diagnosis.derived_value
    assert (diagnosis.compared is not None) == CHAIN[name].summed


@pytest.mark.parametrize("name", COMPARABLE)
def test_quantity_differs_from_a_number(name: str) -> None:
    """For a sum over the modes, a number is rejected: it is not the contribution of one mode."""
    per_mode = CHAIN[name].expression.free_symbols & PLATE.per_term
    if CHAIN[name].summed and per_mode:
        with pytest.raises(FormulaError, match="contribution of one mode"):
            diagnose_text(name, "2", CHAIN)
        with_mode = f"2*{min(s.name for s in per_mode)}"
        assert diagnose_text(name, with_mode, CHAIN).verdict == "different"
    else:
        diagnosis = diagnose_text(name, "2", CHAIN)
        assert (diagnosis.verdict, diagnosis.given_value) == ("different", "2")


@pytest.mark.parametrize("name", COMPARABLE)
@pytest.mark.parametrize("text", ["2*width", "E**2 + 1"])
def test_formulas_with_other_symbols_are_rejected_or_compared(name: str, text: str) -> None:
    elastic = CHAIN[name].expression.free_symbols & {lam, mu, nu, P, A_j}
    if text.startswith("E") and elastic and not CHAIN[name].summed:
        assert diagnose_text(name, text, CHAIN).verdict == "different"
    else:
        with pytest.raises(FormulaError, match=r"unknown name 'width'|Young's modulus|one mode"):
            diagnose_text(name, text, CHAIN)


def test_quantities_that_cannot_be_compared_are_rejected() -> None:
    others = set(CHAIN) - set(COMPARABLE)
    assert {"radial_ode", "F_lateral", "c_1_roots"} <= others
    for name in others - {"k_lateral", "slope_lateral"}:  # integrals with a proved error
        with pytest.raises(FormulaError, match="cannot be compared"):
            diagnose_text(name, "2", CHAIN)


def test_every_symbol_has_a_default_value_in_its_domain() -> None:
    for argument in ARGUMENTS:
        value = Fraction(default_value(argument, PLATE.values))
        assert not violated_conditions(argument.domain, {argument.symbol: value}), argument.name


# --- Young's modulus and Poisson's ratio


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("P", "4*a**3*E/(3*R*(1 - nu**2))"),
        ("P", "8*a**3*mu/(3*R*(1 - nu))"),
        ("C_half", "2*(1 - nu**2)/(E*phi)"),
        ("p", "-2*E*sqrt(a**2 - r**2)/(pi*R*(1 - nu**2))"),
        ("support_ratio", "(1 - nu)/(1 + nu)"),
    ],
)
def test_formulas_in_young_s_modulus_are_compared(name: str, text: str) -> None:
    assert diagnose_text(name, text, CHAIN).verdict == "equal"
    wrong = text.replace("nu", "(nu/2)").replace("E*", "(1 + nu)*E*")
    assert diagnose_text(name, wrong, CHAIN).verdict == "different"


def test_evaluation_point_may_contain_young_s_modulus() -> None:
    text, at = "4*a**3*E/(3*R*(1 - nu**2))", {"E": "70e9", "nu": "0.25", "a": "0.001", "R": "0.01"}
    diagnosis = diagnose_text("P", text, CHAIN, at=at, digits=20)
    with mpmath.workdps(40):
        force = (
            4
            * mpmath.mpf("1e-9")
            * mpmath.mpf("70e9")
            / (3 * mpmath.mpf("0.01") * (1 - 1 / mpmath.mpf(16)))
        )
        assert abs(mpmath.mpf(diagnosis.given_value) / force - 1) < 1e-19


def test_elastic_constants_are_related_as_in_hooke_s_law() -> None:
    """E and nu follow from lam and mu for a bar in uniaxial tension: the lateral stress is zero."""
    draw = random.Random(3)
    for _ in range(5):
        first, shear = Fraction(draw.randint(1, 99), 7), Fraction(draw.randint(1, 99), 11)
        lateral = sp.Symbol("lateral")
        stress = lambda own, others: first * (own + others) + 2 * shear * own  # noqa: B023, E731
        (side,) = sp.solve(stress(lateral, 1 + lateral), lateral)
        values = {lam: sp.Rational(first), mu: sp.Rational(shear)}
        meaning = relations({E, nu, lam, mu})
        assert meaning[nu].subs(values) == -side
        assert meaning[E].subs(values) == stress(1, 2 * side)
        given = {"E": Fraction(stress(1, 2 * side)), "nu": Fraction(-side)}
        assert lame(given) == {"lam": first, "mu": shear}
    assert relations({E, mu, nu}) == {E: 2 * mu * (1 + nu)}


# --- sums and points


@pytest.mark.parametrize(
    ("text", "latex"),
    [
        ("K_j*a*phi**3*sonine", False),
        ("Sum(K_j*a*phi**3*sonine, (j, 1, oo))", False),
        (
            "2*Sum(K_j*a*phi**3*sonine/4, (j, 1, oo)) + Sum(K_j*a*phi**3*sonine, (j, 1, oo))/2",
            False,
        ),
        (r"\sum_{j=1}^{\infty} \frac{16}{\pi R b^2} \sin(a \phi_j)", True),
    ],
)
def test_sums_are_compared_term_by_term(text: str, latex: bool) -> None:
    diagnosis = diagnose_text("delta", text, CHAIN, latex=latex)
    assert diagnosis.verdict == ("different" if latex else "equal")
    assert diagnosis.compared is not None
    assert "one mode" in diagnosis.compared
    assert diagnosis.to_json()["compared"] == diagnosis.compared


def test_conditions_are_tested_exactly() -> None:
    third = Fraction(1, 3)
    assert holds("a < b", {a: third, b: third + Fraction(1, 10**60)})
    assert not holds("a < b", {a: third, b: third})
    assert violated_conditions(("a < b", "a > 0"), {a: Fraction(-1)}) == ["a > 0"]
    for wrong in ("a + b", "a < b"):
        with pytest.raises(ValueError, match=r"expected a (comparison|value)"):
            holds(wrong, {a: third})


def test_default_point_is_replaced_by_one_with_a_real_value_but_a_given_point_is_not() -> None:
    diagnosis = diagnose_text(
        "evanescent_wave_number", "k_n*sqrt(1 - kap*(17 - 7*nu)/(10*eta**2*k_n**2))", CHAIN
    )
    assert diagnosis.verdict == "equal"
    assert diagnosis.given_value == diagnosis.derived_value
    given = {"eta": "0.1", "k_n": "0.5", "kap": "0.01"}
    assert sum(dict(diagnosis.point)[name] != value for name, value in given.items()) == 1
    with pytest.raises(FormulaError, match=r"no real value at .*: choose another point"):
        diagnose_text("evanescent_wave_number", "k_n", CHAIN, at=given)
    far = {"eta": "1e-9"}
    with pytest.raises(FormulaError, match=r"choose another point; \d+ points near it have none"):
        diagnose_text("evanescent_wave_number", "k_n", CHAIN, at=far)


def test_evaluation_points_are_parsed_or_rejected() -> None:
    assert parse_point(" phi = 2.5, h=0.1,") == {"phi": "2.5", "h": "0.1"}
    for text in ("phi", "phi=", "=1", "phi=1,phi=1", "phi=1, phi =2"):
        with pytest.raises(FormulaError, match="--at: expected"):
            parse_point(text)
    with pytest.raises(FormulaError, match="lam once, got it twice"):
        exact_values({"lam": "1", "lambda": "2"}, PLATE, RELATIONS)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["G", "--formula", "T", "--at", "T=-1"], "T > 0"),
        (["G", "--formula", "T", "--at", "T=1,T=2"], "twice"),
        (["G", "--formula", "E**T"], "exp(1)"),
        (["G", "--formula", "+".join(["(T + 1)"] * 9) + "**9" * 2], "lower"),
    ],
)
def test_command_rejects_input_without_a_traceback(
    arguments: list[str], expected: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["diagnose", *arguments]) == 2
    message = capsys.readouterr().err
    assert expected in message
    assert "Traceback" not in message
