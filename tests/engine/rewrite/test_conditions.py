"""`rewrite` with conditions on the variables: the stated error against mpmath inside the domain."""

import math
import random
from collections.abc import Callable

import numpy as np
import pytest
from exact_errors import check_errors
from mpmath import mp

from derivation.engine.emit.own_formula import domain_of, rewrite_text
from derivation.engine.rewrite.several_variables import SeveralCheck

POISSON = "-1 < nu < 0.5"
FORMULAS = {
    ("(1 - 2*nu)/(2 - 2*nu)", POISSON): lambda nu: (1 - 2 * nu) / (2 - 2 * nu),
    ("(3 - 4*nu)*sinh(T) - T", POISSON): lambda nu, T: (3 - 4 * nu) * mp.sinh(T) - T,
    ("tanh(x) - x", "-1 < x < 1"): lambda x: mp.tanh(x) - x,
    ("1 - cos(x)", "-10 <= x <= 10"): lambda x: 2 * mp.sin(x / 2) ** 2,
    ("sqrt(1 + x) - 1", "-1 < x < 1"): lambda x: mp.sqrt(1 + x) - 1,
    ("log(1 + e) - e", "-0.9 < e < 10"): lambda e: mp.log1p(e) - e,
    ("acos(r/a)", "r < a"): lambda r, a: mp.acos(r / a),
}
SPECIAL = -1.0, 0.5, 1.0, -10.0, 10.0
"""Ends of the domains."""
POINTS = 300


def some_number(draw: random.Random) -> float:
    """Return a number of any magnitude and sign, or one next to an end of a domain."""
    if draw.random() < 0.3:
        return draw.choice(SPECIAL) * (1 + draw.choice((-1, 1)) * 10 ** draw.uniform(-16, -1))
    size = draw.choice((1.0, 3.0, 90.0))
    return draw.choice((-1, 1)) * 10 ** draw.uniform(-size, size)


@pytest.mark.parametrize(("text", "where"), FORMULAS)
def test_stated_error_holds_inside_the_domain(text: str, where: str) -> None:
    _, source, tested = rewrite_text(text, where=[where])
    assert isinstance(tested, SeveralCheck)
    space: dict[str, Callable[..., np.ndarray]] = {}
    exec(source, space)
    draw, exact = random.Random(f"inside {where}"), FORMULAS[text, where]
    names, outside = list(tested.at), 0
    checked = list[tuple[list[float], float]]()
    for _ in range(POINTS):
        point = [some_number(draw) for _ in names]
        values = dict(zip(names, point, strict=True))
        inside = eval(where, {}, values) and all(
            x > 0 or name in ("nu", "x", "e") for name, x in values.items()
        )
        computed = float(space["f"](*point))
        if not inside:
            assert math.isnan(computed), point
            outside += 1
        elif max(map(abs, point)) < tested.high and min(map(abs, point)) > tested.low:
            checked.append((point, computed))
    check_errors(exact, checked, tested.limit, tested.share, POINTS / 20)
    assert outside > POINTS / 20


def test_conditions_are_stated_in_the_docstring() -> None:
    source = rewrite_text("sqrt(1 + x) - 1", where=["x > -1", "x <= 1"])[1]
    assert "Conditions: x > -1, x <= 1;" in source
    assert "inside = (x > -1) & (x <= 1)" in source


@pytest.mark.parametrize(
    ("where", "signs"),
    [
        (["-1 < nu < 0.5"], (None, True)),
        (["nu < 0.5"], (True, True)),
        (["nu >= 0", "T < nu"], (None, True)),
        (["nu > 0", "T > -3"], (True, None)),
        (["nu < -1"], (None, True)),
    ],
)
def test_a_variable_is_positive_unless_a_condition_allows_other_numbers(
    where: list[str], signs: tuple[bool | None, ...]
) -> None:
    assert tuple(a.symbol.is_positive for a in domain_of(["nu", "T"], where).arguments) == signs


@pytest.mark.parametrize(
    ("where", "reason"),
    [
        ("nu", "expected a condition like"),
        ("nu < ", "expected a condition like"),
        ("1 < 2", "expected a condition like"),
        ("mu < 0.5", "with mu; correct the name"),
        ("__import__('os') < 1", "expected a condition like"),
        ("nu > 1 and nu < 2", "expected a condition like"),
    ],
)
def test_other_conditions_are_rejected(where: str, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        rewrite_text("1 - 2*nu", where=[where])


def test_conditions_that_exclude_each_other_are_rejected() -> None:
    message = (
        r"1 - 2\*nu cannot be tested: none of 1600 random points satisfies nu > 1, nu < 0.5; these "
        "conditions exclude each other"
    )
    with pytest.raises(ValueError, match=message):
        rewrite_text("1 - 2*nu", where=["nu > 1", "nu < 0.5"])


def test_a_formula_without_values_in_its_domain_is_rejected_with_the_reason() -> None:
    with pytest.raises(ValueError, match="at 0 of the tested points, expected 100; correct the"):
        rewrite_text("sqrt(x - 2)", where=["x < 1"])


def test_a_condition_that_is_rounded_does_not_narrow_the_range() -> None:
    """Q < m n holds exactly at points at which Q is the rounded product; the code gives NaN."""
    _, source, tested = rewrite_text("1 + Q/(m*n)", where=["Q < m*n"])
    assert isinstance(tested, SeveralCheck)
    assert tested.high == 1e100
    assert "NaN where floating-point arithmetic finds that a condition is violated" in source
