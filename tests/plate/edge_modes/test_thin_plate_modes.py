"""Test modes of thin clamped or supported plates: theory, references, flat-punch mean."""

import math
from fractions import Fraction

import flint
import pytest
import sympy as sp
from flint import arb
from mpmath import mp, mpf

from derivation.engine.formula.ball import evaluate, to_ball
from derivation.engine.formula.proof import ProofError, lower_bessel, prove
from derivation.mathematics.bessel.theory import modified as modified_bessel
from derivation.plate import derived
from derivation.plate.edge_modes.oracle import modes as mode_balls
from derivation.plate.edge_modes.route import modes as mode_routes
from derivation.plate.edge_modes.theory import modes as theory
from derivation.plate.vocabulary import alpha, k_n

BITS = 200
pytestmark = pytest.mark.usefixtures("silent")


# --- theory


def test_wrong_norm_or_recurrence_is_rejected() -> None:
    growth = sp.diff((theory.J1 / theory.J0 + theory.I1 / theory.I0) / k_n, k_n)
    wrong = lower_bessel(growth * k_n * theory.J0**2 / 2) - theory.NORM + theory.J1**2 / 7
    with pytest.raises(ProofError, match="growth"):
        prove("Norm", "", {"growth": wrong})
    assert lower_bessel(sp.besseli(-1, k_n) - sp.besseli(1, k_n)) == 0
    assert lower_bessel(sp.besselj(-1, k_n) + sp.besselj(1, k_n)) == 0
    third = lower_bessel(sp.besseli(3, k_n)) - sp.besseli(3, k_n)
    assert abs(evaluate(third + 1, {k_n: Fraction(7, 3)}, 20) - 1) < 1e-19


@pytest.mark.parametrize("start", [16, 24, 32])
def test_bound_of_the_series_of_the_ratio(start: int) -> None:
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
def test_bound_of_the_bessel_integral_as_a_sum(steps: int, largest: int) -> None:
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


# --- references


@pytest.mark.parametrize(
    ("edge", "n", "nu"),
    [("clamped", 1, 0.0), ("clamped", 2, 0.0), ("clamped", 7, 0.0), ("supported", 1, 0.3),
     ("supported", 1, -1 + 2.0**-53), ("supported", 1, math.nextafter(0.5, 0)),
     ("supported", 2, -0.9), ("supported", 6, 0.2)],
)  # fmt: skip
def test_references_agree(edge: mode_balls.Edge, n: int, nu: float) -> None:
    balls, routes = mode_balls.mode(edge, n, nu), mode_routes.mode(edge, n, nu)
    with flint.ctx.workprec(BITS), mp.workdps(50):
        for ball, route in zip(balls, routes, strict=True):
            assert abs(ball / arb(mp.nstr(route, 40)) - 1) < 1e-29


def test_references_reject_invalid_arguments() -> None:
    for n, nu in ((0, 0.3), (1, -1.0), (2, 1.0)):
        with pytest.raises(ValueError, match="n >= 1"):
            mode_balls.mode("supported", n, nu)


# --- known answers


@pytest.mark.parametrize("contact", ["0.01", "0.4", "0.9"])
def test_modal_weight_is_the_mean_under_a_flat_punch(contact: str) -> None:
    """The modal weight is the mean of a mode under a flat punch (weight sin t dt, r = a sin t)."""
    with mp.workdps(25):
        k, a = mpf("9.4394991378764"), mpf(contact)
        part = mp.besselj(0, k) / mp.besseli(0, k)

        def shape(t: mpf) -> mpf:
            r = k * a * mp.sin(t)
            return mp.sin(t) * (mp.besselj(0, r) - part * mp.besseli(0, r)) / (1 - part)

        values = {k_n: Fraction("9.4394991378764"), alpha: Fraction(contact)}
        closed = evaluate(derived.formulas()["thin_mode_mean"].expression, values, 22)
        with flint.ctx.workprec(BITS):
            mean = arb(mp.nstr(mp.quad(shape, mp.linspace(0, mp.pi / 2, 4)), 25))
            assert abs(closed - mean) < 1e-20
