"""Modes of held plates: theory, oracles, kernels in ULP, published values, sums, orthogonality."""

import math
from fractions import Fraction

import flint
import numpy as np
import pytest
import sympy as sp
from flint import arb
from mpmath import mp, mpf
from numpy.polynomial.legendre import leggauss
from scipy.special import iv, j0

from derivation.engine.formula.ball import evaluate, to_ball
from derivation.engine.formula.proof import SYMBOLIC, ProofError, lower_bessel, prove
from derivation.engine.formula.ulp import ulp_error
from derivation.mathematics.bessel.theory import modified as modified_bessel
from derivation.plate import derived
from derivation.plate.budgets import read_budgets
from derivation.plate.edge_modes.kernels import tables as held_tables
from derivation.plate.edge_modes.oracle import modes as held_balls
from derivation.plate.edge_modes.route import modes as held_routes
from derivation.plate.edge_modes.theory import modes as theory
from derivation.plate.vocabulary import alpha, k_n
from derivation.plate.vocabulary import nu as poisson
from generated.bessel import bessel_j0_zeros, bessel_j1_at_j0_zeros
from generated.held_modes import Modes, clamped_modes, supported_modes

BITS = 200
INDICES = (*range(1, 41), 64, 100, 225, 226, 227, 236, 238, 1000, 9999, 10000)
"""Where the method changes, where c becomes subnormal, and where it vanishes."""
RATIOS = (
    -1 + 2.0**-53, -1 + 1e-12, -1 + 1e-5, -0.97, -0.64, -0.3, -1e-3, 0.0, 1e-300, 0.1, 0.25, 0.3,
    1 / 3, 0.45, math.nextafter(0.5, 0),
)  # fmt: skip


pytestmark = pytest.mark.usefixtures("silent")


# --- theory


def test_every_formula_of_the_link_is_proved_symbolically() -> None:
    link = theory.held_modes()
    assert {f.name for f in link} <= set(derived.formulas())
    assert len(link) == 8
    assert {formula.proof.method for formula in link} == {SYMBOLIC}
    assert held_tables.forms().method == SYMBOLIC


def test_another_norm_or_recurrence_is_refused() -> None:
    growth = sp.diff((theory.J1 / theory.J0 + theory.I1 / theory.I0) / k_n, k_n)
    wrong = lower_bessel(growth * k_n * theory.J0**2 / 2) - theory.NORM + theory.J1**2 / 7
    with pytest.raises(ProofError, match="growth"):
        prove("Norm", "", {"growth": wrong})
    assert lower_bessel(sp.besseli(-1, k_n) - sp.besseli(1, k_n)) == 0
    assert lower_bessel(sp.besselj(-1, k_n) + sp.besselj(1, k_n)) == 0
    third = lower_bessel(sp.besseli(3, k_n)) - sp.besseli(3, k_n)
    assert abs(evaluate(third + 1, {k_n: Fraction(7, 3)}, 20) - 1) < 1e-19


@pytest.mark.parametrize("start", [16, 24, 32])
def test_bound_of_the_ratios_series(start: int) -> None:
    terms = start // 2
    with flint.ctx.workprec(BITS):
        bound = modified_bessel.ratio_bound(terms, Fraction(start))
        for k in (start, start + 1, 2 * start, 1000):
            x = arb(k)
            series = sum(
                to_ball(Fraction(int(c.p), int(c.q))) / x**m
                for m, c in enumerate(modified_bessel.ratio_series(terms))
            )
            error = abs(x.bessel_i(1) / x.bessel_i(0) - series)
            assert error <= bound * (arb(start) / k) ** terms * (1 + arb(2) ** -100)
        x = arb(start)
        assert bound < 3 * abs(to_ball(Fraction(modified_bessel.ratio_series(terms + 1)[-1]))) / (
            x**terms
        )
        with pytest.raises(ProofError, match="bound"):
            modified_bessel.ratio_bound(3 * start, Fraction(start))


@pytest.mark.parametrize(("steps", "largest"), [(12, 2), (40, 16)])
def test_bound_of_bessels_integral_as_a_sum(steps: int, largest: int) -> None:
    with flint.ctx.workprec(BITS):
        k = arb(largest)
        turns = [2 * arb.pi() * i / steps for i in range(steps)]
        plain = sum(((k * t.cos()).exp() for t in turns), arb(0)) / steps
        squared = k * sum((t.sin() ** 2 * (k * t.cos()).exp() for t in turns), arb(0)) / steps
        bound = to_ball(modified_bessel.sum_bound(steps, Fraction(largest)))
        for value, order in ((plain, 0), (squared, 1)):
            error = abs(value / k.bessel_i(order) - 1)
            assert 0 < error <= bound
    with pytest.raises(ProofError, match="too few"):
        modified_bessel.sum_bound(10, Fraction(9))


def test_the_method_changes_between_modes() -> None:
    with flint.ctx.workprec(BITS):
        assert held_tables.modes_before(held_tables.asymptotic_start()) == 10
        with pytest.raises(ArithmeticError, match="do not part"):
            held_tables.modes_before(Fraction(30632, 1000))


# --- oracles


@pytest.mark.parametrize(
    ("edge", "n", "nu"),
    [("clamped", 1, 0.0), ("clamped", 2, 0.0), ("clamped", 7, 0.0), ("supported", 1, 0.3),
     ("supported", 1, -1 + 2.0**-53), ("supported", 1, math.nextafter(0.5, 0)),
     ("supported", 2, -0.9), ("supported", 6, 0.2)],
)  # fmt: skip
def test_oracles_agree(edge: held_balls.Edge, n: int, nu: float) -> None:
    balls, routes = held_balls.mode(edge, n, nu), held_routes.mode(edge, n, nu)
    with flint.ctx.workprec(BITS), mp.workdps(50):
        for ball, route in zip(balls, routes, strict=True):
            assert abs(ball / arb(mp.nstr(route, 40)) - 1) < 1e-29


def test_oracles_refuse_what_has_no_meaning() -> None:
    for n, nu in ((0, 0.3), (1, -1.0), (2, 1.0)):
        with pytest.raises(ValueError, match="counted from 1"):
            held_balls.mode("supported", n, nu)


# --- generated kernels


def worst(found: Modes, n: int, true: held_balls.Mode, allowed: tuple[float, ...]) -> float:
    """Largest error of a mode's three numbers over what is allowed."""
    errors = (ulp_error(float(x[n - 1]), t) for x, t in zip(found, true, strict=True))
    return max(error / limit for error, limit in zip(errors, allowed, strict=True))


def test_clamped_modes_against_the_oracle() -> None:
    budget = read_budgets()["clamped_modes"].ulp
    found = clamped_modes(10000)
    for n in INDICES:
        true = held_balls.mode("clamped", n, digits=25)
        assert worst(found, n, true, (1.0, budget, budget)) <= 1, n


def conditions(n: int, nu: float) -> tuple[float, float, float]:
    """Relative change of k, c and W by that of nu, from the oracle."""
    step = Fraction(1, 10**12)
    ends = [held_balls.mode("supported", n, Fraction(nu) * (1 + s), 30) for s in (step, -step)]
    with flint.ctx.workprec(BITS):
        rates = [abs(one / other - 1) / 2 * 10**12 for one, other in zip(*ends, strict=True)]
    return float(rates[0]), float(rates[1]), float(rates[2])


@pytest.mark.parametrize("nu", RATIOS)
def test_supported_modes_against_the_oracle(nu: float) -> None:
    budget = read_budgets()["supported_modes"].ulp
    found = supported_modes(10000, nu)
    for n in (1, *INDICES[1::3]):
        true = held_balls.mode("supported", n, nu, digits=25)
        by_nu = (0.0, 0.0, 0.0) if abs(nu) < 1e-9 or 1 + nu < 1e-9 else conditions(n, nu)
        k, c, w = (0.5 * rate for rate in by_nu)
        assert worst(found, n, true, (1.5 + k, budget + c, budget + w)) <= 1, n


def test_counts_are_prefixes_of_each_other() -> None:
    for nu in (None, 0.3):
        whole = clamped_modes(40) if nu is None else supported_modes(40, nu)
        for count in (0, 1, 2, 9, 10, 11, 12, 40, 11.0):
            part = clamped_modes(count) if nu is None else supported_modes(count, nu)
            for x, y in zip(part, whole, strict=True):
                assert x.shape == (int(count),)
                np.testing.assert_array_equal(x, y[: int(count)])
        for x in whole:
            assert x.dtype == np.float64


@pytest.mark.parametrize("count", [-1, 2.5, math.nan, math.inf])
def test_impossible_counts_are_refused(count: float) -> None:
    with pytest.raises(ValueError, match="number of modes, an integer >= 0"):
        clamped_modes(count)
    with pytest.raises(ValueError, match="number of modes, an integer >= 0"):
        supported_modes(count, 0.3)


def test_shapes_types_and_domain() -> None:
    nu = np.array([[0.3, -0.5, 0.5], [-1.0, math.nan, math.inf]])
    found = supported_modes(13, nu)
    for x, y in zip(found, supported_modes(13, 0.3), strict=True):
        assert x.shape == (2, 3, 13)
        np.testing.assert_array_equal(x[0, 0], y)
        np.testing.assert_array_equal(np.isnan(x[..., 0]), [[0, 0, 1], [1, 1, 1]])
        np.testing.assert_array_equal(np.isnan(x).all(axis=-1), np.isnan(x).any(axis=-1))
    assert supported_modes(2, nu[:, :0]).k.shape == (2, 0, 2)
    single = supported_modes(12, np.float32(0.3))
    assert {x.dtype for x in single} == {np.dtype(np.float32)}
    np.testing.assert_array_equal(
        single.weight, supported_modes(12, float(np.float32(0.3))).weight.astype(np.float32)
    )
    with pytest.raises(TypeError, match="real numbers"):
        supported_modes(3, 0.3j)


def test_one_mode_between_neighbouring_zeros() -> None:
    """And what the part of I0 does: it changes sign, falls, and ends as 0."""
    j = np.concatenate(([0.0], bessel_j0_zeros(10001)))
    clamped = clamped_modes(10000)
    assert ((j[1:-1] < clamped.k) & (clamped.k < j[2:])).all()
    for nu in RATIOS:
        found = supported_modes(10000, nu)
        assert ((j[:-2] < found.k) & (found.k < j[1:-1])).all()
        assert (np.sign(found.c[:230]) == np.resize([1, -1], 230)).all()
        assert (found.c[240:] == 0).all()
    assert (np.sign(clamped.c[:230]) == np.resize([-1, 1], 230)).all()
    assert (np.diff(np.abs(clamped.c)) <= 0).all()


# --- known answers


def test_published_values() -> None:
    """Leissa, Vibration of Plates (1969), tables 2.1 and 2.5 (nu = 0.3): k^2, of n circles."""
    np.testing.assert_allclose(clamped_modes(3).k ** 2, [10.2158, 39.771, 89.104], atol=6e-4)
    found = supported_modes(3, 0.3).k ** 2
    np.testing.assert_allclose(found, [4.9351, 29.7200, 74.1561], atol=6e-5)


def test_an_almost_free_edge() -> None:
    """nu -> -1: D nabla^2 w alone resists, w = 1 - r^2: k^4 = 24 (1 + nu), W = 3/pi."""
    for power in (-20, -40, -53):
        first = supported_modes(1, -1 + 2.0**power)
        assert first.k[0] ** 4 == pytest.approx(24 * 2.0**power, rel=2.0 ** (power + 1) + 1e-14)
        assert first.weight[0] == pytest.approx(3 / math.pi, rel=2.0 ** (power + 1) + 1e-14)


@pytest.mark.parametrize("nu", [None, -0.9, 0.0, 0.3])
def test_modes_are_orthogonal_and_have_their_norm(nu: float | None) -> None:
    count = 12
    found = clamped_modes(count) if nu is None else supported_modes(count, nu)
    x, weights = leggauss(60)
    r = (1 + x) / 2
    with np.errstate(under="ignore"):
        shape = j0(np.outer(found.k, r)) - found.c[:, None] * iv(0, np.outer(found.k, r))
    products = np.einsum("ir,jr,r->ij", shape, shape, weights * r / 2)
    norms = np.diag(products)
    np.testing.assert_allclose((1 - found.c) ** 2 / (2 * np.pi * norms), found.weight, rtol=1e-12)
    off = products / np.sqrt(np.outer(norms, norms)) - np.eye(count)
    assert np.abs(off).max() < 1e-11


def test_sums_are_the_deflections_at_rest() -> None:
    """The terms beyond are 1/(2 k^3) at a distance of pi: as good as their integral."""
    names = ("clamped_compliance", "supported_compliance")
    clamped, supported = (derived.formulas()[name].expression for name in names)
    j, slopes = bessel_j0_zeros(10000), bessel_j1_at_j0_zeros(10000)
    cases = [
        (clamped_modes(10000), float(clamped)),
        (Modes(j, 0 * j, 1 / (np.pi * slopes**2)), 1 / (8 * math.pi)),
    ]
    for nu in (-0.99, -0.3, 0.0, 0.3, 0.499):
        cases.append((supported_modes(10000, nu), float(supported.subs(poisson, sp.Float(nu, 30)))))
    for modes, known in cases:
        rest = 1 / (4 * math.pi * (modes.k[-1] + math.pi / 2) ** 2)
        total = math.fsum(modes.weight / modes.k**4) + rest
        assert total == pytest.approx(known, rel=2e-13)


@pytest.mark.parametrize("contact", ["0.01", "0.4", "0.9"])
def test_mean_under_a_flat_punch(contact: str) -> None:
    """r = a sin t has the weight sin t dt under it."""
    with mp.workdps(25):
        k, a = mpf("9.4394991378764"), mpf(contact)
        part = mp.besselj(0, k) / mp.besseli(0, k)

        def shape(t: mpf) -> mpf:
            r = k * a * mp.sin(t)
            return mp.sin(t) * (mp.besselj(0, r) - part * mp.besseli(0, r)) / (1 - part)

        values = {k_n: Fraction("9.4394991378764"), alpha: Fraction(contact)}
        closed = evaluate(derived.formulas()["held_share"].expression, values, 22)
        with flint.ctx.workprec(BITS):
            mean = arb(mp.nstr(mp.quad(shape, mp.linspace(0, mp.pi / 2, 4)), 25))
            assert abs(closed - mean) < 1e-20
