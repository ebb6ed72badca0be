"""Test the slope of the contact law and the sensitivities of an impact."""

import math
from fractions import Fraction

import flint
import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf

from derivation.engine.formula.ball import to_ball
from derivation.engine.formula.dimension import unit as dimension_of
from derivation.engine.formula.proof import ProofError, prove
from derivation.plate.contact.oracle import balls as contact_balls
from derivation.plate.contact.oracle.balls import ratio_of
from derivation.plate.contact.oracle.sums import excess
from derivation.plate.contact.route import residue_law
from derivation.plate.impact.oracle import sensitivity
from derivation.plate.impact.oracle.impact import stored_energy
from derivation.plate.impact.theory import sensitivity as theory
from derivation.plate.modes.theory.plate_factor import plate_factor_slope, plate_factors
from derivation.plate.vocabulary import BY_NAME, T
from generated import contact_law, impact
from generated.sensitivity import PARAMETERS, RESULTS, impact_sensitivities, indentation_slope

LAM, MU = 6e10, 8e10
SCENE = (0.05, 0.03, 10.0, 0.001, 0.05, LAM, MU)
THICK = (1e3, 2.0, 0.0022, 1.0, 0.01, LAM, MU)
"""Scene with h/b = 100."""
ROOT = 0.5301974990742511
"""The double nearest to the h/b at which c_1 = 0."""
BELOW, ABOVE = 1 - 1e-9, 1 + 1e-9
BITS = 128
LIMIT = 2e-15


pytestmark = pytest.mark.usefixtures("no_warning")


# --- theory


def test_slope_of_the_plate_factor_is_its_derivative() -> None:
    G, slope = plate_factors()[0].expression, plate_factor_slope().expression
    with pytest.raises(ProofError, match="halved leaves the residual"):
        prove("Slope", "", {"halved": T * sp.diff(G, T) - slope / 2})


def test_hertz_impact_has_the_known_exponents() -> None:
    """The contact time of a Hertz impact has the known exponents.

    It is proportional to Y^(-1/10) sqrt(m/(E* h)), with Y the energy number.
    """
    table = theory.exponents()
    own, energy = (table[name] for name in ("contact_time", "energy"))
    total = [a - sp.Rational(1, 10) * e for a, e in zip(own, energy, strict=True)]
    fifth = sp.Rational(1, 5)
    assert total == [-fifth, 2 * fifth, -fifth, 0, 0, -2 * fifth]


# --- slope of the law


def test_slope_and_stiffness_agree() -> None:
    a = np.geomspace(1e-8, 5e-3, 60)
    slope = indentation_slope(a, 0.05, 1e-3, 0.05)
    rise = 3.0 * contact_law.force_of_radius(a, 0.05, LAM, MU) / a
    stiff = contact_law.stiffness(a, 0.05, 1e-3, 0.05, LAM, MU)
    assert np.abs(slope * stiff / rise - 1).max() < 3e-15


def test_stiffness_on_the_short_range_of_the_second_polynomial() -> None:
    """The range of the second polynomial is short if 1/eta slightly exceeds 3.

    It starts at A = 3 and ends at alpha = 1, that is A = 1/eta.
    """
    for v, A in ((3.0012, 3.0006), (3.0001, 3.00005), (3.0001, 2.9999), (2.999, 2.9987)):
        got = contact_law.stiffness(A, 1e3, 1.0, v, LAM, MU)
        exact = contact_balls.stiffness(A, 1e3, 1.0, v, LAM, MU, 22)
        assert abs(float(got) - exact) < LIMIT * exact


# --- sensitivities against the reference


def test_more_digits_agree_with_fewer() -> None:
    few, many = (sensitivity.impact_sensitivities(THICK, digits) for digits in (20, 40))
    with flint.ctx.workprec(160):
        for short, long in zip(few, many, strict=True):
            assert long.rad() < 1e-39
            assert abs(short - long) < 1e-19
        assert all(abs(sum(many[k + 5 : k + 7], flint.arb(0))) < 1 for k in range(0, 28, 7))


def test_conditioning_is_the_change_by_the_parameters() -> None:
    """The conditioning is the sum of the changes due to each parameter, by finite differences."""
    scene, step = THICK, 1e-4
    total = np.zeros((len(RESULTS), len(PARAMETERS)))
    for index in range(len(PARAMETERS)):
        ends = [
            [*scene[:index], scene[index] * f, *scene[index + 1 :]] for f in (1 + step, 1 - step)
        ]
        upper, lower = (impact_sensitivities(*moved) for moved in ends)
        total += np.abs(upper - lower) / (2 * step)
    values = sensitivity.impact_sensitivities(scene, 20)
    actual = [float(x) for x in sensitivity.rounding(scene, values)]
    np.testing.assert_allclose(np.reshape(actual, total.shape), total, rtol=1e-4, atol=1e-8)


def test_second_reference_agrees_with_finite_differences() -> None:
    """Finite differences of the mpmath reference agree; the step of v0 = 5 is exact."""
    scene, step = (1e3, 2.0, 5.0, 1.0, 3.5, LAM, MU), 2.0**-20
    upper, lower = (
        residue_law.impact(*scene[:2], 5.0 * (1 + x), *scene[3:], digits=20) for x in (step, -step)
    )
    got = impact_sensitivities(*scene)[:, 2]
    with mp.workdps(30):
        for high, low, value in zip(upper, lower, got, strict=True):
            assert abs(mp.log(high / low) / (2 * mpf(step)) - mpf(float(value))) < 1e-12


def peaks_by_energy(a: float, h: float, b: float) -> tuple[flint.arb, flint.arb]:
    """Return the exact sensitivities of indentation and radius to energy, at a largest radius.

    With dE = P d delta, that of the radius is (1 + work)/(5 (1 + sinc)) in terms of the sums
    of `contact.oracle.sums`.
    """
    with flint.ctx.workprec(BITS):
        eta, alpha = ratio_of(h, b), to_ball(ratio_of(a, b))
        work, slope, depth = (1 + excess(name, alpha, eta) for name in ("work", "sinc", "hertz"))
        return 2 * work / (5 * depth), work / (5 * slope)


def peaks_by_thickness(a: float, h: float, b: float) -> tuple[flint.arb, flint.arb]:
    """Return the sensitivities of delta R/h^2 and a/h to h/b at a fixed energy number."""
    ratio = ratio_of(a, h)

    def results(factor: Fraction) -> tuple[flint.arb, flint.arb]:
        eta = ratio_of(h, b) * factor
        alpha = to_ball(ratio * eta)
        return 1 + excess("hertz", alpha, eta), 1 + excess("work", alpha, eta)

    with flint.ctx.workprec(BITS):
        depth, work = sensitivity.logarithmic(results, Fraction(1, 2**22), BITS, 1e-20)
        by_energy, radius = peaks_by_energy(a, h, b)
        return depth - work * by_energy, -work * radius


@pytest.mark.parametrize(("v", "A"), [(3.01, 3 * BELOW), (4 * BELOW, 3.5), (1 / ROOT, 1.0)])
def test_sensitivities_of_peaks_agree_with_interval_arithmetic(v: float, A: float) -> None:
    """The sensitivities of the peaks follow from work and slope of the law, without an impact."""
    energy = stored_energy(A, 1e3, 1.0, v, LAM, MU, 22)
    got = impact_sensitivities(1e3, 2.0, math.sqrt(float(energy)), 1.0, v, LAM, MU)
    by_energy = peaks_by_energy(A, 1.0, v)
    by_eta = peaks_by_thickness(A, 1.0, v)
    # The energy is rounded to a double, which explains the larger limit.
    for row, energy_ball, eta_ball in zip((1, 3), by_energy, by_eta, strict=True):
        assert abs(energy_ball - float(got[row, 2]) / 2) < LIMIT
        assert abs(eta_ball + float(got[row, 4])) < 2 * LIMIT


# --- limits


def test_sensitivities_of_small_contacts_agree_with_hertz() -> None:
    got = impact_sensitivities(0.01, 0.03, 1e-30, 5.0, 9.0, LAM, MU)
    expected = [
        [-0.2, 0.4, -0.2, 0.0, 0.0, -0.4],
        [-0.2, 0.4, 0.8, 0.0, 0.0, -0.4],
        [0.2, 0.6, 1.2, 0.0, 0.0, 0.4],
        [0.4, 0.2, 0.4, 0.0, 0.0, -0.2],
    ]
    modulus = got[:, 5] + got[:, 6]
    assert np.abs(np.column_stack((got[:, :5], modulus)) - expected).max() < 1e-15


def test_sensitivities_of_compliant_plates_agree_with_a_linear_spring() -> None:
    """In the limit of a linear spring the time is independent of sphere radius and speed.

    The deflection is P b^2/(8 pi D) with D = (2/3) E* h^3.
    """
    got = impact_sensitivities(1e3, 1e-9, 1e-3, 1e-8, 10.0, LAM, MU)
    third = 1 / 3
    expected = [
        [0.0, 0.5, 0.0, -1.5, 1.0, -0.5],
        [0.0, 0.5, 1.0, -1.5, 1.0, -0.5],
        [0.0, 0.5, 1.0, 1.5, -1.0, 0.5],
        [third, third / 2, third, 0.5, -third, -third / 2],
    ]
    modulus = got[:, 5] + got[:, 6]
    assert np.abs(np.column_stack((got[:, :5], modulus)) - expected).max() < 2e-15


# --- scaling

SCENES = st.tuples(
    st.floats(-3.0, 2.0),  # log10 h/b
    st.floats(-4.0, 0.98),  # log10 of a/h over its largest value, 6 or b/h
    st.floats(-0.6, 50.0),  # lam/mu
    st.floats(-3.0, 3.0),  # log10 b
)


def scene_of(shape: tuple[float, float, float, float]) -> tuple[float, ...]:
    thickness, width, ratio, size = shape
    b = 10**size
    h = b * 10**thickness
    a = min(6.0 * h, b) * min(10**width, 0.98)
    R, m, mu = 50.0 * b, 2.0, 3e9
    lam = ratio * mu
    # 40 % of the work of the half-space law, so that the largest radius stays within the range.
    modulus = 4 * mu * (lam + mu) / (lam + 2 * mu)
    energy = 8 / 15 * modulus * a**5 / R**2 * 0.4
    return R, m, math.sqrt(2 * energy / m), h, b, lam, mu


@given(SCENES)
@settings(max_examples=60)
def test_results_do_not_depend_on_units(shape: tuple[float, float, float, float]) -> None:
    got = impact_sensitivities(*scene_of(shape))
    assert np.isfinite(got).all()
    for row, unit in zip(got, theory.RESULTS.values(), strict=True):
        for basis in ("length", "mass", "time"):
            weights = [float(getattr(dimension_of(BY_NAME[x].unit), basis)) for x in PARAMETERS]
            expected = float(getattr(dimension_of(unit), basis))
            assert abs(np.dot(weights, row) - expected) < 2e-14


@given(SCENES, st.sampled_from(range(7)))
@settings(max_examples=40)
def test_sensitivities_agree_with_differences_of_the_impact(
    shape: tuple[float, float, float, float], index: int
) -> None:
    scene, step = scene_of(shape), 1e-3

    def results(factor: float) -> np.ndarray:
        return np.log(impact.impact(*scene[:index], scene[index] * factor, *scene[index + 1 :]))

    near, far = ((results(math.exp(x)) - results(math.exp(-x))) / (2 * x) for x in (step, 2 * step))
    assert np.abs((4 * near - far) / 3 - impact_sensitivities(*scene)[:, index]).max() < 1e-9


def test_peaks_depend_on_mass_and_speed_by_energy() -> None:
    """Peaks depend on m and v0 only by m v0^2; the contact time has an extra factor sqrt(m)."""
    got = impact_sensitivities(*SCENE)
    assert np.abs(got[1:, 2] - 2 * got[1:, 1]).max() < 1e-15
    assert abs(got[0, 1] - 0.5 - got[0, 2] / 2) < 1e-15


# --- arrays


def test_sensitivities_are_nan_outside_the_domain_and_keep_single_precision() -> None:
    for index in (0, 1, 2, 3, 4, 6):
        bad = [*SCENE]
        bad[index] = np.array([0.0, -1.0, np.nan])
        got = impact_sensitivities(*bad)
        assert got.shape == (4, 7, 3)
        assert np.isnan(got).all()
    assert np.isnan(impact_sensitivities(*SCENE[:2], 1e6, *SCENE[3:])).all()
    assert np.isnan(impact_sensitivities(*SCENE[:5], -0.7 * MU, MU)).all()
    wide = (1e-4, 0.03, 50.0, *SCENE[3:])  # the contact is wider than the sphere
    assert np.isnan(impact.impact(*wide).contact_time)
    assert np.isnan(impact_sensitivities(*wide)).all()
    single = impact_sensitivities(*(np.float32(x) for x in SCENE))
    assert single.dtype == np.float32
    assert single.shape == (4, 7)
    assert np.isfinite(single).all()
    speeds, heights = [[1.0], [2.0]], [1e-3, 2e-3, 3e-3]
    grid = impact_sensitivities(0.05, 0.03, speeds, heights, 0.05, LAM, MU)
    assert grid.shape == (4, 7, 2, 3)
    one = impact_sensitivities(0.05, 0.03, 2.0, 2e-3, 0.05, LAM, MU)
    assert np.abs(grid[:, :, 1, 1] - one).max() < 1e-15
    assert impact_sensitivities(np.zeros(0), *SCENE[1:]).shape == (4, 7, 0)


def test_arrays_of_scenes_equal_single_scenes() -> None:
    speed = np.geomspace(1e-3, 3e3, 1200)  # more than one batch, also beyond A = 3
    h = np.resize([1e-3, 2e-3, 5e-3, 0.02, 0.7], 1200)
    together = impact_sensitivities(*SCENE[:2], speed, h, *SCENE[4:])
    for index in (0, 511, 512, 1100, 1199):
        alone = impact_sensitivities(*SCENE[:2], speed[index], h[index], *SCENE[4:])
        np.testing.assert_allclose(together[:, :, index], alone, rtol=0, atol=2e-15)
