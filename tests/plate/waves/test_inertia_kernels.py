"""Test the generated functions of plate inertia: Arb error budgets, limits, known values."""

import math

import numpy as np
import pytest
from shared_scenes import material

from derivation.plate.vocabulary import xi_R
from derivation.plate.waves.oracle import KINDS
from derivation.plate.waves.theory import bending_branch
from generated.inertia import (
    bending_fraction,
    bending_frequency,
    bending_residue,
    dynamic_influence,
)
from generated.plate_waves import branches

pytestmark = pytest.mark.usefixtures("silent")


def test_static_load_is_the_limit() -> None:
    x, nu = np.geomspace(1e-6, 200.0, 40), 0.3
    still, slow = (np.stack(dynamic_influence(x, load, nu)) for load in (0.0, 1e-40))
    np.testing.assert_allclose(slow, still, rtol=1e-13)
    # The values agree on both sides of kap = x^2 and of gam kap = x^2, where Bs has a pole.
    for place in (1.0, 1 / float(material(nu))):
        load = 0.49 * place * np.array([1 - 1e-12, 1 + 1e-12])
        below, above = np.stack(dynamic_influence(0.7, load, nu)).T
        np.testing.assert_allclose(below, above, rtol=1e-10, atol=1e-11)


@pytest.mark.parametrize(("x", "nu"), [(0.2, 0.31), (2.4, 0.1), (1.7, -0.63), (6.0, 0.44)])
def test_no_branch_is_missed(x: float, nu: float) -> None:
    """On a fine grid, B changes its sign only at the computed zeros and the known poles."""
    count = 40
    lines = [branches(x, nu, count, kind)[0] for kind in KINDS]
    most = min(line[-1] for line in lines) * 0.999
    omega = np.linspace(most * 1e-6, most, 100_001)
    compliances = dynamic_influence(x, omega * omega, nu)
    for line, compliance, least in zip(lines, compliances, (0.5, 1.0), strict=True):
        angles = (np.arange(400) + least) * math.pi
        level = float(material(nu))
        poles = [*(x * x + angles**2), *((x * x + angles**2) / level)]
        if least == 1.0:
            poles.append(x * x / level)
        counts, _ = np.histogram([*line, *np.sqrt(poles)], omega)
        changed = np.diff(np.sign(compliance)) != 0
        assert (counts > 0).sum() > 0.8 * count
        np.testing.assert_array_equal(changed, counts % 2 == 1)


def test_branches_without_response_to_pressure() -> None:
    """Two kinds of branches have known frequencies, and S0 for nu = 0 has no deflection.

    S0 for nu = 0 is a longitudinal rod wave. Lame's waves have kap = 2 x^2.
    """
    x = np.array([0.01, 0.3, 1.5])
    frequency, residue = branches(x, 0.0, 1, "symmetric")
    np.testing.assert_allclose(frequency[:, 0], math.sqrt(2) * x, rtol=1e-15)
    assert (residue < 1e-25).all()
    for kind, x in ((KINDS[0], math.pi), (KINDS[1], math.pi / 2)):
        actual, _ = branches(x, 0.3, 6, kind)
        assert np.abs(actual / (math.sqrt(2) * x) - 1).min() < 1e-15


def test_array_shapes_and_rejected_arguments() -> None:
    frequency, residue = branches(np.full((2, 1), 0.3, np.float32), np.float32(0.3), 4)
    assert frequency.shape == residue.shape == (2, 1, 4)
    assert frequency.dtype == residue.dtype == np.float32
    assert branches(np.empty(0), 0.3, 3)[0].shape == (0, 3)
    assert np.isnan(branches([0.0, -1.0, np.nan, 1e41], 0.3, 2)).all()
    assert np.isnan(branches(1.0, [0.5, -1.0, np.nan], 2, "symmetric")).all()
    np.testing.assert_array_equal(branches([np.nan, 1.0], 0.3, 2)[0][1], branches(1.0, 0.3, 2)[0])
    assert branches(1.0, 0.3, 1)[0][0] == bending_frequency(1.0, 0.3)
    with pytest.raises(ValueError, match="parity is"):
        branches(1.0, 0.3, 2, "even")
    with pytest.raises(ValueError, match="at least one"):
        branches(1.0, 0.3, 0)


# --- known answers


def test_thin_plates_have_the_kirchhoff_frequency() -> None:
    """In thin plates A0 has Kirchhoff's frequency and carries the whole deflection.

    Here omega = phi^2 sqrt(D/(rho H)) and r = 1/(rho H).
    """
    x, nu = 1e-5, np.array([-0.9, 0.0, 0.3, 0.499])
    rigidity = 2.0 * 2.0**3 / (12.0 * (1.0 - nu))  # D/(mu h^3), E = 2 mu (1 + nu)
    assert bending_frequency(x, nu) == pytest.approx(x * x * np.sqrt(rigidity / 2), rel=1e-9)
    assert bending_residue(x, nu) == pytest.approx(0.5, rel=1e-9)
    assert bending_fraction(x, nu) == pytest.approx(1.0, rel=1e-9)


def test_short_waves_have_the_rayleigh_speed() -> None:
    """Short waves have the Rayleigh speed: for nu = 1/4, c_R/c_T = sqrt(2 - 2/sqrt 3) = 0.9194."""
    speed = bending_frequency(300.0, 0.25) / 300.0
    assert speed == pytest.approx(0.9194, abs=5e-5)
    assert speed == pytest.approx(math.sqrt(2 - 2 / math.sqrt(3)), rel=1e-15)
    stretching, _ = branches(300.0, 0.25, 1, "symmetric")
    assert stretching[0] / 300.0 == pytest.approx(float(speed), rel=1e-15)
    limit = bending_branch.rayleigh()[1].expression.subs(xi_R, speed**2)
    assert bending_residue(300.0, 0.25) / 300.0 == pytest.approx(float(limit), rel=1e-13)


def test_cut_off_frequencies_are_thickness_resonances() -> None:
    """The cut-off frequencies are n pi/2 for shear and n pi/(2 sqrt gam) for pressure waves.

    Bending branches have odd n for shear and even n for pressure waves, so A1 begins at pi/2.
    Extensional branches have the other n.
    """
    nu, x = 0.25, 1e-9
    pressure = math.sqrt(2 * (1 - nu) / (1 - 2 * nu))
    odd, even = (np.arange(1, 30) - 0.5) * math.pi, np.arange(1, 30) * math.pi
    for kind, shear, other in ((KINDS[0], odd, even), (KINDS[1], even, odd)):
        known = np.sort(np.concatenate((shear, other * pressure)))[:20]
        actual, _ = branches(x, nu, 21, kind)
        np.testing.assert_allclose(actual[1:], known, rtol=1e-15)
    assert branches(x, nu, 2)[0][1] == pytest.approx(math.pi / 2, rel=1e-15)


def test_extensional_branch_of_thin_plates() -> None:
    """In thin plates S0 has the frequency omega = phi sqrt(E*/rho)."""
    x, nu = 1e-6, np.array([-0.9, 0.0, 0.4])
    assert branches(x, nu, 1, "symmetric")[0][:, 0] == pytest.approx(x * np.sqrt(2 / (1 - nu)))


@pytest.mark.parametrize("x", [0.3, 1.0, 4.0])
@pytest.mark.parametrize("nu", [-0.5, 0.0, 0.25, 0.49])
@pytest.mark.parametrize("parity", KINDS)
def test_branches_add_up_to_the_static_load(x: float, nu: float, parity: str) -> None:
    """sum r/kap converges to the static 1/B; N branches omit a part proportional to 1/N."""
    whole = float(dynamic_influence(x, 0.0, nu)[KINDS.index(parity)])
    frequency, residue = branches(x, nu, 400, parity)
    fractions = residue / frequency**2 / whole
    assert (fractions >= 0).all()
    lack = 1.0 - np.cumsum(fractions)[[99, 199, 399]]
    assert (lack > 0).all()
    assert lack[0] < 0.02
    assert lack[:2] / lack[1:] == pytest.approx([2.0, 2.0], rel=0.15)
    if parity == KINDS[0]:
        other = float(dynamic_influence(x, 0.0, nu)[1])
        lowest = float(bending_fraction(x, nu)) * (1 + other / whole)
        assert fractions[0] == pytest.approx(lowest, rel=1e-14)


def test_contribution_of_the_lowest_branch() -> None:
    """For nu = 1/4, A0 carries 98 % of the static deflection at x = 0.5 and 79 % at x = 1."""
    assert bending_fraction([0.5, 1.0], 0.25) == pytest.approx([0.9765, 0.7945], abs=5e-5)
