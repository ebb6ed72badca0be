"""Formulas of powers of the variable, and functions of stable forms, against mpmath."""

import math
import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import platecontact as pc
import pytest
import sympy as sp
from exact_errors import check_errors
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from derivation.engine.emit.standalone import standalone
from derivation.engine.formula.parse import parse
from derivation.engine.formula.vocabulary import NOTHING
from derivation.engine.rewrite.compositions import compositions
from derivation.engine.rewrite.powers import powers
from derivation.engine.rewrite.search import stabilised
from derivation.engine.rewrite.substitutions import substitutions

x = sp.Symbol("x", positive=True)


@settings(deadline=None, max_examples=40)
@given(
    st.fractions(-3, 3, max_denominator=6).filter(lambda power: power.denominator > 1),
    st.fractions(-4, 4, max_denominator=3).filter(bool),
    st.integers(-2, 2),
)
def test_a_substitution_does_not_change_the_formula(
    power: Fraction, slope: Fraction, factor: int
) -> None:
    b = sp.Rational(slope)
    for formula in (
        (1 + b * x) ** sp.Rational(power) - 1 - sp.Rational(power) * b * x,
        x**factor * sp.log(1 + b * x) + x**2,
    ):
        (actual,) = substitutions(formula, x)
        known: dict[sp.Symbol, sp.Expr] = {}
        for step in actual.steps:
            known[step.symbol] = step.expression.xreplace(known)
        at = {x: sp.Rational(1, 7) / abs(b)}
        u = known[actual.variable]
        assert actual.inverse.xreplace({actual.variable: u.xreplace(at)}).evalf(
            30
        ) == pytest.approx(at[x], rel=1e-25)
        equal = (actual.front * actual.expression.xreplace({actual.variable: u})).xreplace(at)
        assert equal.evalf(30) == pytest.approx(formula.xreplace(at).evalf(30), rel=1e-20)


@pytest.mark.parametrize(
    "formula",
    [
        sp.asin(x / 2) - x * sp.sqrt(4 - x**2) / 4,
        (2 * x**2 - 1) * sp.asin(x) / sp.sqrt(1 - x**2) ** 3,
        x * sp.asinh(3 * x) - sp.sqrt(1 + 9 * x**2),
    ],
)
def test_a_formula_equals_that_in_the_value_of_an_inverse_function(formula: sp.Expr) -> None:
    rows = list(substitutions(formula, x))
    if formula.has(sp.sqrt(4 - x**2)):
        assert not rows  # only a root of 1 - b^2 x^2 is a cosine
        return
    (row,) = rows
    assert not row.expression.has(x, sp.asin, sp.asinh)
    at = {x: sp.Rational(1, 7)}
    u = row.steps[0].expression.xreplace(at)
    assert row.inverse.xreplace({row.variable: u}).evalf(30) == pytest.approx(at[x], rel=1e-25)
    equal = row.expression.xreplace({row.variable: u}).evalf(30)
    assert equal == pytest.approx(formula.xreplace(at).evalf(30), rel=1e-25)


@settings(max_examples=30, deadline=None)
@given(
    st.sampled_from(["{u} - sin({u})", "exp(-{u}) - 1", "{u}*cos({u})", "log(1 + {u})/{u}"]),
    st.sampled_from(["x**2", "x**3", "1/x", "sqrt(x)", "x**(3/2)", "x**(-1/3)", "pi*x", "2/x**2"]),
    st.integers(-3, 3),
    st.floats(0.2, 5.0),
)
def test_a_formula_equals_its_compositions(core: str, inner: str, power: int, at: float) -> None:
    """Substitute every decomposition again, at 40 digits."""
    expression = parse(f"x**({power}/2)*({core.format(u=inner)})", NOTHING, {"x": x})
    assert not any(row.expression.has(x) for row in powers(expression, x))
    exact = expression.evalf(40, subs={x: at})
    for row in compositions(expression, x):
        whole = row.outer(row.expression).xreplace({row.variable: row.argument})
        assert abs(whole.evalf(40, subs={x: at}) - exact) <= abs(exact) * sp.Float("1e-30")


@pytest.mark.parametrize(
    ("formula", "inner"),
    [
        ("(x**3 + x*sin(x**2))/x", "x**2"),
        ("x**(5/2)*cosh(x**(1/2))", "sqrt(x)"),
        ("coth(1/x) - x", "1/x"),
        ("(exp(-x**2) - 1)/x**7", "x**2"),
    ],
)
def test_the_power_is_the_largest_common_one(formula: str, inner: str) -> None:
    first = next(powers(parse(formula, NOTHING, {"x": x}), x))
    assert str(first.argument) == inner


def test_an_ill_conditioned_square_ends_the_range() -> None:
    """The rounding of x^2 has an effect on sin(x^2) next to its first zero at sqrt(pi)."""
    _, tested = standalone(stabilised(parse("sin(x**2)/x**2", NOTHING, {"x": x}), x))
    assert tested.low == 1e-150
    assert tested.high > 1.5
    assert mpmath.isfinite(tested.limit)


def test_rounding_of_a_power_is_included_between_the_tested_points() -> None:
    """Points close to the end of the range have errors of u = sqrt(x) up to half a unit."""
    stable = pc.rewrite("1 - cos(sqrt(x))")
    names: dict[str, Any] = {}
    exec(stable.source, names)
    draw = random.Random(1)
    points = [stable.tested.high * draw.uniform(0.5, 1.0) for _ in range(3000)]
    for point, got in zip(points, names["f"](np.array(points)).tolist(), strict=True):
        with mp.workdps(40):
            root = mp.sqrt(mpf(point))
            exact = 1 - mp.cos(root)
            error = float(abs(mpf(got) - exact) / mpf(math.ulp(float(exact))))
            slack = float(abs(root * mp.sin(root) / exact)) / 4
        assert error <= stable.tested.limit + slack, point


@pytest.mark.parametrize("formula", ["erf(x)/x", "gamma(x + 1) - 1", "erfc(x)*exp(x**2)"])
def test_a_function_that_numpy_does_not_have_is_rejected(formula: str) -> None:
    with pytest.raises(ValueError, match="expected functions of NumPy"):
        pc.rewrite(formula)


@pytest.mark.parametrize(
    ("formula", "exact"),
    [
        ("(1 + x)**(1/7) - 1", lambda x: mp.expm1(mp.log1p(x) / 7)),
        ("(1 + x)**0.3 - 1", lambda x: mp.expm1(3 * mp.log1p(x) / 10)),
        ("(x**0.4 - 1)/0.4", lambda x: mp.expm1(2 * mp.log(x) / 5) * 5 / 2),
        ("x**(2/7) - x**(1/7)", lambda x: mp.expm1(mp.log(x) / 7) * mp.root(x, 7)),
    ],
)
def test_a_power_with_a_rounded_exponent_is_accurate_for_usual_numbers(
    formula: str, exact: Callable[[mpf], mpf]
) -> None:
    """For a huge number, its logarithm multiplies the error of the exponent."""
    form = pc.rewrite(formula)
    assert form.tested.low <= 1e-9
    assert form.tested.high >= 1e9
    names: dict[str, Any] = {}
    exec(form.source, names)
    draw = random.Random(formula)
    points = [10 ** draw.uniform(-9, 9) for _ in range(150)]
    points += [1 + draw.choice((-1, 1)) * 10 ** draw.uniform(-15, -1) for _ in range(100)]
    points += [form.tested.low, form.tested.high]
    checked = [([point], float(names["f"](point))) for point in points]
    check_errors(exact, checked, form.tested.limit, 0.5, len(points) - 1, math.inf)
