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

Exact = Callable[[mpf], mpf]
x = sp.Symbol("x", positive=True)

CASES: dict[str, tuple[Exact, float, float]] = {
    "(1 - cos(x**2))/x**4": (lambda t: (1 - mp.cos(t**2)) / t**4, 1e-150, 2.2),
    "(1 - exp(-x**2))/x": (lambda t: (1 - mp.exp(-(t**2))) / t, 1e-150, 1e150),
    "sqrt(x)*coth(sqrt(x)) - 1": (lambda t: mp.sqrt(t) * mp.coth(mp.sqrt(t)) - 1, 1e-150, 1e150),
    "(exp(-1/x) - 1)*x": (lambda t: (mp.exp(-1 / t) - 1) * t, 1e-150, 1e150),
    "(sqrt(x) - sin(sqrt(x)))/x**(3/2)": (
        lambda t: (mp.sqrt(t) - mp.sin(mp.sqrt(t))) / mp.sqrt(t) ** 3,
        1e-150,
        1e150,
    ),
    "1 - cos(sqrt(x))": (lambda t: 1 - mp.cos(mp.sqrt(t)), 1e-150, 20.0),
    "1 - sin(pi*x)/(pi*x)": (lambda t: 1 - mp.sin(mp.pi * t) / (mp.pi * t), 1e-150, 1e150),
    "x*log(1 + 1/x) - 1": (lambda t: t * mp.log(1 + 1 / t) - 1, 1e-150, 1e150),
    "log(cosh(x))": (lambda t: mp.log(mp.cosh(t)), 1e-150, 1e150),
    "log(1 + exp(x)) - x": (lambda t: mp.log(1 + mp.exp(t)) - t, 1e-150, 700.0),
    "sqrt(cosh(x) - 1)": (lambda t: mp.sqrt(mp.cosh(t) - 1), 1e-150, 700.0),
    "exp(sin(x)) - 1": (lambda t: mp.exp(mp.sin(t)) - 1, 1e-150, 3.0),
    "acosh(1 + x)": (lambda t: mp.acosh(1 + t), 1e-150, 1e150),
    "acos(1 - x)": (lambda t: mp.acos(1 - t), 1e-150, 1.9),
    "atan(x + 1) - atan(x)": (lambda t: mp.atan(t + 1) - mp.atan(t), 1e-150, 1e70),
    "log(1 + x) - log(x)": (lambda t: mp.log(1 + t) - mp.log(t), 1e-150, 1e150),
    "(x + 1)**(1/3) - x**(1/3)": (lambda t: mp.cbrt(t + 1) - mp.cbrt(t), 1e-150, 1e150),
    "(1 + x)**(1/3) - 1": (lambda t: mp.cbrt(1 + t) - 1, 1e-150, 1e150),
    "sqrt(1 + x) - 1 - x/2": (lambda t: mp.sqrt(1 + t) - 1 - t / 2, 1e-150, 1e150),
    "(1 + 2*x)**(1/3) - 1 - 2*x/3": (lambda t: mp.cbrt(1 + 2 * t) - 1 - 2 * t / 3, 1e-150, 1e150),
    "1/sqrt(1 - x**2) - 1 - x**2/2": (
        lambda t: 1 / mp.sqrt(1 - t**2) - 1 - t**2 / 2,
        1e-75,
        0.999,
    ),
    "log(1 + x) - x + x**2/2": (lambda t: mp.log(1 + t) - t + t**2 / 2, 1e-100, 1e150),
    "(log(1 + x) - x + x**2/2)/x**3": (
        lambda t: (mp.log(1 + t) - t + t**2 / 2) / t**3,
        1e-150,
        1e150,
    ),
    "(1 - x)*log(1 - x) + x - x**2/2": (
        lambda t: (1 - t) * mp.log(1 - t) + t - t**2 / 2,
        1e-100,
        0.99,
    ),
    "tan(x) - x": (lambda t: mp.tan(t) - t, 1e-150, 1e150),
    "x - atan(x)": (lambda t: t - mp.atan(t), 1e-150, 1e150),
    "x - sin(x)*cos(x)": (lambda t: t - mp.sin(t) * mp.cos(t), 1e-150, 1e150),
}
"""Exact values, and a range that the code has to include."""


def relative(function: Exact, point: float) -> tuple[mpf, float]:
    """Return the value, and half the condition number, from a difference of high precision."""
    with mp.workdps(150 + 9 * int(abs(math.log10(point)))):
        at, step = mpf(point), mpf(10) ** -(mp.dps // 3)
        value = function(at)
        slope = (function(at * (1 + step)) - function(at * (1 - step))) / (2 * step)
        return +value, float(abs(slope / value)) / 2


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
        (found,) = substitutions(formula, x)
        known: dict[sp.Symbol, sp.Expr] = {}
        for step in found.steps:
            known[step.symbol] = step.expression.xreplace(known)
        at = {x: sp.Rational(1, 7) / abs(b)}
        u = known[found.variable]
        assert found.inverse.xreplace({found.variable: u.xreplace(at)}).evalf(30) == pytest.approx(
            at[x], rel=1e-25
        )
        equal = (found.front * found.expression.xreplace({found.variable: u})).xreplace(at)
        assert equal.evalf(30) == pytest.approx(formula.xreplace(at).evalf(30), rel=1e-20)


@pytest.mark.parametrize("formula", CASES)
def test_the_stated_error_holds_in_the_stated_range(formula: str) -> None:
    function, low, high = CASES[formula]
    found = pc.rewrite(formula)
    assert found.tested.low <= low
    assert found.tested.high >= high
    names: dict[str, Any] = {}
    exec(found.source, names)
    draw = random.Random(formula)
    ends = math.log10(found.tested.low), math.log10(found.tested.high)
    close = max(ends[0], -4.0), min(ends[1], 2.0)
    points = [10 ** draw.uniform(*ends) for _ in range(40)]
    points += [10 ** draw.uniform(*close) for _ in range(80)]
    points = [min(max(p, found.tested.low), found.tested.high) for p in points]
    compared = 0
    with np.errstate(all="ignore"):
        values = names["f"](np.array(points)).tolist()
    for point, got in zip(points, values, strict=True):
        if (formula.startswith("log(1 + exp") and point > 700) or point > 1e140:
            continue  # the exact value would need too many digits
        exact, slack = relative(function, point)
        if abs(exact) > 1e-290:
            error = float(abs(mpf(got) - exact) / mpf(math.ulp(float(exact))))
            assert error <= found.tested.limit + slack, point
            compared += 1
    assert compared > 60


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


def test_the_rounding_of_a_power_is_bounded_where_no_tested_point_shows_it() -> None:
    """Points close to the end of the range have errors of u = sqrt(x) up to half a unit."""
    found = pc.rewrite("1 - cos(sqrt(x))")
    names: dict[str, Any] = {}
    exec(found.source, names)
    draw = random.Random(1)
    points = [found.tested.high * draw.uniform(0.5, 1.0) for _ in range(3000)]
    for point, got in zip(points, names["f"](np.array(points)).tolist(), strict=True):
        with mp.workdps(40):
            root = mp.sqrt(mpf(point))
            exact = 1 - mp.cos(root)
            error = float(abs(mpf(got) - exact) / mpf(math.ulp(float(exact))))
            slack = float(abs(root * mp.sin(root) / exact)) / 4
        assert error <= found.tested.limit + slack, point


@pytest.mark.parametrize("formula", ["erf(x)/x", "gamma(x + 1) - 1", "erfc(x)*exp(x**2)"])
def test_a_function_that_numpy_does_not_have_is_refused(formula: str) -> None:
    with pytest.raises(ValueError, match="expected functions of NumPy"):
        pc.rewrite(formula)
