"""Test the generated contact law and impact: coefficients, inverses, limits, energy balance."""

from functools import cache

import flint
import numpy as np
import pytest
from flint import arb

from derivation.engine.formula.ulp import DOUBLE, SINGLE, Format, spacing_exponent
from derivation.plate.contact.cases.check import stated_limits
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.impact.oracle import impact as contact_impact
from generated import contact_law as law
from generated import contact_series, impact, reversed_series

LAM, MU = 6e10, 8e10
THICK = (0.34, 0.4, 0.5302, 1.0, 3.0, 10.0, 100.0)
SWITCHES = [float(np.nextafter(1 / v, side)) for v in (3, 4, 6, 11) for side in (0, 1)]
ETAS = (1e-3, 0.01, 0.05, 0.08, *SWITCHES, 0.1, 0.14, 0.17, 0.2, 0.25, 0.3, *THICK)
HERTZ_TIME = 2.9432751843247046
"""2 int_0^1 dx/sqrt(1 - x^(5/2)), which is twice 1.4716375921623523."""


PLATES = (1e-3, 0.05, 0.0908, 0.0911, 0.2, 0.3332, 0.3335, 0.5302, 1.0, 10.0)


@cache
def departure(alpha: float, eta: float) -> arb:
    return contact_balls.relative_correction(alpha, eta, 1.0, 25)


@pytest.mark.parametrize("eta", PLATES)
@pytest.mark.parametrize("fmt", [DOUBLE, SINGLE], ids=lambda fmt: fmt.name)
def test_coefficients_give_the_correction(eta: float, fmt: Format) -> None:
    kind = np.dtype(fmt.name).type
    eta = float(np.float32(eta))  # rounded for both formats, which then share the reference values
    rows = contact_series.plate_coefficients(kind(eta))
    assert rows.dtype == fmt.name
    with flint.ctx.workprec(200):
        reach = min(arb(3), 1 / arb(eta))
        for fraction in (0.02, 0.16, 0.5, 0.8, 0.98):
            A = reach * arb(fraction)
            alpha = float(A * arb(eta))
            A = arb(alpha) / arb(eta)
            value = arb(0)
            for coefficient in rows[::-1]:
                value = value * (A / reach) ** 2 + arb(float(coefficient))
            reference = departure(alpha, eta)
            unit = arb(2) ** spacing_exponent((1 + reference).max(abs(reference)), fmt)
            assert abs(A * value - reference) / unit <= stated_limits()["plate_coefficients"]


@pytest.mark.parametrize("eta", [*ETAS, 1e-4, 1e-6])
def test_contact_radius_inverts_the_indentation(eta: float) -> None:
    random = np.random.default_rng(3)
    top = min(6.0, 0.9999999 / eta)
    A = np.concatenate((10 ** random.uniform(-12, np.log10(top), 300), [top]))
    back = law.contact_radius(law.indentation(A, 1e6, 1.0, 1 / eta), 1e6, 1.0, 1 / eta)
    assert np.abs(back / A - 1).max() < 2e-15


def test_radius_of_force_inverts_the_force() -> None:
    a = np.geomspace(1e-9, 1e-3, 50)
    P = law.force_of_radius(a, 0.02, LAM, MU)
    assert np.abs(law.radius_of_force(P, 0.02, LAM, MU) / a - 1).max() < 1e-15
    delta = law.indentation(a, 0.02, 1e-3, 0.02)
    assert np.abs(law.force(delta, 0.02, 1e-3, 0.02, LAM, MU) / P - 1).max() < 5e-15
    mean = P / (np.pi * a**2)
    assert np.allclose(law.max_pressure(a, 0.02, LAM, MU), 1.5 * mean, rtol=1e-14, atol=0)


def test_reversed_series_is_nan_beyond_its_radius() -> None:
    plate_coefficients = contact_series.plate_coefficients
    reversed_force = reversed_series.force_by_series
    for b in (5.0, 20.0, 1000.0, 1.5):
        c1 = float(plate_coefficients(1 / b)[0])
        limit = 2 / (3 * np.sqrt(3) * abs(c1))  # convergence radius of the series with c_1 alone
        eps = np.array([0.1, 0.3, 0.5]) * min(limit, 0.9 * min(3.0, b))
        delta = eps**2 / 1e6
        exact = law.force(delta, 1e6, 1.0, b, LAM, MU)
        series = reversed_force(delta, 1e6, 1.0, b, LAM, MU, terms=70)
        assert np.abs(series / exact - 1).max() < 1e-13
        if b > 10:
            outside = np.array([0.99, 1.01]) * limit
            actual = reversed_force(outside**2 / 1e6, 1e6, 1.0, b, LAM, MU)
            assert np.isnan(actual).tolist() == [False, True]


def test_law_covers_extreme_plates_and_wide_contacts() -> None:
    """The law covers 1e-90 < h/b < 1e90 and contact radii up to 6 h, and gives NaN beyond.

    For a thin plate c_1 is 1/(4 pi eta^2).
    """
    first = contact_series.plate_coefficients([1.5e-90, 0.9e-90, 0.9e90, 1.1e90])[:, 0]
    assert np.isnan(first).tolist() == [False, True, False, True]
    assert abs(first[0] * 4 * np.pi * 1.5e-90**2 - 1) < 1e-12
    wide = float(contact_balls.indentation(6.0, 50.0, 1.0, 20.0, 20))
    radius = law.contact_radius([wide * (1 + 7e-16), wide * (1 + 1e-13)], 50.0, 1.0, 20.0)
    assert np.isnan(radius).tolist() == [False, True]
    assert abs(radius[0] - 6.0) < 1e-14


def test_reversed_series_of_one_term_is_the_hertz_force() -> None:
    actual = reversed_series.force_by_series(1e-6, 0.02, 0.02, 0.02, LAM, MU, terms=1)
    modulus = 4 * MU * (LAM + MU) / (LAM + 2 * MU)
    assert abs(actual / (4 / 3 * modulus * np.sqrt(0.02) * 1e-9) - 1) < 1e-14


def test_arrays_of_plates_equal_single_plates() -> None:
    eta = np.geomspace(1e-5, 50, 40)
    A = 0.7 * np.minimum(6, 1 / eta)
    together = law.indentation(A, 1e6, 1.0, 1 / eta)
    alone = [float(law.indentation(x, 1e6, 1.0, 1 / e)) for x, e in zip(A, eta, strict=True)]
    assert np.abs(together / alone - 1).max() < 1e-15


# --- impact


@pytest.mark.parametrize(("b", "end"), [(2.0, 2.0), (6.0, 3.6)])
def test_impact_up_to_the_limit_of_the_law(b: float, end: float) -> None:
    """An impact can reach the limit of the contact law, which is a = b or a = 6 h."""
    R, m, h = 20.0, 3e7, 0.6
    energy = contact_impact.stored_energy(np.nextafter(end, 0.0), R, h, b, LAM, MU, digits=18)
    result = impact.impact(R, m, np.sqrt(2 * float(energy) / m), h, b, LAM, MU)
    assert abs(result.max_contact_radius / end - 1) < 1e-12


def test_small_contacts_agree_with_hertz() -> None:
    result = impact.impact(0.01, 0.03, 1e-30, 5.0, 9.0, LAM, MU)
    ratio = result.contact_time * 1e-30 / result.max_indentation
    assert abs(ratio / HERTZ_TIME - 1) < 1e-14


def test_compliant_plates_agree_with_a_linear_spring() -> None:
    result = impact.impact(1e3, 1e-9, 1e-3, 1e-8, 10.0, LAM, MU)  # c1 A is 2e17
    ratio = result.contact_time * 1e-3 / result.max_indentation
    assert abs(ratio / np.pi - 1) < 1e-14


SCENES = (
    (0.05, 0.03, 1e-3, 0.001, 0.05, LAM, MU),
    (0.05, 0.03, 10.0, 0.001, 0.05, LAM, MU),
    (0.05, 0.03, 2000.0, 0.001, 0.05, LAM, MU),
    (0.01, 0.03, 1.0, 0.05, 0.01, LAM, MU),
    (1e3, 1e-3, 1e-3, 1.0, 1e5, LAM, MU),
)


@pytest.mark.parametrize("scene", SCENES)
def test_history_conserves_energy(scene) -> None:
    R, m, v0, h, b, lam, mu = scene
    result = impact.impact(*scene)
    t = np.linspace(1e-6, 1 - 1e-6, 57) * result.contact_time
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
def test_velocity_is_the_derivative_of_the_indentation(scene) -> None:
    result = impact.impact(*scene)
    t = np.linspace(0.1, 0.9, 25) * result.contact_time
    step = 1e-3 * result.contact_time
    ahead, behind, far_ahead, far_behind = (
        impact.history(t + n * step, *scene).indentation for n in (1, -1, 2, -2)
    )
    rate = (8 * (ahead - behind) - (far_ahead - far_behind)) / (12 * step)
    velocity = impact.history(t, *scene).velocity
    assert np.abs(rate - velocity).max() < 1e-9 * scene[2]
    mirrored = impact.history(result.contact_time - t, *scene)
    assert np.allclose(mirrored.velocity, -velocity, rtol=0, atol=1e-12 * scene[2])
    middle = impact.history(0.5 * result.contact_time, *scene)
    assert np.allclose(middle.indentation, result.max_indentation, rtol=1e-14, atol=0)
    free = impact.history([-1.0, 0.0, 1e9], *scene)
    assert (free.indentation == 0).all()
    assert free.velocity.tolist() == [scene[2], scene[2], -scene[2]]
