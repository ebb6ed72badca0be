"""Test the motion: energy, contact time, linearisation, and the published (9) to (18)."""

import json
from collections.abc import Mapping

import mpmath as mp
import pytest
import sympy as sp

from derivation.engine.errata.findings import Finding
from derivation.engine.formula.parse_latex import parse_latex
from derivation.engine.formula.proof import decide_zero
from derivation.plate.misprints import diagnose_power, diagnose_series, misprints
from derivation.plate.printed.contact import K_j
from derivation.plate.printed.motion import PRINTED_MOTION, Printed
from derivation.plate.vocabulary import PLATE, D, Formula, delta, gamma_k, k, m, u_t, v0, xi_k

HERTZ = "1.4716375921623523"


@pytest.fixture(scope="module")
def findings(formulas: Mapping[str, Formula]) -> dict[str, Finding]:
    names = {record.name for record in PRINTED_MOTION}
    actual = misprints(formulas)
    return {
        finding.printed.name: finding
        for finding in actual
        if finding.printed.name in names and int(finding.printed.equation) > 8
    }


def test_computed_motion_conserves_energy(formulas: Mapping[str, Formula]) -> None:
    """The velocity from integrating (11) with mpmath's Taylor solver agrees with (13)."""
    numbers = {m: 2, v0: 3, xi_k[2]: 5, xi_k[3]: sp.Rational(7, 10)}
    acceleration = sp.lambdify(delta, formulas["acceleration"].expression.subs(numbers), "mpmath")
    speed = sp.lambdify(delta, formulas["speed"].expression.subs(numbers), "mpmath")
    # The integration starts at delta > 0 because delta^(5/3) has no Taylor series at 0.
    start = mp.mpf("0.3")
    solve = mp.odefun(lambda _, y: [y[1], acceleration(y[0])], 0, [start, speed(start)])
    place, velocity = solve(mp.mpf("0.5"))
    assert place > 1
    assert abs(velocity - speed(place)) < mp.mpf("1e-12")


def contact_integral(formulas: Mapping[str, Formula], law: tuple[float, ...]) -> mp.mpf:
    """Return the integral of the recorded integrand for a law with given D_3, D_5, D_7."""
    values = dict.fromkeys((D[3], D[5], D[7]), sp.Integer(0))
    values |= {D[2 * i + 3]: sp.Rational(value) for i, value in enumerate(law)}
    integrand = sp.lambdify(u_t, formulas["contact_integrand"].expression.subs(values), "mpmath")
    return mp.quad(integrand, [0, 0.5, 1])


@pytest.mark.parametrize("law", [(), (0.7,), (-0.2, 0.01), (40.0, -3.0, 0.5), (1e10,)])
def test_contact_time_integral_agrees_with_the_motion(
    formulas: Mapping[str, Formula], law: tuple[float, ...]
) -> None:
    """The contact-time integral equals int d delta/velocity by mpmath, for given D_3, D_5, D_7."""
    pairs = [(2, mp.mpf(1)), *((2 * i + 3, mp.mpf(value)) for i, value in enumerate(law))]

    def rate(q: mp.mpf) -> mp.mpf:
        work = mp.fsum(n * d / (n + 3) * (1 - q ** (n + 3)) for n, d in pairs)
        return mp.fsum(n * d * q ** (n - 1) for n, d in pairs) / mp.sqrt(work)

    with mp.workdps(40):
        # The square root at q = 1 halves the digits: the omitted part is about 2 rate sqrt(1e-30).
        expected = mp.quad(rate, [0, 0.5, 0.9, 0.999, 1 - mp.mpf("1e-30")])
        assert abs(contact_integral(formulas, law) / expected - 1) < mp.mpf("1e-12")


def test_hertz_contact_time_agrees_with_the_known_constant(formulas: Mapping[str, Formula]) -> None:
    value = mp.mpf(str(formulas["hertz_time"].expression.evalf(25)))
    assert abs(value / 2 - mp.mpf(HERTZ)) < mp.mpf("2e-16") * 4
    assert abs(value - mp.mpf("2.94327518")) < 1e-8
    direct = mp.quad(lambda u: 2 * u / mp.sqrt(-mp.expm1(2.5 * mp.log1p(-(u**2)))), [0, 0.5, 1])
    assert abs(value / 2 - direct) < 1e-12
    # The general integral I agrees too: half the contact time is sqrt(2/5) I delta_max/v0.
    general = contact_integral(formulas, ())
    assert abs(general * mp.sqrt(mp.mpf(2) / 5) - value / 2) < 1e-14


def test_radicand_is_negative_before_the_turning_point(
    formulas: Mapping[str, Formula],
) -> None:
    numbers = {m: 2, v0: 3, xi_k[2]: 5, xi_k[3]: sp.Rational(7, 10)}
    at_turn = float(formulas["radicand_at_turn"].expression.subs(numbers))
    turning = 3 * (2 / 5) ** 0.5
    radicand = 9 - 5 / 2 * turning**2 - 3 * 0.7 / (4 * 2) * turning ** (8 / 3)
    assert at_turn == pytest.approx(radicand, rel=1e-12)
    assert at_turn < 0


@pytest.mark.parametrize("name", ["", "hertz"])
def test_linearised_equation_is_accurate_to_second_order(
    formulas: Mapping[str, Formula], name: str
) -> None:
    """eta' + F eta + G = 0 is accurate to second order in eta for two exact velocities."""
    F, G = (formulas[f"{x}_{name or 1}"].expression for x in ("F", "G"))
    values = {"m": 2, "v0": 3, "xi_2": 5, "xi_3": 0.7, "lam": 1.1, "mu": 0.4, "R": 0.8, "h": 2}
    values |= {"c_1": 0.3}
    at = 0.4

    def number(expression: sp.Expr, place: float) -> float:
        by = {s: values.get(str(s), place) for s in expression.free_symbols}
        return float(expression.subs(by))

    def force(place: mp.mpf) -> mp.mpf:
        if not name:
            return 5 * place + mp.mpf("0.7") * place ** (mp.mpf(5) / 3)
        modulus = 4 * 0.4 * 1.5 / (1.1 + 0.8)
        eps = mp.sqrt(0.8 * place) / 2
        return 4 * modulus / 3 * mp.sqrt(0.8) * place**1.5 * (1 - 1.5 * 0.3 * eps)

    def first(place: mp.mpf) -> mp.mpf:
        if not name:
            return 5 * place
        return 4 * (4 * 0.4 * 1.5 / 1.9) / 3 * mp.sqrt(0.8) * place**1.5

    def speed(law, place: float) -> mp.mpf:
        return mp.sqrt(9 - mp.quad(law, [0, place]))

    errors = []
    for eta in (0.01, 0.005):
        exact = speed(force, at + eta) - speed(first, at)
        errors.append(abs(exact + number(F, at) * eta + number(G, at)))
    assert 3.5 < errors[0] / errors[1] < 4.5
    assert errors[0] < 1e-3


@pytest.mark.parametrize("record", PRINTED_MOTION, ids=lambda record: record.name)
def test_latex_and_expression_agree(record: Printed) -> None:
    names = {symbol.name: symbol for symbol, _ in record.where} | {"v_0": v0, "K_j": K_j}
    text = record.latex.replace("(t)", "")
    assert decide_zero(parse_latex(text, PLATE, names) - record.expression) is not None


def test_order_is_that_of_the_paper() -> None:
    equations = [int(record.equation) for record in PRINTED_MOTION]
    assert equations == sorted(equations)
    compared = set(map(str, equations))
    # The other equations are assumptions or definitions; (16) is proved with (17).
    assert compared | {"9", "12", "14", "16"} == {str(n) for n in range(9, 19)}


EXPECTED = {
    "force_power": "wrong exponent",
    "xi_2": "equal",
    "xi_3": "wrong exponent",
    "gamma_2": "divergent",
    "gamma_3": "divergent",
    "acceleration": "equal",
    "speed": "equal",
    "delta_0": "equal",
    "F_1": "equal",
    "G_1": "equal",
}


def test_misprints_of_the_motion_are_found(findings: dict[str, Finding]) -> None:
    assert {name: finding.diagnosis.kind for name, finding in findings.items()} == EXPECTED
    for finding in findings.values():
        assert finding.is_misprint == (finding.diagnosis.kind != "equal")
        report = finding.to_json()
        assert json.loads(json.dumps(report)) == report


def test_findings_state_the_correction_of_each_equation(findings: dict[str, Finding]) -> None:
    assert "gamma_2**(-8/3) instead of gamma_2**(-3)" in findings["xi_3"].repair
    assert findings["xi_3"].diagnosis.ratio == gamma_k[2] ** sp.Rational(-1, 3)
    assert "m^1/3" in str(findings["xi_3"].diagnosis.dimension)
    assert "the first power is 3/2, not 1" in findings["force_power"].repair
    assert "each is 1/2 above the one before, not 2/3" in findings["force_power"].repair
    assert "diverges because the terms do not tend to zero" in findings["gamma_2"].repair
    assert "diverges because the terms grow like j^2" in findings["gamma_3"].repair


def test_convergent_series_is_compared_like_any_formula(formulas: Mapping[str, Formula]) -> None:
    expression = formulas["delta"].expression
    assert diagnose_series("delta", expression, formulas).kind == "equal"
    assert diagnose_series("delta", -expression, formulas).kind == "sign"


def test_correct_power_is_equal(formulas: Mapping[str, Formula]) -> None:
    everything = dict(formulas)
    assert diagnose_power("force_power", (k + 1) / 2, everything).kind == "equal"
    assert "not 1/3" in diagnose_power("force_power", k / 3 + 1, everything).repair
