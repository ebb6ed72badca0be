"""Test the theory of plate inertia, and its two references against each other and limits."""

import itertools
from fractions import Fraction

import flint
import pytest
import sympy as sp
from flint import arb
from mpmath import mp, mpf
from shared_scenes import material

from derivation.engine.formula.ball import PrecisionError, evaluate, to_ball
from derivation.engine.formula.proof import ProofError, prove
from derivation.plate import derived
from derivation.plate.vocabulary import gam, h, kap, mu, x_h, xi_R
from derivation.plate.waves import oracle as inertia_balls
from derivation.plate.waves import route as inertia_routes
from derivation.plate.waves.oracle import KINDS
from derivation.plate.waves.theory import bending_branch, dynamic_modes

DIGITS = 20
BITS = 128

pytestmark = pytest.mark.usefixtures("silent")


# --- theory


def test_wrong_influence_is_rejected() -> None:
    """The proof fails for twice the influence, which full loads A_j on both faces would give."""
    p, q = dynamic_modes.p, dynamic_modes.q
    printed = dynamic_modes.in_p_and_q(dynamic_modes.stiffness(sp.tanh(p), sp.tanh(q)))
    part = dynamic_modes.loaded_wave(bends=True).f.subs(dynamic_modes.z, 1)
    assert dynamic_modes.in_sines(part - 1 / printed) == 0
    with pytest.raises(ProofError, match="B_a"):
        prove("Twice", "", {"B_a": dynamic_modes.in_sines(2 * part - 1 / printed)})


@pytest.mark.parametrize(
    ("x", "load", "nu"), [(0.3, 0.02, 0.25), (1.3, 1.1, -0.7), (4.0, 9.0, 0.4)]
)
def test_influence_agrees_with_numerical_traction_conditions(
    x: float, load: float, nu: float
) -> None:
    formula = derived.formulas()["dynamic_influence"].expression
    values = {x_h: x, kap: load, gam: material(nu), h: 1, mu: 1}
    ball = evaluate(formula, values, 25)
    with mp.workdps(40):
        route = sum(inertia_routes.influence(x, load, nu, 25))
        with flint.ctx.workprec(BITS):
            assert abs(ball / arb(mp.nstr(route, 35)) - 1) < 1e-24


def test_thin_plate_series_of_any_order() -> None:
    """Each order of the series reduces the error by about x^2, compared with A0 from Arb."""
    x, nu = 0.125, 0.3
    slopes, residues = bending_branch.thin_powers(12)
    with flint.ctx.workprec(BITS):
        reference = inertia_balls.zero(x, nu, digits=25) / arb(x) ** 4
        answer = inertia_balls.residue(x, nu, digits=25)
        for row, exact in ((slopes, reference), (residues, answer)):
            total, errors = arb(0), []
            for n, coefficient in enumerate(row):
                total += evaluate(coefficient, {gam: material(nu)}, 30) * arb(x) ** (2 * n)
                errors.append(float(abs(total / exact - 1)))
            assert errors[-1] < 1e-15
            assert all(after < 0.1 * before for before, after in itertools.pairwise(errors))


def test_rayleigh_speed_agrees_with_the_known_one() -> None:
    cubic = bending_branch.rayleigh()[0].expression
    (speed,) = (
        root for root in sp.Poly(cubic.subs(gam, sp.Rational(1, 3)), xi_R).nroots(20)
        if root.is_real and 0 < root < 1
    )  # fmt: skip
    assert abs(speed - (2 - 2 / sp.sqrt(3))) < 1e-18


# --- references


@pytest.mark.parametrize(
    ("x", "load", "nu"),
    [(0.3, 0.01, 0.25), (1.0, 1.4, -0.5), (2.0, 30.0, 0.4), (0.01, 1e-9, 0.3), (40.0, 700.0, 0.1)],
)
def test_references_agree_on_the_influence(x: float, load: float, nu: float) -> None:
    balls = inertia_balls.influence(x, load, nu, 25)
    with mp.workdps(40):
        routes = inertia_routes.influence(x, load, nu, 25)
        with flint.ctx.workprec(BITS):
            for ball, route in zip(balls, routes, strict=True):
                assert abs(ball / arb(mp.nstr(route, 35)) - 1) < 1e-24


@pytest.mark.parametrize(("x", "nu"), [(1e-3, 0.3), (0.9, -0.9), (3.0, 0.49), (60.0, 0.25)])
def test_references_agree_on_the_lowest_branch(x: float, nu: float) -> None:
    digits = 12
    pairs = zip(
        (inertia_balls.zero, inertia_balls.residue, inertia_balls.fraction),
        (inertia_routes.zero, inertia_routes.residue, inertia_routes.fraction),
        strict=True,
    )
    for first, second in pairs:
        ball = first(x, nu, digits=digits + 4)
        with mp.workdps(30):
            route = mp.nstr(mpf(second(x, nu, digits=digits)), 25)
            with flint.ctx.workprec(BITS):
                assert abs(ball / arb(route) - 1) < 10.0**-digits


@pytest.mark.parametrize("x", [1e-3, 0.7, 30.0])
def test_reference_encloses_its_limits(x: float) -> None:
    """The Arb reference encloses two limits.

    At kap = 0 the expected value follows from the static plate factor. At kap = x^2, where
    q = 0, it is the mpmath reference at a nearby kap.
    """
    still = inertia_balls.influence(x, 0.0, 0.3, 25)
    turn = inertia_balls.influence(x, Fraction(x) ** 2, 0.3, 25)
    with flint.ctx.workprec(200):
        T = 2 * arb(x)
        G = (T.sinh() * T.cosh() + T) / (T.sinh() ** 2 - T**2)
        whole = G / (2 * (1 - to_ball(material(0.3))) * arb(x))
        assert abs((still[0] + still[1]) / whole - 1) < 1e-24
    with mp.workdps(40):
        neighbour = inertia_routes.influence(x, mpf(x) ** 2 * (1 + mpf(10) ** -18), 0.3, 25)
        with flint.ctx.workprec(BITS):
            for ball, route in zip(turn, neighbour, strict=True):
                assert abs(ball / arb(mp.nstr(route, 35)) - 1) < 1e-14


@pytest.mark.parametrize("kind", KINDS)
def test_reference_for_very_thin_and_thick_plates(kind: str) -> None:
    """The first higher branch lies between its poles in very thin and very thick plates."""
    for x in (1e-40, 1e40):
        kap_1 = inertia_balls.zero(x, 0.3, kind, 1, DIGITS)
        with flint.ctx.workprec(1000):
            low, high = (((n + 0.5 * (kind == KINDS[0])) * arb.pi()) ** 2 for n in (0, 2))
            assert low < kap_1 - arb(x) ** 2 < high
        assert inertia_balls.residue(x, 0.3, kind, 1, DIGITS) > 0


def test_reference_raises_an_error_if_undefined() -> None:
    """The reference raises an error at p = 0, where the expression is undefined but has a limit."""
    with pytest.raises(PrecisionError, match="digits"):
        inertia_balls.influence(1.0, 1.5, -0.5)
