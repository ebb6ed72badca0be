"""Test the derivations of the effects and their functions, by integrals and definitions."""

import math
from functools import cache
from typing import Any

import flint
import numpy as np
import pytest
from mpmath import mp, mpf
from shared_scenes import model

from derivation.engine.formula.proof import ProofError
from derivation.plate.contact.theory import spherical_profile as curvature_theory
from derivation.plate.effects import theory as effects_theory
from derivation.scene import kernels
from derivation.scene.effects import BY_NAME
from generated.effect_numbers import LATERAL_CUBIC, LATERAL_LINEAR
from generated.effects import (
    bending,
    bending_period,
    echo_time,
    finite_radius,
    sphere_contact,
    zener_number,
)


def test_wrong_slope_is_rejected() -> None:
    slope = curvature_theory.spherical_contact()[0].expression
    with pytest.raises(ProofError, match="halved"):
        curvature_theory.prove("Sphere", "", {"halved": slope - slope / 2})


def test_growth_of_the_lateral_surface_agrees_with_another_quadrature() -> None:
    with mp.workdps(20):
        actual = 4 / mp.pi**2 * mp.quad(
            lambda y: (y * mp.cosh(y) - mp.sinh(y)) / (2 * y) * mp.besselk(0, y) / mp.besseli(0, y),
            [0, 0.1, 1, 5, 20, 60],
        )  # fmt: skip
    assert abs(float(effects_theory.lateral_growth_ball()) - float(actual)) < 1e-12
    assert actual < kernels.LATERAL_GROWTH < 1.01 * actual


def test_sphere_on_a_half_space_agrees_with_sneddon() -> None:
    """Indentation and force of a sphere on a half-space agree with Sneddon's integrals.

    delta = a int f'/sqrt(a^2 - r^2) dr and P = 2 E* int r^2 f'/sqrt(...) dr, r = a sin t.
    """
    with mp.workdps(30):
        for rho in (mpf("1e-6"), mpf("0.1"), mpf("0.7"), mpf("0.98")):

            def slope(t: mpf, rho: mpf = rho) -> mpf:
                r = rho * mp.sin(t)
                return r / mp.sqrt(1 - r * r)

            depth = rho * mp.quad(slope, [0, mp.pi / 2])
            force = 2 * mp.quad(
                lambda t, rho=rho: (rho * mp.sin(t)) ** 2 * slope(t, rho), [0, mp.pi / 2]
            )
            rho_double = float(rho)
            actual = sphere_contact(rho_double)
            exact = mpf(rho_double)
            assert abs(actual.depth * exact**2 / depth - 1) < 1e-13
            assert abs(actual.force * mpf(4) / 3 * exact**3 / force - 1) < 1e-13


def test_sphere_function_is_within_its_budget() -> None:
    with mp.workdps(40):
        for rho in (1e-150, 1e-9, 0.1, 0.4999999, 0.5, 0.5000001, 0.9, 0.99, 1 - 2.0**-40):
            x = mpf(rho)
            arc = mp.atanh(x)
            force = mpf(3) / 4 * ((1 + x * x) * arc - x) / x**3 if rho > 1e-5 else 1 + 2 * x * x / 5
            depth, edge = arc / x, 1 / (1 - x * x)
            reference = (force, depth, (depth + edge) / 2)
            # The condition number of `edge` is at most 2 x^2/(1 - x^2).
            allowed = 8 + float(x * x / (1 - x * x))
            for value, exact_value in zip(sphere_contact(rho), reference, strict=True):
                assert abs(mpf(float(value)) - exact_value) < allowed * float(
                    np.spacing(float(exact_value))
                )


def test_lateral_surface_is_within_its_budget() -> None:
    """The correction for the lateral surface agrees with its integral; its slope is bounded.

    The integral (with y = u^3) takes 40 digits because its numerator cancels.
    """

    @cache  # the nodes are the same for every alpha
    def bessel_ratio(y: mpf) -> mpf:
        with flint.ctx.workprec(200):  # these balls take much less time than mpmath's functions
            x = flint.arb(flint.fmpz(int(y.man))) * flint.arb(2) ** int(y.exp)
            return mpf((x.bessel_k(0) / x.bessel_i(0)).str(45, radius=False))

    with mp.workdps(40):
        for alpha in (0.01, 0.3, 0.999):
            a = mpf(alpha)
            integral = mp.quad(
                lambda u, a=a: 3 * u**2
                * (mp.cosh(a * u**3) * a * u**3 - mp.sinh(a * u**3)) / u**9
                * bessel_ratio(u**3),
                [mpf("1e-6"), 0.1, 0.5, 1, 2, 3, 4.4],
            )  # fmt: skip
            exact_value = -8 / (mp.pi**2 * a**2) * integral
            assert abs(mpf(float(finite_radius(alpha).depth)) / exact_value - 1) < 1e-14
    alpha = np.linspace(0.01, 0.99, 50)
    step = 1e-5
    low, high = (finite_radius(alpha * f).depth * (alpha * f) ** 2 for f in (1 - step, 1 + step))
    slope = (high - low) / (2 * step * alpha) / (2 * alpha)
    np.testing.assert_allclose(finite_radius(alpha).slope, slope, rtol=1e-8)
    assert (finite_radius(alpha).slope <= 0).all()
    assert (-finite_radius(alpha).slope <= LATERAL_LINEAR * alpha + LATERAL_CUBIC * alpha**3).all()


def test_bending_agrees_with_thin_plate_theory() -> None:
    """The bending deflection is that of a thin plate, P b^2/(8 pi D) with D = E* H^3/12."""
    a, R, h, b, E = 0.01, 0.3, 0.02, 0.7, 3e9
    P, D = 4 / 3 * E * a**3 / R, E * (2 * h) ** 3 / 12
    contribution = P * b**2 / (8 * math.pi * D) * R / a**2
    assert bending(a / h, h / b).depth == pytest.approx(contribution, rel=1e-15)
    assert BY_NAME["bending"].value(model(R=R, h=h, b=b), a) == pytest.approx(
        2 / math.pi * a * b**2 / (2 * h) ** 3, rel=1e-15
    )


def test_parameters_of_plate_motion_agree_with_their_definitions() -> None:
    R, m, v0, h, b, lam, mu, rho = 0.01, 0.03, 2.0, 0.004, 0.5, 2e10, 3e10, 2500.0
    E, H = 4 * mu * (lam + mu) / (lam + 2 * mu), 2 * h
    D, K = E * H**3 / 12, 4 / 3 * E * math.sqrt(R)
    T = (m**2 / (K**2 * v0)) ** 0.2
    exact_value = m / (8 * T * math.sqrt(D * rho * H))
    assert zener_number(R, m, v0, h, lam, mu, rho) == pytest.approx(exact_value, rel=1e-14)
    omega = 2.404825557695773**2 / b**2 * math.sqrt(D / (rho * H))
    period = bending_period(h, b, lam, mu, rho)
    assert period == pytest.approx(2 * math.pi / omega, rel=1e-14)
    assert echo_time(h, lam, mu, rho) == pytest.approx(
        4 * H / math.sqrt((lam + 2 * mu) / rho), rel=1e-14
    )


@pytest.mark.parametrize(
    ("call", "good", "bad"),
    [
        (sphere_contact, (0.5,), [(-0.1,), (1.0,), (math.nan,), (math.inf,)]),
        (finite_radius, (0.5,), [(-0.1,), (1.0,), (math.nan,)]),
        (bending, (0.5, 0.1), [(-1.0, 0.1), (1.0, 0.0), (1.0, -1.0)]),
        (echo_time, (1.0, 1.0, 1.0, 1.0), [(0.0, 1.0, 1.0, 1.0), (1.0, -1.0, 1.0, 1.0)]),
    ],
)
def test_results_are_nan_outside_the_domain_and_keep_single_precision(
    call: Any, good: tuple[float, ...], bad: list[tuple[float, ...]]
) -> None:
    with np.errstate(all="raise"):
        for point in bad:
            assert np.isnan(np.asarray(call(*point))).all()
        single = np.asarray(call(*(np.float32(x) for x in good)))
        assert single.dtype == np.float32
        several = np.asarray(call(*([x, x] for x in good)))
        assert several.shape[-1] == 2
        assert np.isfinite(several).all()
