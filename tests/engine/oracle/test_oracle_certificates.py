"""A reference value whose certificate fails raises an error (Arb and mpmath references)."""

import math
from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace
from typing import Any, cast

import flint
import pytest
from flint import acb, arb
from mpmath import mp, mpc, mpf

from derivation.engine.formula.ball import PrecisionError
from derivation.engine.oracle.agreement import RouteError
from derivation.mathematics.bessel import oracle as zeros
from derivation.plate import oracle as references
from derivation.plate.back_face import oracle as back_face_references
from derivation.plate.back_face import route as back_face_routes
from derivation.plate.contact.oracle import balls as contact_references
from derivation.plate.contact.oracle import forces as contact_forces
from derivation.plate.contact.oracle import lateral as contact_lateral
from derivation.plate.contact.oracle import points as contact_points
from derivation.plate.contact.oracle import sums as contact_sums
from derivation.plate.contact.route import residue_law
from derivation.plate.edge.oracle import supported as edge_references
from derivation.plate.edge.route import supported as edge_routes
from derivation.plate.edge_modes.oracle import modes as edge_mode_references
from derivation.plate.edge_modes.route import modes as edge_mode_routes
from derivation.plate.impact.oracle import impact as contact_impact
from derivation.plate.impact.oracle import quantities as contact_quantities
from derivation.plate.impact.oracle import state_rounding
from derivation.plate.modes.route import routes
from derivation.plate.pressure import oracle as pressure_references
from derivation.plate.pressure import route as pressure_routes
from derivation.plate.waves import oracle as wave_references
from derivation.plate.waves import route as wave_routes

SPHERE = (0.01, 0.03, 1.0, 0.1, 1.0, 1.2e11, 8e10)
"""R, m, v0, h, b, lam, mu of an impact."""


# --- zeros of Bessel functions


class ZeroNewtonSteps(int):
    """A precision that makes Newton's iteration end before its first step."""

    def bit_length(self) -> int:
        return -4


@pytest.mark.parametrize(
    ("find", "check", "message"),
    [
        (zeros.j0_zero, "first_zero_is_first", "no zero below 3 pi/4"),
        (zeros.j1_zero, "first_zero_of_j1_is_first", "no zero up to 5 pi/4 - 1/8"),
    ],
)
def test_numbering_of_zeros_needs_a_certified_first_zero(
    find: Any, check: str, message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(zeros, check, lambda: False)
    with pytest.raises(zeros.ZeroError, match=message):
        find.__wrapped__(1, 60)


@pytest.mark.parametrize(
    ("guess", "message"),
    [(5.5201, "is outside the interval of zero 1"), (2.4, "does not change its sign")],
)
def test_value_that_is_no_zero_of_j0_is_not_certified(
    guess: float, message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """5.5201 is close to the second zero, 2.4 next to the first."""
    monkeypatch.setattr(zeros, "_newton", lambda *_: arb(guess))
    with pytest.raises(zeros.ZeroError, match=message):
        zeros.j0_zero.__wrapped__(1, 60)


def test_value_that_is_no_zero_of_j1_is_not_certified(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(zeros.ZeroError, match="J1 does not change its sign"):
        zeros.j1_zero.__wrapped__(1, ZeroNewtonSteps(60))
    monkeypatch.setattr(zeros, "WIDTH_J1", arb(0.01))  # narrower than 5 pi/4 - 3.8317
    with pytest.raises(zeros.ZeroError, match="is outside the interval of zero 1 of J1"):
        zeros.j1_zero.__wrapped__(1, 60)


def test_j1_at_an_inaccurate_zero_is_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zeros, "j0_zero", lambda *_: arb(2.405, 0.001))
    with pytest.raises(zeros.ZeroError, match=r"J1 at zero 1 is .* \[0\.52 \+/- "):
        zeros.j1_at_zero.__wrapped__(1, 60)


def test_index_must_be_an_integer() -> None:
    with pytest.raises(ValueError, match=r"kappa needs an integer index, got 1\.5"):
        references.certified_value("kappa", {"n": 1.5})


# --- the contact law in interval arithmetic


def test_interval_that_stays_wide_is_rejected() -> None:
    with pytest.raises(PrecisionError, match="no 10 digits of the value within"):
        contact_references.refine_to_digits(lambda _: (arb(0, 1e-300),), 10, "the value")


def test_lengths_must_be_positive() -> None:
    with pytest.raises(ValueError, match=r"lengths are positive, got 0\.1 and 0\.0"):
        contact_references.indentation(0.1, 1.0, 0.1, 0.0)
    with pytest.raises(ValueError, match=r"a radius is positive, got -1\.0"):
        contact_references.stiffness(0.01, -1.0, 0.1, 1.0, 1e9, 1e9)


def test_subtracted_polar_part_of_the_plate_factor_is_verified(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With a modified numerator, negative powers of T remain after subtracting 6/T^3 + 6/(5T)."""
    with flint.ctx.workprec(60):
        known = contact_sums.plate_excess(acb(1)) + 1 - acb(7.2)
        assert abs(contact_references._regular(acb(1), 60) - known) < 1e-15
    wrong = vars(math) | {"factorial": lambda n: math.factorial(n) * (n + 1)}
    monkeypatch.setattr(contact_references, "math", SimpleNamespace(**wrong))
    with pytest.raises(ArithmeticError, match="polar part of G is not"):
        contact_references._regular(acb(1), 60)


def decreasing(x: Any) -> Any:
    return 1 / x


def test_roots_are_enclosed_or_rejected() -> None:
    """Solve x = 1/4 with the exact slope, with a slope that makes the iteration overshoot, and
    solve 1/x = 4, whose left side decreases.
    """
    with flint.ctx.workprec(64):
        actual = contact_references.ratio_where(
            lambda x: x, lambda *_: arb(1), arb(0.25), 0.1, "1/4"
        )
        assert actual.contains(arb(0.25))
        assert actual.rad() < 1e-9
        with pytest.raises(PrecisionError, match="no convergence towards 1/4"):
            contact_references.ratio_where(lambda x: x, lambda *_: arb(0.4), arb(0.25), 0.1, "1/4")
        with pytest.raises(PrecisionError, match=r"4 is not enclosed by .0\.24999.* and .0\.25000"):
            contact_references.ratio_where(decreasing, lambda *_: arb(-1), arb(4), 0.1, "4")


def test_roots_of_the_mpmath_reference_converge_or_are_rejected() -> None:
    with mp.workdps(30):
        actual = residue_law._root(lambda x, _: (x, mpf(1)), mpf("0.25"), mpf("0.1"), 24)
        assert abs(actual - mpf("0.25")) < mpf(10) ** -28
        with pytest.raises(RouteError, match="no root found near"):
            residue_law._root(lambda x, _: (x, mpf("0.4")), mpf("0.25"), mpf("0.1"), 24)
        with pytest.raises(RouteError, match=r"no root found near 0\.25"):
            residue_law._root(lambda x, _: (1 / x, mpf(-1)), mpf(4), mpf("0.1"), 24)
    with pytest.raises(ValueError, match="would reach the edge of the plate"):
        residue_law.contact_radius(1.0, 1.0, 0.1, 0.2, 20)


def test_error_bound_needs_a_positive_slope() -> None:
    """S/q = 1/q + p is at least 1 + p, which is positive for p = -1/2 but not for p = -2."""
    with flint.ctx.workprec(64):
        error = arb(2) ** -40
        allowed = contact_impact._error_bound(flint.arb_poly([-0.5]), error)
        assert error / arb(0.5) <= allowed < error / arb(0.49)
        with pytest.raises(PrecisionError, match="slope could not be shown to be positive"):
            contact_impact._error_bound(flint.arb_poly([-2]), error)


def test_bounds_are_rejected_outside_their_region_of_validity() -> None:
    with pytest.raises(ValueError, match="a ball across the cut"):
        contact_sums.hankel_over_j0(acb(-1, 1))
    with pytest.raises(ValueError, match="between -45 and 45 degrees"):
        contact_sums.hankel_bound(acb(1, 2))
    with pytest.raises(PrecisionError, match="no bound on the ellipse near"):
        contact_sums._panel(acb(1), acb(2), arb(3), lambda z: z, lambda _: arb("inf"))
    with pytest.raises(ValueError, match=r"the sum, which ends at T = 4\.0"):
        edge_references._rest(arb(4), arb(1))
    assert edge_references._rest(arb(20), arb(1)).rad() < 1e-4
    near = edge_references._near(edge_references.KERNELS["slope"], arb(0.5), acb(4))
    assert not near.is_finite()


def test_bound_on_the_lateral_surface_is_checked_where_it_begins(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(contact_lateral, "NEAR", 1.4)  # sinh(1.4) < 2
    with pytest.raises(PrecisionError, match=r"is not valid from t = 1\.4 on"):
        contact_lateral.shifted_bound.__wrapped__()


def test_sums_that_end_too_early_are_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contact_lateral, "trapezoidal", lambda *_: ([arb(0), arb(1)], [arb(1)] * 2))
    with pytest.raises(PrecisionError, match=r"sum ends at 1\.0.*, too early"):
        contact_lateral.lateral_points.__wrapped__(64)
    monkeypatch.setattr(contact_points, "mode_count", lambda *_: 1)
    few = SimpleNamespace(**vars(math) | {"ceil": lambda _: 0})
    monkeypatch.setattr(back_face_references, "math", few)
    with pytest.raises(ValueError, match=r"the sum, which ends at T = \[1\.0995"):
        back_face_references.back_face_sum(0.01, 0.1, 1.0, 10)
    with pytest.raises(PrecisionError, match=r"modes end at T = \[0\.1099\d* .*, too early"):
        contact_points.mode_points.__wrapped__(Fraction(1, 100), 64, 104)


# --- quantities of the law


@pytest.mark.parametrize("terms", [4, 8])
def test_truncated_series_of_the_force_has_the_order_of_its_terms(terms: int) -> None:
    """The error of P(delta) with n terms is of order eps^n; eps^2 is proportional to delta."""
    R, h, b, lam, mu = 0.13, 0.1, 1.0, 0.36e9, 0.43e9
    errors = []
    for delta in (1e-6, 1e-5):
        exact = contact_forces.force(delta, R, h, b, lam, mu, 16)
        actual, ratio = contact_quantities.truncated_series(delta, R, h, b, lam, mu, 16, terms)
        with flint.ctx.workprec(200):
            errors.append(float(abs(actual / exact - 1)))
        assert ratio >= 1
    assert errors[1] / errors[0] == pytest.approx(10 ** (terms / 2), rel=0.06)


def test_radius_and_force_are_inverse_functions() -> None:
    a, R, lam, mu = 0.01, 0.13, 0.36e9, 0.43e9
    force = contact_forces.force_of_radius(a, R, lam, mu, 40)
    back = contact_forces.radius_of_force(contact_quantities.fraction(force), R, lam, mu, 40)
    pressure = contact_forces.max_pressure(a, R, lam, mu, 40)
    with flint.ctx.workprec(160):
        assert abs(back / arb(a) - 1) < 1e-38
        # In Hertz theory, the maximum pressure is 3/2 of the mean pressure.
        assert abs(pressure * arb.pi() * arb(a) ** 2 / force - arb(1.5)) < 1e-38


@pytest.mark.parametrize(("fraction", "speed"), [(0.0, 1.0), (2.5, -1.0)])
def test_sphere_moves_freely_before_and_after_the_contact(fraction: float, speed: float) -> None:
    """Without loss the rebound speed equals the impact speed and depends on no other argument."""
    whole = contact_impact.impact(*SPHERE, digits=20).contact_time
    given, exact_state = (fraction * float(whole), *SPHERE), cast("Any", contact_quantities.state)

    def state(arguments: Any, digits: int) -> Any:
        return exact_state(*arguments, digits=digits)

    actual = state(given, 12)
    assert [float(part) for part in actual] == [0.0, speed, 0.0, 0.0]
    changes = [float(part) for part in state_rounding.rounding(state, given, actual)]
    assert changes == pytest.approx([0.0, 1.0, 0.0, 0.0], abs=1e-12)


def test_states_are_enclosed_in_time_or_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = float(contact_impact.impact(*SPHERE, digits=20).contact_time)
    monkeypatch.setattr(contact_quantities, "_STEPS", 1)
    with pytest.raises(PrecisionError, match=r"the state at .* is not enclosed by"):
        contact_quantities.state(0.3 * whole, *SPHERE, digits=12)


def test_history_rejects_radii_above_the_maximum() -> None:
    most = contact_impact.impact(*SPHERE, digits=20).max_contact_radius
    wider = 1.0001 * float(most)
    with pytest.raises(ValueError, match=r"a contact radius below .* is expected, got 0\.0"):
        contact_impact.history([wider], *SPHERE, digits=20)


# --- mpmath reference


def test_coefficients_from_a_circle_next_to_a_pole_are_rejected() -> None:
    """The coefficient of z^2 in 1/(1 - z/p) is 1/p^2; for p = 1.0001 the samples do not give it."""
    with mp.workdps(20):
        actual = edge_routes._coefficient(lambda z: 1 / (1 - z / 2), 2, mpf(1), 15)
        assert abs(actual - 0.25) < 1e-14
        with pytest.raises(RouteError, match="did not give a coefficient"):
            edge_routes._coefficient(lambda z: 1 / (1 - z / mpf("1.0001")), 2, mpf(1), 15)


def test_residue_sums_that_do_not_converge_are_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(RouteError, match=r"no root of sinh T = \+-T for n = 0\.5"):
        edge_routes.root(0.5, 53)  # type: ignore[arg-type]
    monkeypatch.setattr(edge_routes, "MOST", 4)
    with pytest.raises(RouteError, match=r"4 roots .* at h/b = 0\.1"):
        edge_routes._roots(1, lambda _: mpc(1), mpf("0.1"))
    with pytest.raises(RouteError, match=r"too few roots at h/b = 0\.9"):
        back_face_routes._roots(mpf("0.9"), mpf(1))


def test_edge_mode_without_a_change_of_sign_is_not_certified() -> None:
    with (
        flint.ctx.workprec(24),
        pytest.raises(edge_mode_references.RootError, match="no change of sign"),
    ):
        edge_mode_references._root("clamped", 1, 0.3, 64)


def test_edge_modes_without_roots_of_the_determinant_are_rejected(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(edge_mode_routes, "_determinant", lambda *_: mpf("nan"))
    with mp.workdps(20):
        with pytest.raises(RouteError, match="fewer than 2 modes up to k = 12"):
            edge_mode_routes._interval("clamped", 2, mpf(0))
        with pytest.raises(RouteError, match="no root of the determinant"):
            edge_mode_routes._bisected("clamped", mpf(1), mpf(2), mpf(0), 10)


def test_wave_numbers_that_are_not_enclosed_are_rejected(monkeypatch: pytest.MonkeyPatch) -> None:
    with mp.workdps(20):
        actual = wave_routes._secant(lambda x: x * x - 2, mpf(1), mpf(2), 10)
        assert abs(actual - mp.sqrt(2)) < mpf(10) ** -14
        with pytest.raises(RouteError, match="secant method does not converge"):
            wave_routes._secant(lambda x: x * x + 1, mpf("0.3"), mpf("0.4"), 10)
    monkeypatch.setattr(wave_routes, "_answers", lambda *_: (mpf(1), mpf(1)))
    with pytest.raises(RouteError, match="no zero between"):
        wave_routes._zero(mpf(1), mpf("0.3"), 20)
    monkeypatch.setattr(wave_references, "_slope", lambda *_: arb(2) ** -200)
    with flint.ctx.workprec(100):
        assert wave_references._zero(wave_references.KINDS[0], 1.0, 0.3, 1, 15).is_nan()


def test_contact_pressures_of_two_resolutions_must_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    narrow = pressure_references._wider(arb(1), arb(1) + arb(2) ** -50, 10)
    assert narrow.contains(arb(1))
    with pytest.raises(PrecisionError, match=r"two resolutions of the contact differ by 0\.5"):
        pressure_references._wider(arb(1), arb(1.5), 10)
    monkeypatch.setattr(pressure_routes, "_size", lambda *_: 2)
    with pytest.raises(RouteError, match="two bases differ by"):
        pressure_routes.solve(Fraction(1), Fraction(1, 4), digits=20)


def test_quadrature_that_does_not_converge_is_rejected() -> None:
    with mp.workdps(40):
        value = routes._integral(mp.exp, [mpf(0), mpf(1)], "tanh-sinh")
        assert abs(value - mp.e + 1) < mpf(10) ** -35
        with pytest.raises(RouteError, match=r"quadrature reached 0\.2\d+ \+- .* only"):
            routes._integral(lambda x: abs(x - mpf(1) / 3), [mpf(0), mpf(1)], "tanh-sinh")


@pytest.mark.parametrize("result", ["inf", "nan"])
def test_route_that_is_not_finite_is_rejected(result: str) -> None:
    oracle = replace(routes.ORACLE, routes={"G": lambda _: mpf(result)})
    with pytest.raises(RouteError, match=r"G at \{'T': 1\.0\}: no two results agree to 50 digits"):
        oracle.value("G", {"T": 1.0})
