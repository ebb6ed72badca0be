"""Formulas without a stable form, and tables with too large an error, are rejected."""

import json
import math
from fractions import Fraction
from importlib import import_module
from typing import Any

import flint
import platecontact as pc
import pytest
import sympy as sp
from flint import arb

from derivation.engine.rewrite import account, rules, truncated_series
from derivation.engine.rewrite.automatic import automatic
from derivation.engine.rewrite.doubles import rounded_value
from derivation.engine.rewrite.series import leading_power, truncated_taylor
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


def test_record_of_the_rules_is_up_to_date() -> None:
    """Measure the fastest formula again, with and without reports of progress."""
    chosen = formulas(), ("Omega_3",), SCALES
    reported: list[tuple[str, int, int]] = []
    (actual,) = account.accounts(*chosen, lambda *step: reported.append(step))
    assert reported == [("Omega_3", 1, 1)]
    assert account.accounts(*chosen) == (actual,)
    (row,) = (r for r in json.loads(PAPER.rewritten.read_text())["rows"] if r["name"] == "Omega_3")
    assert (actual.variable, actual.worst) == (row["variable"], row["worst"])
    assert [a.rule for a in actual.applied] == [a["rule"] for a in row["applied"]]


@pytest.mark.parametrize("rule", [rules.conjugate, rules.logarithm, rules.fraction, rules.decay])
def test_rules_for_expressions_ignore_forms_that_are_decomposed(rule: Any) -> None:
    (shape,) = rules.decay(x, (sp.sqrt(1 + x) - 1) * sp.log(1 + x) * sp.sinh(x))
    assert isinstance(shape, Shape)
    assert not list(rule(x, shape))


def test_formula_without_a_dimensionless_variable_is_rejected() -> None:
    length, force = sp.symbols("length force", positive=True)
    with pytest.raises(UnreachableError, match=r"no dimensionless variable for force\*length"):
        automatic(sp.sinh(length * force), {}, SCALES)


def test_leading_power_of_zero_is_rejected() -> None:
    assert leading_power(terms_of(x - sp.sin(x), x)) == 3
    with pytest.raises(UnreachableError, match="vanishes at 0 with all its derivatives"):
        leading_power({})


def test_series_with_irrational_coefficients_is_rejected() -> None:
    k = sp.Symbol("k", positive=True)
    terms = terms_of(k * x - sp.sin(x), x)
    with pytest.raises(UnreachableError, match="with further variables is not rational"):
        truncated_taylor(terms, sp.Rational(1, 2))


def test_formula_that_cannot_be_tested_is_rejected() -> None:
    """There are too many further variables, or no point at which the value is real."""
    many = sum(sp.symbols("p q r s t u v", positive=True), sp.Integer(0))
    with pytest.raises(UnreachableError, match=r"at most 6 further variables, got \[p, q"):
        stabilise(many * (x - sp.sin(x)), x)
    with pytest.raises(UnreachableError, match="at 0 of the tested points"):
        stabilise(sp.log(-1 - x) * x, x)


def test_formula_that_no_rule_makes_accurate_is_rejected() -> None:
    """1 - sin x cancels at pi/2, but the rules only remove cancellation at 0."""
    with pytest.raises(UnreachableError, match="no rule applies to the rest"):
        stabilise(1 - sp.sin(x), x, (1.5, 1.65))


def test_rounded_evaluation_of_constants_and_at_infinity() -> None:
    assert rounded_value(sp.pi * x, {x: 3.0}) == math.pi * 3.0
    assert rounded_value(sp.exp(x), {x: math.inf}) == math.inf
    assert rounded_value(sp.exp(x), {x: -math.inf}) == 0.0
    assert math.isnan(rounded_value(sp.exp(x), {x: math.nan}))
    with pytest.raises(NotImplementedError, match="no double precision for besselj"):
        rounded_value(sp.besselj(0, x), {x: 1.0})


# --- tables


def test_tabulated_zeros_are_certified(monkeypatch: pytest.MonkeyPatch) -> None:
    with flint.ctx.workprec(100):
        assert abs(bessel_tables.bessel_zero(0, 1) - arb("2.4048255576957727686216")) < 1e-22
        monkeypatch.setattr(bessel_tables, "_NEWTON_STEPS", 1)
        with pytest.raises(ArithmeticError, match=r"no zero number 1 of J0 near \[?2\.40"):
            bessel_tables.bessel_zero(0, 1)


def test_search_for_the_first_index_ends_at_a_limit() -> None:
    assert bessel_tables.first_true(lambda n: n * n > 50) == 8
    with pytest.raises(ArithmeticError, match="the condition is not met below 64"):
        bessel_tables.first_true(lambda _: False, 64)


def test_functions_of_the_thin_plate_are_continuous_at_zero() -> None:
    """g tends to 1 as 1 - A^2/10, and the thin part tends to 0 as A^4."""
    with flint.ctx.workprec(moment_tables.BITS):
        assert contact_tables.shape(arb(0)) == 1
        assert abs(contact_tables.shape(arb(2) ** -20) - 1 + arb(2) ** -40 / 10) < 1e-24
        assert contact_tables.thin_part(arb(0)) == 0
        halves = [contact_tables.thin_part(arb(2) ** -k) for k in (10, 11)]
        assert abs(halves[0] / halves[1] - 16) < 1e-4  # it is proportional to A^4


def test_table_with_a_large_truncation_error_is_rejected(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Replace the sum by |x - 1/4|, whose Chebyshev coefficients decay only as 1/n^2."""
    monkeypatch.setattr(edge_tables, "alternating_sum", lambda _, at: abs(at - arb(0.25)))
    with flint.ctx.workprec(moment_tables.BITS):
        first = arb("2.404825557695772768621632")
        with pytest.raises(ArithmeticError, match="truncation error of SQUARE"):
            edge_tables._tables(slope_kernel, first, [arb(0), arb(0)])


def test_series_that_end_too_early_are_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(effect_tables, "kappas", lambda: [arb(1), arb(0), arb(1)])
    with pytest.raises(ArithmeticError, match="needs more moments kappa_n"):
        effect_tables.lateral_rows()
    with pytest.raises(ValueError, match="F needs more than 40 terms up to S = 100"):
        wave_terms(sp.Integer(100))
    with pytest.raises(ValueError, match=r"needs more than 30 terms up to 9/4"):
        truncated_series._coefficients(1 / (1 - truncated_series.y**2), 0)
    cosh, _ = truncated_series._coefficients(sp.cosh(truncated_series.y), 0)
    assert [1 / c for c in cosh] == [math.factorial(2 * k) for k in range(len(cosh))]


def test_asymptotic_series_has_at_least_three_terms(monkeypatch: pytest.MonkeyPatch) -> None:
    """Their error bound is valid only from three terms on, whatever the tolerance."""
    start = Fraction(40)
    with flint.ctx.workprec(moment_tables.BITS):
        exact = edge_mode_terms(start)
        monkeypatch.setattr(import_module(edge_mode_terms.__module__), "TOLERANCE", 1)
        assert edge_mode_terms(start) == 3 < exact


def test_values_with_a_wide_interval_are_not_tabulated() -> None:
    assert moment_tables.midpoint(arb(1)) == 1
    with pytest.raises(ArithmeticError, match="is too large for a table"):
        moment_tables.midpoint(arb(1, 1e-10))


def test_tail_bound_of_simple_impacts_needs_enough_modes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(simple_impact_tables, "zero_of_j0", lambda *_: arb(2.4))
    with pytest.raises(ArithmeticError, match="too few modes for the tail's bound"):
        simple_impact_tables.numbers()


@pytest.mark.parametrize(
    "formula",
    ["log(x + sqrt(x**2 + x + 1))", "atan(x) - pi/4 - (x - 1)/2", "exp(x) - sqrt(1 + 2*x)"],
)
def test_a_range_includes_the_points_of_cancellation(formula: str) -> None:
    """These formulas are accurate in a part of the range without any rule, which is of no use."""
    with pytest.raises(ValueError, match="the rules give a form"):
        pc.rewrite(formula)


@pytest.mark.parametrize("formula", ["log(-x)", "x - x", "sin(x)**2 + cos(x)**2 - 1"])
def test_a_formula_without_values_is_rejected(formula: str) -> None:
    with pytest.raises(ValueError, match=r"has values other than 0, .* of the tested points x > 0"):
        pc.rewrite(formula)
