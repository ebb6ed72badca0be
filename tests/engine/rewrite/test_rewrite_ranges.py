"""Textbook formulas as a user gives them: the code against mpmath, inside its stated range."""

import math
import random
from collections.abc import Callable

import mpmath
import numpy as np
import platecontact as pc
import pytest
from mpmath import mp, mpf

Exact = Callable[[mpf], mpf]

CASES: dict[str, tuple[Exact, float, float]] = {
    "1 - tanh(x)": (lambda x: 1 - mp.tanh(x), 1e-150, 1e150),
    "x - sqrt(x**2 - 1)": (lambda x: x - mp.sqrt(x**2 - 1), 1.01, 1e150),
    "cosh(x)**2 - sinh(x)**2": (lambda _: mpf(1), 1e-150, 1e150),
    "abs(x - 1)": (lambda x: abs(x - 1), 1e-150, 1e150),
    "x**1.5": (lambda x: x ** mpf(1.5), 1e-150, 1e150),
    "1/sqrt(1 - x**2) - 1": (lambda x: 1 / mp.sqrt(1 - x**2) - 1, 1e-150, 0.99),
    "1/sqrt(1 + x**2) - 1": (lambda x: 1 / mp.sqrt(1 + x**2) - 1, 1e-150, 1e150),
    "log(1 + exp(-x))": (lambda x: mp.log(1 + mp.exp(-x)), 1e-150, 700.0),
    "3*(x*cosh(x) - sinh(x))/x**3": (
        lambda x: 3 * (x * mp.cosh(x) - mp.sinh(x)) / x**3,
        1e-150,
        690.0,
    ),
    "2*(1 - cos(x))/x**2": (lambda x: 2 * (1 - mp.cos(x)) / x**2, 1e-150, 5.9),
    "(1 - cos(x))/x": (lambda x: (1 - mp.cos(x)) / x, 1e-150, 5.9),
}
"""Exact values, and a range that the code has to include."""


def exact_value(function: Exact, x: float) -> mpf:
    """Return the value to 50 digits, computed with enough of them for cancellation."""
    with mp.workdps(60 + 8 * int(abs(math.log10(x)))):
        return +function(mpf(x))


def condition(function: Exact, x: float) -> float:
    """Return half the condition number, by a difference."""
    with mp.workdps(100 + 8 * int(abs(math.log10(x)))):
        step = mpf(x) * mpf(10) ** -40
        slope = (function(mpf(x) + step) - function(mpf(x) - step)) / (2 * step)
        return float(abs(slope * x / function(mpf(x)))) / 2


@pytest.mark.parametrize("formula", CASES)
def test_the_stated_error_holds_in_the_stated_range(formula: str) -> None:
    function, low, high = CASES[formula]
    rewritten = pc.rewrite(formula)
    found = rewritten.tested
    assert found.low <= low
    assert found.high >= high
    names: dict[str, Callable[[np.ndarray], np.ndarray]] = {}
    exec(rewritten.source, names)
    draw = random.Random(formula)
    ends = math.log10(found.low), math.log10(min(found.high, 1e40))
    points = [10 ** draw.uniform(*ends) for _ in range(60)]
    points += [draw.uniform(max(found.low, 1e-3), min(found.high, 50.0)) for _ in range(120)]
    for x, got in zip(points, names["f"](np.array(points)), strict=True):
        exact = exact_value(function, x)
        if abs(exact) < 1e-290:
            continue
        unit = math.ulp(float(exact))
        error = float(abs(mpmath.mpf(float(got)) - exact) / unit)
        assert error <= found.limit + condition(function, x), x
    outside = np.array([0.0, -1.0, found.low / 2, found.high * 2])
    assert np.isnan(names["f"](outside)).all()


@pytest.mark.parametrize(
    "formula", ["log(x + sqrt(x**2 + 1))", "x*log(x) - x + 1", "exp(x) - sqrt(1 + 2*x)"]
)
def test_a_range_does_not_leave_out_where_the_formula_cancels(formula: str) -> None:
    """These are accurate in a part of the range without any rule, which would be no help."""
    with pytest.raises(ValueError, match="the rules give a form"):
        pc.rewrite(formula)


@pytest.mark.parametrize("formula", ["log(-x)", "x - x", "sin(x)**2 + cos(x)**2 - 1"])
def test_a_formula_without_values_is_refused(formula: str) -> None:
    with pytest.raises(ValueError, match=r"has values other than 0, .* of the tested points x > 0"):
        pc.rewrite(formula)
