"""The generated contact law and impact against brute sums in ball arithmetic."""

import itertools
from functools import cache

import flint
import numpy as np
import pytest
from flint import arb

from derivation.plate.contact.kernels import tables
from derivation.plate.contact.kernels.moments import finite_parts, kappas
from generated import contact_law as law
from generated import contact_series, impact, reversed_series

BITS = 160
BUDGET = 2e-15
"""Of the law, relative to max(1 + F, |F|)."""
LAM, MU = 6e10, 8e10
THICK = (0.34, 0.4, 0.5302, 1.0, 3.0, 10.0, 100.0)
SEAMS = [float(np.nextafter(1 / v, side)) for v in (3, 4, 6, 11) for side in (0, 1)]
ETAS = (1e-3, 0.01, 0.05, 0.08, *SEAMS, 0.1, 0.14, 0.17, 0.2, 0.25, 0.3, *THICK)
NEAR = (1e-8, 1e-3, 0.1, 0.4999999, 0.5000001, 1.0, 2.0, 2.9, 2.999999)
RADII = (*NEAR, 3.000001, 3.2, 4.0, 5.0, 5.999)
HERTZ_TIME = 2.9432751843247046
"""2 int_0^1 dx/sqrt(1 - x^(5/2)), from theory: twice 1.4716375921623523."""


@cache
def modes(eta: float) -> list[tuple[arb, arb]]:
    """j_n and (G - 1)/(j_n J1^2) until G - 1 is below e^-80."""
    with flint.ctx.workprec(BITS):
        found = []
        for n in itertools.count(1):
            beta = (arb(n) - arb(1) / 4) * arb.pi()
            x = beta + 1 / (8 * beta) - 31 / (384 * beta**3)
            for _ in range(6 if n < 10 else 4 if n < 100 else 2):
                x = (x + x.bessel_j(0) / x.bessel_j(1)).mid()
            T = 2 * arb(eta) * x
            if T > 44:
                return found
            excess = ((1 - (-2 * T).exp()) / 2 + T + T * T) / (T.sinh() ** 2 - T * T)
            found.append((x, excess / (x * x.bessel_j(1) ** 2)))
    raise AssertionError


@cache
def edge_moments() -> tuple[arb, ...]:
    """kappa_0, kappa_2, ... by trapezoids, step 1/20 in ln y."""
    with flint.ctx.workprec(900):
        step, sums = arb(1) / 20, [arb(0)] * 45
        for i in range(-95 * 20, 5 * 20 + 8):
            y = (step * i).exp()
            share = step * y * y.bessel_k(0) / y.bessel_i(0)
            for n in range(45):
                sums[n] += share
                share *= y * y
        return tuple(total.mid() for total in sums)


def truth(A: arb, eta: float) -> tuple[arb, arb]:
    """F and A F' at the precision now set."""
    alpha = A * arb(eta)
    total, slope = arb(0), arb(0)
    for zero, weight in modes(eta):
        y = alpha * zero
        sine, cosine = y.sin(), y.cos()
        g = 3 * (sine - y * cosine) / y**3
        total += weight * g
        slope += weight * (3 * sine / y - 2 * g)
    factor = 8 * alpha / (3 * arb.pi())
    F, rise, power, factorial = factor * total, factor * slope, alpha, arb(6)
    for k, kappa in enumerate(edge_moments(), start=2):
        share = -8 * kappa * (2 * k - 2) / factorial * power / arb.pi() ** 2
        F += share
        rise += (2 * k - 3) * share
        power *= alpha * alpha
        factorial *= (2 * k) * (2 * k + 1)
    return F, rise


def radii(eta: float) -> list[float]:
    return [A for A in RADII if A * eta < 1] + [x / eta for x in (0.99, 0.5) if x / eta < 6]


def law_error(eta: float, points: list[float]) -> float:
    """Largest error of delta over (a^2/R) max(1 + F, |F|); h = 1."""
    b = 1 / eta
    eta = 1.0 / b
    worst = 0.0
    values = law.indentation(np.array(points), 1e6, 1.0, b)
    for A, got in zip(points, values.tolist(), strict=True):
        with flint.ctx.workprec(BITS):
            F, _ = truth(arb(A), eta)
            scale = max(float(abs(1 + F)), float(abs(F)))
            worst = max(worst, float(abs(arb(got) * 10**6 / arb(A) ** 2 - 1 - F)) / scale)
    return worst


def test_the_tables_rest_on_the_right_integrals() -> None:
    with flint.ctx.workprec(BITS):
        for ours, other in zip(kappas()[:12:2], edge_moments(), strict=False):
            assert abs(ours - other) < arb(2) ** -100 * other
        second, third = finite_parts()[:2]
        assert abs(second - arb("-1.12648392978257645242944")) < 1e-22
        assert abs(third - arb("7.72386466370692885870034")) < 1e-22


@pytest.mark.parametrize("eta", ETAS)
def test_law(eta: float) -> None:
    assert law_error(eta, radii(eta)) < BUDGET


def test_law_of_a_very_thin_plate() -> None:
    assert law_error(1e-4, [1e-6, 0.3, 2.9, 5.5]) < BUDGET


def test_law_beyond_the_polynomials() -> None:
    assert law_error(0.02, [6.5, 12.0, 30.0, 49.0]) < BUDGET


def test_stiffness() -> None:
    for eta in (0.03125, 0.125, 0.25, 0.5, 4.0):
        for A in radii(eta):
            with flint.ctx.workprec(BITS):
                F, rise = truth(arb(A), eta)
                expected = 16 * arb(MU) * (arb(LAM) + MU) / (arb(LAM) + 2 * MU)
                expected *= arb(A) / (2 * (1 + F) + rise)
                got = law.stiffness(A, 1e6, 1.0, 1 / eta, LAM, MU)
                assert abs(arb(float(got)) / expected - 1) < 3e-15, (eta, A)


@pytest.mark.parametrize("eta", [*ETAS, 1e-4, 1e-6])
def test_inversion_round_trip(eta: float) -> None:
    random = np.random.default_rng(3)
    top = min(6.0, 0.9999999 / eta)
    A = np.concatenate((10 ** random.uniform(-12, np.log10(top), 300), [top]))
    back = law.contact_radius(law.indentation(A, 1e6, 1.0, 1 / eta), 1e6, 1.0, 1 / eta)
    assert np.abs(back / A - 1).max() < 2e-15


def test_force_and_its_inverse() -> None:
    a = np.geomspace(1e-9, 1e-3, 50)
    P = law.force_of_radius(a, 0.02, LAM, MU)
    assert np.abs(law.radius_of_force(P, 0.02, LAM, MU) / a - 1).max() < 1e-15
    delta = law.indentation(a, 0.02, 1e-3, 0.02)
    assert np.abs(law.force(delta, 0.02, 1e-3, 0.02, LAM, MU) / P - 1).max() < 5e-15
    mean = P / (np.pi * a**2)
    assert np.allclose(law.max_pressure(a, 0.02, LAM, MU), 1.5 * mean, rtol=1e-14, atol=0)


def test_reversed_series_within_its_radius_and_not_beyond() -> None:
    plate_coefficients = contact_series.plate_coefficients
    reversed_force = reversed_series.force_by_series
    for b in (5.0, 20.0, 1000.0, 1.5):
        c1 = float(plate_coefficients(1 / b)[0])
        limit = 2 / (3 * np.sqrt(3) * abs(c1))  # of c1 alone
        eps = np.array([0.1, 0.3, 0.5]) * min(limit, 0.9 * min(3.0, b))
        delta = eps**2 / 1e6
        exact = law.force(delta, 1e6, 1.0, b, LAM, MU)
        series = reversed_force(delta, 1e6, 1.0, b, LAM, MU, terms=70)
        assert np.abs(series / exact - 1).max() < 1e-13
        if b > 10:
            outside = np.array([0.99, 1.01]) * limit
            found = reversed_force(outside**2 / 1e6, 1e6, 1.0, b, LAM, MU)
            assert np.isnan(found).tolist() == [False, True]


def test_domain_and_types() -> None:
    plate_coefficients = contact_series.plate_coefficients
    reversed_force = reversed_series.force_by_series
    assert np.isnan(law.indentation([-1.0, 2.0, np.nan, np.inf], 100.0, 0.1, 2.0)).all()
    assert np.isnan(law.indentation(0.1, [0.0, -1.0, 0.05], 0.1, 2.0)).all()
    assert np.isnan(law.indentation(0.1, 1.0, [0.0, -1.0, np.nan], [1.0, 1.0, 1.0])).all()
    assert law.indentation(0.0, 1.0, 0.1, 1.0) == 0
    assert law.contact_radius(0.0, 1.0, 0.1, 1.0) == 0
    end = float(law.indentation(0.6, 1e3, 0.1, 2.0))
    beyond = law.contact_radius([end * (1 - 1e-12), end * (1 + 1e-12), -1e-9], 1e3, 0.1, 2.0)
    assert np.isnan(beyond).tolist() == [False, True, True]
    single = [np.float32(x) for x in (0.01, 1.0, 0.1, 1.0)]
    assert law.indentation(*single).dtype == np.float32
    assert law.contact_radius(np.zeros(0), 1.0, 0.1, 1.0).shape == (0,)
    assert np.ndim(law.indentation(0.01, 1.0, 0.1, 1.0)) == 0
    assert law.indentation([[0.01], [0.02]], 1.0, [0.1, 0.2, 0.3], 1.0).shape == (2, 3)
    assert plate_coefficients([[0.1, 0.5, np.nan]]).shape == (1, 3, tables.TERMS)
    with pytest.raises(ValueError, match="at least one term"):
        reversed_force(1e-9, 1.0, 0.1, 1.0, LAM, MU, terms=0)


def test_many_plates_are_as_one() -> None:
    eta = np.geomspace(1e-5, 50, 40)
    A = 0.7 * np.minimum(6, 1 / eta)
    together = law.indentation(A, 1e6, 1.0, 1 / eta)
    alone = [float(law.indentation(x, 1e6, 1.0, 1 / e)) for x, e in zip(A, eta, strict=True)]
    assert np.abs(together / alone - 1).max() < 1e-15


# Impact.


@cache
def gauss(count: int) -> list[tuple[arb, arb]]:
    with flint.ctx.workprec(BITS):
        pairs = [arb.legendre_p_root(count, i, weight=True) for i in range(count)]
        return [((1 + x) / 2, w / 2) for x, w in pairs]


def impact_truth(A: float, eta: float) -> tuple[arb, arb, arb]:
    """v0 times contact time, depth, and energy, for h = R = (4/3) E* = 1 and a_m = A."""

    def energy(a: arb) -> arb:
        """int_0^a x^3 d(x^2 (1 + F))."""
        total = arb(0)
        for x, weight in gauss(28):
            F, rise = truth(a * x, eta)
            total += weight * x**4 * (2 * (1 + F) + rise)
        return a**5 * total

    with flint.ctx.workprec(BITS):
        whole, depth = energy(arb(A)), arb(A) ** 2 * (1 + truth(arb(A), eta)[0])
        time = arb(0)
        for u, weight in gauss(28):
            a = A * (1 - u * u)
            F, rise = truth(a, eta)
            speed = (1 - energy(a) / whole).sqrt()
            time += weight * 2 * u * A * a * (2 * (1 + F) + rise) / speed
        return 2 * time, depth, whole


@pytest.mark.parametrize(
    ("A", "eta"), [(1e-6, 0.5), (0.3, 0.5), (1.9, 0.5), (2.5, 0.125), (0.24, 4.0), (5.0, 0.125)]
)
def test_impact(A: float, eta: float) -> None:
    time, depth, energy = impact_truth(A, eta)
    # (4/3) E* = 1 for lam = 0: 16 mu/(3 * 2) = 1; R = 1e6 scales the energy by R^-2.
    R, v0, mu = 1e6, 1e-3, 0.375
    m = 2 * float(energy) / (R * v0) ** 2
    found = impact.impact(R, m, v0, 1.0, 1 / eta, 0.0, mu)
    expected = (float(time) / R / v0, float(depth) / R, A**3 / R, A)
    errors = [abs(float(got) / want - 1) for got, want in zip(found, expected, strict=True)]
    assert max(errors) < 5e-15, errors


def test_hertz_limit() -> None:
    found = impact.impact(0.01, 0.03, 1e-30, 5.0, 9.0, LAM, MU)
    ratio = found.contact_time * 1e-30 / found.max_indentation
    assert abs(ratio / HERTZ_TIME - 1) < 1e-14


def test_linear_spring_limit() -> None:
    found = impact.impact(1e3, 1e-9, 1e-3, 1e-8, 10.0, LAM, MU)  # c1 A is 2e17
    ratio = found.contact_time * 1e-3 / found.max_indentation
    assert abs(ratio / np.pi - 1) < 1e-14


SCENES = (
    (0.05, 0.03, 1e-3, 0.001, 0.05, LAM, MU),
    (0.05, 0.03, 10.0, 0.001, 0.05, LAM, MU),
    (0.05, 0.03, 2000.0, 0.001, 0.05, LAM, MU),
    (0.01, 0.03, 1.0, 0.05, 0.01, LAM, MU),
    (1e3, 1e-3, 1e-3, 1.0, 1e5, LAM, MU),
)


@pytest.mark.parametrize("scene", SCENES)
def test_energy_along_the_history(scene) -> None:
    R, m, v0, h, b, lam, mu = scene
    found = impact.impact(*scene)
    t = np.linspace(1e-6, 1 - 1e-6, 57) * found.contact_time
    state = impact.history(t, *scene)
    x, weight = (0.5 * y for y in np.polynomial.legendre.leggauss(60))
    a = state.contact_radius[:, None] * (0.5 + x)
    force = law.force_of_radius(a, R, lam, mu)
    rise = 3 * force / a / law.stiffness(a, R, h, b, lam, mu)  # d delta/da
    stored = state.contact_radius * (weight * force * rise).sum(axis=1)
    kinetic = 0.5 * m * v0**2
    assert np.abs((stored + 0.5 * m * state.velocity**2) / kinetic - 1).max() < 1e-13
    again = law.indentation(state.contact_radius, R, h, b)
    assert np.allclose(again, state.indentation, rtol=5e-14, atol=0)
    assert np.allclose(law.force_of_radius(state.contact_radius, R, lam, mu), state.force, 1e-13, 0)


@pytest.mark.parametrize("scene", SCENES)
def test_history_moves_at_its_velocity(scene) -> None:
    found = impact.impact(*scene)
    t = np.linspace(0.1, 0.9, 25) * found.contact_time
    step = 1e-3 * found.contact_time
    ahead, behind, far_ahead, far_behind = (
        impact.history(t + n * step, *scene).indentation for n in (1, -1, 2, -2)
    )
    rate = (8 * (ahead - behind) - (far_ahead - far_behind)) / (12 * step)
    velocity = impact.history(t, *scene).velocity
    assert np.abs(rate - velocity).max() < 1e-9 * scene[2]
    mirrored = impact.history(found.contact_time - t, *scene)
    assert np.allclose(mirrored.velocity, -velocity, rtol=0, atol=1e-12 * scene[2])
    middle = impact.history(0.5 * found.contact_time, *scene)
    assert np.allclose(middle.indentation, found.max_indentation, rtol=1e-14, atol=0)
    free = impact.history([-1.0, 0.0, 1e9], *scene)
    assert (free.indentation == 0).all()
    assert free.velocity.tolist() == [scene[2], scene[2], -scene[2]]


def test_units_do_not_matter() -> None:
    metres = impact.impact(0.02, 0.03, 2.0, 1e-3, 0.05, LAM, MU)
    millimetres = impact.impact(20.0, 3e-5, 2000.0, 1.0, 50.0, LAM * 1e-6, MU * 1e-6)
    factors = (1, 1e3, 1, 1e3)
    for one, other, factor in zip(metres, millimetres, factors, strict=True):
        assert abs(float(other) / float(one) / factor - 1) < 5e-15


def test_scaling() -> None:
    base = np.array([0.02, 0.03, 2.0, 1e-3, 0.05])
    one = impact.impact(*base, LAM, MU)
    # All lengths times 8, masses times 8^3: times 8, lengths 8, forces 64.
    two = impact.impact(*(base * [8, 512, 1, 8, 8]), LAM, MU)
    for small, large, factor in zip(one, two, (8, 8, 64, 8), strict=True):
        assert abs(float(large) / float(small) / factor - 1) < 1e-15
    small, large = (
        law.indentation(1e-3, *base[[0, 3, 4]]),
        law.indentation(8e-3, *base[[0, 3, 4]] * 8),
    )
    assert abs(float(large) / float(small) / 8 - 1) < 1e-15


def test_impact_domain_and_types() -> None:
    scene = SCENES[1]
    for index in (0, 1, 2, 3, 4, 6):
        bad = [*scene]
        bad[index] = np.array([0.0, -1.0, np.nan])
        assert np.isnan(np.stack(impact.impact(*bad))).all()
        assert np.isnan(np.stack(impact.history(1e-9, *bad))).all()
    assert np.isnan(impact.impact(*scene[:2], 1e6, *scene[3:]).contact_time)
    single = impact.impact(*(np.float32(x) for x in scene))
    assert all(x.dtype == np.float32 and x.shape == () for x in single)
    grid = impact.impact(0.05, 0.03, [[1.0], [2.0]], [1e-3, 2e-3, 3e-3], 0.05, LAM, MU)
    assert grid.contact_time.shape == (2, 3)
    assert impact.impact(np.zeros(0), *scene[1:]).max_force.shape == (0,)
    each = impact.history(np.linspace(0, 1e-4, 7), 0.05, 0.03, [[1.0], [2.0]], *scene[3:])
    assert each.force.shape == (2, 7)
