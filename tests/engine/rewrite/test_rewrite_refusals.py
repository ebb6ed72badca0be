"""Where rules and tables end: what they cannot hold to their bounds is refused, and why."""

import json
import math
from fractions import Fraction
from importlib import import_module
from typing import Any

import flint
import pytest
import sympy as sp
from flint import arb

from derivation.engine.rewrite import account, rules, sections
from derivation.engine.rewrite.automatic import automatic
from derivation.engine.rewrite.doubles import rounded
from derivation.engine.rewrite.series import leading_power, taylor_section
from derivation.engine.rewrite.shape import Shape
from derivation.engine.rewrite.stabilise import stabilise
from derivation.engine.rewrite.terms import UnreachableError, terms_of
from derivation.mathematics.bessel import kernels as bessel_tables
from derivation.plate.contact.kernels import moments as moment_tables
from derivation.plate.contact.kernels import tables as contact_tables
from derivation.plate.derived import formulas
from derivation.plate.edge.kernels import tables as edge_tables
from derivation.plate.edge.theory.sums import slope_kernel
from derivation.plate.edge_modes.kernels.numbers import series_terms as edge_mode_terms
from derivation.plate.effects.kernels import numbers as effect_tables
from derivation.plate.forms import SCALES
from derivation.plate.impact.kernels import simple as simple_impact_tables
from derivation.plate.paper import PAPER
from derivation.plate.waves.kernels.numbers import terms as wave_terms

x = sp.Symbol("x", positive=True)


def test_an_account_is_the_one_committed() -> None:
    """Measured anew, with and without being told of progress, for the quickest formula."""
    chosen = formulas(), ("Omega_3",), SCALES
    told: list[tuple[str, int, int]] = []
    (found,) = account.accounts(*chosen, lambda *step: told.append(step))
    assert told == [("Omega_3", 1, 1)]
    assert account.accounts(*chosen) == (found,)
    (row,) = (r for r in json.loads(PAPER.rewritten.read_text())["rows"] if r["name"] == "Omega_3")
    assert (found.variable, found.worst) == (row["variable"], row["worst"])
    assert [a.rule for a in found.applied] == [a["rule"] for a in row["applied"]]


@pytest.mark.parametrize("rule", [rules.conjugate, rules.logarithm, rules.fraction, rules.decay])
def test_what_is_taken_apart_is_left_to_later_rules(rule: Any) -> None:
    (shape,) = rules.decay(x, (sp.sqrt(1 + x) - 1) * sp.log(1 + x) * sp.sinh(x))
    assert isinstance(shape, Shape)
    assert not list(rule(x, shape))


def test_no_dimensionless_number_no_form() -> None:
    length, force = sp.symbols("length force", positive=True)
    with pytest.raises(UnreachableError, match=r"no dimensionless variable for force\*length"):
        automatic(sp.sinh(length * force), {}, SCALES)


def test_nothing_has_no_lowest_power() -> None:
    assert leading_power(terms_of(x - sp.sin(x), x)) == 3
    with pytest.raises(UnreachableError, match="vanishes at 0 with all its derivatives"):
        leading_power({})


def test_series_have_rational_coefficients() -> None:
    k = sp.Symbol("k", positive=True)
    terms = terms_of(k * x - sp.sin(x), x)
    with pytest.raises(UnreachableError, match="with further variables is not rational"):
        taylor_section(terms, sp.Rational(1, 2))


def test_what_cannot_be_judged_is_refused() -> None:
    """Seven further variables; and the logarithm of a number below 0 at every point."""
    many = sum(sp.symbols("p q r s t u v", positive=True), sp.Integer(0))
    with pytest.raises(UnreachableError, match=r"at most 6 further variables, got \[p, q"):
        stabilise(many * (x - sp.sin(x)), x)
    with pytest.raises(UnreachableError, match="at 0 of the tested points"):
        stabilise(sp.log(-1 - x) * x, x)


def test_a_form_that_no_rule_helps_is_refused() -> None:
    """1 + cos x cancels at pi: nothing stops a rule, but all of them mend what is at 0."""
    with pytest.raises(UnreachableError, match="no rule applies to the rest"):
        stabilise(1 + sp.cos(x), x, (3.0, 3.3))


def test_doubles_of_constants_and_of_the_ends() -> None:
    assert rounded(sp.pi * x, {x: 3.0}) == math.pi * 3.0
    assert rounded(sp.exp(x), {x: math.inf}) == math.inf
    assert rounded(sp.exp(x), {x: -math.inf}) == 0.0
    assert math.isnan(rounded(sp.exp(x), {x: math.nan}))
    with pytest.raises(NotImplementedError, match="no double precision for besselj"):
        rounded(sp.besselj(0, x), {x: 1.0})


# --- tables


def test_zeros_are_certified_before_they_are_tabulated(monkeypatch: pytest.MonkeyPatch) -> None:
    with flint.ctx.workprec(100):
        assert abs(bessel_tables.bessel_zero(0, 1) - arb("2.4048255576957727686216")) < 1e-22
        monkeypatch.setattr(bessel_tables, "_NEWTON_STEPS", 1)
        with pytest.raises(ArithmeticError, match=r"no zero number 1 of J0 near \[?2\.40"):
            bessel_tables.bessel_zero(0, 1)


def test_a_condition_that_never_holds_has_no_first() -> None:
    assert bessel_tables.first_true(lambda n: n * n > 50) == 8
    with pytest.raises(ArithmeticError, match="the condition is not met below 64"):
        bessel_tables.first_true(lambda _: False, 64)


def test_the_thin_plates_function_begins_as_its_slope() -> None:
    """Phi/A at 0 is 0, g(0) is 1; both are where their neighbours tend to."""
    with flint.ctx.workprec(moment_tables.BITS):
        assert contact_tables.shape(arb(0)) == 1
        assert abs(contact_tables.shape(arb(2) ** -20) - 1 + arb(2) ** -40 / 10) < 1e-24
        assert contact_tables.thin_part(arb(0)) == 0
        halves = [contact_tables.thin_part(arb(2) ** -k) for k in (10, 11)]
        assert abs(halves[0] / halves[1] - 16) < 1e-4  # as A^4


def test_tables_whose_last_coefficients_count_are_refused(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A kink in the place of a sum, whose Chebyshev coefficients fall like 1/n^2."""
    monkeypatch.setattr(edge_tables, "alternating_sum", lambda _, at: abs(at - arb(0.25)))
    with flint.ctx.workprec(moment_tables.BITS):
        first = arb("2.404825557695772768621632")
        with pytest.raises(ArithmeticError, match="truncation error of SQUARE"):
            edge_tables._tables(slope_kernel, first, [arb(0), arb(0)])


def test_series_that_end_too_early_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(effect_tables, "kappas", lambda: [arb(1), arb(0), arb(1)])
    with pytest.raises(ArithmeticError, match="needs more moments kappa_n"):
        effect_tables.wall_rows()
    with pytest.raises(ValueError, match="F needs more than 40 terms up to S = 100"):
        wave_terms(sp.Integer(100))
    with pytest.raises(ValueError, match=r"needs more than 30 terms up to 9/4"):
        sections._coefficients(1 / (1 - sections.y**2), 0)
    cosh, _ = sections._coefficients(sp.cosh(sections.y), 0)
    assert [1 / c for c in cosh] == [math.factorial(2 * k) for k in range(len(cosh))]


def test_asymptotic_series_have_three_terms_at_least(monkeypatch: pytest.MonkeyPatch) -> None:
    """Their bounds hold from there on, however much may be left out."""
    start = Fraction(40)
    with flint.ctx.workprec(moment_tables.BITS):
        exact = edge_mode_terms(start)
        monkeypatch.setattr(import_module(edge_mode_terms.__module__), "TOLERANCE", 1)
        assert edge_mode_terms(start) == 3 < exact


def test_blurred_numbers_are_not_tabulated() -> None:
    assert moment_tables.sharp(arb(1)) == 1
    with pytest.raises(ArithmeticError, match="is not sharp enough for a table"):
        moment_tables.sharp(arb(1, 1e-10))


def test_modes_of_simple_impacts_reach_their_tails_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(simple_impact_tables, "zero_of_j0", lambda *_: arb(2.4))
    with pytest.raises(ArithmeticError, match="too few modes for the tail's bound"):
        simple_impact_tables.numbers()
