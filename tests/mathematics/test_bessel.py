"""The generated Bessel functions against Arb: values, zeros, switch points, types."""

import importlib
import math
import sys
import warnings
from types import ModuleType

import flint
import numpy as np
import pytest
import sympy as sp

from derivation.engine.formula.proof import ProofError, decide_zero
from derivation.engine.formula.ulp import neighbours, ulp_error
from derivation.mathematics.bessel import kernels as tables
from derivation.mathematics.bessel.oracle import j0_zero, j1_zero
from derivation.mathematics.bessel.theory import functions as theory
from derivation.mathematics.bessel.theory.zeros import zero_bound, zero_correction

BITS = 256
VALUE_BUDGET = 2.25
"""Largest error in ULP, minus half the condition number."""
BUDGET_NEAR_ZEROS = 2.75
"""Largest error in ULP close to the first zeros, condition number included."""
ZERO_BUDGET = 0.51
"""Largest error in ULP of the zeros, and of J1 at them."""
INDICES = (*range(1, 61), 64, 77, 100, 1000, 10**4, 10**5, 10**6)


@pytest.fixture(scope="module")
def bessel() -> ModuleType:
    """Return the generated module; another test checks that it is up to date."""
    return importlib.import_module("generated.bessel")


def excess(function, order: int, points: np.ndarray) -> tuple[float, float]:
    """Return the largest error in ULP minus half the condition number, and its argument."""
    worst = (-math.inf, math.nan)
    for x, got in zip(points.tolist(), function(points).tolist(), strict=True):
        # The precision is sufficient for the exact x, which may be as large as 2^1024.
        with flint.ctx.workprec(BITS + max(0, 2 * math.frexp(x)[1])):
            ball = flint.arb(x)
            j0, j1 = ball.bessel_j(0), ball.bessel_j(1)
            reference = (j0, j1)[order]
            if reference == 0:
                assert got == 0
                continue
            slope = -j1 if order == 0 else j0 - j1 / ball
            condition = float(abs(ball * slope / reference))
        worst = max(worst, (ulp_error(got, reference) - condition / 2, x))
    return worst


def around(points, count: int = 32) -> np.ndarray:
    """Return the points and their neighbours in double precision."""
    near = [n for x in points for n in neighbours(float(x), count)]
    return np.array([x for x in near if x >= 0])


def arguments(where: str) -> np.ndarray:
    """Return arguments in a region."""
    random = np.random.default_rng(7)
    start = tables.taylor_table().switches[-1]
    if where == "taylor":
        return random.uniform(0, start, 3000)
    if where == "tiny":
        return 10 ** random.uniform(-150, 0, 1000)
    if where == "phase":
        return start + random.uniform(0, 200, 3000)
    if where == "large":
        return 10 ** random.uniform(2, 15, 2000)
    if where == "switches":
        return around(tables.switches())
    with flint.ctx.workprec(BITS):
        zeros = [tables.bessel_zero(n, i) for n in (0, 1) for i in (*range(1, 31), 1000, 10**6)]
    return around(float(zero) for zero in zeros)


@pytest.mark.parametrize("order", [0, 1])
@pytest.mark.parametrize("where", ["taylor", "tiny", "phase", "large", "switches", "zeros"])
def test_values_are_within_the_budget(bessel: ModuleType, order: int, where: str) -> None:
    function = (bessel.bessel_j0, bessel.bessel_j1)[order]
    error, x = excess(function, order, arguments(where))
    assert error <= VALUE_BUDGET, f"{error} ULP at {x.hex()}"


@pytest.mark.parametrize("order", [0, 1])
def test_huge_arguments_are_within_the_budget(bessel: ModuleType, order: int) -> None:
    points = np.array([2.0**50 + 1, 1e16, 1e22, 1e100, 1e300, sys.float_info.max])
    error, x = excess((bessel.bessel_j0, bessel.bessel_j1)[order], order, points)
    assert error <= VALUE_BUDGET, f"{error} ULP at {x.hex()}"


@pytest.mark.parametrize("order", [0, 1])
def test_no_digits_are_lost_close_to_the_first_zeros(bessel: ModuleType, order: int) -> None:
    function = (bessel.bessel_j0, bessel.bessel_j1)[order]
    with flint.ctx.workprec(BITS):
        zeros = [float(tables.bessel_zero(order, index)) for index in range(1, 10)]
    points = around(zeros)
    with flint.ctx.workprec(BITS):
        reference_values = [flint.arb(x).bessel_j(order) for x in points.tolist()]
    error = max(map(ulp_error, function(points).tolist(), reference_values))
    assert error <= BUDGET_NEAR_ZEROS


def test_zeros_and_slopes_are_within_the_budget(bessel: ModuleType) -> None:
    zeros, slopes = bessel.bessel_j0_zeros(10**6), bessel.bessel_j1_at_j0_zeros(10**6)
    assert zeros.shape == slopes.shape == (10**6,)
    for index in INDICES:
        reference = j0_zero(index, 200)
        with flint.ctx.workprec(200):
            slope = reference.bessel_j(1)
        assert ulp_error(float(zeros[index - 1]), reference) <= ZERO_BUDGET, index
        assert ulp_error(float(slopes[index - 1]), slope) <= ZERO_BUDGET, index


def test_zeros_of_j1_are_within_the_budget(bessel: ModuleType) -> None:
    zeros = bessel.bessel_j1_zeros(10**6)
    assert zeros.shape == (10**6,)
    assert (np.diff(zeros) > 3).all()
    near = (10**power + step for power in range(3, 6) for step in (-1, 0, 1))
    for index in (*range(1, 201), *near, 10**6 - 1, 10**6):
        assert ulp_error(float(zeros[index - 1]), j1_zero(index, 200)) <= ZERO_BUDGET, index


@pytest.mark.parametrize("order", [0, 1])
def test_expansion_of_zeros_is_within_its_bound(order: int) -> None:
    """The bound is tested at the switch point, and below it, where it is larger."""
    for index in (2, 3, tables.mcmahon_start(order), 50):
        with flint.ctx.workprec(BITS):
            beta = (4 * flint.arb(index) + 2 * order - 1) / 4 * flint.arb.pi()
            series = sum(
                flint.arb(flint.fmpq(int(a.p), int(a.q))) * beta ** (-1 - 2 * i)
                for i, a in enumerate(zero_correction(order, tables.TERMS).coefficients)
            )
            error = abs((j0_zero, j1_zero)[order](index, BITS) - beta - series)
        # A little below beta: pi > 3.1415.
        near = sp.Rational(4 * index + 2 * order - 1, 4) * sp.Rational(31415, 10**4)
        bound = zero_bound(order, tables.TERMS, near)
        assert error <= float(bound), index
        assert bound < 10 * float(error) or index < 4, index
    assert zero_bound(order, tables.TERMS, sp.Rational(1, 3)) == sp.oo


def test_zeros_of_j1_are_certified_and_counted_from_one() -> None:
    with flint.ctx.workprec(200):
        for index in (1, 2, 7):
            assert j1_zero(index, 150).overlaps(tables.bessel_zero(1, index))
    with pytest.raises(ValueError, match="at least 1"):
        j1_zero(0, 100)


@pytest.mark.parametrize("count", [0, 1, 5, 7, 8, 9, 10, 11, 12, 13, 40])
def test_shorter_tables_are_the_beginning_of_longer_ones(bessel: ModuleType, count: int) -> None:
    for function in (bessel.bessel_j0_zeros, bessel.bessel_j1_zeros, bessel.bessel_j1_at_j0_zeros):
        assert function(count).shape == (count,)
        np.testing.assert_array_equal(function(count), function(64)[:count])
        np.testing.assert_array_equal(function(float(count)), function(count))


@pytest.mark.parametrize("count", [-1, 2.5, math.nan, math.inf])
def test_invalid_counts_are_rejected(bessel: ModuleType, count: float) -> None:
    for function in (bessel.bessel_j0_zeros, bessel.bessel_j1_zeros, bessel.bessel_j1_at_j0_zeros):
        with pytest.raises(ValueError, match="integer >= 0"):
            function(count)


def test_j0_is_even_and_j1_is_odd(bessel: ModuleType) -> None:
    x = np.array([0.0, 1e-300, 0.3, 5.0, 31.0, 77.7, 1e16])
    np.testing.assert_array_equal(bessel.bessel_j0(-x), bessel.bessel_j0(x))
    np.testing.assert_array_equal(bessel.bessel_j1(-x), -bessel.bessel_j1(x))
    assert np.signbit(bessel.bessel_j1(-0.0))
    assert bessel.bessel_j0(0) == 1


def test_results_have_shape_and_type_of_the_arguments(bessel: ModuleType) -> None:
    x = np.linspace(-50, 50, 24).reshape(2, 3, 4)
    for function in (bessel.bessel_j0, bessel.bessel_j1):
        whole = function(x)
        np.testing.assert_array_equal(function(x[:, ::-2, ::3]), whole[:, ::-2, ::3])
        np.testing.assert_array_equal(function(x.T), whole.T)
        assert function(np.empty(0)).shape == (0,)
        assert function(np.empty((3, 0))).shape == (3, 0)
        assert np.ndim(function(1)) == 0
        assert function([1, 2]).dtype == np.float64
        single = x.astype(np.float32)
        assert function(single).dtype == np.float32
        np.testing.assert_array_equal(
            function(single), function(single.astype(np.float64)).astype(np.float32)
        )
        with pytest.raises(TypeError):
            function(1j)


def test_values_do_not_depend_on_blocks(bessel: ModuleType) -> None:
    x = np.random.default_rng(3).uniform(0, 60, 3 * bessel._BLOCK + 5)
    for function in (bessel.bessel_j0, bessel.bessel_j1):
        np.testing.assert_array_equal(function(x)[::997], [function(v) for v in x[::997]])


def test_arguments_that_are_not_finite_give_nan_without_warning(bessel: ModuleType) -> None:
    x = np.array([np.nan, np.inf, -np.inf, 0.0, 5e-324, 3.0, 1e3, 1e16, 1.7e308])
    with warnings.catch_warnings(), np.errstate(all="raise"):
        warnings.simplefilter("error")
        for function in (bessel.bessel_j0, bessel.bessel_j1):
            np.testing.assert_array_equal(np.isnan(function(x)), [True] * 3 + [False] * 6)
            assert np.isnan(function(np.inf))


def test_tables_are_reproducible() -> None:
    first = tables.bessel_numbers()
    tables.taylor_table.cache_clear()
    tables.low_zeros.cache_clear()
    assert tables.bessel_numbers() == first


def test_centres_of_series_are_zeros_in_twice_double_precision() -> None:
    table = tables.taylor_table()
    for order in (0, 1):
        rows = [i for i, row in enumerate(table.rows[order]) if row[0] == 0 and table.high[i] > 0]
        assert len(rows) >= 9
        for index, row in enumerate(rows, start=1):
            with flint.ctx.workprec(BITS):
                centre = flint.arb(table.high[row]) + flint.arb(table.low[row])
                assert abs(tables.bessel_zero(order, index) / centre - 1) < 2.0**-100


def test_nearest_double_of_a_wide_interval_is_rejected() -> None:
    with pytest.raises(ArithmeticError, match="nearest doubles"):
        tables.nearest_double(flint.arb(1, 2.0**-40))


@pytest.mark.parametrize("order", [0, 1])
def test_modulus_bound_holds_at_the_start_of_the_asymptotic_range(order: int) -> None:
    start = sp.Rational(tables.asymptotic_start())
    with flint.ctx.workprec(BITS):
        x = flint.arb(float(start))
        reference = (x.bessel_j(order) ** 2 + x.bessel_y(order) ** 2) * flint.arb.pi() * x / 2
        series = theory.modulus_squared(order, tables.TERMS).expression(start, tables.TERMS)
        error = abs(reference - flint.arb(flint.fmpq(int(series.p), int(series.q))))
    bound = float(theory.modulus_bound(order, tables.TERMS, start))
    assert bound / 2 < float(error) <= bound


def test_phase_bound_is_close_to_the_first_omitted_term() -> None:
    start = sp.Rational(tables.asymptotic_start())
    omitted = abs(theory.phase_shift(0, tables.TERMS + 1).term(tables.TERMS, start))
    assert 1 <= theory.phase_bound(0, tables.TERMS, start) / omitted < 1.1
    assert theory.phase_bound(0, tables.TERMS, sp.Integer(1)) == sp.oo


def test_coefficients_agree_with_published_ones() -> None:
    """Digital Library of Mathematical Functions, equations 10.18.17, 10.18.18 and 10.21.19."""
    third = sp.Rational(1, 3)
    assert theory.modulus_squared(0, 3).coefficients == (
        1,
        sp.Rational(-1, 8),
        sp.Rational(27, 128),
    )
    assert theory.phase_shift(0, 2).coefficients == (sp.Rational(-1, 8), sp.Rational(25, 384))
    assert zero_correction(0, 3).coefficients == (
        sp.Rational(1, 8),
        sp.Rational(-31, 128) * third,
        sp.Rational(3779, 15360),
    )
    assert zero_correction(1, 3).coefficients == (
        sp.Rational(-3, 8),
        sp.Rational(3, 128),
        sp.Rational(-1179, 5120),
    )


def test_wrong_coefficient_is_detected(monkeypatch: pytest.MonkeyPatch) -> None:
    correct = theory.phase_shift(0, 12)
    wrong = theory.Expansion(
        correct.name,
        correct.first,
        (correct.coefficients[0] * 2, *correct.coefficients[1:]),
        correct.proof,
    )
    monkeypatch.setattr(theory, "phase_shift", lambda *_: wrong)
    monkeypatch.setattr(theory, "phase_bound", lambda *_: sp.Rational(1, 10**9))
    with pytest.raises(ProofError, match="J0"):
        theory._contains(0, sp.Integer(20), 12)


def test_equation_of_another_order_is_not_satisfied() -> None:
    assert decide_zero(theory.equation(sp.besselj(0, theory.x), sp.Integer(1))) is None
