"""Misprints in formulas of textbooks: each correction is stated as a reader would state it."""

import pytest
import sympy as sp

from derivation.engine.errata.compare import diagnose
from derivation.engine.errata.relations import Relations
from derivation.engine.formula.parse import parse
from derivation.engine.formula.proof import prove
from derivation.engine.formula.record import Record
from derivation.engine.formula.vocabulary import Argument, Vocabulary

NAMES = "a r h D E E_1 E_2 P R T_0 kappa t w x y z nu nu_1 nu_2 I_z L beta_f"
SYMBOLS = sp.symbols(NAMES, positive=True)
a, r, h, D, E, E_1, E_2, P, R, T_0, kappa, t, w, x, y, z, nu, nu_1, nu_2, I_z, L, beta_f = SYMBOLS
PLAIN = Vocabulary(tuple(Argument(s, "1", s.name, "a number", (f"{s} > 0",)) for s in SYMBOLS))


class Formula(Record):
    """A formula of pure numbers."""

    vocabulary = PLAIN


ROOT = sp.sqrt(4 * kappa * t)
DERIVED = {
    "contact_modulus": 1 / ((1 - nu_1**2) / E_1 + (1 - nu_2**2) / E_2),
    "half_width": sp.sqrt(4 * P * R / (sp.pi * E)),
    "adhesion": 4 * E * a**3 / (3 * R) - sp.sqrt(8 * sp.pi * w * E * a**3),
    "below_contact": (1 + nu) * (1 - z / a * sp.atan(a / z)) - 1 / (2 * (1 + z**2 / a**2)),
    "half_space": z**2 / (r**2 + z**2) ** sp.Rational(3, 2) + 2 * (1 - nu) / sp.sqrt(r**2 + z**2),
    "stiffness": E * h**3 / (12 * (1 - nu**2)),
    "clamped": (a**2 - r**2) ** 2 / (64 * D),
    "supported": (3 + nu) / (1 + nu) * (a**2 - r**2) + 2 * r**2 * sp.log(r / a),
    "cantilever": P * x**2 * (3 * L - x) / (6 * E * I_z),
    "shell": P * R * sp.sqrt(3 * (1 - nu**2)) / (4 * E * h**2),
    "step": T_0 * sp.erfc(x / ROOT),
    "flux": 2 * sp.sqrt(kappa * t / sp.pi) * sp.exp(-(x**2) / ROOT**2) - x * sp.erfc(x / ROOT),
    "fin": 2 * sp.besseli(1, beta_f * R) / (beta_f * R * sp.besseli(0, beta_f * R)),
    "weibull": T_0 * sp.gamma(1 + 1 / y),
    "shaft": 16 * P * R / (sp.pi * a**3 * (1 - (h / a) ** 4)),
}
PROOF = prove("textbook", "typed", {"identity": sp.Integer(0)})
FORMULAS = {
    name: Formula(name, name[0], name, expression, "1", "", (), PROOF)
    for name, expression in DERIVED.items()
}


@pytest.mark.parametrize(
    ("name", "text", "kind", "repair"),
    [
        ("contact_modulus", "1/((1 - nu_1**2)/E_2 + (1 - nu_2**2)/E_1)", "swapped symbol",
         "exchange E_1 and E_2 in 1/((1 - nu_1**2)/E_2 + (1 - nu_2**2)/E_1)"),
        ("half_width", "sqrt(2*P*R/(pi*E))", "constant ratio",
         "multiply the whole expression by sqrt(2)"),
        ("adhesion", "4*E*a**3/(3*R) - sqrt(6*pi*w*E*a**3)", "constant ratio",
         "multiply the term -sqrt(6)*sqrt(pi)*sqrt(E)*a**(3/2)*sqrt(w) by 2*sqrt(3)/3"),
        ("below_contact", "(1 + nu)*(1 - z/a*atan(z/a)) - 1/(2*(1 + z**2/a**2))",
         "swapped symbol", "exchange a and z in the argument z/a"),
        ("below_contact", "(1 - nu)*(1 - z/a*atan(a/z)) - 1/(1 + z**2/a**2)", "two misprints",
         "multiply the term -1/(1 + z**2/a**2) by 1/2; and reverse the sign of the term -nu"),
        ("half_space", "z**2/(r**2 + z**2)**(3/2) + 2*nu/sqrt(r**2 + z**2)", "swapped symbol",
         "read 1 - nu instead of nu in the term 2*nu/sqrt(r**2 + z**2)"),
        ("stiffness", "E*h**3/12*(1 - nu**2)", "wrong exponent",
         "read 1/(1 - nu**2) instead of 1 - nu**2"),
        ("clamped", "(a**2 + r**2)**2/(64*D)", "sign", "reverse the sign of the term a**2"),
        ("supported", "(3 + nu)*(1 + nu)*(a**2 - r**2) + 2*r**2*log(r/a)", "wrong exponent",
         "read 1/(nu + 1) instead of nu + 1"),
        ("cantilever", "P*x**2*(3*x - L)/(6*E*I_z)", "swapped symbol",
         "exchange L and x in -L + 3*x"),
        ("shell", "P*R*sqrt(3)*(1 - nu**2)/(4*E*h**2)", "wrong exponent",
         "read sqrt(1 - nu**2) instead of 1 - nu**2"),
        ("step", "T_0*erf(x/sqrt(4*kappa*t))", "swapped function",
         "read erfc(x/(2*sqrt(kappa)*sqrt(t))) instead of erf(x/(2*sqrt(kappa)*sqrt(t)))"),
        ("step", "T_0*erfc(x/sqrt(kappa*t))", "constant ratio",
         "read erfc(x/(2*sqrt(kappa)*sqrt(t))) instead of erfc(x/(sqrt(kappa)*sqrt(t)))"),
        ("flux", "2*sqrt(kappa*t)/pi*exp(-x**2/(4*kappa*t)) - x*erfc(x/sqrt(4*kappa*t))",
         "constant ratio", ("multiply the term "
         "2*sqrt(kappa)*sqrt(t)*exp(-x**2/(4*kappa*t))/pi by sqrt(pi)")),
        ("fin", "2*J1(beta_f*R)/(beta_f*R*J0(beta_f*R))", "two misprints",
         ("read besseli(0, R*beta_f) instead of besselj(0, R*beta_f); and read "
         "besseli(1, R*beta_f) instead of besselj(1, R*beta_f)")),
        ("weibull", "T_0*gamma(1 + y)", "extra factor",
         "read gamma((y + 1)/y) instead of gamma(y + 1)"),
        ("shaft", "16*P*R/(pi*a**3*(1 - h/a)**4)", "two misprints",
         ("divide the whole expression by the missing factor 1 - h**4/a**4; and leave out the "
         "factor 1 - h/a in the base 1 - h/a")),
    ],
)  # fmt: skip
def test_misprint_of_a_textbook_formula(name: str, text: str, kind: str, repair: str) -> None:
    given = parse(text, PLAIN)
    diagnosis = diagnose(name, given, FORMULAS, Relations())
    assert (diagnosis.kind, diagnosis.repair) == (kind, repair)
    assert diagnosis.repaired is not None
    point = {s: sp.Rational(1, 3) + sp.Rational(k, 97) for k, s in enumerate(SYMBOLS)}
    repaired, derived = (sp.N(e.subs(point), 30) for e in (diagnosis.repaired, DERIVED[name]))
    assert abs(repaired - derived) < 1e-25 * abs(derived)
