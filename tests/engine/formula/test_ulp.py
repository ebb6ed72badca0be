"""ULP functions against spacing and nextafter of NumPy, and against exact fractions."""

import itertools
import math
import sys
from fractions import Fraction

import flint
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from derivation.engine.formula.ulp import (
    DOUBLE,
    SINGLE,
    from_ordinal,
    neighbours,
    ordinal,
    overflows,
    spacing,
    ulp_error,
)

TINY = 5e-324
LARGEST = sys.float_info.max
finite = st.floats(allow_nan=False, allow_infinity=False)
singles = st.floats(allow_nan=False, allow_infinity=False, width=32)


def exact(number: Fraction) -> flint.arb:
    with flint.ctx.workprec(4000):
        return flint.arb(flint.fmpq(number.numerator, number.denominator))


@given(finite)
def test_spacing_agrees_with_python(x: float) -> None:
    assert spacing(x) == math.ulp(x)


@given(singles.filter(lambda x: abs(x) < 3e38))
def test_spacing_in_single_precision_agrees_with_numpy(x: float) -> None:
    assert spacing(x, SINGLE) == np.spacing(np.float32(abs(x)))


@pytest.mark.parametrize("x", [0.0, TINY, 2.0**-1022, 1.0, 2.0, LARGEST])
def test_spacing_at_the_limits_of_the_format(x: float) -> None:
    assert spacing(x) == math.ulp(x)


@example(-LARGEST, -(2.0**52))
@given(finite, finite)
def test_error_is_the_exact_quotient(got: float, near: float) -> None:
    reference = Fraction(near) * (1 + Fraction(1, 3**40))
    unit = Fraction(math.ulp(near))
    expected = abs(Fraction(got) - reference) / unit
    error = ulp_error(got, exact(reference))
    if error == math.inf:  # errors are rounded upwards
        assert expected * (1 + Fraction(1, 2**52)) > Fraction(LARGEST)
    else:
        assert error == pytest.approx(float(expected), rel=1e-13)


def test_unit_below_a_power_of_two_is_half_the_unit_above() -> None:
    assert ulp_error(1.0, flint.arb(math.nextafter(1.0, 0.0))) == 1.0
    assert ulp_error(math.nextafter(1.0, 0.0), flint.arb(1.0)) == 0.5


def test_interval_around_a_power_of_two_has_the_unit_of_that_power() -> None:
    with flint.ctx.workprec(200):
        third = flint.arb(3) / flint.arb(3)
        below = third - flint.arb(2) ** -190
        clearly_below = 1 - flint.arb(2) ** -60
    assert ulp_error(1.0 + 2.0**-52, below) == pytest.approx(1.0)
    assert ulp_error(1.0, clearly_below) == 2.0**-7


def test_error_of_a_value_that_is_not_finite_is_infinite() -> None:
    for got in (math.nan, math.inf, -math.inf):
        assert ulp_error(got, flint.arb(1)) == math.inf


def test_infinity_is_correct_if_the_reference_overflows() -> None:
    huge = flint.arb(2) ** 1024
    assert overflows(huge)
    assert ulp_error(math.inf, huge) == 0.0
    assert ulp_error(-math.inf, huge) == math.inf
    assert ulp_error(-math.inf, -huge) == 0.0
    assert ulp_error(LARGEST, huge) == 1.0
    assert ulp_error(math.nan, huge) == math.inf


def test_overflow_begins_half_a_unit_above_the_largest_number() -> None:
    with flint.ctx.workprec(200):
        threshold = flint.arb(2) ** 1024 - flint.arb(2) ** 970
        assert overflows(threshold)
        assert not overflows(threshold - 1)
        assert ulp_error(math.inf, threshold - 1) == math.inf
    assert overflows(flint.arb(2) ** 128, SINGLE)


def test_unit_below_the_smallest_number_is_the_smallest_subnormal() -> None:
    reference = flint.arb(2) ** -1080
    assert ulp_error(0.0, reference) == 2.0**-6
    assert ulp_error(TINY, reference) == 1 - 2.0**-6
    assert ulp_error(3 * TINY, flint.arb(0)) == 3.0
    assert ulp_error(-0.0, flint.arb(0)) == 0.0
    assert ulp_error(2.0**-149, flint.arb(0), SINGLE) == 1.0


def test_radius_of_the_reference_counts_as_error() -> None:
    assert ulp_error(1.0, flint.arb(1, 2.0**-51)) == pytest.approx(2.0, rel=1e-6)


def test_reference_must_be_finite() -> None:
    with pytest.raises(ValueError, match="finite ball"):
        ulp_error(1.0, flint.arb.nan())


@given(finite)
def test_ordinal_and_its_inverse_give_the_same_double(x: float) -> None:
    assert from_ordinal(ordinal(x)) == x


@given(singles)
def test_ordinal_and_its_inverse_give_the_same_single(x: float) -> None:
    assert from_ordinal(ordinal(x, SINGLE), SINGLE) == x


@given(finite, finite)
def test_ordinals_are_ordered_like_the_numbers(x: float, y: float) -> None:
    assert (ordinal(x) < ordinal(y)) == (x < y)


@given(finite.filter(lambda x: x != LARGEST))
def test_next_float_has_the_next_ordinal(x: float) -> None:
    assert ordinal(float(np.nextafter(x, np.inf))) == ordinal(x) + 1


def test_ordinal_of_nan_and_infinity_is_rejected() -> None:
    for x in (math.nan, math.inf):
        with pytest.raises(ValueError, match="finite number"):
            ordinal(x)


def test_neighbours_of_zero_contain_zero_once() -> None:
    assert neighbours(0.0, 2) == (-2 * TINY, -TINY, 0.0, TINY, 2 * TINY)


def test_neighbours_stop_at_the_largest_number() -> None:
    assert neighbours(LARGEST, 2)[-1] == LARGEST
    assert len(neighbours(LARGEST, 2)) == 3


@given(finite.filter(lambda x: abs(x) < 1e300))
def test_neighbours_agree_with_repeated_nextafter(x: float) -> None:
    around = neighbours(x, 3, DOUBLE)
    assert around[3] == x
    for left, right in itertools.pairwise(around):
        assert right == np.nextafter(left, np.inf)
