"""Test the compared methods against references, and the split into truncation and rounding."""

import math
from dataclasses import replace

import flint
import numpy as np
import pytest
from flint import arb

from derivation.mathematics.bessel import oracle as zeros
from derivation.plate.benchmark import (
    errors,
    inversion,
    laws,
    motion,
    polynomials,
    problems,
    ready_methods,
    sums,
)
from derivation.plate.benchmark.arithmetic import (
    DOUBLE,
    HAS_LONG_DOUBLE,
    LONG_DOUBLE,
    SINGLE,
    BallArithmetic,
    Mpmath,
    as_ball,
    exact_for,
)
from derivation.plate.benchmark.catalogue import NODES, methods
from derivation.plate.benchmark.coefficients import coefficients
from derivation.plate.benchmark.errors import BenchmarkErrors, digits, measure_errors
from derivation.plate.benchmark.interface import CASES, PAPER, Method, largest_contact_radius
from derivation.plate.benchmark.problems import Problem
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import sums as contact_sums
from derivation.plate.impact.oracle import impact as contact_impact
from generated.contact_law import force, indentation
from generated.impact import impact

needs_long = pytest.mark.skipif(not HAS_LONG_DOUBLE, reason="long double is a double")
THIN, THICK, LARGE = CASES[0], CASES[2], CASES[4]
RADII = np.array([0.002, 0.01, 0.03])


@pytest.fixture(scope="module")
def law() -> Problem:
    """Return the problem of the paper's law at three radii."""
    reference_values = [
        contact_balls.indentation(float(a), PAPER.R, PAPER.h, PAPER.b, 40) for a in RADII
    ]
    return Problem("law", PAPER, RADII, tuple(reference_values), 40, np.full(50, 0.01))


@pytest.fixture(scope="module")
def inverse() -> Problem:
    """Return the inversion problem of the thick plate at two indentations."""
    depths = np.array([1e-4, 0.1])
    actual = [contact_balls.contact_radius(d, THICK.R, THICK.h, THICK.b, 40) for d in depths]
    with flint.ctx.workprec(160):
        stiffness = 4 * contact_balls.modulus(THICK.lam, THICK.mu) / (3 * arb(THICK.R))
        forces = [stiffness * a**3 for a in actual]
    return Problem("inversion", THICK, depths, tuple(forces), 38, np.full(50, 0.01))


def bounce(case) -> Problem:
    r, speeds = case, np.array([case.speed])
    result = contact_impact.impact(r.R, r.m, r.speed, r.h, r.b, r.lam, r.mu, 32)
    return Problem("impact", r, speeds, (result.contact_time,), 32, speeds)


@pytest.fixture(scope="module")
def rebound() -> Problem:
    """Return the problem of the paper's impact."""
    return bounce(PAPER)


@pytest.fixture(scope="module")
def wide() -> Problem:
    """Return the problem of the impact with a large contact."""
    return bounce(LARGE)


def checked(method: Method, task: Problem) -> BenchmarkErrors:
    """Return the errors, and check that both parts are known and add up to the total."""
    with np.errstate(all="ignore"):
        actual = measure_errors(method, task, lambda: 0.0).errors
    assert actual.unsplit is None
    assert actual.truncation is not None
    assert actual.rounding is not None
    assert 10**-actual.total <= 1.05 * (10**-actual.truncation + 10**-actual.rounding)
    return actual


# --- arithmetics


@pytest.mark.parametrize(
    ("ar", "right"),
    [
        (SINGLE, 6),
        (DOUBLE, 14.5),
        (Mpmath(30), 29),
        (LONG_DOUBLE, 17.5 if HAS_LONG_DOUBLE else 14.5),
    ],
    ids=lambda ar: getattr(ar, "name", ""),
)
def test_arithmetics_agree_with_interval_arithmetic(ar, right: float) -> None:
    exact, given = BallArithmetic(60), np.array([1e-3, 0.3, 1.5, 1.7, 5.0])
    with ar.context(), exact.context():
        y = ar.array(given)
        balls = exact.array([as_ball(x) for x in y])
        for name in ("shape", "lateral_shape", "excess"):
            values, reference = getattr(ar, name)(y), getattr(exact, name)(balls)
            assert min(map(digits, values, reference, [60] * len(y))) > right, name
        turned = [as_ball(x.imag) for x in ar.complex_shape(y)]
        assert min(map(digits, turned[1:], exact.shape(balls)[1:], [60] * 4)) > right - 1.5


@pytest.mark.parametrize("number", [3, 1001, 123_457, 20_000_000])
@pytest.mark.parametrize(
    "ar", [DOUBLE, pytest.param(LONG_DOUBLE, marks=needs_long)], ids=lambda ar: ar.name
)
def test_zeros_agree_with_certified_ones(ar, number: int) -> None:
    (j,), (slope,) = ar.zeros(number, number - 1)
    with flint.ctx.workprec(160):
        least = ar.digits - 1.3
        assert digits(j, zeros.j0_zero(number, 120), 30) > least
        assert digits(slope, zeros.j1_at_zero(number, 120), 30) > least


def test_constants_of_long_doubles_have_full_precision() -> None:
    for ar in [Mpmath(30), *([LONG_DOUBLE] if HAS_LONG_DOUBLE else [])]:
        (actual,) = sums.split(72, 6, ar).prepared(PAPER)(RADII[-1:])
        reference = contact_balls.indentation(0.03, PAPER.R, PAPER.h, PAPER.b, 40)
        with flint.ctx.workprec(160):
            assert digits(actual, reference, 40) > min(ar.digits - 2, 27)


def test_single_precision_is_kept() -> None:
    for method in methods():
        if method.arithmetic == "float32" and method.fails(PAPER) is None:
            point = {"law": 0.01, "inversion": 1e-4, "impact": 1.0}[method.task]
            assert method.prepared(PAPER)(np.array([point])).dtype == np.float32, method.name


# --- parts of methods


@pytest.mark.parametrize(("h", "order"), [(0.1, 1), (0.01, 5), (0.45, 23)])
def test_coefficients_agree_with_the_reference(h: float, order: int) -> None:
    """The coefficients agree with the reference to 1e-30 of the sum at a/h = 0.5."""
    actual = coefficients(replace(PAPER, h=h, speed=1e-3), 12, 30)[order // 2]
    reference = contact_balls.coefficient(order, h, 1.0, 32)
    with flint.ctx.workprec(160):
        assert abs(actual - reference) / 2**order < 1e-30


@pytest.mark.parametrize("double_exponential", [True, False])
def test_both_quadrature_rules_give_the_moments(double_exponential: bool) -> None:
    """The nodes and weights, which include 1/y^3, integrate y^n K0/I0 as the Arb reference does."""
    nodes, weights = sums.lateral_nodes(64, 16, double_exponential, 120)
    y, w = (np.array([float(x) for x in column]) for column in (nodes, weights))
    for n in (0, 2, 4):
        reference = float(contact_balls.kappa(n, 20))
        off = abs((w * y ** (n + 3)).sum() / reference - 1)
        assert off < (1e-13 if double_exponential else 1e-8)  # limited by the logarithm of K0 at 0


def test_levin_transformation_sums_an_alternating_series() -> None:
    n = np.arange(1, 13.0)
    terms = (-1) ** (n + 1) / n
    actual = sums.u_transform(np.cumsum(terms) + 0j, n * terms + 0j, n)
    assert actual.real == pytest.approx(math.log(2), rel=1e-10)


@pytest.mark.parametrize("case", [THIN, PAPER, THICK, LARGE], ids=lambda r: r.name)
def test_force_in_plain_python_agrees_with_the_generated_code(case) -> None:
    r, scalar = case, motion.scalar_force(case)
    depths = indentation(np.array([1e-3, 0.1, 0.5, 1.0]) * r.h * min(r.high, 5.5), r.R, r.h, r.b)
    expected = force(depths, r.R, r.h, r.b, r.lam, r.mu)
    np.testing.assert_allclose([scalar(float(d)) for d in depths], expected, rtol=1e-13)
    assert scalar(0.0) == scalar(-1.0) == 0.0


@pytest.mark.parametrize("case", CASES[:4], ids=lambda r: r.name)
def test_series_agree_with_the_generated_inverse_and_impact(case) -> None:
    r, top = case, largest_contact_radius(case)
    depths = indentation(top * np.array([0.01, 0.3, 1.0]), r.R, r.h, r.b)
    expected = force(depths, r.R, r.h, r.b, r.lam, r.mu)
    speeds = r.speed * np.array([0.5, 1.0])
    times = impact(r.R, r.m, speeds, r.h, r.b, r.lam, r.mu).contact_time
    for ar, tolerance in ((SINGLE, 2e-6), (DOUBLE, 3e-15)):
        actual = laws.newton(20, ar).prepared(case)(depths)
        np.testing.assert_allclose(actual, expected, rtol=tolerance)
        actual = laws.gauss(24, 20, ar).prepared(case)(speeds)
        np.testing.assert_allclose(actual, times, rtol=tolerance)
    assert laws.diverges(LARGE)


def test_integration_without_enough_steps_gives_nan(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(motion, "MOST_STEPS", 20)
    assert np.isnan(motion.verlet(100).prepared(PAPER)(np.array([1.0]))).all()


# --- the law used as exact reference


@pytest.mark.parametrize("case", [THIN, PAPER, LARGE], ids=lambda r: r.name)
def test_complete_series_agrees_with_the_reference(case) -> None:
    r, ar = case, exact_for(DOUBLE)
    a = largest_contact_radius(case) * np.array([0.01, 0.3, 1.0])
    with ar.context():
        law, A = laws.SeriesLaw(r, ar), ar.array(a) / ar.number(r.h)
        lift, slope = law.lift(A), law.slope(A)
        time = law.duration(56, ar)(ar.array(np.array([r.speed])))[0]
    for k, radius in enumerate(a.tolist()):
        depth = contact_balls.indentation(radius, r.R, r.h, r.b, 45)
        steep = contact_balls.slope(radius, r.R, r.h, r.b, 45)
        with flint.ctx.workprec(200):
            first, second = arb(radius), arb(r.R)
            assert digits(lift[k], depth * second / first**2, 45) > 37
            assert digits(slope[k], steep * second / (2 * first), 45) > 37
    assert digits(time, bounce(r).reference_values[0], 32) > 30


def test_law_that_would_take_minutes_is_rejected() -> None:
    thin = replace(LARGE, h=1e-5, speed=0.003)
    assert largest_contact_radius(thin) / thin.h > 4
    with pytest.raises(NotImplementedError, match="thin a plate takes minutes"):
        laws.SeriesLaw(thin, exact_for(DOUBLE))


def test_law_of_the_paper_agrees_with_another_reference_to_many_digits(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(problems, "MANY_DIGITS", 40)
    monkeypatch.setattr(problems, "ARRAY", 50)
    set_task = problems.problem("law", PAPER, quick=False)
    assert set_task.digits == 40
    for a, value in list(zip(set_task.points, set_task.reference_values, strict=True))[:3]:
        reference = contact_balls.indentation(float(a), PAPER.R, PAPER.h, PAPER.b, 42)
        assert digits(value, reference, 50) > 39


# --- truncation and rounding

SPLITS = {
    "law": (
        (sums.direct(100), 0.2, 15),
        (sums.direct(1000, SINGLE), 1.8, 6.8),
        (sums.split(16, 2), 8.2, 15),
        (sums.split(48, 4, SINGLE), 11.2, 6.8),
        (sums.split(NODES[30], 6, Mpmath(30)), 31.5, 33.2),
        (sums.split(NODES[30], 6, BallArithmetic(30)), 31.5, 34.8),
        (sums.levin(4), 6, 15),
        (polynomials.small_contacts(1), 3.2, 15.2),
        (polynomials.small_contacts(4), 10.7, 15.2),
        (polynomials.small_contacts(4, Mpmath(50)), 10.7, 40),
        (polynomials.small_contacts(4, BallArithmetic(50)), 10.7, 40),
        (polynomials.chebyshev(2), 9.8, 15.2),
        (polynomials.chebyshev(6, SINGLE), 21.4, 7),
        (polynomials.table(3), 12.8, 15),
    ),
    "inversion": (
        (ready_methods.hertz("inversion"), 1, 15),
        (inversion.reversed_series(12), 6.1, 15),
        (inversion.reversed_series(12, SINGLE), 6.1, 6.5),
        (inversion.table(64), 7.5, 14.3),
        (laws.newton(4), 7.8, 15),
        (laws.newton(4, SINGLE), 7.8, 6),
    ),
    "impact": (
        (ready_methods.hertz("impact"), 0.5, 15.3),
        (motion.linear(25), 0.8, 15.5),
        (motion.gauss(8), 8.2, 15.3),
        (laws.gauss(8, 12), 8.2, 15.3),
        (laws.gauss(8, 12, SINGLE), 8.2, 7),
        (motion.solver("DOP853", 1e-6), 7.0, 14.5),
        (motion.solver("Radau", 1e-6), 8.8, 15),
        (motion.solver("LSODA", 1e-6), 6.0, 15),
        (motion.verlet(20), 3.3, 15.3),
        (motion.verlet(20, ar=SINGLE), 3.3, 7),
    ),
}
"""Methods with their approximate numbers of correct digits: truncation, rounding."""


@pytest.mark.parametrize("task", SPLITS)
def test_truncation_and_rounding_are_separated(task: str, law, inverse, rebound) -> None:
    where = {"law": law, "inversion": inverse, "impact": rebound}[task]
    for method, truncation, rounding in SPLITS[task]:
        evaluation = checked(method, where)
        assert evaluation.truncation == pytest.approx(truncation, abs=0.8), method.name
        assert evaluation.rounding == pytest.approx(rounding, abs=1.5), method.name
        assert bool(evaluation.remark) == (method.split == "units")


@needs_long
def test_truncation_in_long_doubles_equals_that_in_more_digits(law: Problem) -> None:
    task = replace(law, points=RADII[1:], reference_values=law.reference_values[1:])
    method = sums.direct(1500)
    assert method.split == "long"
    evaluation, again = checked(method, task), checked(replace(method, split="wide"), task)
    assert evaluation.truncation == pytest.approx(again.truncation, abs=1e-9)
    assert evaluation.rounding == pytest.approx(again.rounding, abs=0.02)


def test_separation_by_units_agrees_with_separation_by_digits(law, inverse, rebound) -> None:
    """Splitting errors by other units or by more digits gives the same parts.

    If truncation is below rounding, the estimate is only a bound.
    """
    for method, where in (
        (sums.split(16, 2), law), (polynomials.small_contacts(4), law),
        (polynomials.small_contacts(16), law), (inversion.reversed_series(12), inverse),
        (laws.newton(4, SINGLE), inverse), (motion.gauss(8), rebound),
    ):  # fmt: skip
        exact, estimate = checked(method, where), checked(replace(method, split="units"), where)
        assert estimate.rounding == pytest.approx(exact.rounding, abs=1.2), method.name
        seen = min(exact.truncation, exact.rounding)
        assert estimate.truncation == pytest.approx(seen, abs=1.2), method.name
        if exact.truncation < exact.rounding - 2:
            assert estimate.truncation == pytest.approx(exact.truncation, abs=0.01)


def test_force_with_fewer_bits_counts_as_rounding(rebound, monkeypatch) -> None:
    exact = motion.scalar_force

    def short(case):
        force = exact(case)
        return lambda x: float(np.float32(force(x)))

    monkeypatch.setattr(motion, "scalar_force", short)
    assert 6.3 < checked(motion.solver("LSODA", 1e-6), rebound).rounding < 9.5


@pytest.mark.parametrize("name", ["DOP853", "Radau", "LSODA"])
def test_truncation_of_a_solver_decreases_with_its_tolerance(rebound, wide, name: str) -> None:
    for where in (rebound, wide):
        loose, tight = (checked(motion.solver(name, rtol), where) for rtol in (1e-6, 1e-9))
        assert loose.truncation + 1.5 < tight.truncation < tight.rounding
        assert loose.truncation == pytest.approx(loose.total, abs=0.05)


def test_spread_has_mean_and_standard_deviation() -> None:
    actual = errors.spread([arb(1), arb(2), arb(3)])
    assert float(actual.mid()) == 2
    assert float(actual.rad()) == pytest.approx(1)


def test_unseparated_errors_have_a_reason(rebound, monkeypatch) -> None:
    monkeypatch.setattr(errors, "HAS_LONG_DOUBLE", False)
    actual = errors.separated_errors(sums.direct(2000), replace(rebound, points=RADII[:1]), [1.0])
    assert (actual.truncation, actual.rounding) == (None, None)
    assert "long double" in (actual.unsplit or "")


def test_methods_without_truncation_have_only_rounding(inverse) -> None:
    actual = measure_errors(ready_methods.generated_force(), inverse, lambda: 0.0).errors
    assert (actual.truncation, actual.rounding) == (None, actual.total)
    assert actual.total > 14.5


def test_digits_of_nan_and_of_exact_values() -> None:
    one = arb(1)
    assert digits(math.nan, one, 30) == -math.inf
    assert digits(1.0, one, 30) == 30
    assert digits(1.001, one, 30) == pytest.approx(3, abs=0.01)


# --- Arb intervals


def test_radius_of_an_interval_is_rounding(rebound, monkeypatch) -> None:
    """The radius of an interval is unchanged without the bounds of omitted terms."""
    p, made, called_with = PAPER, contact_sums._panels, []

    def computed() -> list[arb]:
        return [
            contact_balls.indentation(p.high * p.h, p.R, p.h, p.b, 30),
            contact_balls.contact_radius(1e-4, p.R, p.h, p.b, 30),
        ]

    def without(*arguments):
        panels, _ = made(*arguments)
        called_with.append(arguments)
        return tuple(panel._replace(bound=arb(0)) for panel in panels), arb(0)

    whole = computed()
    monkeypatch.setattr(contact_sums, "_panels", without)
    for ball, bare in zip(whole, computed(), strict=True):
        assert float(bare.rad() / ball.rad()) == pytest.approx(1, rel=1e-6)
    assert called_with
    monkeypatch.undo()
    actual = measure_errors(ready_methods.arb_reference("impact", 30), rebound, lambda: 0.0).errors
    assert actual.truncation is actual.unsplit is None
    assert actual.rounding == actual.total > 30
