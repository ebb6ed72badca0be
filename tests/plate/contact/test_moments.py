"""Test kappa_n and M_k: generated functions and their expansions against certified integrals."""

from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise

import flint
import numpy as np
import pytest
import sympy as sp
from flint import arb

import generated
import generated.series_numbers
from derivation.engine.formula.proof import ProofError
from derivation.engine.formula.ulp import ulp_error
from derivation.mathematics.bessel.theory.functions import phase_shift, power
from derivation.plate.contact.kernels import moments as tables
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import moments as reference
from derivation.plate.contact.theory import moments as theory
from generated import finite_part, finite_part_ratio, kappa, kappa_ratio

BITS = 76
BUDGET = 0.51
LAST_N, LAST_K = 196, 99
"""The largest indices whose values do not overflow a double."""
LARGE = (300, 999, 1000, 4097, 10**4, 10**5, 123457, 10**6)
KERNELS = (kappa, kappa_ratio, finite_part, finite_part_ratio)
FIRST = {kappa: 0, kappa_ratio: 0, finite_part: 2, finite_part_ratio: 2}
SWITCHES = {kappa_ratio: tables.kappa_start(), finite_part_ratio: tables.finite_part_start()}


pytestmark = pytest.mark.usefixtures("silent")


def errors(kernel: Callable, number: Callable[[int, int], arb], indices: list[int]) -> list[float]:
    """Return the errors in ULP at the indices, which are evaluated as one array."""
    got = kernel(np.array(indices, dtype=float)).tolist()
    return [ulp_error(g, number(i, BITS)) for g, i in zip(got, indices, strict=True)]


def fraction(value: sp.Rational) -> arb:
    return arb(flint.fmpq(int(value.p), int(value.q)))


# --- values


def test_lateral_moments_are_within_the_budget() -> None:
    start = tables.kappa_start()
    indices = [*range(7), 9, 12, 19, 33, 50, 76, start - 1, start, 150, LAST_N - 1, LAST_N]
    assert max(errors(kappa, reference.kappa, indices)) <= BUDGET
    assert max(errors(kappa_ratio, reference.kappa_ratio, [*indices, *LARGE])) <= BUDGET


def test_lateral_moments_around_the_switch_point() -> None:
    start = tables.kappa_start()
    near = [*range(start - 2, start + 2)]
    assert max(errors(kappa_ratio, reference.kappa_ratio, near)) <= BUDGET


def test_finite_parts_of_every_index() -> None:
    indices = list(range(2, LAST_K + 1))
    assert max(errors(finite_part, reference.finite_part, indices)) <= BUDGET
    assert max(errors(finite_part_ratio, reference.finite_part_ratio, [*indices, *LARGE])) <= BUDGET


def test_signs_and_known_values_of_finite_parts() -> None:
    """M_2, M_3 and M_4 have known values; M_2 is the only negative number of both tables."""
    assert finite_part([2, 3, 4]).tolist() == [
        -1.12648392978257645242944,
        7.72386466370692885870034,
        41.9670644769000627482199,
    ]
    assert (finite_part(np.arange(3, LAST_K + 1)) > 0).all()
    assert (kappa(np.arange(LAST_N + 1)) > 0).all()


def test_last_values_are_the_largest_without_overflow() -> None:
    largest = arb(np.finfo(float).max)
    assert reference.kappa(LAST_N, BITS) < largest < reference.kappa(LAST_N + 1, BITS)
    assert reference.finite_part(LAST_K, BITS) < largest < reference.finite_part(LAST_K + 1, BITS)
    assert np.isnan(kappa([LAST_N + 1, 10**6])).all()
    assert np.isnan(finite_part([LAST_K + 1, 10**6])).all()


@pytest.mark.parametrize("kernel", [kappa_ratio, finite_part_ratio])
def test_ratios_tend_to_one(kernel: Callable) -> None:
    index = np.array([1e7, 1e15, 1e16, 2.0**53, 1e18, 1e100])
    assert (np.abs(kernel(index) - 1) <= 1.01 / index + 2.0**-53).all()
    assert kernel(1e300) == kernel(1.7e308) == 1


def test_ratios_and_values_agree() -> None:
    """The values are the ratios times their factorial factors, within a few rounding errors."""
    n = np.arange(160)
    factorials = np.array([float(sp.factorial(i)) for i in range(160)])
    np.testing.assert_allclose(
        kappa(n), kappa_ratio(n) * np.pi * factorials / 2.0 ** (n + 1), 1e-15
    )
    k = np.arange(2, 80)
    grown = factorials[2 * k - 2] / 2.0 ** (2 * k - 3)
    np.testing.assert_allclose(finite_part(k), finite_part_ratio(k) * grown, 1e-15)


# --- arrays


@pytest.mark.parametrize(("kernel", "last"), [(kappa, 43), (finite_part, 22)])
def test_single_precision_overflows_to_nan(kernel: Callable, last: int) -> None:
    largest = float(np.finfo(np.float32).max)
    double = kernel(np.arange(2.0, last + 20))
    single = kernel(np.arange(2.0, last + 20).astype(np.float32))
    np.testing.assert_array_equal(np.isnan(single), np.abs(double) > largest)
    assert 0 < np.isnan(single).sum() < single.size


# --- theory


def test_quotient_follows_from_the_phase() -> None:
    """The expansion of K0/I0 follows independently from the phase of J0 and Y0."""
    terms = 9
    t = sp.Symbol("t")
    shift = phase_shift(0, 5).coefficients
    exponent = 2 * sum((-1) ** i * d * t ** (1 + 2 * i) for i, d in enumerate(shift))
    series = sp.series(sp.exp(exponent), t, 0, terms).removeO()
    actual = [series.coeff(t, i) for i in range(terms)]
    assert tuple(actual) == theory.lateral_quotient(terms)


def test_hankel_coefficients_agree_with_published_ones() -> None:
    """The coefficients are those of equation 10.17.1 of the NIST DLMF for nu = 0."""
    assert theory.hankel(4) == (1, sp.Rational(1, 8), sp.Rational(9, 128), sp.Rational(75, 1024))
    ratio = power(theory.hankel(4), sp.Integer(-1), 4)
    assert ratio[1] == -sp.Rational(1, 8)


@pytest.mark.parametrize("y", [0.01, 0.3, 1.0, 2.5, 7.0, 20.0, 100.0])
def test_bound_of_the_quotient_holds(y: float) -> None:
    terms = 6
    plain, fading = theory.quotient_bound(terms)
    with flint.ctx.workprec(400):
        point = arb(y)
        series = sum(fraction(q) * point**-j for j, q in enumerate(theory.lateral_quotient(terms)))
        exact = (2 * point).exp() * point.bessel_k(arb(0)) / point.bessel_i(arb(0)) / arb.pi()
        bound = theory._at(plain, point) + (-point).exp() * theory._at(fading, point)
        assert abs(exact - series) < bound
        assert y < 50 or bound < 30 * abs(exact - series)


def test_bound_of_the_quotient_with_one_term() -> None:
    """The bound is (1 + 1/(2y)) (3 a_1/y + e^-y (4/5 (1 + y) + 3/2)) with a_1 = 1/8."""
    plain, fading = theory.quotient_bound(1)
    assert plain == {-1: Fraction(3, 8), -2: Fraction(3, 16)}
    assert fading == {1: Fraction(4, 5), 0: Fraction(27, 10), -1: Fraction(23, 20)}


@pytest.mark.parametrize("y", [1e-6, 0.01, 0.4, 1.0, 3.0, 30.0])
def test_inequalities_behind_the_bound(y: float) -> None:
    """The lower bound of the scaled I0 and the bounds of its terms of order e^-y hold."""
    with flint.ctx.workprec(200):
        point, half = arb(y), arb(1) / 2
        scaled = (2 * arb.pi() * point).sqrt() * (-point).exp() * point.bessel_i(arb(0))
        assert 1 / scaled <= 1 + 1 / (2 * point)
        # The substitution u = 2 - v^2 removes the square-root singularity at u = 2.
        edge = flint.acb.integral(
            lambda v, _: (
                2 * flint.acb(2).sqrt() * (-point * (2 - v * v)).exp() / (2 - v * v).sqrt()
            ),
            0,
            1,
        ).real
        fading = (point / arb.pi()).sqrt() * edge
        assert fading <= (-point).exp() * (1 + point) * 4 / 5
        cut, limit = arb(0), arb(0)
        for j, a in enumerate(theory.hankel(5)):
            coefficient = fraction(a)
            cut += coefficient * (2 * point).gamma_upper(j + half) / (j + half).gamma() * point**-j
            limit += coefficient * 2**j * point**-j * 3 / 2
        assert cut <= (-point).exp() * limit


@pytest.mark.parametrize("n", [24, 30, 60, 120])
def test_bound_of_the_expansion_holds(n: int) -> None:
    terms = 12
    value = sum(a / sp.ff(n, j) for j, a in enumerate(theory.kappa_steps(terms)))
    with flint.ctx.workprec(200):
        error = abs(reference.kappa_ratio(n, 140) - fraction(value))
        bound = fraction(theory.kappa_bound(n, terms))
        assert error < bound
        assert n < 100 or bound < 1000 * error
    assert theory.kappa_bound(2 * terms - 1, terms) == sp.oo


def test_bounds_decrease_with_the_index() -> None:
    kappas = [theory.kappa_bound(n, 12) for n in (24, 25, 40, 100, 101, 1000)]
    parts = [theory.finite_part_bound(k) for k in (4, 5, 6, 30, 31, 300)]
    for bounds in (kappas, parts):
        assert all(b < a for a, b in pairwise(bounds))


@pytest.mark.parametrize("k", [4, 5, 9, 20, 37])
def test_bound_of_the_finite_part_holds(k: int) -> None:
    limit = theory.finite_part_limit().subs(sp.Symbol("k", positive=True), k)
    with flint.ctx.workprec(300):
        error = reference.finite_part_ratio(k, 200) - fraction(limit)
    bound = fraction(theory.finite_part_bound(k))
    assert 0 < error < bound
    assert k < 9 or bound < 20 * error
    assert theory.finite_part_bound(3) == sp.oo


def test_wrong_coefficient_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    right = theory.lateral_quotient(12)
    wrong = (right[0], -right[1], *right[2:])
    monkeypatch.setattr(theory, "lateral_quotient", lambda _: wrong)
    with pytest.raises(ProofError, match="K0/I0"):
        theory.lateral_constant.__wrapped__(12)


# --- tables and references


def test_switch_points_follow_from_the_bound() -> None:
    assert list(SWITCHES.values()) == [120, 37]
    tolerance = sp.Rational(tables.TOLERANCE)
    assert (
        theory.kappa_bound(119, tables.TERMS) > tolerance >= theory.kappa_bound(120, tables.TERMS)
    )
    assert theory.finite_part_bound(36) > tolerance >= theory.finite_part_bound(37)


def test_trapezoidal_rule_is_more_accurate_than_double_precision() -> None:
    """The relative error is below 2^-_WARRANTED, which the rounding of the tables requires."""
    assert tables._TABLE_BITS >= 90
    limit = arb(2) ** -tables._TABLE_BITS
    with flint.ctx.workprec(200):
        for n in (0, 1, 2, 11, 64, 130, LAST_N):
            assert abs(tables.kappas()[n] / reference.kappa(n, BITS) - 1) < limit, n
        for k in (2, 3, 4, 11, 40, LAST_K):
            assert abs(tables.finite_parts()[k - 2] / reference.finite_part(k, BITS) - 1) < limit, k


def test_generated_steps_equal_those_of_the_theory() -> None:
    """The steps are compared directly because the last ones change no rounded value."""
    expected = [float(a) for a in theory.kappa_steps(tables.TERMS)]
    assert list(generated.series_numbers.KAPPA_STEPS) == expected


def test_table_that_ends_too_early_is_rejected() -> None:
    with pytest.raises(ArithmeticError, match="largest double"):
        tables._doubles(tables.kappas()[:50])


def test_tables_are_reproducible() -> None:
    first = tables.tables()
    tables.tables.cache_clear()
    assert tables.tables() == first


@pytest.mark.parametrize("n", [17, 20, 31])
def test_integral_around_the_peak_equals_the_plain_integral(n: int) -> None:
    assert reference.kappa(n, 120).overlaps(contact_balls.kappa(n, 35))


def test_integral_around_the_peak_of_finite_parts_equals_the_plain_one() -> None:
    for k in (67, 75):
        assert reference.finite_part(k, 120).overlaps(contact_balls.finite_part(k, 35))


def test_result_has_the_requested_precision() -> None:
    for bits in (60, 150):
        for n in (3, 30, 10**5):
            assert reference.kappa_ratio(n, bits).rel_accuracy_bits() >= bits
            assert reference.finite_part_ratio(n, bits).rel_accuracy_bits() >= bits
        assert reference.kappa(30, bits).rel_accuracy_bits() >= bits
    for number in (reference.kappa_ratio, reference.kappa):
        with pytest.raises(ValueError, match="from 0"):
            number(-1, 60)
    with pytest.raises(ValueError, match="from 2"):
        reference.finite_part(1, 60)


def test_scaled_bessel_function_of_a_wide_ball_contains_its_values() -> None:
    """The slope at the left end bounds the change in the ball; the largest change is near it."""
    draw = np.random.default_rng(7)
    ratios = []
    for _ in range(300):
        size = 10 ** draw.uniform(-3, 2)
        middle = size * complex(draw.uniform(-0.2, 1), draw.uniform(-1, 1))
        width = min(size, 3.0) * 10 ** draw.uniform(-3, 0)
        corners = [complex(a, b) * width for a in (-1, 1) for b in (-1, 0, 1)]
        wide = flint.acb(middle) + flint.acb(arb(0, width), arb(0, width))
        found = contact_balls.scaled_i0(wide)
        for corner in corners:
            point = flint.acb(middle + corner)
            value = (-point).exp() * point.bessel_i(0)
            assert found.overlaps(value)
            change = abs(value - contact_balls.scaled_i0(flint.acb(middle)))
            ratios.append(float(change.mid()) / float(found.real.rad()))
    assert 0.5 < max(ratios) <= 1.0
