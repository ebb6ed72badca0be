"""Test the published equations and the findings of their comparison with the derived ones."""

import json
from collections.abc import Mapping

import pytest
from sympy import Rational

from derivation.engine.errata.findings import Finding, Printed
from derivation.engine.formula.notation import to_latex
from derivation.engine.formula.parse_latex import parse_latex
from derivation.engine.formula.proof import decide_zero
from derivation.plate.misprints import misprints
from derivation.plate.modes.balance import balances, signs_that_balance
from derivation.plate.printed.contact import PRINTED
from derivation.plate.vocabulary import J1, PLATE, Formula, P, R, a, b, gamma_k, h, lam, mu, phi

IDS = [f"({record.equation}) {record.name}" for record in PRINTED]


@pytest.fixture(scope="module")
def findings(formulas: Mapping[str, Formula]) -> dict[tuple[str, str], Finding]:
    actual = misprints(formulas)
    return {(finding.printed.equation, finding.printed.name): finding for finding in actual}


@pytest.mark.parametrize("record", PRINTED, ids=IDS)
def test_published_expressions_are_parsed_from_their_latex(record: Printed) -> None:
    names = {symbol.name: symbol for symbol, _ in record.where}
    read = parse_latex(to_latex(record.expression, PLATE), PLATE, names)
    assert decide_zero(read - record.expression) is not None


def test_order_is_that_of_the_paper() -> None:
    equations = [int(record.equation) for record in PRINTED]
    assert equations == sorted(equations)


EXPECTED = {
    ("1", "u"): ("sign", -1),
    ("1", "w"): ("equal", 1),
    ("2", "f_j"): ("equal", 1),
    ("2", "g_j"): ("equal", 1),
    ("4", "A_j"): ("equal", 1),
    ("5", "Omega_1"): ("equal", 1),
    ("5", "Omega_2"): ("equal", 1),
    ("5", "Omega_3"): ("extra factor", 1 / phi),
    ("5", "Omega_4"): ("extra factor", 1 / phi),
    ("6", "delta"): (
        "factor counted twice",
        -16 * mu * (lam + mu) / (J1**2 * R * b**2 * phi**3 * (lam + 2 * mu)),
    ),
    ("6", "K_j"): ("equal", 1),
    ("6", "K_j_bottom"): ("other face", None),
    ("7", "p"): ("equal", 1),
    ("7", "P"): ("equal", 1),
    ("8", "A_j"): ("two misprints", None),
    ("10", "force_power"): ("wrong exponent", None),
    ("10", "xi_2"): ("equal", 1),
    ("10", "xi_3"): ("wrong exponent", gamma_k[2] ** Rational(-1, 3)),
    ("10", "gamma_2"): ("divergent", None),
    ("10", "gamma_3"): ("divergent", None),
    ("11", "acceleration"): ("equal", 1),
    ("13", "speed"): ("equal", 1),
    ("15", "delta_0"): ("equal", 1),
    ("17", "F_1"): ("equal", 1),
    ("18", "G_1"): ("equal", 1),
}


def test_every_published_formula_is_compared(findings: dict[tuple[str, str], Finding]) -> None:
    assert list(findings) == list(EXPECTED)


@pytest.mark.parametrize("key", EXPECTED, ids=lambda key: f"({key[0]}) {key[1]}")
def test_misprints_are_found(
    key: tuple[str, str], findings: dict[tuple[str, str], Finding]
) -> None:
    kind, ratio = EXPECTED[key]
    finding = findings[key]
    assert finding.diagnosis.kind == kind
    assert finding.is_misprint == (kind != "equal")
    if ratio is not None:
        assert (finding.diagnosis.ratio / ratio).is_number
    repaired = finding.diagnosis.repaired
    assert repaired is not None
    by_radius = repaired.subs(P, findings["7", "P"].formula.expression)
    assert (
        repaired == finding.formula.expression
        or decide_zero(by_radius - finding.formula.expression) is not None
    )


def test_findings_state_the_correction_of_each_misprint(
    findings: dict[tuple[str, str], Finding],
) -> None:
    assert "u in (1) or that of g_j in (2)" in findings["1", "u"].repair
    assert findings["5", "Omega_3"].diagnosis.dimension == (
        "[1/Pa] expected, [m/Pa] found: a factor of [m] too much"
    )
    assert "z = +h" in findings["6", "K_j_bottom"].repair
    assert "K_j already contains" in findings["6", "delta"].repair
    eight = findings["8", "A_j"]
    assert "sign" in eight.repair
    assert "parentheses" in eight.repair
    assert "are added" in str(eight.diagnosis.dimension)
    assert eight.diagnosis.edits == 2


def test_signs_of_the_published_displacements() -> None:
    assert not balances({})
    assert signs_that_balance(["u", "g_j"]) == ("u", "g_j")
    assert not balances({"u": -1, "g_j": -1})


def test_findings_are_plain_text(findings: dict[tuple[str, str], Finding]) -> None:
    for finding in findings.values():
        report = finding.to_json()
        assert json.loads(json.dumps(report)) == report
        assert {"equation", "name", "printed", "derived", "verdict", "kind", "repair"} <= set(
            report
        )
        assert finding._repr_latex_().startswith("$")


def test_contact_radius_is_compared_as_published() -> None:
    (record,) = (record for record in PRINTED if record.name == "P")
    assert record.expression != record.compared
    assert record.compared.has(a)
    assert not record.compared.has(h)
