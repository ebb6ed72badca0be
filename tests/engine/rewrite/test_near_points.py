"""Forms of formulas in which terms cancel at a point other than 0, against mpmath."""

import math
import random

import mpmath
import numpy as np
import platecontact as pc
import pytest
import sympy as sp

from derivation.engine.rewrite import code_check
from derivation.engine.rewrite.doubles import run
from derivation.engine.rewrite.form import Switch
from derivation.engine.rewrite.near_points import about_point, cancelling_points
from derivation.engine.rewrite.series import POLYNOMIAL, truncated_taylor
from derivation.engine.rewrite.terms import UnreachableError, terms_of

x = sp.Symbol("x", positive=True)
e = sp.Symbol("e", real=True)
FORMULAS = (
    (x * sp.log(x) - x + 1, x, 1),
    (sp.log(4 * x) - 4 * x + 1, x, sp.Rational(1, 4)),
    (x * (sp.exp(x - 1) - x), x, 1),
    (x - 1 - sp.log(x**2) / 2, x, 1),
    (sp.log(x) ** 2 - (x - 1) ** 2, x, 1),
    ((x**2 - 1) / 2 - sp.log(x), x, 1),
    (sp.log(2 * x - 1) - 2 * (x - 1), x, 1),
    (sp.log(1 + e) - e, e, 0),
    (1 - sp.cos(e) - e**2 / 2, e, 0),
    (e * sp.cosh(e) - sp.sinh(e), e, 0),
)


@pytest.mark.parametrize(("formula", "variable", "point"), FORMULAS)
def test_series_about_a_point_hold_on_both_sides(
    formula: sp.Expr, variable: sp.Symbol, point: sp.Rational
) -> None:
    stable = about_point(formula, variable, sp.sympify(point))
    exact = sp.lambdify(variable, formula, "mpmath")
    compared = {True: 0, False: 0}
    for change in (1e-12, 1e-3, 0.1, 0.3, 0.5, 0.62, 0.9, 1.5, 1.9, 2.1):
        for sign in (-1, 1):
            at = float(point) + sign * change
            known = {variable: at}
            for step in stable.steps:
                known[step.symbol] = run((), step.expression, known)
            assert isinstance(stable.value, Switch)
            if known[stable.value.variable] < float(stable.value.at):
                with mpmath.workdps(120):
                    value = exact(mpmath.mpf(at))
                    got = run(stable.steps, stable.value, {variable: at})
                    assert abs(got - value) <= 8 * math.ulp(float(value)), at
                compared[sign > 0] += 1
    assert min(compared.values()) >= 3


def test_a_truncation_error_is_bounded_for_negative_arguments() -> None:
    """The sum of this exponential series is smallest at a negative argument."""
    terms, end = terms_of(sp.exp(x) - 1 - x, x), sp.Integer(1)
    one, both = (truncated_taylor(terms, end, both_signs=both) for both in (False, True))
    assert both.bound > one.bound
    with mpmath.workdps(60):
        value = mpmath.expm1(-1) + 1
        section = both.polynomial(x).replace(
            POLYNOMIAL, lambda u, *row: sp.Add(*(c * u**n for n, c in enumerate(row)))
        )
        got = mpmath.mpf(section.subs(x, -1).p) / section.subs(x, -1).q
        assert abs(got - value) <= mpmath.mpf(both.bound.p) / both.bound.q * abs(value)


@pytest.mark.parametrize(
    ("formula", "points"),
    [
        (sp.log(x) * sp.log(4 * x), [1, sp.Rational(1, 4)]),
        (sp.log(x**2 - 3), [2]),
        (sp.exp(x - 1) + sp.sin(2 * x - 3), [1, sp.Rational(3, 2)]),
        (sp.log(1 + x) + sp.log(sp.cosh(x)), []),
    ],
)
def test_points_at_which_a_logarithm_or_an_argument_is_zero(
    formula: sp.Expr, points: list[sp.Rational]
) -> None:
    assert set(cancelling_points(formula, x)) == set(points)


def test_a_sum_without_a_series_of_this_kind_is_rejected() -> None:
    with pytest.raises(UnreachableError, match="the series of log1p"):
        about_point(sp.exp(x - 1) - 1 - sp.log(x), x, sp.Integer(1))


def test_without_cancellation_there_is_no_form() -> None:
    with pytest.raises(UnreachableError, match=r"no terms of .* cancel at x = 1"):
        about_point(sp.log(x) + x, x, sp.Integer(1))


def test_a_point_without_a_value_does_not_end_the_range() -> None:
    stable = pc.rewrite("(x - 1)/log(x)")
    assert (stable.tested.low, stable.tested.high) == (1e-150, 1e150)
    assert stable.tested.undefined == (1.0,)
    assert "NaN at x = 1.0, where the formula has no value." in " ".join(stable.source.split())
    names: dict[str, np.ufunc] = {}
    exec(stable.source, names)
    assert np.isnan(names["f"](1.0))
    assert names["f"](1 + 2**-52) == pytest.approx(1.0, rel=1e-15)


def test_a_pole_ends_the_range() -> None:
    tested = pc.rewrite("1/(x - 1)").tested
    assert tested.low > 1.0 or tested.high < 1.0
    assert tested.undefined == ()


def test_many_points_are_tested_near_the_ends_of_a_range() -> None:
    """Errors of log(x)^2 - (x - 1)^2 rise towards a triple zero at 1, at which the range ends."""
    near = code_check._towards(random.Random(1), 1.0, 50.0)
    assert sum(40 < point < 49 for point in near) > 50
    assert sum(1.02 < point < 1.25 for point in near) > 50
