"""A misprint is found although the printed formula has no real value, and is shown on one line."""

import mpmath
import platecontact as pc
import pytest

from derivation.engine.errata.text import NOT_PRINTED, NOT_REAL
from derivation.engine.formula.parse import FormulaError
from derivation.plate.derived import formulas
from derivation.plate.elastic import diagnose_text

CHAIN = formulas()
SPEED = "sqrt(-3*delta**(8/3)*xi_3/(4*m) - delta**2*xi_2/m + v0**2)"


@pytest.mark.parametrize(
    ("name", "text", "value", "kind"),
    [
        ("speed", SPEED.replace("+ v0", "- v0"), NOT_REAL, "sign"),
        ("p", "-3*P*sqrt(r**2 - a**2)/(2*pi*a**3)", NOT_REAL, None),
        ("S_tt", "2*C3*lam*mu*cosh(mu*phi*z)/(lam + mu)", NOT_PRINTED, None),
    ],
)
def test_a_formula_without_a_real_value_is_compared(
    name: str, text: str, value: str, kind: str | None
) -> None:
    diagnosis = diagnose_text(name, text, CHAIN)
    assert diagnosis.verdict == "different"
    assert diagnosis.given_value == value
    assert float(diagnosis.derived_value) != 0
    assert kind in (None, diagnosis.diagnosis.kind)


def test_another_default_point_is_taken_if_the_formula_has_a_value_there() -> None:
    """sqrt(h - 5 a) is real for a thicker plate only; both values belong to that point."""
    diagnosis = diagnose_text("P", "mu*sqrt(h - 5*a)*a**(3/2)", CHAIN, digits=30)
    with mpmath.workdps(40):
        h, a, mu = (mpmath.mpf(dict(diagnosis.point)[name]) for name in ("h", "a", "mu"))
        exact = mu * mpmath.sqrt(h - 5 * a) * a ** mpmath.mpf(1.5)
        assert abs(mpmath.mpf(diagnosis.given_value) / exact - 1) < 1e-28


def test_a_given_point_without_a_value_is_rejected() -> None:
    with pytest.raises(FormulaError, match="no real value at"):
        diagnose_text("speed", SPEED.replace("+ v0", "- v0"), CHAIN, at={"v0": "1"})


def test_a_correction_with_an_imaginary_constant_causes_no_exception() -> None:
    """If only a root of G_1 is given, pairs of edits contain roots of negative numbers."""
    text = "-sqrt(-3*delta_0**(8/3)*xi_3/(4*m) - delta_0**2*xi_2/m + v0**2)"
    assert diagnose_text("G_1", text, CHAIN).verdict == "different"


def test_results_are_shown_on_one_line() -> None:
    diagnosis = pc.diagnose("P", "16*mu*(lam + mu)*a**2/(3*R*(lam + 2*mu))")
    assert str(diagnosis) == "P: different, wrong exponent: read a**3 instead of a**2"
    assert str(diagnosis.diagnosis) == str(diagnosis)
    assert str(pc.diagnose("G", str(CHAIN["G"].expression))) == "G: equal"
    (omega, *_) = (one for one in pc.misprints() if one.printed.name == "Omega_3")
    assert str(omega).startswith("(5) Omega_3: extra factor: leave out the factor phi")
    (right, *_) = (one for one in pc.misprints() if not one.is_misprint)
    assert str(right) == f"({right.printed.equation}) {right.printed.name}: correct as published"


@pytest.mark.parametrize(
    ("text", "latex"),
    [
        ("Sum(Sum(K_j*a*phi**3*sonine, (j, 1, oo)), (j, 1, oo))", False),
        ("2*Sum(K_j*Sum(a*phi, (j, 1, oo)), (j, 1, oo))", False),
        (r"\sum_{j=1}^{\infty} \sum_{k=1}^{\infty} K_j a \phi_j^3", True),
        (r"\sum_j K_j \left(1 + \sum_j a\right)", True),
    ],
)
def test_a_sum_within_a_sum_is_rejected_with_its_remedy(text: str, latex: bool) -> None:
    with pytest.raises(FormulaError, match=r"no sum within another sum.*give one term of it"):
        pc.diagnose("delta", text, latex=latex)


@pytest.mark.parametrize("text", [r"a + \sum_{j=1}^{\infty} K_j", r"\sum_{j=1}^{9} K_j"])
def test_a_latex_sum_of_another_kind_is_rejected_with_its_remedy(text: str) -> None:
    with pytest.raises(FormulaError, match=r"give one term of the sum, or write c .sum_"):
        pc.diagnose("delta", text, latex=True)


@pytest.mark.parametrize("name", ["Sin", "sin2", "sinus"])
def test_an_unknown_function_is_not_taken_for_a_factor(name: str) -> None:
    with pytest.raises(FormulaError, match=f"unknown function '{name}'.*expected one of") as caught:
        pc.diagnose("G", f"{name}(T)")
    assert f"{name}*(" not in str(caught.value)
