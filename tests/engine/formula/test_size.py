"""The estimated number of terms of an expansion is never too small, and exact for plain powers."""

import math

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derivation.engine.formula.size import terms_when_expanded

x, y, z = sp.symbols("x y z")


@pytest.mark.parametrize("power", [1, 8, 20, 100])
def test_powers_of_sums_have_multinomial_numbers_of_terms(power: int) -> None:
    assert terms_when_expanded((x + 1) ** power) == power + 1
    assert terms_when_expanded((x + y + z) ** power) == math.comb(power + 2, 2)


@given(
    st.lists(st.tuples(st.integers(1, 4), st.integers(0, 3), st.integers(0, 3)), max_size=4),
    st.integers(1, 6),
    st.integers(1, 3),
)
def test_estimates_are_upper_bounds(
    terms: list[tuple[int, int, int]], power: int, more: int
) -> None:
    sum_of_terms = sp.Add(*(c * x**n * y**m for c, n, m in terms)) + 1
    expression = sum_of_terms**power * (x + sp.sinh(z)) ** more - 1
    expanded = sp.expand(expression.rewrite(sp.exp))
    assert len(sp.Add.make_args(expanded)) <= terms_when_expanded(expression)
