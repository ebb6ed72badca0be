"""Methods compared: their arithmetics, their digits, and how these split, by independent truth."""

import math
from dataclasses import replace

import flint
import numpy as np
import pytest

from derivation.plate.benchmark import (
    by_series,
    inversion,
    law_generated,
    law_series,
    law_sums,
    levin,
    motion,
    panels,
    problems,
    stepping,
)
from derivation.plate.benchmark.arithmetic import (
    DOUBLE,
    HAS_LONG,
    LONG,
    SINGLE,
    BallArithmetic,
    Mpmath,
    as_ball,
)
from derivation.plate.benchmark.catalogue import NODES, methods
from derivation.plate.benchmark.coefficients import series
from derivation.plate.benchmark.errors import digits, judge
from derivation.plate.benchmark.headline import zeros
from derivation.plate.benchmark.interface import PAPER, REGIMES, Method, deepest
from derivation.plate.benchmark.levin import u_transform
from derivation.plate.benchmark.problems import Problem
from derivation.plate.benchmark.replay import turning_time
from derivation.plate.benchmark.stepping import scalar_force
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.impact.oracle import impact as contact_impact
from generated.contact_law import force, indentation
from generated.contact_series import plates_of
from generated.impact import impact
from generated.reversed_series import _reversed

RADII = np.array([0.002, 0.01, 0.03])


@pytest.fixture(scope="module")
def law() -> Problem:
    """The paper's law at three radii."""
    truths = [contact_balls.indentation(float(a), PAPER.R, PAPER.h, PAPER.b, 40) for a in RADII]
    return Problem("law", PAPER, RADII, tuple(truths), 40, np.full(50, 0.01))


# --- arithmetics and methods


@pytest.mark.parametrize(
    ("ar", "right"), [(SINGLE, 6), (DOUBLE, 14.5), (LONG, 17.5 if HAS_LONG else 14.5)]
)
def test_floats_agree_with_balls(ar, right: float) -> None:
    y = np.array([1e-6, 0.3, 1.5, 1.7, 5.0], dtype=ar.dtype)
    exact = BallArithmetic(40)
    for name in ("shape", "wall_shape", "excess"):
        values = getattr(ar, name)(y)
        with exact.context():
            balls = getattr(exact, name)(np.array([as_ball(x) for x in y], dtype=object))
            assert min(map(digits, values, balls, [40] * len(y))) > right, name


def test_mpmath_agrees_with_balls() -> None:
    ar, exact, y = Mpmath(30), BallArithmetic(60), [1e-3, 0.5, 3.0]
    with ar.context(), exact.context():
        for name in ("shape", "wall_shape", "excess"):
            values = getattr(ar, name)(ar.array(y))
            balls = getattr(exact, name)(exact.array(y))
            assert min(map(digits, values, balls, [60] * 3)) > 29, name


@pytest.mark.parametrize("h", [0.1, 1e-2])
def test_coefficients_are_the_oracles(h: float) -> None:
    found = series(h, 1.0, 3, 20)
    for k in (0, 2):
        true = contact_balls.coefficient(2 * k + 1, h, 1.0, 20)
        assert digits(found[k], true, 20) > 18


def test_late_coefficients_are_the_oracles_too() -> None:
    true = contact_balls.coefficient(23, 0.45, 1.0, 32)
    assert digits(series(0.45, 1.0, 12, 30)[11], true, 32) > 30


@pytest.mark.parametrize("ar", [*([LONG] if HAS_LONG else []), Mpmath(30), BallArithmetic(30)])
def test_the_split_reaches_its_arithmetics_digits(law: Problem, ar) -> None:
    found = judge(law_sums.split(NODES[30], 6, ar), law, lambda: 0.0).errors
    assert found.total > ar.digits - 2
    assert found.truncation > ar.digits


@pytest.mark.parametrize("ar", [LONG, Mpmath(30)], ids=lambda ar: ar.name)
def test_no_constant_of_a_split_sum_is_a_double(ar) -> None:
    if ar.digits <= DOUBLE.digits:
        pytest.skip("long double is a double")
    true = contact_balls.indentation(0.03, PAPER.R, PAPER.h, PAPER.b, 40)
    (found,) = law_sums.split(72, 6, ar).prepare(PAPER)(np.array([0.03]))
    with flint.ctx.workprec(160):
        assert digits(found, true, 40) > min(ar.digits - 2, 27)


def test_levins_transformation_sums_an_alternating_series() -> None:
    n = np.arange(1, 13.0)
    terms = (-1) ** (n + 1) / n
    found = u_transform(np.cumsum(terms) + 0j, n * terms + 0j, n)
    assert found.real == pytest.approx(math.log(2), rel=1e-10)


def test_far_zeros_are_those_of_the_generated_code() -> None:
    from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros

    j, square = zeros(65_000, 66_000)
    np.testing.assert_allclose(j, bessel_j0_zeros(66_000)[65_000:], rtol=4e-16)
    np.testing.assert_allclose(square, bessel_j1_at_j0_zeros(66_000)[65_000:] ** 2, rtol=1e-15)


@pytest.mark.parametrize("regime", [REGIMES[1], REGIMES[4]], ids=lambda r: r.name)
def test_the_scalar_force_is_the_generated_one(regime) -> None:
    a = np.array([0.1, 0.6, 1.0]) * regime.h * min(regime.high, 4.0)
    depths = indentation(a, regime.R, regime.h, regime.b)
    r, scalar = regime, scalar_force(regime)
    expected = force(depths, r.R, r.h, r.b, r.lam, r.mu)
    np.testing.assert_allclose([scalar(float(d)) for d in depths], expected, rtol=1e-13)


@pytest.mark.parametrize("regime", REGIMES[:4], ids=lambda r: r.name)
def test_the_series_invert_and_bounce_like_the_generated_code(regime) -> None:
    r, top = regime, deepest(regime)
    depths = indentation(top * np.array([0.01, 0.3, 1.0]), r.R, r.h, r.b)
    expected = force(depths, r.R, r.h, r.b, r.lam, r.mu)
    speeds = r.speed * np.array([0.5, 1.0])
    times = impact(r.R, r.m, speeds, r.h, r.b, r.lam, r.mu).contact_time
    for ar, tolerance in ((SINGLE, 2e-6), (DOUBLE, 3e-15)):
        found = by_series.inverse(20, ar)(regime)(depths)
        assert found.dtype == ar.dtype
        np.testing.assert_allclose(found, expected, rtol=tolerance)
        found = by_series.gauss(24, 20, ar).prepare(regime)(speeds)
        np.testing.assert_allclose(found, times, rtol=tolerance)
    assert by_series.diverges(REGIMES[4])


def test_reversed_series_in_balls_is_the_generated_one() -> None:
    thick = REGIMES[2]
    radius, generated = _reversed(plates_of(np.array([thick.eta])), 0, 8)
    balls = [float(p) for p in inversion._reversed_balls(thick, 8, radius)]
    np.testing.assert_allclose(balls, generated, rtol=1e-8)
    c_1 = float(contact_balls.coefficient(1, thick.h, thick.b, 20))
    assert balls[1] / radius == pytest.approx(-1.5 * c_1, rel=1e-13)


def test_float32_goes_in_and_comes_out() -> None:
    for method in methods():
        if method.arithmetic == "float32" and method.fails(PAPER) is None:
            problem = {"law": 0.01, "inversion": 1e-4, "impact": 1.0}[method.task]
            assert method.prepare(PAPER)(np.array([problem])).dtype == np.float32, method.name


def test_nodes_of_the_oracle_are_set_up_not_timed(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    monkeypatch.setattr(contact_balls, "indentation", lambda *arguments: asked.append(arguments))
    call = law_generated.oracle(30).prepare(PAPER)
    assert asked == [(PAPER.high * PAPER.h, PAPER.R, PAPER.h, PAPER.b, 30)]
    assert len(call(RADII)) == 3
    assert len(asked) == 4


# --- errors


@pytest.fixture(scope="module")
def pressed() -> Problem:
    """Inversion in the thick plate at two indentations."""
    thick = REGIMES[2]
    depths = np.array([1e-4, 0.1])
    found = [contact_balls.contact_radius(d, thick.R, thick.h, thick.b, 40) for d in depths]
    with flint.ctx.workprec(160):
        truths = [4 * contact_balls.modulus(thick.lam, thick.mu) * a**3 / (3 * flint.arb(thick.R))
                  for a in found]  # fmt: skip
    return Problem("inversion", thick, depths, tuple(truths), 38, np.full(50, 0.01))


@pytest.fixture(scope="module")
def bounced() -> Problem:
    """The paper's impact."""
    p, speeds = PAPER, np.array([1.0])
    times = [contact_impact.impact(p.R, p.m, v, p.h, p.b, p.lam, p.mu, 30)[0] for v in speeds]
    return Problem("impact", PAPER, speeds, tuple(times), 30, np.full(50, 0.9))


SPLITS = {
    "Hertz": (inversion.hertz(), 1, 15),
    "reversed series": (inversion.reversed_series(12), 6.1, 15),
    "reversed series, float32": (inversion.reversed_series(12, SINGLE), 6.1, 6.5),
    "table": (inversion.table(64), 7.5, 14),
    "Newton on 4 terms": (by_series.newton(4), 7.8, 15),
    "Newton on 4 terms, float32": (by_series.newton(4, SINGLE), 7.8, 6),
    "Hertz's impact": (motion.hertz(), 0.5, 15),
    "linear term": (motion.linear(25), 0.8, 15),
    "Gauss": (motion.gauss(8), 8.2, 15),
    "Gauss on the series": (by_series.gauss(8, 12), 8.2, 15),
    "Gauss on the series, float32": (by_series.gauss(8, 12, SINGLE), 8.2, 7),
    "production, float32": (motion.production(np.float32), 21.7, 7.5),
    "DOP853": (stepping.solver("DOP853", 1e-6), 7.0, 15),
    "Verlet": (stepping.verlet(20), 3.3, 15),
    "Verlet, float32": (stepping.verlet(20, dtype=np.float32), 3.3, 7),
}
"""Methods with their digits of truncation and of rounding, about."""


@pytest.mark.parametrize("name", SPLITS)
def test_inversion_and_impact_are_split_too(pressed: Problem, bounced: Problem, name: str) -> None:
    method, truncation, rounding = SPLITS[name]
    found = judge(method, bounced if method.task == "impact" else pressed, lambda: 0.0).errors
    assert found.truncation == pytest.approx(truncation, abs=0.8)
    assert found.rounding == pytest.approx(rounding, abs=1.5)
    assert 10**-found.total <= 1.01 * (10**-found.truncation + 10**-found.rounding)


def test_long_numbers_are_as_long_as_they_say(pressed: Problem, bounced: Problem) -> None:
    wide = [(Mpmath(30), 30)] + ([(LONG, 17.5)] if HAS_LONG else [])
    for ar, least in wide:
        assert judge(by_series.newton(28, ar), pressed, lambda: 0.0).errors.total > least
        found = judge(by_series.gauss(48, 24, ar), bounced, lambda: 0.0).errors
        assert found.total >= min(least, bounced.digits)
    if HAS_LONG:
        found = judge(inversion.reversed_series(24, LONG), pressed, lambda: 0.0).errors
        assert found.rounding > 17.5


def test_what_truncates_nothing_has_rounding_alone(pressed: Problem) -> None:
    found = judge(inversion.newton(), pressed, lambda: 0.0).errors
    assert (found.truncation, found.rounding) == (None, found.total)


def test_truncation_is_told_beyond_doubles_too(law: Problem) -> None:
    for ar in (Mpmath(50), BallArithmetic(50)):
        found = judge(law_series.small_contacts(4, ar), law, lambda: 0.0).errors
        assert found.truncation == pytest.approx(found.total, abs=1e-9)
        assert found.rounding == law.digits


def test_many_digits_are_held_to_another_oracle(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(problems, "MANY_DIGITS", 40)
    found = problems._many_digits(RADII, PAPER)
    for a, value in zip(RADII, found, strict=True):
        true = contact_balls.indentation(float(a), PAPER.R, PAPER.h, PAPER.b, 42)
        assert digits(value, true, 50) > 39


def test_a_thousand_digits_are_the_papers_alone_and_left_out_with_a_reason() -> None:
    deep = [m for m in methods() if m.arithmetic.endswith("1000 digits")]
    assert {m.arithmetic for m in deep} == {"mpmath, 1000 digits", "Arb, 1000 digits"}
    tried = {m.family for m in deep if m.fails(PAPER) is None}
    assert tried == {"small-a series"}
    for regime in REGIMES:
        if regime is not PAPER:
            assert all((m.fails(regime) or "").startswith("left out") for m in deep)
    assert not any(m.arithmetic.endswith("1000 digits") for m in methods(quick=True))


def test_error_split_adds_up(law: Problem) -> None:
    for method in (law_sums.split(16, 2), law_series.small_contacts(4), law_sums.direct(100)):
        found = judge(method, law, lambda: 0.0).errors
        assert found.truncation is not None
        assert found.rounding is not None
        parts = 10**-found.truncation + 10**-found.rounding
        assert 10**-found.total <= parts * 1.01
        assert found.rounding > 13
    assert judge(law_series.small_contacts(1), law, lambda: 0.0).errors.total == pytest.approx(
        judge(law_series.small_contacts(1), law, lambda: 0.0).errors.truncation, abs=1e-3
    )


@pytest.mark.parametrize(
    ("method", "truncation"),
    [
        (law_series.chebyshev(2), 9.7),
        (law_series.chebyshev(6, SINGLE), 21.2),
        (law_series.table(3), 13.0),
        (levin.levin(4), 6.0),
    ],
    ids=lambda x: getattr(x, "name", None),
)
def test_surrogates_and_samples_are_split(law: Problem, method: Method, truncation: float) -> None:
    found = judge(method, law, lambda: 0.0).errors
    assert found.truncation == pytest.approx(truncation, abs=1.5)
    assert found.rounding is not None
    assert found.rounding > (6.5 if method.arithmetic == "float32" else 14)
    assert 10**-found.total <= 1.01 * (10**-found.truncation + 10**-found.rounding)
    assert 10**-found.total >= 0.9 * abs(10**-found.truncation - 10**-found.rounding)


def test_what_is_not_split_says_why(
    law: Problem, bounced: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every method that is tried and none of whose errors is known apart has its reason."""
    monkeypatch.setattr(stepping, "HAS_LONG", False)
    monkeypatch.setattr(law_sums, "HAS_LONG", False)
    stepping._repeated.cache_clear()
    for problem, method, reason in (
        (bounced, stepping.solver("Radau", 1e-3), "long double"),
        (law, law_sums.direct(2000), "modes"),
    ):
        found = judge(method, problem, lambda: 0.0).errors
        assert (found.truncation, found.rounding, found.remark) == (None, None, None)
        assert reason in (found.unsplit or "")
    assert judge(law_series.chebyshev(2), law, lambda: 0.0).errors.unsplit is None
    assert all(m.same or m.exact or m.certified or "perturbation" in m.family for m in methods())


@pytest.mark.parametrize("name", ["DOP853", "Radau"])
def test_repeated_steps_are_scipys(name: str) -> None:
    """A force that is linear: the time is pi/2 over the frequency, but for the steps' own error."""
    from scipy.integrate import solve_ivp

    def top(t: float, y: np.ndarray) -> float:  # noqa: ARG001
        return float(y[1])

    top.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(
        lambda t, y: (y[1], -4 * y[0]), (0, 2), (0.0, 3.0), method=name,  # noqa: ARG005
        rtol=1e-4, atol=1e-6, events=top, dense_output=True,
    )  # fmt: skip
    ends = [p.t_old for p in found.sol.interpolants] + [found.sol.interpolants[-1].t]
    time = float(turning_time(stepping.REPEATED[name], 3.0, 2.0, ends, lambda x: 8 * x))
    # Radau's Newton iteration has a Jacobian by differences, and stops at a tolerance.
    rel = 1e-14 if name == "DOP853" else 1e-9
    assert time == pytest.approx(float(found.t_events[0][0]), rel=rel)
    assert 1e-12 < abs(time / (math.pi / 4) - 1) < 1e-4


def test_digits_of_no_number_and_of_exact_ones() -> None:
    one = flint.arb(1)
    assert digits(math.nan, one, 30) == -math.inf
    assert digits(1.0, one, 30) == 30
    assert digits(1.001, one, 30) == pytest.approx(3, abs=0.01)


def test_a_method_without_digits_fails_with_a_reason(law: Problem) -> None:
    half = Method("law", "half", "", lambda regime: lambda a: 0.1 * a)  # noqa: ARG005
    nothing = Method("law", "nothing", "", lambda regime: lambda a: a * math.nan)  # noqa: ARG005
    refused = replace(half, fails=lambda regime: "dear")  # noqa: ARG005
    reasons = [panels.judged_row(method, law)[0].fails for method in (half, nothing, refused)]
    assert reasons[0] is not None
    assert "no digit" in reasons[0]
    assert reasons[1:] == ["gives no number in part of the regime", "dear"]
