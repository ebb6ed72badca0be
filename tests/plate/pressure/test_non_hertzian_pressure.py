"""Test the contact with non-Hertzian pressure: theory, references, generated code, limits."""

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
import sympy as sp
from mpmath import mp
from scipy.optimize import brentq

from derivation.engine.formula.proof import ProofError
from derivation.engine.oracle.agreement import RouteError, to_ball
from derivation.plate.budgets import read_stated_limits
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.pressure import oracle as pressure_balls
from derivation.plate.pressure import route as pressure_routes
from derivation.plate.pressure.theory import bound
from derivation.plate.pressure.theory import integral_equation as theory
from derivation.plate.vocabulary import a_ratio, c_A
from derivation.plate.vocabulary import eta as eta_symbol
from generated.contact_series import plates_of
from generated.non_hertzian_pressure import contact, plate, pressure
from generated.pressure_numbers import ERROR, THIN, WIDEST, WIDEST_OVER_B, WIDEST_OVER_R

R, E = 1e3, 7e10
OPEN = 3.012493
"""a/H, with H = 2 h, at which every thin plate loses contact at the centre."""


pytestmark = pytest.mark.usefixtures("no_warning")


# --- theory


def test_cubic_coefficient_is_eight_thirds() -> None:
    ratio, law = (f.expression for f in theory.at_given_force())
    assert law.coeff(a_ratio, 3) == sp.Rational(8, 3) * c_A[3]
    assert law.coeff(a_ratio, 1) == c_A[1]
    assert ratio == 1 + sp.Rational(5, 3) * c_A[3] * a_ratio**3


def test_too_small_contribution_of_the_lateral_surface_is_rejected(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(bound, "LATERAL_EXTRA", sp.Rational(3, 40))
    with pytest.raises(ProofError, match="contribution of the edge"):
        bound.lateral_ratio.__wrapped__()


@pytest.mark.parametrize("eta", [4.0, 0.53, 0.2, 0.05, 0.003])
def test_bounds_hold_and_are_positive(eta: float) -> None:
    """The differences of slope and indentation are below their bounds, by a factor of at most 8.

    The slope of the non-Hertzian law is S_T = 2 E* a_H/K.
    """
    slope_bound, depth_bound = (f.expression for f in bound.pressure_bound())
    third = contact_balls.coefficient(3, eta, 1)
    assert third < 0
    most = min((5 * (0.08 * eta**3 - 7.5 * float(third))) ** (-1 / 3), 0.4 / eta)
    for fraction in (0.3, 0.97):
        a = fraction * most
        # The Hertz radius of the solution at contact radius a is slightly smaller than a.
        case = pressure_balls.case(a, 1, 1 / eta)
        state = pressure_balls.solve(case)
        ratio = float(0.75 * state.force) ** (1 / 3)  # Hertz's radius of the force over a
        depth = float(state.depth) / ratio**2  # delta R/a_H^2
        hertz = a * ratio
        slope = 2 * ratio / float(state.stiffness)
        gone = slope - float(contact_balls.slope(hertz, 1e3, 1, 1 / eta, 20)) * 1e3 / (2 * hertz)
        sunk = depth - 1 - float(contact_balls.relative_correction(hertz, 1, 1 / eta, 20))
        values = {c_A[3]: float(third), a_ratio: hertz, eta_symbol: eta}
        for moved, most_of in ((gone, slope_bound), (sunk, depth_bound)):
            assert abs(moved) < float(most_of.subs(values)) < 8 * abs(moved)


# --- references


AGREE = [
    (Fraction(1, 25), Fraction(10), Fraction(0), Fraction(1)),
    (Fraction(1, 2), Fraction(1), Fraction(0), Fraction(1)),
    (Fraction(1), Fraction(3, 10), Fraction(1, 5), Fraction(4, 5)),
    (Fraction(5), Fraction(1, 10), Fraction(0), Fraction(1)),
    (Fraction(1), Fraction(1, 100), Fraction(0), Fraction(1)),
    (Fraction(1, 2), Fraction(1, 300), Fraction(0), Fraction(1)),
]


@pytest.mark.parametrize("numbers", AGREE, ids=lambda x: f"{float(x[1]):g}-{float(x[0]):g}")
def test_references_agree_to_twenty_digits(numbers: tuple[Fraction, ...]) -> None:
    one = pressure_balls.solve(pressure_balls.Case(*numbers), 22)
    other = pressure_routes.solve(*numbers, digits=20)
    for ball, number in zip((one.force, one.depth, one.centre), other, strict=True):
        assert abs(ball - to_ball(number)) < 1e-22 * abs(ball) + 1e-24


def test_stiffness_and_slope_are_derivatives_of_the_second_reference() -> None:
    numbers = Fraction(3, 2), Fraction(1, 5)
    one = pressure_balls.solve(pressure_balls.Case(*numbers))
    stiffness, slope = pressure_routes.derivatives(*numbers, digits=12)
    with mp.workdps(30):
        assert abs(one.stiffness - to_ball(stiffness)) < 1e-15
        assert abs(one.slope - to_ball(slope)) < 1e-15


def test_references_reject_contacts_outside_their_range() -> None:
    with pytest.raises(RouteError, match="is above"):
        pressure_routes.solve(Fraction(1), Fraction(3, 4))
    with pytest.raises(ValueError, match="expected 0 < a < b"):
        pressure_balls.case(2.0, 1.0, 1.0)


# --- generated code against the reference


def test_stated_limit_is_the_recorded_one() -> None:
    assert read_stated_limits("pressure") == {"error": ERROR}


@pytest.mark.parametrize(
    ("a", "v", "sphere"), [(0.5, 2.0, 0.8), (1.5, 20.0, 1.9), (2.0, 5.0, 9.0), (0.95, 1.2, 1.0)]
)
def test_sphere_and_its_elasticity_agree_with_the_reference(
    a: float, v: float, sphere: float
) -> None:
    exact = pressure_balls.solve(pressure_balls.case(a, 1.0, v, sphere, 0.75), 20)
    got = contact(plate(1.0, v), a, sphere, 0.75 * E, E, sphere=True)
    scale = 0.75 * E
    for value, ball in (
        (got.force * sphere / (scale * a**3), exact.force),
        (got.indentation * sphere / a**2, exact.depth),
        (got.stiffness / (scale * a), exact.stiffness),
        (got.slope * sphere / a, exact.slope),
        (got.centre_pressure * sphere / (scale * a), exact.centre),
    ):
        assert abs(float(value) - ball) < ERROR * abs(float(ball))


def test_kernel_follows_from_the_slope_of_the_law() -> None:
    """The integral equation's kernel follows from the series of the contact law alone.

    The series is F = A sum S_k (A/reach)^(2k).
    """
    nodes, weights = np.polynomial.legendre.leggauss(40)
    x, w = np.append(nodes[20:], 1.0), weights[20:]
    for v, a in ((1.5, 0.7), (2.5, 1.2), (5.0, 1.4), (30.0, 1.5), (1e4, 1.5)):
        law = plates_of(np.array([1 / v]))
        powers = np.arange(law.first.coefficients.shape[0])
        S = law.first.coefficients[:, 0] * (powers + 1.5) * (2 * powers + 1)

        def k(y: np.ndarray, S: np.ndarray = S, law: object = law) -> np.ndarray:
            return np.polynomial.polynomial.polyval((y / law.reach[0]) ** 2, S)  # type: ignore[attr-defined]

        kernel = a * (k(a * (x[:, None] + x)) + k(a * (x[:, None] - x))) / 2
        system = np.eye(21)
        system[:, :20] += kernel[:, :20] * w
        psi, omega = np.linalg.solve(system, np.stack((np.ones(21), x**2), axis=1)).T
        depth = omega[-1] / psi[-1]
        force = 2 * (depth * psi - omega)[:20] @ w
        got = contact(plate(1.0, v), a, R, E)
        # This direct solution loses digits by cancellation against the constant of a thin plate.
        loss = 1e-13 + 1e-16 * v**2
        assert abs(force * E * a**3 / R / got.force - 1) < loss
        assert abs(got.indentation / (a**2 / R * depth) - 1) < loss


# --- limits


def test_small_contacts_agree_with_hertz() -> None:
    for v in (1.0, 30.0):
        got = contact(plate(1.0, v), 1e-5, R, E)
        assert abs(got.centre_pressure / got.mean_pressure - 1.5) < 1e-14
        assert abs(got.force / (4 / 3 * E * 1e-15 / R) - 1) < 1e-13
        r = np.linspace(0.0, 1e-5, 9)
        shape = pressure(r, plate(1.0, v), 1e-5, R, E) / got.centre_pressure
        assert np.abs(shape - np.sqrt(1 - (r / 1e-5) ** 2)).max() < 1e-14


@pytest.mark.parametrize("a_over_R", [1e-6, 0.1, 0.5, WIDEST_OVER_R])
def test_spherical_profile_on_a_half_space_agrees_with_sneddon(a_over_R: float) -> None:
    a = 1e-20
    radius = a / a_over_R
    got = contact(plate(1.0, 1.0), a, radius, E, sphere=True)
    logarithm = 2 * math.atanh(a_over_R)
    assert abs(got.indentation / (a / 2 * logarithm) - 1) < ERROR
    if a_over_R > 0.01:  # the closed form loses digits by cancellation for smaller values
        force = E * ((a**2 + radius**2) / 2 * logarithm - a * radius)
        assert abs(got.force / force - 1) < ERROR


def test_effect_of_the_spherical_profile_is_quadratic() -> None:
    of = plate(1.0, 8.0)
    moved = []
    for radius in (50.0, 100.0):
        plain, round_ = (contact(of, 1.0, radius, E, sphere=x) for x in (False, True))
        moved.append(round_.indentation / plain.indentation - 1)
    assert abs(moved[0] / moved[1] - 4) < 1e-3


@pytest.mark.parametrize("eta", [0.02, 0.2, 0.8])
def test_leading_terms_at_a_given_force(eta: float) -> None:
    """The leading terms at a given force have the coefficients (8/3) c_3 and (5/3) c_3.

    (delta R/a_H^2 - 1 - c_1 A)/A^3 -> (8/3) c_3 and (a_H/a - 1)/A^3 -> (5/3) c_3.
    """
    first, third = (contact_balls.coefficient(n, eta, 1, 30) for n in (1, 3))
    actual = []
    for a in (Fraction(1, 50), Fraction(1, 100)):
        state = pressure_balls.solve(pressure_balls.case(a, 1, 1 / Fraction(eta)), 25)
        ratio = (state.force * 3 / 4).root(3)
        hertz = ratio * a.numerator / a.denominator
        law = state.depth / ratio**2 - 1 - first * hertz
        actual.append((float(law / hertz**3), float((ratio - 1) / (hertz / ratio) ** 3)))
    for (far, near), factor in zip(zip(*actual, strict=True), (8 / 3, 5 / 3), strict=True):
        limit = (4 * near - far) / 3
        assert abs(limit / (factor * float(third)) - 1) < 1e-5


# --- general properties of a contact


CONTACTS = [(0.5, 1.2), (2.0, 8.0), (3.5, 40.0), (5.5, 1e4), (0.8, 0.9), (5.8, 12.0)]


@pytest.mark.parametrize(("a", "v"), CONTACTS)
def test_pressure_integrates_to_the_force_and_vanishes_at_the_edge(a: float, v: float) -> None:
    of = plate(1.0, v)
    got = contact(of, a, R, E)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    u, w = (1 + nodes) / 2, weights / 2
    q = pressure(a * np.sqrt((1 - u) * (1 + u)), of, a, R, E)
    assert abs(2 * np.pi * a**2 * (q * u) @ w / got.force - 1) < 1e-12
    assert pressure(a, of, a, R, E) == 0
    fit = np.polynomial.chebyshev.Chebyshev.fit((got.nodes / a) ** 2, got.chi, 23)
    assert abs(fit(1.0)) < 1e-9 * got.chi.max()


@pytest.mark.parametrize("edge", [0.0, 0.1, -0.2])
@pytest.mark.parametrize(("a", "v"), CONTACTS)
def test_work_and_stiffness_are_consistent(a: float, v: float, edge: float) -> None:
    """dU = P d delta and dP = K d delta hold along a, also with a compliant support and edge."""
    of, compliance = plate(1.0, v, edge), 3e-11
    a = a if np.isfinite(contact(of, a, R, E).force) else 0.8 * a  # a curved plate loses contact
    nodes, weights = np.polynomial.legendre.leggauss(60)
    x, w = a * (1 + nodes) / 2, a * weights / 2
    path = contact(of, x, R, E, compliance=compliance)
    end = contact(of, a, R, E, compliance=compliance)
    assert abs((path.force * path.slope) @ w / end.energy - 1) < 1e-10
    assert abs((path.stiffness * path.slope) @ w / end.force - 1) < 1e-10
    assert abs(path.slope @ w / end.indentation - 1) < 1e-10


@pytest.mark.parametrize("modulus_ratio", [1.0, 0.4])
@pytest.mark.parametrize("v", [100.0, 5.0])
def test_contact_is_accurate_where_the_punch_compliance_is_a_single_term(
    v: float, modulus_ratio: float
) -> None:
    """At one radius near a = h, the term N(0, 0) is the whole compliance of a flat punch."""
    of, own = plate(1.0, v), modulus_ratio * E

    def other_terms(a: float) -> float:
        compliance = 2.0 * own * a / float(contact(of, a, R, own, E).stiffness)
        return compliance - of.first / of.unit * a * modulus_ratio

    a = brentq(other_terms, 0.5, 3.0, xtol=1e-15)
    state = pressure_balls.solve(pressure_balls.case(a, 1.0, v, 0, modulus_ratio), 18)
    got = contact(of, a, R, own, E)
    values = [
        got.force * R / (own * a**3), got.indentation * R / a**2, got.stiffness / (own * a),
        got.slope * R / a, got.centre_pressure * R / (own * a),
    ]  # fmt: skip
    exact = [state.force, state.depth, state.stiffness, state.slope, state.centre]
    np.testing.assert_allclose(values, [float(x) for x in exact], rtol=5e-14)


def test_compliance_of_a_support_is_added() -> None:
    of = plate(1.0, 20.0)
    firm, soft = (contact(of, 1.3, R, E, compliance=c) for c in (0.0, 1e-10))
    assert soft.force == firm.force
    assert abs(soft.indentation - firm.indentation - 1e-10 * firm.force) < 1e-15 * soft.indentation
    assert abs(1 / soft.stiffness - 1 / firm.stiffness - 1e-10) < 1e-24
    stiffer = contact(of, 1.3, R, E, compliance=-1e-12)
    assert stiffer.stiffness > firm.stiffness
    assert stiffer.indentation < firm.indentation


def test_contact_is_lost_at_the_centre_at_three_thicknesses() -> None:
    """p(0)/p_mean decreases with a and reaches 0 at the same a/h in all thin plates."""
    for v in (10.0, 15.9, 16.1, 100.0, 1e4):
        of = plate(1.0, v)
        a = np.linspace(0.1, WIDEST, 1400)
        got = contact(of, a, R, E)
        ratio = got.centre_pressure / got.mean_pressure
        open_from = np.flatnonzero(np.isnan(ratio))[0]
        assert np.isnan(ratio[open_from:]).all()
        assert (np.diff(ratio[:open_from]) < 0).all()
        low, high = a[open_from - 1], a[open_from]
        for _ in range(40):
            middle = (low + high) / 2
            opened = np.isnan(contact(of, middle, R, E).force)
            low, high = (low, middle) if opened else (middle, high)
        print(f"b/h = {v:g}: contact is lost at the centre at a/H = {low / 2:.6f}")
        assert abs(low / 2 - OPEN) < 1e-6


def test_pressure_profile_in_thin_plates_depends_only_on_the_thickness() -> None:
    """In thin plates the pressure profile depends on a/h and not on b/h.

    b/h changes the kernel only by terms t^2 + s^2, which act like a curvature of the sphere.
    """
    radii = np.linspace(0.0, 3.0, 7)
    shapes = [
        pressure(radii, of, 3.0, R, E) / contact(of, 3.0, R, E).mean_pressure
        for of in (plate(1.0, v) for v in (20.0, 300.0, 1e5))
    ]
    assert np.abs(shapes[1] - shapes[0]).max() < ERROR
    assert np.abs(shapes[2] - shapes[0]).max() < ERROR


# --- domain and arrays


def test_results_are_nan_outside_the_domain() -> None:
    of = plate(1.0, 2.0)
    for a in (0.0, -1.0, np.nan, WIDEST_OVER_B * 2.0001, 2.5):
        assert np.isnan(contact(of, a, R, E).force)
    assert np.isnan(contact(of, 0.5, 0.4, E).force)
    assert np.isnan(contact(of, 1.001 * WIDEST_OVER_R, 1.0, E, sphere=True).force)
    assert np.isnan(contact(of, 0.5, R, -E).force)
    assert np.isnan(contact(of, 0.5, R, E, 0.9 * E).force)
    assert np.isnan(contact(of, 0.5, R, E, compliance=np.nan).force)
    assert contact(of, 1e-200, R, E).mean_pressure > 0
    assert np.isnan(contact(plate(1.0, 100.0), 1.001 * WIDEST, R, E).force)
    for h, b in ((0.0, 1.0), (1.0, -1.0), (1e-95, 1.0), (np.nan, 1.0)):
        assert np.isnan(contact(plate(h, b), 1e-3, R, E).force)
    assert np.isnan(pressure([-0.1, 0.6, np.nan], of, 0.5, R, E)).all()
    assert np.isnan(pressure(0.1, plate(1.0, 100.0), 6.5, 10.0, E))


def test_arrays_equal_single_contacts() -> None:
    for v in (1.0, 50.0):
        of = plate(1.0, v)
        a = np.linspace(0.01, 0.9, 130).reshape(2, 65)
        together = contact(of, a, R, [[E], [2 * E]])
        assert together.force.shape == (2, 65)
        assert together.chi.shape == (2, 65, 24)
        for i, j in itertools.product((0, 1), (0, 31, 64)):
            alone = contact(of, a[i, j], R, (1 + i) * E)
            for x, y in zip(together, alone, strict=True):
                np.testing.assert_allclose(x[i, j], y, rtol=1e-14)
        assert contact(of, np.zeros((0, 3)), R, E).chi.shape == (0, 3, 24)


def test_results_do_not_depend_on_units() -> None:
    for v in (2.0, 1.0 / 3e-3):
        one = contact(plate(1e-3, 1e-3 * v), 1.2e-3, 0.05, E)
        other = contact(plate(1.0, v), 1.2, 50.0, E / 1e6)
        assert abs(one.force / other.force - 1) < 1e-14
        assert abs(one.indentation * 1e3 / other.indentation - 1) < 1e-14


def test_kernels_of_thin_and_thick_plates_agree_at_their_switch_point() -> None:
    a = np.linspace(0.1, 6.0, 60)
    thick, thin = (contact(plate(1.0, THIN * (1 + x)), a, R, E) for x in (-1e-13, 1e-13))
    assert np.abs(thick.force / thin.force - 1).max() < 1e-12
    assert np.abs(thick.indentation / thin.indentation - 1).max() < 1e-12
    assert plate(1.0, THIN * 0.99).square == 0 != plate(1.0, THIN * 1.01).square
