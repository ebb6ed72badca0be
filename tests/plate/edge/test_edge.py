"""Test simply supported and clamped edges: resultants, references, functions, bound, limits."""

import itertools
import math
from fractions import Fraction

import flint
import numpy as np
import pytest
import sympy as sp
from flint import arb
from mpmath import mp, mpf
from shared_scenes import lame

from derivation.engine.formula.ball import enclose, to_ball
from derivation.engine.formula.proof import ProofError, prove
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.theory.hertz import contact_radius, pressure_coefficient
from derivation.plate.edge.kernels import tables as edge_tables
from derivation.plate.edge.oracle import supported as edge_balls
from derivation.plate.edge.route import supported as edge_routes
from derivation.plate.edge.theory import sums as edge_sums
from derivation.plate.edge.theory import supported as edge
from derivation.plate.modes.route.exponentials import ModeMaterial, unit_mode
from derivation.plate.modes.theory.influence import PLANE_STRAIN_MODULUS
from derivation.plate.vocabulary import J1, A_j, R, a, alpha, b, eta, h, lam, mu, phi
from generated import contact_law
from generated import edge as kernels

nu = sp.Symbol("nu")
LAM_OF_NU = 2 * mu * nu / (1 - 2 * nu)
BITS = 140
BELOW, ABOVE = 1 - 1e-9, 1 + 1e-9


pytestmark = pytest.mark.usefixtures("silent")


# --- theory


def test_wrong_plate_state_is_rejected() -> None:
    """The proof fails without the thinning lam z^2/(lam + 2 mu): the faces would have pressure."""
    stress = edge.hooke(edge.r * edge.z, (b**2 - edge.r**2) / 2)
    with pytest.raises(ProofError, match="pressure"):
        prove("Bending", "", {"pressure": stress.zz})


def test_thin_plates_agree_with_plate_theory() -> None:
    """A simple support multiplies the thin-plate deflection by (3 + nu)/(2 (1 + nu)).

    The deflection with the paper's edge is P b^2/(8 pi D), and X is half of it.
    """
    soft = alpha / eta**3 / (4 * sp.pi)
    (thin,) = (f.expression for f in edge_sums.thin_edge() if f.name == "F_edge_thin")
    relative_reduction = sp.limit(sp.limit((thin / soft), eta, 0), alpha, 0)
    assert sp.simplify(relative_reduction - sp.Rational(1, 2)) == 0
    ratio = edge.support_ratio().expression.subs(lam, LAM_OF_NU)
    assert sp.simplify(1 + ratio * relative_reduction - (3 + nu) / (2 * (1 + nu))) == 0


def test_moment_at_the_edge_of_a_thin_plate() -> None:
    """The edge moment per length of a thin plate is (1 - nu) P/(8 pi) for a small contact.

    This uses sum 1/(j^3 J1) = 1/8.
    """
    moment = {f.name: f.expression for f in edge.edge_resultants()}["edge_moment"]
    thin = sp.limit(moment, h, 0).subs(A_j, pressure_coefficient().expression)
    point = sp.limit(thin / a**3, a, 0)
    plain = edge_sums.closed_sums(edge_sums.indentation_kernel).plain.subs(alpha, 0)
    # The moment of a mode is proportional to 1/(phi^3 J1) = b^3/(j^3 J1).
    total = sp.simplify(point * phi**3 * J1 * b**3 * plain)
    force = contact_radius().expression / a**3
    assert sp.simplify((total / force - (1 - nu) / (8 * sp.pi)).subs(lam, LAM_OF_NU)) == 0
    assert force == sp.Rational(4, 3) * sp.factor(PLANE_STRAIN_MODULUS) / R


@pytest.mark.parametrize(("wave", "ratio"), [(0.03, 0.3), (1.7, -0.8), (9.0, 0.49)])
def test_resultants_equal_integrals_over_the_thickness(wave: float, ratio: float) -> None:
    """The resultants equal integrals over the thickness of fields solved with mpmath."""
    values = {f.name: f.expression for f in edge.edge_resultants()}
    first, second = lame(ratio)
    radius, slope = 2.4 / wave, 0.52
    with mp.workdps(40):
        material = ModeMaterial(mpf(first), mpf(second))

        def moment(power: int) -> mpf:
            return slope * mp.quad(
                lambda z: z**power * unit_mode(mpf(wave), mpf(1), material, z).u, [-1, 0, 1]
            )

        expected = {
            "edge_extension": moment(0) / (2 * mpf(radius)),
            "edge_rotation": 3 * moment(1) / (2 * mpf(radius)),
            "edge_force": -2 * second / mpf(radius) * moment(0),
            "edge_moment": -2 * second / mpf(radius) * moment(1),
        }
    numbers = {phi: wave, h: 1.0, lam: first, mu: second, b: radius, J1: slope, A_j: 1.0}
    with flint.ctx.workprec(256):
        balls = {symbol: to_ball(value) for symbol, value in numbers.items()}
        for name, value in expected.items():
            assert abs(enclose(values[name], balls) / arb(mp.nstr(value, 35)) - 1) < 1e-28


# --- references


@pytest.mark.parametrize("kind", ["indentation", "slope"])
@pytest.mark.parametrize(
    ("thickness", "width", "ratio"),
    [
        (0.002, 0.5, 0.25), (0.002, 0.9, -0.9), (0.02, 0.01, 0.49), (0.02, 0.9, 0.3),
        (0.1, 0.9, 0.49), (0.3, 0.3, -0.5), (1.0, 0.001, 0.1), (1.0, 0.9, 0.49),
        (3.0, 0.5, -0.9), (3.0, 0.9, 0.4),
    ],
)  # fmt: skip
def test_references_agree(kind: str, thickness: float, width: float, ratio: float) -> None:
    n = Fraction(ratio)
    first, second = 2 * n, 1 - 2 * n
    ball = edge_balls.edge_part(kind, width, thickness, 1, first, second, 27)
    with mp.workdps(40):
        route = edge_routes.edge_part(kind, width, thickness, 1, ratio, 27)
        with flint.ctx.workprec(BITS):
            assert abs(ball / arb(mp.nstr(route, 35)) - 1) < 1e-25


def test_tables_agree_with_integrals_of_the_reference() -> None:
    for kind, kernel in (
        ("indentation", edge_sums.indentation_kernel),
        ("slope", edge_sums.slope_kernel),
    ):
        for width in (Fraction(1, 5), Fraction(9, 10)):
            oracle = edge_balls.alternating_sum(kind, width, 120)
            with flint.ctx.workprec(512):
                assert abs(edge_tables.alternating_sum(kernel, to_ball(width)) - oracle) < 1e-34


# --- generated functions


@pytest.mark.parametrize("support", ["supported", "clamped"])
def test_slope_is_the_derivative_of_the_indentation(support: str) -> None:
    """The slope equals (R/2a) d(a^2 X/R)/da by finite differences."""
    plate = (0.2, 1.0, *lame(0.3))
    function, its_slope = (getattr(kernels, f"{support}_edge{part}") for part in ("", "_slope"))
    for width in (0.05, 0.4, 0.85):
        step = 1e-5
        ends = [(width + s) ** 2 * float(function(width + s, *plate)) for s in (step, -step)]
        slope = (ends[0] - ends[1]) / (4 * step * width)
        assert math.isclose(slope, float(its_slope(width, *plate)), rel_tol=1e-7)


def test_edge_term_is_linear_in_the_force() -> None:
    """X is unchanged if both Lame constants are doubled: force and stiffness scale together."""
    plate = (0.01, 0.05, 1.0, *lame(0.3))
    for function in (kernels.supported_edge, kernels.clamped_edge):
        assert function(*plate) == function(*plate[:3], *(2 * x for x in plate[3:]))


def test_thin_plates_have_the_factors_of_their_support() -> None:
    """A clamp halves the centre deflection of the paper's edge.

    A simple support multiplies it by (3 + nu)/(2 (1 + nu)).
    """
    plate, ratio = (1e-5, 1e-5, 1.0), 0.3
    soft = float(contact_law.indentation(1e-5, 1e3, *plate[1:])) * 1e3 / 1e-10 - 1
    clamped = float(kernels.clamped_edge(*plate, *lame(ratio)))
    supported = float(kernels.supported_edge(*plate, *lame(ratio)))
    assert math.isclose(1 + clamped / soft, 0.5, rel_tol=1e-6)
    assert math.isclose(1 + supported / soft, (3 + ratio) / (2 * (1 + ratio)), rel_tol=1e-6)


# --- the bound


def test_bound_holds_and_is_close_for_thin_plates() -> None:
    for thickness, ratio in itertools.product((0.02, 0.1, 0.5, 1.0, 3.0), (-0.9, 0.3, 0.49)):
        limits = []
        for width in (0.01, 0.3, 0.7, 0.9, 0.97):
            taken = abs(edge_balls.edge_part("slope", width, thickness, 1, *lame(ratio), 12))
            added = taken * float(edge_balls.support_ratio(*lame(ratio)))
            limits.append(float(kernels.supported_edge_bound(width, thickness, 1.0, *lame(ratio))))
            assert added < limits[-1]
        assert limits == sorted(limits)
    thin = kernels.supported_edge_bound(1e-3, 1e-3, 1.0, *lame(0.3))
    assert thin < 1.01 * abs(kernels.supported_edge_slope(1e-3, 1e-3, 1.0, *lame(0.3)))


def test_generated_bound_agrees_with_the_formula() -> None:
    formula = edge_sums.edge_bound()
    for thickness, ratio in itertools.product((0.003, 0.4, 1.7), (-0.7, 0.2, 0.45)):
        first, second = lame(ratio)
        numbers = {alpha: 0.3, eta: thickness, lam: first, mu: second}
        with flint.ctx.workprec(BITS):
            exact = enclose(formula.expression, {s: to_ball(x) for s, x in numbers.items()})
            exact *= to_ball(edge_balls.support_ratio(first, second))
        got = float(kernels.supported_edge_bound(0.3, thickness, 1.0, first, second))
        assert abs(exact - got) < 1e-15 * got * (8 + 4 * abs(thickness))


def test_constant_of_the_bound_exceeds_the_sum() -> None:
    sum_of_squares = edge_sums.inverse_squares()
    with flint.ctx.workprec(128):
        ball = edge_sums.inverse_squares_ball(3)
    number = float(sum_of_squares)
    assert float(ball.upper()) < number < 1.003 * float(ball.lower())


# --- domain


def test_results_are_nan_outside_the_domain() -> None:
    plate = (0.1, 1.0, *lame(0.3))
    assert kernels.clamped_edge(0.0, *plate) == 0
    for function in (kernels.supported_edge, kernels.clamped_edge_slope):
        assert np.isnan(function([-0.1, 0.91, np.nan, np.inf], *plate)).all()
        assert np.isnan(function(0.1, [0.0, -1.0, 1e-91, 1e91], *plate[1:])).all()
        assert np.isnan(function(0.1, 0.1, 1.0, -2.0, 3.0))
    assert np.isnan(kernels.clamped_edge_bound([1.01, -1.0], *plate)).all()


def test_reference_rejects_invalid_arguments() -> None:
    with pytest.raises(ValueError, match="a < b"):
        edge_balls.edge_part("slope", 1.0, 0.1, 1.0, 1.0, 1.0)


def test_edge_term_does_not_change_the_leading_term() -> None:
    """The edge term is proportional to a for small a, so the Hertz term stays the leading one."""
    small = kernels.supported_edge(np.array([1e-9, 1e-6]), 0.1, 1.0, *lame(0.3))
    assert math.isclose(float(small[1] / small[0]), 1e3, rel_tol=1e-9)
    exact = contact_balls.slope(1e-9, 1.0, 0.1, 1.0, 12)
    assert abs(exact / 2e-9 - 1) < 1e-6
