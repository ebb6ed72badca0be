"""Sums over a number are compared term by term, sums over modes only with sums over modes."""

import pytest

from derivation.engine.formula.parse import FormulaError
from derivation.plate.derived import formulas
from derivation.plate.elastic import diagnose_text

CHAIN = formulas()
FORCE = r"\sum_{k=2}^{\infty} \xi_k \delta(t)^{\frac{2k-1}{3}}"
WORK = r"\sum_{k=2}^{\infty} \frac{\xi_k}{k+1} \delta(t)^{\frac{2(k+1)}{3}}"
PUBLISHED = {
    "(11)": ("acceleration", rf"\ddot{{\delta}}(t) = -\frac{{1}}{{m}} {FORCE}, \quad (11)"),
    "(13)": ("speed", rf"\dot{{\delta}}(t) = \sqrt{{v_0^2 - \frac{{3}}{{m}} {WORK}}}. \tag{{13}}"),
    "in brackets": (
        "acceleration",
        r"-\left( \sum_{k = 2}^\infty \xi_{k} \delta^{\frac{2k - 1}{3}} \right) \frac{1}{m}",
    ),
    "with an end": (
        "acceleration",
        r"-\frac{1}{m}\sum\limits_{k=2}^{3} \xi_k \delta^{(2k-1)/3} + \xi_2 - \xi_2",
    ),
}
NOTE = "the terms k = 2 to 3 of the sum, as in the derived formula"


@pytest.mark.parametrize("case", PUBLISHED)
def test_published_series_equals_the_terms_of_the_derived_formula(case: str) -> None:
    name, text = PUBLISHED[case]
    diagnosis = diagnose_text(name, text, CHAIN, latex=True)
    assert diagnosis.verdict == "equal"
    assert diagnosis.compared == (None if "infty" not in text else NOTE)


def test_misprint_in_a_series_is_named() -> None:
    text = "-Sum(xi_k*delta**((2*k + 1)/3),  (k, 2, oo))/m"
    diagnosis = diagnose_text("acceleration", text, CHAIN)
    assert (diagnosis.verdict, diagnosis.compared) == ("different", NOTE)
    assert "delta**(2/3)" in diagnosis.repair


def test_term_beyond_the_derived_formula_is_a_misprint() -> None:
    text = "-Sum(xi_k*delta**((2*k - 1)/3), (k, 2, 4))/m"
    diagnosis = diagnose_text("acceleration", text, CHAIN)
    assert diagnosis.verdict == "different"
    assert "leave out the term" in diagnosis.repair


REJECTED = {
    "symbols of another formula": (
        ("P", r"P = \sum_{k=2}^{\infty} \xi_k \delta^{\frac{2k-1}{3}}", True),
        "got xi_2: name a formula that contains them, acceleration, speed",
    ),
    "no symbol with the index": (
        ("P", r"\sum_{k=2}^{\infty} a^k", True),
        "P is not a sum over the modes",
    ),
    "too many terms": (("xi_2", "Sum(1/gamma_2**k, (k, 1, 1000))", False), "1 to 100 terms"),
    "nested sums with too many terms": (
        ("xi_2", r"\sum_{k=1}^{99} \sum_{l=1}^{99} \sum_{m=1}^{99} k", True),
        "at most 20000 characters, got",
    ),
    "no terms": (("xi_2", "Sum(1/gamma_2**k, (k, 3, 2))", False), "1 to 100 terms"),
    "sum over modes of a formula that is none, in LaTeX": (
        ("K_j", r"\sum_{j=1}^{\infty} \frac{1}{\phi_j}", True),
        "K_j is not a sum over the modes",
    ),
    "sum over modes of a formula that is none": (
        ("Omega_3", "Sum(-sinh(phi*h)/(2*mu*(sinh(2*phi*h) + 2*phi*h)), (j, 1, oo))", False),
        "Omega_3 is not a sum over the modes",
    ),
    "name of a sum in a formula that is none": (
        ("delta_reduced", "(delta_half + delta_thickness)*R/a**2", False),
        "is not a sum over the modes, but delta_thickness is",
    ),
    "function of time without an equation": (
        ("acceleration", r"-\frac{\xi_2 \delta(t)}{m}", True),
        r"leave out \(t\)",
    ),
    "argument that may be a factor": (
        ("f_j", r"f_j(z) = C_1 \phi_j(z)", True),
        r"leave out \(z\)",
    ),
}


@pytest.mark.parametrize("case", REJECTED)
def test_other_sums_are_rejected_with_a_reason(case: str) -> None:
    (name, text, latex), reason = REJECTED[case]
    with pytest.raises(FormulaError, match=reason):
        diagnose_text(name, text, CHAIN, latex=latex)
