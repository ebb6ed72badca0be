"""Algorithms written by hand with one thing wrong, in memory: independent values notice it."""

import math
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
import pytest
from mpmath import mp, mpf
from mutated_code import GUARDS, SAME, SIZE, named, survivors

from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle import moments
from derivation.plate.pressure import oracle as pressure_balls
from generated.bessel_numbers import ASYMPTOTIC_START, LARGEST_PHASE

NAN = math.nan


class Sharp(NamedTuple):
    """What a function gives: values of the type and shape here, within so many of their ULP."""

    call: Callable[[ModuleType], Any]
    true: np.ndarray
    ulp: float

    def holds(self, module: ModuleType) -> bool:
        found = np.asarray(self.call(module))
        if found.shape != self.true.shape or found.dtype != self.true.dtype:
            return False
        with np.errstate(all="ignore"):
            close = np.abs(found - self.true) <= self.ulp * np.spacing(np.abs(self.true))
        return bool((close | (found == self.true) | (np.isnan(found) & np.isnan(self.true))).all())


def expected(
    name: str, points: Sequence[tuple[float, ...]], true: Sequence[Any], ulp: float
) -> list[Sharp]:
    """All points at once, in single precision too, and every one as a scalar."""
    values = np.array([[float(x) for x in np.atleast_1d(row)] for row in true])
    values = values[:, 0] if values.shape[1] == 1 else values.T
    columns = [np.array(column, dtype=float) for column in zip(*points, strict=True)]
    found = [Sharp(lambda m: getattr(m, name)(*columns), values, ulp)]
    for index, point in enumerate(points):
        one = np.float64(values[..., index])
        found.append(Sharp(lambda m, point=point: getattr(m, name)(*point), one, ulp))
    return found


# --- Bessel functions


def bessel_cases() -> list[Sharp]:
    """Both sides of every method, beside zeros, and arguments as large as there are."""
    inside = [0.0, 1e-300, 1e-5, 0.5, 1.841, 5.0, 11.7, ASYMPTOTIC_START - 1e-9, 17.0]
    beside = [2.404825557695773, 3.8317059702075125, 14.930917708487787, 30.634606468431976]
    beyond = [ASYMPTOTIC_START, 26.0, 31.0, 1e3, 123456.789, 1e10, 3e13]
    far = [LARGEST_PHASE, 1.3 * LARGEST_PHASE, 1e20, 3e300]
    every = [*inside, *beside, *beyond, *far]
    points = [(x,) for x in (*every, *(-x for x in every), NAN, math.inf, -math.inf)]
    found = []
    with mp.workdps(340):
        for order in (0, 1):
            true = [mp.besselj(order, x) if math.isfinite(x) else NAN for (x,) in points]
            found += expected(f"bessel_j{order}", points, true, 1.5)
            found.append(single(f"bessel_j{order}", float(mp.besselj(order, 5))))
    for count in (0, 1, 5, 30):
        found += map(counted, *zip(*zeros(count), strict=True))
    return found


def single(name: str, true: float) -> Sharp:
    """In single precision."""
    return Sharp(lambda m: getattr(m, name)(np.float32(5)), np.asarray(np.float32(true)), 0.0)


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


def counted(name: str, row: tuple[float, ...]) -> Sharp:
    return Sharp(lambda m: getattr(m, name)(len(row)), np.array(row), 0.6)


# --- constants by index


def series_cases() -> list[Sharp]:
    found = []
    for name, start, last in (("kappa", 0, 196), ("finite_part", 2, 99)):
        some = [start, start + 1, start + 4, 17, 30, 60, last]
        true: Callable[[int, int], Any] = getattr(moments, name)
        ratio: Callable[[int, int], Any] = getattr(moments, f"{name}_ratio")
        nowhere = [start - 1, -3, 2.5, 1e6 + 0.5, NAN]
        values = [*(float(true(n, 80)) for n in some), *[NAN] * (len(nowhere) + 1)]
        found += expected(name, [(x,) for x in (*some, *nowhere, last + 1)], values, 0.51)
        some += [last + 1, 1000, 10**6]
        values = [*(float(ratio(n, 80)) for n in some), *[NAN] * len(nowhere)]
        found += expected(f"{name}_ratio", [(x,) for x in (*some, *nowhere)], values, 0.51)
        large = np.array([np.nan, float(true(10, 80))], dtype=np.float32)
        index = np.array([60, 10], dtype=np.float32)
        found.append(Sharp(lambda m, x=index, n=name: getattr(m, n)(x), large, 0.0))
    return found


# --- single effects


def elastic(lam: float, mu: float) -> mpf:
    """E* of a plate."""
    return 4 * mpf(mu) * (mpf(lam) + mu) / (mpf(lam) + 2 * mpf(mu))


def effect_cases() -> list[Sharp]:
    with mp.workdps(40):
        return [*profile_cases(), *wall_cases(), *motion_cases()]


def profile_cases() -> list[Sharp]:
    def sneddon(x: float) -> tuple[mpf, ...]:
        x, logarithm = mpf(x), mp.log((1 + mpf(x)) / (1 - mpf(x)))
        depth = logarithm / (2 * x)
        force = 3 * ((1 + x * x) / 2 * logarithm - x) / (4 * x**3)
        return force, depth, (depth + 1 / (1 - x * x)) / 2

    radii = [1e-3, 0.2, 0.499, 0.5, 0.7, 0.999]
    outside = [-0.1, 1.0, 1.5, NAN]
    true = [*map(sneddon, radii), (1.0, 1.0, 1.0), *[(NAN,) * 3] * 4]
    bent = [(0.3, 0.1), (0.0, 2.0), (5.0, 1e-3)]
    beyond = [(-0.3, 0.1), (0.3, 0.0), (0.3, -1.0)]
    shares = [mpf(a) / (4 * mp.pi * mpf(eta) ** 2) for a, eta in bent]
    return [
        *expected("sphere_contact", [(x,) for x in (*radii, 0.0, *outside)], true, 8.0),
        *expected(
            "bending", [*bent, *beyond], [*((s, 1.5 * s) for s in shares), *[(NAN,) * 2] * 3], 4.0
        ),
    ]


def wall_cases() -> list[Sharp]:
    balls = [contact_balls.kappa(2 * k, 20).mid() for k in range(20)]
    kappas = [mpf(ball.str(24, radius=False)) for ball in balls]

    def share(alpha: float) -> tuple[mpf, mpf]:
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
    true = [*map(share, alphas), (0.0, 0.0), *[(NAN,) * 2] * 3]
    return expected("side_wall", [(x,) for x in (*alphas, 0.0, -0.1, 1.0, 1.5)], true, 8.0)


SOLID = (0.36e9, 0.43e9), (-0.6, 1.0), (-0.66, 1.0), (-0.3, 0.5), (-1.3, 2.0)
"""Lame's constants; 3 lam is above -2 mu."""
NO_SOLID = (-0.67, 1.0), (-0.8, 1.0), (-0.4, 0.5), (-1.4, 2.0), (1.0, 0.0), (1.0, -0.4)


def in_domain(
    name: str,
    true: Callable[..., mpf],
    of: Callable[[float, float], tuple[float, ...]],
    positive: Sequence[int],
    ulp: float,
) -> list[Sharp]:
    """At solids, and NaN for what is none, or where one of the other arguments is not positive."""
    points = [of(*elasticity) for elasticity in SOLID]
    outside = [of(*elasticity) for elasticity in NO_SOLID]
    for place in positive:
        for value in (0.0, -1.0):
            outside.append((*points[0][:place], value, *points[0][place + 1 :]))
    values = [*(true(*map(mpf, point)) for point in points), *[NAN] * len(outside)]
    return expected(name, [*points, *outside], values, ulp)  # fmt: skip


def motion_cases() -> list[Sharp]:
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


# --- viscous contact


def viscosity_cases() -> list[Sharp]:
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
            *map(logarithms, COURSES),
        ]  # fmt: skip


COURSES = (
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
"""Weak to strong, with a weight, and where nothing is shown."""


def logarithms(course: tuple[float, ...]) -> Sharp:
    """The bounds of link 24 as its text has them."""
    epsilon, n, fall, rise, depth, radius, u = map(mpf, course)
    true = [mp.inf] * 5
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
            true = [max(longer, shorter) + slower, depth * turned, force, radius * turned, rebound]
    return Sharp(
        lambda m: m.viscous_logarithms(m.Course(*course)), np.array([float(x) for x in true]), 32.0
    )


# --- solved pressure

SOLVED = (
    # a/h, b/h, R/h, share of E*, sphere
    (0.5, 2.0, 0.8, 0.75, True),
    (3.0, 10.0, 50.0, 1.0, False),
    (0.9, 1.2, 2.0, 0.6, False),
    (5.0, 8.5, 90.0, 1.0, False),
    (2.0, 40.0, 3.0, 0.75, True),
    (5.5, 300.0, 90.0, 1.0, False),
)
E, H = 7e10, 0.125
PLACES = 0.25, 0.9375


def pressure_cases() -> list[Sharp]:
    found = []
    for numbers in SOLVED:
        for compliance in (0.0, 2e-10):
            found.append(solved(*numbers, compliance))
        found.append(distribution(*numbers))
    found += [work(*numbers) for numbers in SOLVED[1:3]]
    return [*found, *refused(), in_other_units(0.5)]


@cache
def state(a: float, v: float, R: float, share: float, sphere: bool) -> pressure_balls.PressureState:
    places = () if sphere else PLACES
    return pressure_balls.solve(
        pressure_balls.case(a, 1.0, v, R if sphere else 0, share, places), 18
    )


def solved(a: float, v: float, R: float, share: float, sphere: bool, compliance: float) -> Sharp:
    """Force, indentation, stiffness, slope, both pressures, and the nodes' sum of chi."""
    true, own = state(a, v, R, share, sphere), share * E
    width, radius = a * H, R * H
    force = own * width**3 / radius * float(true.force)
    stiffness = own * width * float(true.stiffness)
    nodes, weights = (x[len(x) // 2 :] for x in np.polynomial.legendre.leggauss(48))
    values = [
        force,
        width**2 / radius * float(true.depth) + compliance * force,
        1 / (1 / stiffness + compliance),
        width / radius * float(true.slope) * (1 + compliance * stiffness),
        own * width / radius * float(true.centre),
        force / (math.pi * width**2),
        width,
        force,
        width * nodes[0],
    ]

    def call(m: ModuleType) -> list[float]:
        radii = np.full(9, width)  # more than are worked on at a time
        every = m.contact(
            m.plate(H, v * H), radii, radius, own, E, sphere=sphere, compliance=compliance
        )
        got = [x[-1] for x in every]
        carried = 2 * np.pi * width * weights @ got[9]
        return [*got[1:5], *got[6:8], got[0], carried, got[8][0]]

    return Sharp(call, np.array(values), 4000.0)


def distribution(a: float, v: float, R: float, share: float, sphere: bool) -> Sharp:
    """The pressure's distribution: against the oracle, or that it carries the force."""
    true, own = state(a, v, R, share, sphere), share * E
    width, radius = a * H, R * H
    nodes, weights = np.polynomial.legendre.leggauss(40)
    u, w = (1 + nodes) / 2, weights / 2

    def call(m: ModuleType) -> list[float]:
        of = m.plate(H, v * H)
        r = np.append(width * np.sqrt((1 - u) * (1 + u)), [PLACES[0] * width, PLACES[1] * width])
        q = m.pressure(r, of, width, radius, own, E, sphere=sphere)
        ends = m.pressure([-0.1 * width, 1.01 * width], of, width, radius, own, E, sphere=sphere)
        alone = m.pressure(width, of, width, radius, own, E, sphere=sphere)
        carried = 2 * np.pi * width**2 * (q[:40] * u) @ w
        return [carried, *([] if sphere else q[40:]), *ends, alone]

    force = own * width**3 / radius * float(true.force)
    places = [own * width / radius * float(x) for x in true.pressures]
    return Sharp(call, np.array([force, *places, NAN, NAN, 0.0]), 4000.0)


def work(a: float, v: float, R: float, share: float, sphere: bool) -> Sharp:
    """dU = P d delta along a."""
    width, radius = a * H, R * H
    nodes, weights = np.polynomial.legendre.leggauss(30)

    def call(m: ModuleType) -> float:
        of, kept = m.plate(H, v * H), {"sphere": sphere, "compliance": 2e-10}
        path = m.contact(of, width * (1 + nodes) / 2, radius, share * E, E, **kept)
        end = m.contact(of, width, radius, share * E, E, **kept)
        return float(width * (path.force * path.slope) @ weights / 2 / end.energy)

    return Sharp(call, np.asarray(1.0), 1e6)


def in_other_units(unit: float) -> Sharp:
    """Force and pressure go with E*, however small it is."""

    def call(m: ModuleType) -> list[float]:
        of = m.plate(H, 2 * H)
        one, other = (
            (float(m.contact(of, 0.1, 1.0, x).force), float(m.pressure(0.05, of, 0.1, 1.0, x)))
            for x in (1.0, unit)
        )
        return [small / large for small, large in zip(other, one, strict=True)]

    return Sharp(call, np.full(2, unit), 2.0)


def refused() -> list[Sharp]:
    """Where there is no contact, or no plate."""
    within = 0.1, 1.0, 50.0, 1.0, 1.0
    outside = [
        (0.0, *within[1:]), (-0.1, *within[1:]), (0.951, *within[1:]), (0.1, 1.0, 0.1, 1.0, 1.0),
        (0.1, 1.0, 50.0, 0.0, 1.0), (0.1, 1.0, 50.0, 1.0, 0.9), (7.01, 1e3, 50.0, 1.0, 1.0),
        (6.5, 1e3, 50.0, 1.0, 1.0),
    ]  # fmt: skip

    def force(m: ModuleType, a: float, b: float, R: float, modulus: float, own: float) -> float:
        return float(m.contact(m.plate(1.0, b), a, R, modulus, own).force)

    found = [Sharp(lambda m, p=point: force(m, *p), np.asarray(NAN), 0.0) for point in outside]
    none = np.array([NAN, NAN, 0.0, 0.0])
    sizes = (0.0, 1.0), (1.0, 0.0), (-1.0, -2.0), (1e-91, 1.0), (1e91, 1.0), (1e-60, 1e60)
    for size in (*sizes, (1e60, 1e-60)):
        found.append(Sharp(lambda m, size=size: numbers_of(m.plate(*size)), none, 0.0))
    thin = Sharp(lambda m: float(m.plate(1.0, 100.0).rises.size), np.asarray(0.0), 0.0)
    return [*found, thin]


def numbers_of(plate: Any) -> list[float]:
    return [plate.h, plate.first, plate.waves.size, plate.rises.size]


MORE = "more terms or fewer, which are below rounding"
TURNS = "whichever multiple of pi is taken off, its sine has the digits"
OPEN = "a contact opens before it is as wide"

EQUIVALENT: Mapping[str, Mapping[str, Sequence[str]]] = {
    "bessel": {
        SIZE: ["_BLOCK: 8192 -> 16384 in _BLOCK = 8192"],
        TURNS: [
            "_modulus_phase: 0.25 * quarter -> 0.25 / quarter",
            "_modulus_phase: 0.25 -> 0.5 in 0.25 * quarter",
        ],
        SAME: [  # a sign
            (
                "_modulus_phase: wave *= 1.0 - 4.0 * (half - np.floor(half)) -> "
                "wave /= 1.0 - 4.0 * (half - np.floor(half))"
            ),
            (
                "bessel_j1_at_j0_zeros: slope[FIRST_MCMAHON[0] % 2::2] *= -1.0 -> "
                "slope[FIRST_MCMAHON[0] % 2::2] /= -1.0"
            ),
        ],
    },
    "series_constants": {
        MORE: ["kappa_ratio: 2 -> 4 in len(KAPPA_STEPS) - 2"],
        GUARDS: ["_looked_up: 0.0 -> 1 in np.where(known, place, 0.0)"],
    },
    "effects": {},
    "viscosity": {},
    "non_hertzian_pressure": {
        SIZE: ["_BLOCK: 8 -> 16 in _BLOCK = 8"],
        MORE: [
            "plate: 2.0 * np.pi -> 2.0 / np.pi",
            "plate: 2 -> 4 in int(FADED / (2.0 * np.pi * eta)) + 2",
        ],
        OPEN: ["contact: WIDEST * plate.h -> WIDEST / plate.h"],
        GUARDS: ["_solve: 0.0 -> 1 in np.where(np.isfinite(kernel), kernel, 0.0)"],
        SAME: ["_profile: x * c -> x / c"],
    },
}
"""Mutants that change no result, by the reason; every other one must be noticed."""

CASES: Mapping[str, Callable[[], list[Sharp]]] = {
    "bessel": bessel_cases,
    "series_constants": series_cases,
    "effects": effect_cases,
    "viscosity": viscosity_cases,
    "non_hertzian_pressure": pressure_cases,
}


@pytest.mark.parametrize("name", CASES)
def test_every_mutant_of_a_runtime_is_noticed_or_changes_nothing(name: str) -> None:
    found = sorted(mutant.name for mutant in survivors(name, CASES[name]()))
    assert found == named(EQUIVALENT[name])
