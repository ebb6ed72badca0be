"""Parsers for formulas in Python syntax and in LaTeX: exact results; other text is rejected."""

import re
from contextlib import suppress
from functools import partial

import flint
import mpmath
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from derivation.engine.formula import parse as plain
from derivation.engine.formula import parse_latex as in_latex
from derivation.engine.formula.ball import evaluate
from derivation.engine.formula.elementary import ELEMENTARY, INSTEAD, OTHER_NAMES
from derivation.engine.formula.notation import to_latex
from derivation.engine.formula.operations import operation
from derivation.engine.formula.parse import FormulaError
from derivation.engine.formula.proof import decide_zero
from derivation.engine.formula.vocabulary import NOTHING
from derivation.plate.chain import derive
from derivation.plate.vocabulary import (
    C1,
    J1,
    PLATE,
    A_j,
    R,
    a,
    a_ratio,
    b,
    h,
    k,
    kap,
    kappa,
    lam,
    mu,
    nu,
    omega,
    phi,
    r,
    rho,
    v0,
    z,
)

parse = partial(plain.parse, vocabulary=PLATE)
parse_latex = partial(in_latex.parse_latex, vocabulary=PLATE)

ACCEPTED = {
    "0.1": sp.Rational(1, 10),
    "1.5e-3": sp.Rational(3, 2000),
    ".5*h": h / 2,
    "lambda + 2*mu": lam + 2 * mu,
    "C_1*phi_j": C1 * phi,
    "-a**-2": -(a**-2),
    "-2*a^2^3/h^-1": -2 * a**8 * h,
    "factorial(4) + factorial(a)": 24 + sp.gamma(a + 1),
    "exp(1)**(h*phi)": sp.exp(h * phi),
    "gamma(3) + beta(1, 2)": sp.Rational(5, 2),
    "Abs(-h) + abs(h)": 2 * h,
    "besseli(0, phi*r) + I1(phi*r)": sp.besseli(0, phi * r) + sp.besseli(1, phi * r),
    "EulerGamma": sp.EulerGamma,
    "4**(k - 1)": 4 ** (k - 1),
    "exp(h*phi)*A_j": sp.exp(h * phi) * A_j,
    "J1": J1,
    "J1(b*phi)": J1,
    "J1(phi*b)**2": J1**2,
    "besselj(1, b*phi)": J1,
    "J1(phi*r)": sp.besselj(1, phi * r),
    "J0(phi*r)": sp.besselj(0, phi * r),
    "sqrt(1 - r**2/a**2)": sp.sqrt(1 - r**2 / a**2),
    "cos(pi/3)": sp.Rational(1, 2),
    "cot(h*phi)": sp.cos(h * phi) / sp.sin(h * phi),
    " sinh( phi*z )\n + 1 ": sp.sinh(phi * z) + 1,
    "+h - -h": 2 * h,
}

REJECTED = {
    "__import__('os')": "quoted text",
    "__import__(os)": "unknown function",
    "().__class__": "expected numbers",
    "phi.free_symbols": "expected numbers",
    "h[0]": "square brackets",
    "lambda x: x": "':'",
    "(a for b in h)": "expected numbers",
    "[a for a in h]": "square brackets",
    "{h}": "braces",
    "f'{h}'": "braces|quoted",
    "h if a else b": "expected numbers",
    "a and b": "expected numbers",
    "not a": "expected numbers",
    "await a": "expected numbers",
    "sin(x=1)": "'='",
    "sin(*a)": "expected numbers",
    "sin(a, b)": "1 plain argument",
    "sin()": "1 plain argument",
    "sin": "expected an argument",
    "a(b)": r"write a\*",
    "exp(a)(b)": "expected numbers",
    "q": "unknown name 'q': .*expected one of A_j",
    "sin(q)": "unknown name",
    "zeta(3)": "unknown function",
    "E**(h*phi)": r"Young's modulus.* write exp\(1\)",
    "e**h": r"write exp\(\.\.\.\)",
    "gamma(0)": "no value",
    "beta(a)": "2 plain arguments",
    "((((a + 1)**9 + 1)**9 + 1)**9 + 1)**9": "total degree up to 1000",
    "a ^^ 2": "breaks off",
    "a!": r"write factorial\(n\)",
    "factorial(-1)": "no value",
    "a = b": "'='",
    "a == b": "'='",
    "a < b": "comparison",
    "a, b": "expected numbers",
    "a // b": "operator",
    "a % b": "not part of a formula",
    "a @ b": "not part of a formula",
    "~a": "not part of a formula",
    "a b": r"write every \*",
    "2 mu": r"write every \*",
    "2mu": r"write every \*",
    "(a": "missing '\\)'",
    "a)": "missing '\\('",
    ")(": "pairs|breaks",
    "*a": "breaks off near character 1",
    "a +": "ends too early",
    "a**": "ends too early",
    "a\\b": "backslash",
    "φ": "not part of a formula",
    "a\x00b": "not part of a formula",
    "1j": "decimal number",
    "0x10": "decimal number",
    "1_000": "decimal number",
    "True": "decimal number",
    "None": "decimal number",
    "": "empty text",
    " \n ": "empty text",
    "1/0": "zero",
    "1/(h - h)": "zero",
    "0/0": "zero",
    "0**-1": "no value",
    "(h - h)**(-2)": "no value",
    "log(0)": "zero",
    "tan(pi/2)": "zero",
    "cot(0)": "zero",
    "sqrt(-1)": "not real",
    "sqrt(-h)": "not real",
    "log(-1)": "not real",
    "9**9**9": "lower it",
    "10**10**10": "lower it",
    "2.0**1e9": "lower it",
    "((a**64)**64)**64": "lower it",
    "((a + b)**64)**64": "lower it",
    "(((2*a)**64)**64)": "lower it",
    "(1 + 10**-60)**100": "lower it",
    "9**99**(1/2)": "number as exponent",
    "h**b": "number as exponent",
    "1e999999999": "power of ten",
    "exp(exp(exp(100)))": "below 10000",
    "exp(10**50)": "below 10000",
    "sin(10**99)": "below 10000",
    "besselj(a, b)": "whole order",
    "besselj(10**6, b)": "whole order",
    "9" * 5000: "digits",
    "(" * 5000 + "a" + ")" * 5000: "nested",
    "-" * 5000 + "a": "nested|parts",
    "a**" * 4000 + "a": "nest",
    "a+" * 4000 + "a": "nest|parts",
    "a" * 30_000: "characters",
    "*".join(["9" * 50] * 200): "out of range",
    "*".join(["a**64"] * 50): "out of range",
    "sin(" * 49 + "1" + ")" * 49 + "/0": "zero",
}


def _mpmath_value(name: str, at: mpmath.mpf) -> mpmath.mpf:
    """Return the value of an elementary function by its usual name."""
    own = {
        "log10": mpmath.log10,
        "log2": lambda t: mpmath.log(t, 2),
        "log1p": lambda t: mpmath.log(1 + t),
        "expm1": lambda t: mpmath.exp(t) - 1,
    }
    return own[name](at) if name in own else getattr(mpmath, OTHER_NAMES.get(name, name))(at)


@settings(max_examples=10)
@given(point=st.floats(1e-3, 0.999))
@pytest.mark.parametrize("name", [*ELEMENTARY, *OTHER_NAMES])
def test_elementary_functions_have_the_values_of_mpmath(name: str, point: float) -> None:
    """The function is read from both notations, and its ball and slope are those of mpmath."""
    at = point + (name in ("acosh", "arccosh", "arcosh"))  # defined from 1 on
    x = sp.Symbol("x", positive=True)
    expression = plain.parse(f"{name}(x)", NOTHING, {"x": x})
    latex = rf"\operatorname{{{name}}}\left(x\right)"
    if name.isalpha():
        assert in_latex.parse_latex(latex, NOTHING, {"x": x}) == expression
    with mpmath.workdps(40):
        exact = _mpmath_value(name, mpmath.mpf(at))
        slope = mpmath.diff(lambda t: _mpmath_value(name, t), mpmath.mpf(at))
        for slopes, expected in ((expression, exact), (expression.diff(x), slope)):
            value = mpmath.mpf(evaluate(slopes, {x: at}, 20).str(25, radius=False))
            assert abs(value - expected) <= abs(expected) * mpmath.mpf("1e-15")
    if expression.args == (x,):
        with flint.ctx.workprec(100):
            step = operation(expression)
            (slopes,) = step.slopes(step.value(flint.arb(at)), flint.arb(at))
            assert abs(float(slopes.mid()) - float(slope)) <= 1e-14 * abs(float(slope))


def expect_error(read: object, text: object, reason: str) -> None:
    with pytest.raises(FormulaError, match=reason):
        read(text)  # type: ignore[operator]


@pytest.mark.parametrize("text", ACCEPTED)
def test_formulas_are_parsed_exactly(text: str) -> None:
    assert parse(text) == ACCEPTED[text]


@pytest.mark.parametrize("text", REJECTED, ids=lambda text: repr(text[:30]))
def test_other_text_is_rejected(text: str) -> None:
    expect_error(parse, text, REJECTED[text])


def test_input_must_be_text() -> None:
    expect_error(parse, 3, "as text")
    expect_error(parse_latex, None, "as text")


def test_allowed_names_can_be_chosen() -> None:
    K = sp.Symbol("K")
    assert plain.parse("2*K", NOTHING, {"K": K}) == 2 * K
    expect_error(
        lambda text: plain.parse(text, NOTHING, {"K": K}), "h", "expected one of EulerGamma, K, pi"
    )


@settings(max_examples=300)
@given(st.text(alphabet="ah phi019.+-*/(),eE^_[]{}'\\=:", max_size=40))
def test_random_text_is_parsed_or_rejected(text: str) -> None:
    for read in (parse, parse_latex):
        with suppress(FormulaError):
            assert isinstance(read(text), sp.Expr)


@settings(max_examples=200)
@given(st.decimals(min_value=0, max_value=10**9, places=12))
def test_decimals_are_exact(value: object) -> None:
    assert parse(f"{value:f}") == sp.Rational(str(value))


LATEX = {
    r"\phi_j h (e^{2\phi_j h} - 1)": phi * h * (sp.exp(2 * phi * h) - 1),
    r"2\mu(\lambda + \mu)": 2 * mu * (lam + mu),
    r"h(2b) + a(-h)(3)": 2 * b * h - 3 * a * h,
    r"\sinh{\left(a \phi_{j} \right)}": sp.sinh(a * phi),
    r"\sin^{2}{\left(a\phi_j\right)}": sp.sin(a * phi) ** 2,
    r"\cos(a\phi_j)^2": sp.cos(a * phi) ** 2,
    r"[J_1(b\phi_j)]^2": J1**2,
    r"J_1(b\phi_j)^{2}": J1**2,
    "J_1^2": J1**2,
    r"J_{1}\left(\phi_j r\right)": sp.besselj(1, phi * r),
    r"J_{0}^{2}\left(\phi_j r\right)": sp.besselj(0, phi * r) ** 2,
    r"\frac12 R\,h": R * h / 2,
    r"\frac{a}{b} \cdot h \times R / 2": a / b * h * R / 2,
    r"\left\{ a + \left[ b + h \right] \right\}^3": (a + b + h) ** 3,
    r"C_1^{(j)} z": C1 * z,
    r"\sqrt[3]{h} \; \sqrt{a}.": h ** sp.Rational(1, 3) * sp.sqrt(a),
    r"a + \\ &\quad - b,": a - b,
    r"\displaystyle -\pi R": -sp.pi * R,
    r"\left(1 - \frac{r^2}{a^2}\right)^{\frac{1}{2}}": sp.sqrt(1 - r**2 / a**2),
    r"a^23": 3 * a**2,
    r"3!^2 (a+h)! / \frac{1}{4!}": 36 * sp.gamma(a + h + 1) * 24,
    r"\begin{aligned} a &+ \\ &h \end{aligned}": a + h,
    r"\[ a + h. \tag{7b} \]": a + h,
    r"$$a + h, \quad (7)$$": a + h,
    r"a (7)": 7 * a,
    r"\nu + \rho \omega^2 + \kappa_0 + \kappa": nu + rho * omega**2 + kappa[0] + kap,
    r"\sin 2 \pi a \cos\frac{a}{b} - \ln h": sp.sin(2 * sp.pi * a) * sp.cos(a / b) - sp.log(h),
    r"\operatorname{arsinh}^2(a) \arctan h": sp.asinh(a) ** 2 * sp.atan(h),
    r"\left| a - b \right| + |h - r| \sqrt a": abs(a - b) + abs(h - r) * sp.sqrt(a),
    r"\lvert a - \lvert b - h \rvert \rvert": abs(a - abs(b - h)),
    r"\phi_{\text{j}} C_\mathrm{1}": C1 * phi,
    r"\operatorname*{erf}(a) + \mathrm{sech}\,b": sp.erf(a) + 1 / sp.cosh(b),
    r"\log_{10} a + \log_2(b)": sp.log(a) / sp.log(10) + sp.log(b) / sp.log(2),
    r"\int_0^a \frac{r}{\sqrt{a^2 - r^2}} \, dr": sp.Integral(r / sp.sqrt(a**2 - r**2), (r, 0, a)),
    r"2\int\limits_{0}^{\infty} r + 1 \, \mathrm{d}r \cdot h": 2
    * h
    * sp.Integral(r + 1, (r, 0, sp.oo)),
    r"\left(\int_0^h \int_0^{r} r z \,dz\,dr\right)^2": sp.Integral(r * z, (z, 0, r), (r, 0, h))
    ** 2,
    r"\int_{-\infty}^{a} dr": sp.Integral(1, (r, -sp.oo, a)),
    r"v_0 A \Gamma(3) I_0(\phi_j r)": 2 * v0 * a_ratio * sp.besseli(0, phi * r),
}

LATEX_REJECTED = {
    r"\delta(t)": "which would be read as a product",
    r"\frac{a^2}{R} \left(1 + h\left(\phi_j, b\right)\right)": "which would be read as a product",
    r"\int_0^a r": r"differential at the end of \\int",
    r"\int_0^a \frac{dr}{r}": r"differential at the end of \\int",
    r"\int r \, dr": r"both limits after \\int",
    r"\int_0 r \, dr": r"both limits after \\int",
    r"\infty r": "leave it out",
    r"\sum_{j} a": r"\\\\sum",
    r"\input{/etc/passwd}": r"\\\\input",
    r"\frac{a}": "ends",
    r"\frac{a}{b": "missing '}'",
    r"a)": "missing '\\('",
    r"a ]": "missing '\\['|missing|pairs",
    r"(a]": r"expected '\)'",
    r"\sin a h": "brackets or braces around the argument",
    r"\sin a (h + b)": "brackets or braces around the argument",
    r"\sin a/2": "brackets or braces around the argument",
    r"\tan^{-1} a": "or the inverse function",
    r"a_{\dot{b}}": "letters and digits",
    r"|a": "ends",
    "J_0": "argument",
    "Q": "unknown name 'Q'",
    "a = b": "'='",
    "a $ b": r"\$",
    "a + + + + b": "two signs",
    "": "got nothing",
    r"\frac{1}{0}": "zero",
    "9^{9^{9}}": "lower it",
    "{" * 5000 + "a" + "}" * 5000: "nested",
    r"\left(" * 2000 + "a" + r"\right)" * 2000: "nested|characters",
    "a^" * 4000 + "a": "second '\\^'",
    r"\sqrt" * 3000 + "{a}": "nested",
    r"\frac" * 3000: "nest|ends",
}


@pytest.mark.parametrize("text", LATEX)
def test_latex_is_parsed(text: str) -> None:
    assert parse_latex(text) == LATEX[text]


@pytest.mark.parametrize("text", LATEX_REJECTED, ids=lambda text: repr(text[:30]))
def test_other_latex_is_rejected(text: str) -> None:
    expect_error(parse_latex, text, LATEX_REJECTED[text])


def test_printed_latex_of_all_formulas_is_parsed_to_the_same() -> None:
    count = 0
    for formula in derive().values():
        if not formula.expression.atoms(sp.Derivative):
            back = parse_latex(to_latex(formula.expression, PLATE))
            assert decide_zero(back - formula.expression) is not None, formula.name
            count += 1
    assert count > 30


@pytest.mark.parametrize("name", INSTEAD)
def test_functions_that_are_not_read_are_rejected_with_what_to_write_instead(name: str) -> None:
    expect_error(parse, f"{name}(a, b)", re.escape(INSTEAD[name]))
    if name.isalpha():
        expect_error(parse_latex, rf"\{name}(a, b)", re.escape(INSTEAD[name]))


@pytest.mark.parametrize(
    "expression",
    [
        sp.Integral(r**2 / sp.sqrt(a**2 - r**2), (r, 0, a)) / 2,
        sp.Integral(sp.exp(-r) * sp.sin(h * r) / r, (r, 0, sp.oo)) + 1,
        sp.Integral(r * z + z, (z, 0, r), (r, 0, a)),
    ],
)
def test_printed_integrals_are_read_again(expression: sp.Expr) -> None:
    assert parse_latex(sp.latex(expression)) == expression


def test_the_differential_differs_from_a_symbol_d() -> None:
    with pytest.raises(FormulaError, match="cannot be told apart"):
        parse_latex(r"\int_0^a d r \, dr", also={"d": sp.Symbol("d")})
