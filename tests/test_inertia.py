"""The plate's own motion: theory, oracles, kernels, known limits."""

import math
import warnings
from collections.abc import Iterator

import numpy as np
import pytest

from generated.inertia import (
    bending_frequency,
    bending_residue,
    bending_share,
    dynamic_influence,
)
from generated.plate_waves import branches

KINDS = ("antisymmetric", "symmetric")


@pytest.fixture(autouse=True)
def _silent() -> Iterator[None]:
    with warnings.catch_warnings(), np.errstate(all="raise"):
        warnings.simplefilter("error")
        yield


# --- known answers


def test_thin_plates_bend_as_kirchhoffs() -> None:
    """omega = phi^2 sqrt(D/(rho H)), r = 1/(rho H), and all of the deflection."""
    x, nu = 1e-5, np.array([-0.9, 0.0, 0.3, 0.499])
    rigidity = 2.0 * 2.0**3 / (12.0 * (1.0 - nu))  # D/(mu h^3), E = 2 mu (1 + nu)
    assert bending_frequency(x, nu) == pytest.approx(x * x * np.sqrt(rigidity / 2), rel=1e-9)
    assert bending_residue(x, nu) == pytest.approx(0.5, rel=1e-9)
    assert bending_share(x, nu) == pytest.approx(1.0, rel=1e-9)


def test_short_waves_are_rayleighs() -> None:
    """Poisson's solid: c_R/c_T = 0.9194 (Rayleigh, 1885), exactly sqrt(2 - 2/sqrt 3)."""
    speed = bending_frequency(300.0, 0.25) / 300.0
    assert speed == pytest.approx(0.9194, abs=5e-5)
    assert speed == pytest.approx(math.sqrt(2 - 2 / math.sqrt(3)), rel=1e-15)
    stretching, _ = branches(300.0, 0.25, 1, "symmetric")
    assert stretching[0] / 300.0 == pytest.approx(float(speed), rel=1e-15)


def test_cut_offs_are_resonances_through_the_thickness() -> None:
    """At x = 0 shear waves resonate at n pi/2 and pressure waves at n pi/2 over sqrt gam.

    Bending takes n odd of shear, even of pressure: A1 begins at pi/2. Stretching the others.
    """
    nu, x = 0.25, 1e-9
    pressure = math.sqrt(2 * (1 - nu) / (1 - 2 * nu))
    odd, even = (np.arange(1, 30) - 0.5) * math.pi, np.arange(1, 30) * math.pi
    for kind, shear, other in (("antisymmetric", odd, even), ("symmetric", even, odd)):
        known = np.sort(np.concatenate((shear, other * pressure)))[:20]
        found, _ = branches(x, nu, 21, kind)
        np.testing.assert_allclose(found[1:], known, rtol=1e-15)
    assert branches(x, nu, 2)[0][1] == pytest.approx(math.pi / 2, rel=1e-15)


def test_thin_plates_stretch() -> None:
    """S0: omega = phi sqrt(E*/rho)."""
    x, nu = 1e-6, np.array([-0.9, 0.0, 0.4])
    assert branches(x, nu, 1, "symmetric")[0][:, 0] == pytest.approx(x * np.sqrt(2 / (1 - nu)))


@pytest.mark.parametrize("x", [0.3, 1.0, 4.0])
@pytest.mark.parametrize("nu", [-0.5, 0.0, 0.25, 0.49])
@pytest.mark.parametrize("parity", KINDS)
def test_branches_carry_the_load_at_rest(x: float, nu: float, parity: str) -> None:
    """sum r/kap is 1/B at kap = 0; what N branches lack goes with 1/N."""
    whole = float(dynamic_influence(x, 0.0, nu)[KINDS.index(parity)])
    frequency, residue = branches(x, nu, 400, parity)
    shares = residue / frequency**2 / whole
    assert (shares >= 0).all()
    lack = 1.0 - np.cumsum(shares)[[99, 199, 399]]
    assert (lack > 0).all()
    assert lack[0] < 0.02
    assert lack[:2] / lack[1:] == pytest.approx([2.0, 2.0], rel=0.15)
    if parity == "antisymmetric":
        assert shares[0] == pytest.approx(
            float(bending_share(x, nu)) * (1 + float(dynamic_influence(x, 0.0, nu)[1]) / whole)
        )
