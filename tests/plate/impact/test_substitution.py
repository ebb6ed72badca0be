"""Test derivation step 18: a law between two simple laws, and the constants of its bounds."""

import flint
import numpy as np
import pytest
from scipy import integrate, special

from derivation.plate.contact.kernels.moments import plate_excess
from derivation.plate.contact.theory.plate_series import kappa_ball
from derivation.plate.contact.theory.thin_remainder import coefficient_remainder_ball
from derivation.plate.impact.kernels import simple as tables
from derivation.plate.impact.theory import substitution
from generated import simple_impact
from generated import simple_impact_numbers as numbers


def test_remainder_of_the_lateral_is_the_series_without_its_first_term() -> None:
    total, factorial = flint.arb(0), flint.arb(1)
    for n in range(2, 40, 2):
        factorial *= n * (n + 1)
        total += kappa_ball(n, 15) / factorial
    series = 4 * total / flint.arb.pi() ** 2
    assert abs(substitution.lateral_rest_ball() - series) < 1e-11


def test_generated_bounds_of_the_lateral_are_rounded_up() -> None:
    """The bounds slightly exceed the integrals of sinh y without its first one or two terms."""

    def integrand(y: float, taken: float) -> float:
        rising = special.k0e(y) / special.i0e(y) * np.exp(-2 * y) / y
        return float(4 / np.pi**2 * (np.sinh(y) - taken) * rising)

    rest = integrate.quad(lambda y: integrand(y, y), 1e-3, 60.0, epsabs=1e-13, limit=200)[0]
    cubic = integrate.quad(
        lambda y: integrand(y, y + y**3 / 6), 1e-2, 60.0, epsabs=1e-13, limit=200
    )[0]
    assert rest < numbers.LATERAL_REST < 1.003 * rest
    assert cubic < numbers.LATERAL_CUBIC < 1.003 * cubic


def test_generated_bounds_of_omitted_terms_are_rounded_up() -> None:
    for proven, constant in (
        (tables._roots(2), numbers.ROOTS_LINEAR),
        (flint.arb(5) / 2 * tables._roots(3), numbers.ROOTS_CUBIC),
        (tables._faded(0), numbers.FADED_LINEAR),
        (tables._faded(2), numbers.FADED_CUBIC),
    ):
        assert proven <= constant < 1.003 * proven


@pytest.mark.parametrize("k", [2, 3])
@pytest.mark.parametrize("inverse", [6.0, 9.0])
def test_contribution_of_the_roots_is_below_its_bound(k: int, inverse: float) -> None:
    contribution = abs(coefficient_remainder_ball(k, 1 / inverse, 10))
    assert contribution < tables._roots(k) * (-flint.arb.pi() * inverse).exp()


def test_omitted_modes_are_below_their_bound() -> None:
    eta = 1 / tables.THIN
    for power in (0, 2):
        total = flint.arb(0)
        for zero, weight in tables.modes(60):
            T = 2 * eta * zero
            if tables.FADED < T:
                total += weight * plate_excess(T) * T**power
        assert 0 < total < tables._faded(power)


@pytest.mark.parametrize("nodes", [4, 6, 8, 10])
def test_quadrature_error_is_below_its_bound(nodes: int) -> None:
    bound = float(substitution.time_quadrature_bound(nodes))

    def integral(count: int, x: float) -> float:
        u, weights = np.polynomial.legendre.leggauss(count)
        q = 1 - ((1 + u) / 2) ** 2
        fifth = 1 + q * (1 + q * (1 + q * (1 + q)))
        radicand = 6 * fifth + 5 * x * (1 + q * fifth)
        return float(np.sum(weights * q * (1 + x * q) / np.sqrt(radicand)))

    for x in (-0.5, -0.2, 0.0, 1.0, 30.0, 1e8):
        assert abs(integral(nodes, x) / integral(48, x) - 1) < bound
    assert bound < 30 * 2.4 ** (1 - 2 * nodes)


def test_ellipse_that_contains_a_root_is_rejected() -> None:
    with pytest.raises(ArithmeticError, match="inside the ellipse"):
        substitution._no_root_inside(flint.arb(3))


def test_laws_of_thin_and_thick_plates_agree_at_their_switch_point() -> None:
    below, above = (simple_impact.plate_of(1 / (tables.THIN + x)) for x in (1e-9, -1e-9))
    assert below.bend == pytest.approx(above.bend, abs=below.bend_error + above.bend_error + 1e-8)
    assert below.rest == pytest.approx(above.rest, rel=1e-6)


@pytest.mark.parametrize("bound", ["1.0", "9.9999999", "2.5617e-17", "0.052313"])
def test_short_bound_is_an_upper_bound(bound: str) -> None:
    ball = flint.arb(bound)
    assert ball <= tables.above(ball) < 1.003 * ball
