"""Tests with mpmath of the range and the error limit that `rewrite` states.

The printed code of every accepted formula is run at random points of the stated range, close to
zeros of the formula, and at both ends. `rewrite` itself does not use mpmath.
"""

import math
import random
import re
from collections.abc import Callable, Iterator, Sequence
from itertools import islice, pairwise
from typing import Any

import mpmath
import numpy as np
import platecontact as pc
import pytest

from derivation.engine.rewrite.code_check import CodeCheck, stated_error

RANGES = {
    "1 - tanh(x)": (1e-150, 1e150),
    "x - sqrt(x**2 - 1)": (1.01, 1e150),
    "cosh(x)**2 - sinh(x)**2": (1e-150, 1e150),
    "abs(x - 1)": (1e-150, 1e150),
    "x**1.5": (1e-150, 1e150),
    "1/sqrt(1 - x**2) - 1": (1e-150, 0.99),
    "1/sqrt(1 + x**2) - 1": (1e-150, 1e150),
    "log(1 + exp(-x))": (1e-150, 700.0),
    "3*(x*cosh(x) - sinh(x))/x**3": (1e-150, 690.0),
    "2*(1 - cos(x))/x**2": (1e-150, 1e100),
    "(1 - cos(x))/x": (1e-150, 5.9),
    "(1 - cos(x**2))/x**4": (1e-150, 2.2),
    "(1 - exp(-x**2))/x": (1e-150, 1e150),
    "sqrt(x)*coth(sqrt(x)) - 1": (1e-150, 1e150),
    "(exp(-1/x) - 1)*x": (1e-150, 1e150),
    "(sqrt(x) - sin(sqrt(x)))/x**(3/2)": (1e-150, 1e150),
    "1 - cos(sqrt(x))": (1e-150, 20.0),
    "1 - sin(pi*x)/(pi*x)": (1e-150, 1e150),
    "x*log(1 + 1/x) - 1": (1e-150, 1e150),
    "log(cosh(x))": (1e-150, 1e150),
    "log(1 + exp(x)) - x": (1e-150, 700.0),
    "sqrt(cosh(x) - 1)": (1e-150, 700.0),
    "exp(sin(x)) - 1": (1e-150, 3.0),
    "acosh(1 + x)": (1e-150, 1e150),
    "acos(1 - x)": (1e-150, 1.9),
    "atan(x + 1) - atan(x)": (1e-150, 1e70),
    "pi/2 - atan(x)": (1e-150, 1e150),
    "x*(pi - 2*atan(sqrt(x)))": (1e-150, 1e150),
    "3*atan(x) - 3*pi/2": (1e-150, 1e150),
    "log(x + sqrt(1 + x**2))": (1e-150, 1e150),
    "log(2*x + sqrt(4*x**2 + 1))/x": (1e-150, 1e150),
    "log(1 + x) - log(x)": (1e-150, 1e150),
    "x*log(x) - x + 1": (1e-150, 1e150),
    "acosh(x) - log(2*x)": (1.01, 1e150),
    "asin(x) - x*sqrt(1 - x**2)": (1e-150, 0.99),
    "x - 1/x**2": (1e-150, 1e100),
    "(x + 1)**(1/3) - x**(1/3)": (1e-150, 1e150),
    "(1 + x)**(1/3) - 1": (1e-150, 1e150),
    "sqrt(1 + x) - 1 - x/2": (1e-150, 1e150),
    "(1 + 2*x)**(1/3) - 1 - 2*x/3": (1e-150, 1e150),
    "1/sqrt(1 - x**2) - 1 - x**2/2": (1e-75, 0.999),
    "log(1 + x) - x + x**2/2": (1e-100, 1e150),
    "(log(1 + x) - x + x**2/2)/x**3": (1e-150, 1e150),
    "(1 - x)*log(1 - x) + x - x**2/2": (1e-100, 0.99),
    "tan(x) - x": (1e-150, 1e150),
    "x - atan(x)": (1e-150, 1e150),
    "x - sin(x)*cos(x)": (1e-150, 1e150),
}
"""Formulas with a range that the code has to include."""
FORMULAS = (
    "1 - cos(x)", "1 + cos(x)", "1 - sin(x)", "cos(x) - 1/2", "2 - 2*cos(x/1000)",
    "(exp(x) - 1)/x", "(exp(2*x) - 1)/(2*x)", "exp(x)/x", "exp(x)", "exp(-x)", "exp(-x)/x**2",
    "1 - exp(-x)", "x*exp(-x)", "x**2", "1/x**3", "x**2 - 2", "x**3 - x - 1",
    "1/(1 + x) - 1/(2 + x)", "x/(1 + x)", "(x**2 - 1)/(x + 1)", "sqrt(x + 1) - sqrt(x)",
    "sqrt(x**2 + 1) - 1", "1/sqrt(x)", "log(1 + x)/x", "log(x)", "log(1 + 3*x)", "log(x)/x",
    "sin(x)", "sin(x)/x", "x - sin(x)", "sin(x) - x*cos(x)", "tan(x)", "sin(x) - 1/2",
    "cosh(x) - 1", "sinh(x)/x", "tanh(x)", "tanh(x)/x", "cosh(x)/x", "sinh(2*x)/sinh(x)",
    "1/cosh(x)", "x/sinh(x)", "exp(x) - 2", "x + 1e-20", "x**4 + x", "1/(x**2 + 1)",
    "exp(x)/(1 + exp(x))", "(x - sin(x))/x**3", "x/(exp(x) - 1)", "log(1 + x) - x",
)  # fmt: skip
REJECTED = {"1 - sin(x)", "sin(x) - 1/2", "2 - 2*cos(x/1000)", "(exp(2*x) - 1)/(2*x)"}
"""Formulas for which no rule gives an accurate form; more than forty others remain."""
RANDOM, NEAR = 60, 15
DIGITS = 400
"""Digits of exact values, with which a difference down to the smallest double is correct."""


def compiled(source: str) -> Callable[[Any], Any]:
    space: dict[str, Any] = {}
    exec(compile(source, "f.py", "exec"), space)
    return space["f"]  # type: ignore[no-any-return]


def zeros(value: Callable[[Any], Any], low: float, high: float) -> Iterator[float]:
    """Yield zeros up to 100, then points where the slope changes sign."""

    def slope(t: Any) -> Any:
        step = t * mpmath.mpf(10) ** -20
        return value(t + step) - value(t - step)

    top = min(high, 100.0)
    grid = [low + (top - low) * k / 1000 for k in range(1, 1000)]
    with mpmath.workdps(60):
        values = [value(mpmath.mpf(p)) for p in grid]
        yield from changes_of_sign(value, values, grid, grid[1:])
        rises = [right - left for left, right in pairwise(values)]
        yield from changes_of_sign(slope, rises, grid, grid[2:])


def changes_of_sign(
    function: Callable[[Any], Any],
    values: Sequence[Any],
    starts: Sequence[float],
    ends: Sequence[float],
) -> Iterator[float]:
    """Yield the points, by bisection, where a function changes its sign as the values do."""
    signs = [mpmath.sign(value) for value in values]
    for (one, other), low, high in zip(pairwise(signs), starts, ends, strict=False):
        if one * other < 0:
            while low < (middle := (low + high) / 2) < high:
                same = mpmath.sign(function(mpmath.mpf(middle))) == one
                low, high = (middle, high) if same else (low, middle)
            yield low


def points(value: Callable[[Any], Any], low: float, high: float, seed: str) -> set[float]:
    """Return random points of the range, points close to zeros, and both ends."""
    draw = random.Random(f"judge {seed}")
    first, last = math.log10(low), math.log10(high)
    actual = {10 ** draw.uniform(first, last) for _ in range(RANDOM)}
    near, far = max(first, -3.0), min(last, 3.0)
    if near < far:
        actual |= {10 ** draw.uniform(near, far) for _ in range(RANDOM)}
    for center in (low, high, *islice(zeros(value, low, high), 8)):
        sides = (1 - 10.0**-k for k in range(1, NEAR)), (1 + 10.0**-k for k in range(1, NEAR))
        actual |= {center, *(center * side for both in sides for side in both)}
    return {p for p in actual if low <= p <= high} | {low, high}


def excess(value: Callable[[Any], Any], point: float, got: float, limit: float) -> float:
    """Return the error in ULP of the exact value, minus half the condition number.

    The condition number is computed only for an error above the limit, because it takes as long as
    the value.
    """
    with mpmath.workdps(DIGITS + int(7 * abs(math.log10(point)))):
        at = mpmath.mpf(point)
        exact = value(at)
        if exact == 0:
            return 0.0 if got == 0 else math.inf
        if not math.isfinite(got):
            return math.inf
        error = float(abs(mpmath.mpf(got) - exact) / math.ulp(float(exact)))
        if error <= limit:
            return error
        step = mpmath.mpf(10) ** (-mpmath.mp.dps // 3)
        condition = abs((value(at * (1 + step)) - exact) / (step * exact))
        return error - float(condition / 2)


def exact_function(text: str) -> Callable[[Any], Any]:
    """Return the formula as a function of mpmath, without the parser of the program."""
    if text == "cosh(x)**2 - sinh(x)**2":
        return lambda _: mpmath.mpf(1)
    exact = re.sub(r"(\d+)/(\d+)", r"mpf(\1)/\2", text)
    return eval(f"lambda x: {exact}", dict(vars(mpmath)))  # type: ignore[no-any-return]


@pytest.mark.parametrize("text", [*RANGES, *FORMULAS])
def test_error_is_below_the_stated_limit_in_the_stated_range(text: str) -> None:
    try:
        rewritten = pc.rewrite(text)
    except ValueError:
        assert text in REJECTED
        return
    source, tested_range = rewritten.source, rewritten.tested
    low, high = RANGES.get(text, (tested_range.low, tested_range.high))
    assert tested_range.low <= low
    assert tested_range.high >= high
    assert repr(tested_range.low) in source
    assert repr(tested_range.high) in source
    assert f"at most {tested_range.limit:g} ULP plus half the condition number" in " ".join(
        source.split()
    )
    f, value = compiled(source), exact_function(text)
    checked = sorted(points(value, tested_range.low, tested_range.high, text))
    with np.errstate(all="ignore"):
        got = f(np.array(checked)).tolist()
        outside = [
            math.nextafter(tested_range.low, 0.0),
            math.nextafter(tested_range.high, math.inf),
        ]
        assert np.isnan(f(np.array([*outside, 0.0, -1.0, math.inf, math.nan]))).all()
    worst = max(
        (excess(value, p, y, tested_range.limit), p) for p, y in zip(checked, got, strict=True)
    )
    assert worst[0] <= tested_range.limit, worst
    assert tested_range.high / tested_range.low >= 10
    assert stated_error(tested_range.worst) == tested_range.limit > tested_range.worst
    assert isinstance(tested_range, CodeCheck)


def test_range_ends_before_an_overflow() -> None:
    """e^x overflows at 709.78."""
    tested_range = pc.rewrite("(exp(x) - 1)/x").tested
    assert tested_range.low == 1e-150
    assert 700.0 < tested_range.high < 709.79
