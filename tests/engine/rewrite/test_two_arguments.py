"""`rewrite` of differences of one function at two arguments, against mpmath at other points."""

import math
import random
from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp
from exact_errors import check_errors
from mpmath import mp
from sympy.codegen.cfunctions import expm1, log1p

from derivation.engine.emit.own_formula import domain_of, rewrite_text
from derivation.engine.formula.grid import inside
from derivation.engine.rewrite.differences_from_one import by_differences_from_one
from derivation.engine.rewrite.doubles import rounded_value
from derivation.engine.rewrite.form import ROUNDING_ERROR
from derivation.engine.rewrite.identities import by_identities, prove_identity
from derivation.engine.rewrite.several_variables import SeveralCheck
from derivation.engine.rewrite.terms import UnreachableError
from derivation.engine.rewrite.two_arguments import DIFFERENCES, difference_of_functions

FORMULAS = {
    ("tanh(x + y) - tanh(x)", ""): lambda x, y: mp.tanh(x + y) - mp.tanh(x),
    ("tanh(a) - tanh(b)", "-5 < a < 5; -5 < b < 5"): lambda a, b: mp.tanh(a) - mp.tanh(b),
    ("atan(a) - atan(b)", "-10 < a < 10; -10 < b < 10"): lambda a, b: mp.atan(a) - mp.atan(b),
    ("asinh(a) - asinh(b)", ""): lambda a, b: mp.asinh(a) - mp.asinh(b),
    ("a**p - b**p", "-3 < p < 3"): lambda a, p, b: a**p - b**p,
    ("r/(1 - (1 + r)**(-n))", ""): lambda r, n: -r / mp.expm1(-n * mp.log1p(r)),
    ("cos(a*c) - cos(b*c)", ""): lambda a, c, b: mp.cos(a * c) - mp.cos(b * c),
}
"""A formula with conditions on its variables, and its function."""
POINTS = 100


def some_point(draw: random.Random, count: int, decades: float) -> list[float]:
    """Return numbers of any magnitude; in every second point, two are nearly equal."""
    point = [10 ** draw.uniform(-decades, decades) for _ in range(count)]
    if draw.random() < 0.5:
        one, other = draw.sample(range(count), 2)
        point[one] = point[other] * (1 - 10 ** draw.uniform(-14, -1))
    sign = draw.choice((1, 1, -1))
    return [sign * x if draw.random() < 0.8 else x for x in point]


@pytest.mark.parametrize(("text", "where"), FORMULAS)
def test_stated_error_holds_at_other_points(text: str, where: str) -> None:
    conditions = [part for part in where.split(";") if part]
    _, source, tested = rewrite_text(text, where=conditions)
    assert isinstance(tested, SeveralCheck)
    assert tested.high >= 1e50
    space: dict[str, Callable[..., np.ndarray]] = {}
    exec(source, space)
    names, words = list(tested.at), domain_of(list(tested.at), conditions)
    draw, checked = random.Random(f"two {text}"), list[tuple[list[float], float]]()
    for number in range(POINTS):
        point = some_point(draw, len(names), math.log10(tested.high) if number % 3 == 0 else 1.0)
        if inside(words, dict(zip(names, point, strict=True))):
            checked.append((point, float(space["f"](*point))))
    check_errors(FORMULAS[text, where], checked, tested.limit, tested.share, POINTS / 6)


x, y, n = sp.symbols("x y n", positive=True)


@pytest.mark.parametrize(
    ("formula", "form"),
    [
        (1 - (1 - x) ** n, -expm1(n * log1p(-x))),
        ((1 + x) ** n - 1, expm1(n * log1p(x))),
        (sp.log(x + y) - sp.log(x), log1p(y / x)),
        (1 - sp.exp(-((x / y) ** n)), -expm1(-((x / y) ** n))),
        (sp.tan(x + y) - sp.tan(x), sp.sin(y) / (sp.cos(x) * sp.cos(x + y))),
    ],
)
def test_the_difference_of_the_arguments_is_not_rounded(formula: sp.Expr, form: sp.Expr) -> None:
    assert next(by_identities(formula)) == form


def test_a_damped_wave_is_a_product_and_a_small_term() -> None:
    *_, found = by_differences_from_one(sp.cos(x) - sp.exp(-y) * sp.cos(x + y))
    product = 2 * sp.sin(y / 2) * sp.sin(x + y / 2)
    assert found == product - sp.cos(x + y) * expm1(-y)


@pytest.mark.parametrize("kind", DIFFERENCES)
@pytest.mark.parametrize("real", [False, True])
def test_a_difference_equals_the_formula_for_every_sign(
    kind: type[sp.Function], real: bool
) -> None:
    p, q = sp.symbols("p q", **({"real": True} if real else {"positive": True}))
    found = difference_of_functions(3 * kind(p), -3 * kind(q))
    if found is None:
        assert real
        assert kind in (sp.asin, sp.acos, sp.asinh, sp.acosh, sp.coth)
    else:
        prove_identity(found, 3 * kind(p) - 3 * kind(q))


@pytest.mark.parametrize(
    ("one", "other"),
    [(sp.tan(x), sp.tan(y)), (sp.tan(x), -2 * sp.tan(y)), (x**n, -(y ** (n**2))), (x, -y)],
)
def test_other_sums_are_not_changed(one: sp.Expr, other: sp.Expr) -> None:
    assert difference_of_functions(one, other) is None


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (2 * x**n, -2 * y**n),
        ((1 + x) ** n, sp.Integer(-1)),
        (sp.Integer(1), -((1 - x / 9) ** -n)),
        ((x + y) ** (1 - n), -(x ** (1 - n))),
        ((x / y) ** (2 * n), -(y**n)),
        (x**n, -(x**y)),
    ],
)
def test_a_difference_of_powers_equals_the_formula(one: sp.Expr, other: sp.Expr) -> None:
    found = difference_of_functions(one, other)
    assert found is not None
    prove_identity(found, one + other)


def test_a_wrong_case_of_nested_bounds_is_rejected() -> None:
    p, q = sp.symbols("p q", real=True)
    positive, negative = (bound(p, 0) - bound(q, 0) for bound in (sp.Max, sp.Min))
    prove_identity(positive + negative, p - q)
    prove_identity(sp.Max(positive, 0) + sp.Min(positive, 0) + negative, p - q)
    with pytest.raises(UnreachableError, match="not proved"):  # it is valid for p > q > 0 only
        prove_identity(sp.Max(positive, 0) + negative, p - q)


def test_the_rounding_error_of_a_product_is_exact() -> None:
    a, b = 1 + 2**-30, 1 - 2**-30
    assert rounded_value(ROUNDING_ERROR(x, y), {x: a, y: b}) == -(2.0**-60)
    assert math.isnan(rounded_value(ROUNDING_ERROR(x, y), {x: 1e200, y: 1e200}))
    assert math.isnan(rounded_value(x**y, {x: -1.0, y: 0.5}))
    assert rounded_value(x**y, {x: 9.0, y: 0.5}) == 3.0
