"""Truncation and rounding told apart: each way to it is held to independent truth."""

import math
from dataclasses import replace

import flint
import numpy as np
import pytest
from flint import arb

from derivation.mathematics.bessel import oracle as zeros
from derivation.plate.benchmark import (
    headline,
    inversion,
    law_generated,
    law_sums,
    motion,
    stepping,
)
from derivation.plate.benchmark.arithmetic import HAS_LONG, LONG, BallArithmetic, as_ball
from derivation.plate.benchmark.by_series import LONG_NUMBERS, duration
from derivation.plate.benchmark.collocation import radau_step
from derivation.plate.benchmark.errors import BenchmarkErrors, digits, judge
from derivation.plate.benchmark.far_zeros import far_zeros
from derivation.plate.benchmark.interface import PAPER, REGIMES, Method, deepest
from derivation.plate.benchmark.problems import Problem, problem
from derivation.plate.benchmark.reference_law import DeepLaw, sure_law
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import sums as contact_sums
from derivation.plate.impact.oracle import impact as contact_impact

needs_long = pytest.mark.skipif(not HAS_LONG, reason="long double is a double")

THIN, LARGE = REGIMES[0], REGIMES[4]
MOST = 40


def law_problem(regime, radii) -> Problem:
    truths = [contact_balls.indentation(float(a), regime.R, regime.h, regime.b, MOST)
              for a in radii]  # fmt: skip
    return Problem("law", regime, np.array(radii), tuple(truths), MOST, np.full(5, radii[0]))


@pytest.fixture(scope="module")
def bounced() -> Problem:
    """The paper's impact."""
    p = PAPER
    found = contact_impact.impact(p.R, p.m, p.speed, p.h, p.b, p.lam, p.mu, 30)
    return Problem("impact", p, np.array([p.speed]), (found.contact_time,), 30, np.full(5, 0.9))


@pytest.fixture(scope="module")
def deep() -> Problem:
    """The impact of large contacts."""
    r, speeds = LARGE, np.array([LARGE.speed])
    found = contact_impact.impact(r.R, r.m, r.speed, r.h, r.b, r.lam, r.mu, 32)
    return Problem("impact", r, speeds, (found.contact_time,), 32, speeds)


def judged(method: Method, task: Problem) -> BenchmarkErrors:
    """Errors whose parts are known and add up."""
    found = judge(method, task, lambda: 0.0).errors
    assert found.unsplit is None
    assert found.truncation is not None
    assert found.rounding is not None
    parts = 10**-found.truncation, 10**-found.rounding
    assert 10**-found.total <= 1.01 * sum(parts)
    assert 10**-found.total >= 0.99 * abs(parts[0] - parts[1])
    return found


# --- sums of many modes


@needs_long
@pytest.mark.parametrize("number", [1001, 5000, 123_457, 20_000_000])
def test_far_zeros_are_the_certified_ones(number: int) -> None:
    with flint.ctx.workprec(96):
        j, slope = far_zeros(number - 1, number, LONG.array(arb.pi()))
    with flint.ctx.workprec(160):
        assert digits(j[0], zeros.j0_zero(number, 120), 30) > 18.5
        assert digits(slope[0], zeros.j1_at_zero(number, 120), 30) > 18.5


def test_zeros_that_are_not_far_are_refused() -> None:
    with pytest.raises(ValueError, match="beyond number 1000, got number 31"):
        far_zeros(30, 40, np.float64(np.pi))


@needs_long
@pytest.mark.parametrize("modes", [300, 1500])
def test_a_sum_in_long_doubles_is_that_in_balls(modes: int) -> None:
    radii = PAPER.h * np.array([0.01, 0.1, 0.3])
    exact = law_sums._direct(BallArithmetic(40), modes, False)(PAPER)(radii)
    found = law_sums._direct(LONG, modes, False)(PAPER)(radii)
    with flint.ctx.workprec(160):
        assert min(map(digits, found, exact, [30] * 3)) > 18


@needs_long
def test_a_direct_sum_of_many_modes_is_split_as_balls_split_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    task = law_problem(PAPER, PAPER.h * np.array([0.05, 0.3]))
    found = judged(law_sums.direct(1500), task)
    monkeypatch.setattr(law_sums, "DIRECT_MODES", 1500)
    again = judged(law_sums.direct(1500), task)
    assert found.truncation == pytest.approx(again.truncation, abs=1e-9)
    assert found.rounding == pytest.approx(again.rounding, abs=0.02)
    assert found.truncation == pytest.approx(found.total, abs=1e-6)
    assert found.rounding > 14.5


@needs_long
def test_the_headlines_sums_in_long_doubles_are_those_in_balls(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(headline, "CHUNK", 1024)
    monkeypatch.setattr(headline, "BLOCK", 512)
    a = deepest(PAPER)
    found = headline.long_sums(PAPER, a, 1536)
    true = contact_balls.indentation(a, PAPER.R, PAPER.h, PAPER.b, 30)
    partial, times, _ = headline.direct(PAPER, a, 2048)
    reached = tuple(headline.Reached(6, modes, 1.0) for modes in (512, 1024, 1536))
    told = headline.told_apart(PAPER, a, true, reached, partial)
    with flint.ctx.workprec(160):
        for each in told:
            (exact,) = law_sums._direct(BallArithmetic(40), each.modes, False)(PAPER)(np.array([a]))
            block = each.modes // 512 - 1
            assert digits(found[block], exact, 30) > 17.5
            assert each.truncation == pytest.approx(digits(exact, true, 30), abs=1e-9)
            assert each.rounding == pytest.approx(digits(partial[block], exact, 30), abs=0.01)
    assert len(times) == len(partial) == 4


def test_a_split_sum_of_a_thin_plate_leaves_out_the_modes_that_follow() -> None:
    """With nodes enough, truncation is the sum of the modes from b/h on: G - 1 = 4 e^(-2T) ..."""
    task = law_problem(THIN, [0.5 * THIN.h])
    found = judged(law_sums.split(64, 1), task)
    modes = law_sums.modes_of(THIN, 1)
    assert modes == 1000
    left_out = arb(0)
    with flint.ctx.workprec(160):
        a, R, h, b = (arb(x) for x in (task.points[0], THIN.R, THIN.h, THIN.b))
        for n in range(modes + 1, 4 * modes):
            j, slope = zeros.j0_zero(n, 100), zeros.j1_at_zero(n, 100)
            T, y = 2 * j * h / b, a * j / b
            excess = 4 * (-2 * T).exp() * ((1 - (-2 * T).exp()) / 2 + T + T * T)
            excess /= (1 - (-2 * T).exp()) ** 2 - 4 * T * T * (-2 * T).exp()
            share = (y.sin() - y * y.cos()) / (j**4 * slope**2)
            left_out += 8 * b * b / (arb.pi() * R) * excess * share
        expected = -math.log10(abs(float(left_out / task.truths[0])))
    assert found.truncation == pytest.approx(expected, abs=1e-6)
    assert found.truncation < 14 < found.rounding


def test_a_thin_split_may_truncate_less_than_long_doubles_tell() -> None:
    found = judged(law_sums.split(48, 4), law_problem(THIN, [0.02 * THIN.h, THIN.h]))
    assert found.truncation > 22
    assert found.rounding == pytest.approx(found.total, abs=1e-6)


# --- steps


@needs_long
def test_a_radau_step_is_its_stability_function() -> None:
    """For x'' = -w^2 x it is (1 + 2z/5 + z^2/20)/(1 - 3z/5 + 3z^2/20 - z^3/60) at z = i w h."""
    w, length = 3.0, 0.25
    state = LONG.array([0.5, 1.25])

    def rate(y):
        return np.array([y[1], -w * w * y[0]])

    found, slope, output = radau_step(state, rate(state), LONG.array(length), rate)
    with flint.ctx.workprec(160):
        z = flint.acb(0, w * length)
        factor = (1 + 2 * z / 5 + z**2 / 20) / (1 - 3 * z / 5 + 3 * z**2 / 20 - z**3 / 60)
        # x + v/(i w) turns by the factor.
        turned = flint.acb(0.5, -arb(1.25) / w) * factor
        assert digits(found[0], turned.real, 30) > 18
        assert digits(found[1], -w * turned.imag, 30) > 18
    np.testing.assert_array_equal(slope, rate(found))
    # The cubic goes through both ends and collocates at the end.
    np.testing.assert_array_equal(output(LONG.array(0.0)), state)
    np.testing.assert_allclose(output(LONG.array(1.0)), found, rtol=1e-18)
    nudge = LONG.array(1e-6)
    steep = (output(1 + nudge) - output(1 - nudge)) / (2 * nudge * length)
    np.testing.assert_allclose(steep.astype(float), slope.astype(float), rtol=1e-9)


@needs_long
def test_radau_steps_of_half_the_length_err_32_times_less() -> None:
    """By a force that is not linear: x'' = -x^(3/2), its first integral v^2/2 + 2 x^(5/2)/5."""

    def rate(y):
        return np.array([y[1], -(y[0] ** LONG.array(1.5))])

    def miss(count: int) -> float:
        state = LONG.array([1.0, 0.5])
        for _ in range(count):
            state, _, _ = radau_step(state, rate(state), LONG.array(0.5) / count, rate)
        energy = state[1] ** 2 / 2 + 2 * state[0] ** LONG.array(2.5) / 5
        return abs(float(energy - LONG.array(0.125) - LONG.array(2.0) / 5))

    errors = [miss(count) for count in (4, 8, 16)]
    assert errors[0] / errors[1] == pytest.approx(32, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(32, rel=0.1)


def test_equations_that_are_not_solved_are_no_number() -> None:
    def rate(y):
        return np.array([y[1], np.nan * y[0]])

    with pytest.raises(ArithmeticError, match="not solved"):
        radau_step(LONG.array([1.0, 1.0]), LONG.array([1.0, 0.0]), LONG.array(0.1), rate)


@needs_long
@pytest.mark.parametrize("share", [None, 0.05])
def test_radaus_truncation_is_its_error_and_falls_with_the_tolerance(
    bounced: Problem, share: float | None
) -> None:
    found = [judged(stepping.solver("Radau", rtol, share), bounced) for rtol in (1e-4, 1e-6, 1e-8)]
    for each in found:
        assert each.truncation == pytest.approx(each.total, abs=0.15)
        assert each.rounding > each.truncation + 0.4
        assert "Newton" in (each.remark or "")
    truncation = [each.truncation or 0.0 for each in found]
    assert truncation[0] + 1 < truncation[1] < truncation[2] - 1
    fine = judged(stepping.solver("Radau", 1e-12, share), bounced)
    assert fine.truncation == pytest.approx(fine.total, abs=0.1)
    assert fine.rounding > 15


@needs_long
def test_steps_on_large_contacts_are_repeated_too(deep: Problem) -> None:
    for method in (stepping.solver("DOP853", 1e-9), stepping.solver("Radau", 1e-6)):
        found = judged(method, deep)
        assert found.truncation == pytest.approx(found.total, abs=0.1)
        assert found.rounding > found.truncation + 1


def test_the_spread_of_numbers_is_their_mean_and_deviation() -> None:
    found = stepping.spread([arb(1), arb(2), arb(3)])
    assert float(found.mid()) == 2
    assert float(found.rad()) == pytest.approx(1)


@needs_long
def test_the_estimate_of_rounding_is_what_repeated_steps_say(
    bounced: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a solver of which both can be had, and steps that rounding does not choose."""
    repeated = judged(stepping.solver("DOP853", 1e-12), bounced)
    monkeypatch.delitem(stepping.REPEATED, "DOP853")
    estimated = judged(stepping.solver("DOP853", 1e-12), bounced)
    assert estimated.truncation == pytest.approx(repeated.truncation, abs=0.01)
    assert estimated.rounding == pytest.approx(repeated.rounding, abs=1)


def test_lsodas_rounding_is_estimated_and_said_to_be(bounced: Problem) -> None:
    found = [judged(stepping.solver("LSODA", rtol), bounced) for rtol in (1e-6, 1e-9, 1e-12)]
    for each in found:
        assert each.truncation == pytest.approx(each.total, abs=0.01)
        assert each.rounding > 13.5
        assert (each.remark or "").startswith("an estimate")
    assert judged(stepping.solver("LSODA", 1e-9), bounced) == found[1]


def test_a_force_of_fewer_bits_is_seen_as_rounding(
    bounced: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The spread must rise with the unit in the last place of what the solver is given."""
    exact = stepping.scalar_force

    def short(regime):
        force = exact(regime)
        return lambda x: float(np.float32(force(x)))

    monkeypatch.setattr(stepping, "scalar_force", short)
    found = judged(stepping.solver("LSODA", 1e-6), bounced)
    assert 6.5 < (found.rounding or 0.0) < 9.5


# --- the law that stands for the exact one


@pytest.mark.parametrize(("ar", "least"), [(LONG, 17), (LONG_NUMBERS, 38)], ids=["long", "mpmath"])
def test_the_law_of_large_contacts_is_the_oracles(ar, least: float) -> None:
    if ar is LONG and not HAS_LONG:
        pytest.skip("long double is a double")
    r = LARGE
    law = sure_law(r, ar)
    assert isinstance(law, DeepLaw)
    a = deepest(r) * np.array([0.01, 0.3, 1.0])
    with ar.context():
        A = ar.array(a) / ar.array(r.h)
        lift, slope, work = law.lift(A), law.slope(A), law.work(A)
    for k, radius in enumerate(a.tolist()):
        depth = contact_balls.indentation(radius, r.R, r.h, r.b, 45)
        steep = contact_balls.slope(radius, r.R, r.h, r.b, 45)
        energy = contact_impact.stored_energy(radius, r.R, r.h, r.b, r.lam, r.mu, 45)
        with flint.ctx.workprec(200):
            first, second = arb(radius), arb(r.R)
            hertz = 8 * contact_balls.modulus(r.lam, r.mu) * first**5 / (15 * second**2)
            assert digits(lift[k], depth * second / first**2, 45) > least
            assert digits(slope[k], steep * second / (2 * first), 45) > least
            assert digits(work[k], energy / hertz, 45) > least


def test_the_time_on_the_law_of_large_contacts_is_the_oracles(deep: Problem) -> None:
    (found,) = duration(56, sure_law, LONG_NUMBERS)(LARGE)(deep.points)
    with flint.ctx.workprec(160):
        assert digits(as_ball(found), deep.truths[0], 32) > 30


def test_tables_quadrature_and_fixed_steps_are_split_on_large_contacts(deep: Problem) -> None:
    task = problem("inversion", LARGE, True)
    for method, where in (
        (inversion.table(64), task), (motion.gauss(8), deep), (stepping.verlet(20), deep),
    ):  # fmt: skip
        found = judged(method, where)
        assert found.truncation == pytest.approx(found.total, abs=1e-3)


def test_what_no_law_stands_for_says_why() -> None:
    thin = replace(LARGE, h=1e-5, speed=1e-4)
    deep = deepest(thin) / thin.h
    assert 0.6 < deep < 6
    with pytest.raises(NotImplementedError, match="thin a plate"):
        sure_law(thin)


# --- balls


def test_a_balls_radius_is_rounding_whatever_is_left_out(
    bounced: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the bounds of what is left out the radii are the same."""
    p, depth = PAPER, 1e-4
    made = contact_sums._panels

    def computed(digits: int) -> list[arb]:
        return [
            contact_balls.indentation(p.high * p.h, p.R, p.h, p.b, digits),
            contact_balls.contact_radius(depth, p.R, p.h, p.b, digits),
            contact_impact.impact(p.R, p.m, p.speed, p.h, p.b, p.lam, p.mu, digits).contact_time,
        ]

    whole = computed(30)
    asked = []

    def without(*arguments):
        panels, _ = made(*arguments)
        asked.append(arguments)
        return tuple(panel._replace(bound=arb(0)) for panel in panels), arb(0)

    monkeypatch.setattr(contact_sums, "_panels", without)
    interpolated, interpolants = contact_impact._slope_polynomial, []

    def of_values(alpha, eta):
        """The interpolant, and what rounding of its values alone makes it wrong by."""
        polynomial, error = interpolated(alpha, eta)
        root, rate = contact_impact._size(float(alpha), float(eta))
        bound = contact_impact._ellipse_bound(alpha, arb(float(eta)), arb(rate) * (1 + 1e-12))
        missed = 4 * bound * arb(root) ** (-2 * polynomial.degree()) / (arb(root) ** 2 - 1)
        assert missed < error
        interpolants.append(missed)
        return polynomial, (error - missed).abs_upper()

    monkeypatch.setattr(contact_impact, "_slope_polynomial", of_values)
    for ball, bare in zip(whole, computed(30), strict=True):
        assert float(bare.rad() / ball.rad()) == pytest.approx(1, rel=1e-6)
    assert asked
    assert interpolants
    monkeypatch.undo()
    found = judge(motion.oracle(30), replace(bounced, digits=30), lambda: 0.0).errors
    assert (found.truncation, found.unsplit) == (None, None)
    assert found.rounding == found.total > 30
    law = judge(law_generated.oracle(30), law_problem(PAPER, [0.01]), lambda: 0.0).errors
    assert law.rounding == law.total > 30
