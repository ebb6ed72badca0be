"""Mutation tests of hand-written algorithms: independent values detect each error."""

import math
from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import pytest
from mpmath import mp, mpf
from mutated_code import ModuleTests, undetected
from within_ulp import WithinUlp, expected

from derivation.plate.contact.oracle import balls as contact_balls
from generated.bessel_numbers import ASYMPTOTIC_START, LARGEST_PHASE

NAN = math.nan


# --- Bessel functions


def bessel_cases() -> list[WithinUlp]:
    """Return cases at both sides of each switch point, near zeros, and at very large arguments."""
    inside = [0.0, 1e-300, 1e-5, 0.5, 1.841, 5.0, 11.7, ASYMPTOTIC_START - 1e-9, 17.0]
    near = [2.404825557695773, 3.8317059702075125, 14.930917708487787, 30.634606468431976]
    beyond = [ASYMPTOTIC_START, 26.0, 31.0, 1e3, 123456.789, 1e10, 3e13]
    far = [LARGEST_PHASE, 1.3 * LARGEST_PHASE, 1e20, 3e300]
    every = [*inside, *near, *beyond, *far]
    points = [(x,) for x in (*every, *(-x for x in every), NAN, math.inf, -math.inf)]
    actual = []
    with mp.workdps(340):
        for order in (0, 1):
            exact = [mp.besselj(order, x) if math.isfinite(x) else NAN for (x,) in points]
            actual += expected(f"bessel_j{order}", points, exact, 1.5)
            actual.append(single(f"bessel_j{order}", float(mp.besselj(order, 5))))
    for count in (0, 1, 5, 30):
        actual += map(counted, *zip(*zeros(count), strict=True))
    return actual


def single(name: str, exact: float) -> WithinUlp:
    """Return the case of a function in single precision."""
    return WithinUlp(lambda m: getattr(m, name)(np.float32(5)), np.asarray(np.float32(exact)), 0.0)


@cache
def zeros(count: int) -> list[tuple[str, tuple[float, ...]]]:
    with mp.workdps(40):
        both = [[mp.besseljzero(n, k) for k in range(1, count + 1)] for n in (0, 1)]
        slopes = [float(mp.besselj(1, x)) for x in both[0]]
        rows = [tuple(map(float, row)) for row in both]
    return [
        ("bessel_j0_zeros", rows[0]),
        ("bessel_j1_zeros", rows[1]),
        ("bessel_j1_at_j0_zeros", tuple(slopes)),
    ]


def counted(name: str, row: tuple[float, ...]) -> WithinUlp:
    return WithinUlp(lambda m: getattr(m, name)(len(row)), np.array(row), 0.6)


# --- single effects


def elastic(lam: float, mu: float) -> mpf:
    """Return E* of a plate."""
    return 4 * mpf(mu) * (mpf(lam) + mu) / (mpf(lam) + 2 * mpf(mu))


def effect_cases() -> list[WithinUlp]:
    with mp.workdps(40):
        return [*profile_cases(), *lateral_cases(), *motion_cases()]


def profile_cases() -> list[WithinUlp]:
    def sneddon(x: float) -> tuple[mpf, ...]:
        x, logarithm = mpf(x), mp.log((1 + mpf(x)) / (1 - mpf(x)))
        depth = logarithm / (2 * x)
        force = 3 * ((1 + x * x) / 2 * logarithm - x) / (4 * x**3)
        return force, depth, (depth + 1 / (1 - x * x)) / 2

    radii = [1e-3, 0.2, 0.499, 0.5, 0.7, 0.999]
    outside = [-0.1, 1.0, 1.5, NAN]
    exact = [*map(sneddon, radii), (1.0, 1.0, 1.0), *[(NAN,) * 3] * 4]
    bent = [(0.3, 0.1), (0.0, 2.0), (5.0, 1e-3)]
    beyond = [(-0.3, 0.1), (0.3, 0.0), (0.3, -1.0)]
    contributions = [mpf(a) / (4 * mp.pi * mpf(eta) ** 2) for a, eta in bent]
    return [
        *expected("sphere_contact", [(x,) for x in (*radii, 0.0, *outside)], exact, 8.0),
        *expected(
            "bending",
            [*bent, *beyond],
            [*((s, 1.5 * s) for s in contributions), *[(NAN,) * 2] * 3],
            4.0,
        ),
    ]


def lateral_cases() -> list[WithinUlp]:
    balls = [contact_balls.kappa(2 * k, 20).mid() for k in range(20)]
    kappas = [mpf(ball.str(24, radius=False)) for ball in balls]

    def contribution(alpha: float) -> tuple[mpf, mpf]:
        terms = [
            -8
            / mp.pi**2
            * kappa
            * (2 * k - 2)
            / mp.factorial(2 * k - 1)
            * mpf(alpha) ** (2 * k - 3)
            for k, kappa in enumerate(kappas, start=2)
        ]
        steeper = (term * (2 * k - 1) / 2 for k, term in enumerate(terms, start=2))
        return mp.fsum(terms), mp.fsum(steeper)

    alphas = [1e-3, 0.3, 0.6]
    exact = [*map(contribution, alphas), (0.0, 0.0), *[(NAN,) * 2] * 3]
    return expected("finite_radius", [(x,) for x in (*alphas, 0.0, -0.1, 1.0, 1.5)], exact, 8.0)


SOLID = (0.36e9, 0.43e9), (-0.6, 1.0), (-0.66, 1.0), (-0.3, 0.5), (-1.3, 2.0)
"""Lame constants of valid solids, 3 lam > -2 mu."""
NO_SOLID = (-0.67, 1.0), (-0.8, 1.0), (-0.4, 0.5), (-1.4, 2.0), (1.0, 0.0), (1.0, -0.4)


def in_domain(
    name: str,
    exact: Callable[..., mpf],
    of: Callable[[float, float], tuple[float, ...]],
    positive: Sequence[int],
    ulp: float,
) -> list[WithinUlp]:
    """Return cases for valid solids, and NaN for invalid solids or non-positive arguments."""
    points = [of(*elasticity) for elasticity in SOLID]
    outside = [of(*elasticity) for elasticity in NO_SOLID]
    for index in positive:
        for value in (0.0, -1.0):
            outside.append((*points[0][:index], value, *points[0][index + 1 :]))
    values = [*(exact(*map(mpf, point)) for point in points), *[NAN] * len(outside)]
    return expected(name, [*points, *outside], values, ulp)  # fmt: skip


def motion_cases() -> list[WithinUlp]:
    def zener(*numbers: mpf) -> mpf:
        R, m, v0, h, lam, mu, rho = numbers
        K = 4 * elastic(lam, mu) * mp.sqrt(R) / 3
        T = (m**2 / (K**2 * v0)) ** (mpf(1) / 5)
        return m / (8 * T * mp.sqrt(elastic(lam, mu) * (2 * h) ** 3 / 12 * rho * 2 * h))

    def period(h: mpf, b: mpf, lam: mpf, mu: mpf, rho: mpf) -> mpf:
        D = elastic(lam, mu) * (2 * h) ** 3 / 12
        return 2 * mp.pi * b**2 / mp.besseljzero(0, 1) ** 2 * mp.sqrt(rho * 2 * h / D)

    def echo(h: mpf, lam: mpf, mu: mpf, rho: mpf) -> mpf:
        return 8 * h / mp.sqrt((lam + 2 * mu) / rho)

    return [
        *in_domain("zener_number", zener, lambda *e: (0.3, 0.7, 0.9, 0.02, *e, 0.95),
                   (0, 1, 2, 3, 6), 8.0),
        *in_domain("bending_period", period, lambda *e: (0.02, 0.3, *e, 0.95), (0, 1, 4), 8.0),
        *in_domain("echo_time", echo, lambda *e: (0.02, *e, 0.95), (0, 3), 8.0),
    ]  # fmt: skip


# --- viscoelastic contact


def viscosity_cases() -> list[WithinUlp]:
    with mp.workdps(40):

        def number(*numbers: mpf) -> mpf:
            R, m, v0, lam, mu, time = numbers
            K = 4 * elastic(lam, mu) * mp.sqrt(R) / 3
            return 3 * time / 2 * (K / m) ** mpf("0.4") * v0 ** mpf("0.2")

        C = mpf("0.8") ** mpf("0.4") * mp.beta(mpf("0.6"), mpf("1.5"))
        weak = [1 - C * mpf(x) + mpf("0.6") * C**2 * mpf(x) ** 2 for x in (0.0, 0.5, 3.0)]
        points = [(x,) for x in (0.0, 0.5, 3.0, -0.1, NAN)]
        return [
            *in_domain("viscous_number", number, lambda *e: (0.3, 0.7, 0.9, *e, 1e-5),
                       (0, 1, 2, 5), 8.0),
            *expected("restitution_weak", points, [*weak, NAN, NAN], 4.0),
            *map(logarithms, EXTREMES),
        ]  # fmt: skip


EXTREMES = (
    (0.1, 1.0, 0.0, 0.2, 0.8, 0.4, 1.0),
    (0.6, 1.4, 0.1, 0.2, 0.8, 0.4, 1.0),
    (0.99, 1.9, 0.0, 0.2, 0.8, 0.4, 1.0),
    (0.4, 1.2, 3.0, 0.2, 0.8, 0.4, 1.1),
    (0.01, 1.2, 0.1, 0.2, 0.8, 0.4, 9.0),
    (0.1, 1.2, 0.1, 0.2, 0.8, 0.4, 9.0),
    (0.05, 1.2, 0.1, 0.2, 0.8, 0.4, 9.0),
    (1.0, 0.5, 0.0, 0.2, 0.8, 0.4, 1.0),
    (1.5, 0.5, 0.0, 0.2, 0.8, 0.4, 1.0),
    (0.9, 2.3, 0.0, 0.2, 0.8, 0.4, 1.0),
    (0.5, 3.9, 0.0, 0.2, 0.8, 0.4, 1.0),
)
"""Weak to strong viscosity, with gravity, and without a finite bound."""


def logarithms(extremes: tuple[float, ...]) -> WithinUlp:
    """Return the case of the bounds of derivation step 24, as stated in its text."""
    epsilon, n, fall, rise, depth, radius, u = map(mpf, extremes)
    exact = [mp.inf] * 5
    if epsilon < 1 and n * epsilon < 2:
        Lambda = mp.pi / 2 * epsilon / (1 - epsilon / 2)
        lost = u * (1 - mp.exp(-2 * Lambda) / (1 + epsilon**2))
        if lost < 1:
            rebound = max(-mp.log(1 - lost), mp.log(1 + (u - 1) * n * epsilon)) / 2
            longer = rise * Lambda - mp.log(1 - epsilon / 2)
            shorter = fall * Lambda + mp.log(1 + epsilon / 2) - mp.log(1 - n * epsilon / 2)
            slower = rebound if u > 1 else 0
            turned = mp.pi / 4 * epsilon
            force = max(mp.log(1 + epsilon**2) / 2, (1 + rise) * turned)
            exact = [max(longer, shorter) + slower, depth * turned, force, radius * turned, rebound]
    return WithinUlp(
        lambda m: m.viscous_logarithms(m.ImpactExtremes(*extremes)),
        np.array([float(x) for x in exact]),
        32.0,
    )


TESTS = {
    "bessel": ModuleTests(
        bessel_cases,
        {
            "_modulus_phase": (3, "a sign; and the multiple of pi that is subtracted"),
            "bessel_j1_at_j0_zeros": (1, "a sign"),
        },
    ),
    "effects": ModuleTests(effect_cases),
    "viscosity": ModuleTests(viscosity_cases),
}


@pytest.mark.parametrize("name", TESTS)
def test_mutants_are_detected_up_to_the_listed_number(name: str) -> None:
    assert undetected(name, TESTS[name]) == {}
